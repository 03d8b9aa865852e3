"""The page of several loops: pairing, knobs, decoupler, the address; it passes axe and fits a phone."""

import re

import pytest
from playwright.sync_api import Page, expect

from access import violations

# On a machine that computes for others too.
SLOW = 20_000


def opened(page: Page, query: str) -> None:
    page.goto(f"/mimo?{query}")
    expect(page.locator("#panel-mimo-responses .js-line").first).to_be_attached(timeout=SLOW)
    expect(page.locator(".mimo-cell").first).to_be_visible()
    expect(page.locator("#panel-mimo-interaction table")).to_be_visible()


def test_pairing_knobs_and_decoupler(page: Page):
    # From the plant's own page.
    page.goto("/plants/wood-berry")
    page.get_by_role("link", name=re.compile("^Close its loops")).click()
    expect(page.locator("#panel-mimo-responses .js-line").first).to_be_attached(timeout=SLOW)
    verdict = page.locator(".mimo-verdict")
    expect(verdict).to_contain_text("Stable", timeout=SLOW)
    expect(page.locator(".mimo-cell.paired b")).to_have_text(["2.01", "2.01"])
    expect(page.locator("#panel-mimo-rga")).to_contain_text("Well paired")
    # Luyben's settings, to the three digits that are shown.
    gains = page.get_by_role("textbox", name=re.compile("controller gain", re.IGNORECASE))
    assert [float(field.input_value()) for field in gains.all()] == pytest.approx([0.375, 0.0754])
    # Closing loop 2 halves the gain that loop 1 sees.
    expect(page.locator("#panel-mimo-interaction")).to_contain_text("from 12.8 to 6.37")

    y2 = page.locator("#panel-mimo-responses .js-line").nth(3)
    before = y2.get_attribute("d")
    slider = page.get_by_role("slider").first
    slider.focus()
    for _ in range(5):
        slider.press("ArrowRight")
    expect(y2).not_to_have_attribute("d", before or "")

    page.get_by_role("radio", name=re.compile("^dynamic")).check()
    expect(page.locator("#panel-mimo-decoupler")).to_contain_text("Exact")
    page.get_by_role("radio", name="none").check()
    page.get_by_role("radio", name=re.compile("^crossed")).check()
    expect(verdict).to_contain_text("Unstable", timeout=SLOW)
    expect(page.locator("#panel-mimo-rga")).to_contain_text("Better paired", timeout=SLOW)
    page.get_by_role("button", name="Pair as recommended").click()
    expect(verdict).to_contain_text("Stable", timeout=SLOW)
    page.get_by_role("button", name="Undo").click()
    expect(verdict).to_contain_text("Unstable", timeout=SLOW)
    expect(page).to_have_url(re.compile("pairing=2,1"))
    page.reload()
    expect(verdict).to_contain_text("Unstable", timeout=SLOW)


@pytest.mark.allow_console("422")
def test_a_matrix_of_ones_own_and_what_is_wrong_with_it(page: Page):
    opened(page, "entries=1,5,1;0.5,5,1|0.2,5,1;-2exp(-s)/(3s%2B1)&time=min")
    entry = page.get_by_label(re.compile("from u2 to y1"))
    entry.fill("1/(s2+1)")
    entry.press("Enter")
    expect(entry).to_have_attribute("aria-invalid", "true")
    expect(page.locator("#card-process [role=alert]")).to_contain_text("g12")
    entry.fill("0.4/(5s+1)")
    entry.press("Enter")
    expect(entry).not_to_have_attribute("aria-invalid", "true")
    page.get_by_role("radio", name="3×3").check()
    expect(page.locator(".mimo-cell")).to_have_count(9)
    expect(page.locator("#card-loop-3")).to_be_visible()
    # A decoupler of transfer functions is for two loops.
    expect(page.get_by_role("radio", name=re.compile("^static"))).to_be_visible()
    expect(page.get_by_role("radio", name=re.compile("^dynamic"))).to_have_count(0)


def test_it_passes_axe_and_fits(page: Page):
    opened(page, "plant=ethanol-water&decoupler=dynamic")
    expect(page.locator("#panel-mimo-decoupler math").first).to_be_visible()
    page.evaluate("for (const fold of document.querySelectorAll('details')) fold.open = true")
    for width, scheme in ((1440, "light"), (360, "dark")):
        page.set_viewport_size({"width": width, "height": 900})
        page.emulate_media(color_scheme=scheme)
        expect(page.locator("html")).to_have_attribute("data-theme", scheme)
        page.wait_for_timeout(300)
        assert violations(page) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width
