"""Design pages: poles that are dragged or moved by keys, a predictor whose plant differs, and the way between them."""

import re
from urllib.parse import parse_qs, urlsplit

import pytest
from playwright.sync_api import Page, expect

from access import barriers

PAGES = ["/design", "/pole-placement", "/smith-predictor"]


def ready(page: Page, panel: str) -> None:
    expect(page.locator(f"#panel-{panel} .js-line").first).to_be_attached(timeout=20_000)


def query(page: Page) -> dict[str, list[str]]:
    return parse_qs(urlsplit(page.url).query)


def test_the_index_leads_to_the_designs(page: Page):
    page.goto("/design")
    expect(page.get_by_role("navigation", name="Pages").get_by_role("link", name="Design")).to_have_attribute(
        "aria-current", "page"
    )
    targets = [link.get_attribute("href") for link in page.locator("design-cards a").all()]
    assert targets == ["/pole-placement", "/smith-predictor", "/mimo", "/state-feedback"]


def test_poles_are_moved_and_the_controller_follows(page: Page):
    page.goto("/pole-placement")
    ready(page, "placed-response")
    controller = page.locator("#panel-placed-controller")
    # The example of the notes: C = (44 s + 278)/(s + 42), an offset of 84/640.
    expect(controller.locator("math")).to_have_text(re.compile(r"44.*278.*42"))
    expect(controller).to_contain_text("13.1 %")

    handle = page.get_by_role("button", name=re.compile("^Wanted pole −40"))
    handle.focus()
    page.keyboard.press("Shift+ArrowRight")
    expect(page.get_by_role("button", name=re.compile("^Wanted pole −3"))).to_be_visible()
    expect(controller.locator("math")).not_to_have_text(re.compile(r"44.*278.*42"))

    page.get_by_role("switch", name=re.compile("^Integral action")).check()
    expect(controller).to_contain_text("A PID with a filter")
    expect(controller).to_contain_text("0.0 %")
    expect(page.locator(".pole-entry")).to_have_count(3)
    link = controller.get_by_role("link", name="Open in the workbench")
    assert parse_qs(urlsplit(link.get_attribute("href") or "").query)["type"] == ["PID"]
    expect(page).to_have_url(re.compile(r"poles=-2\.5,3\.1225;-3[\d.]+;-[\d.]+&integrator=1"))


@pytest.mark.allow_console(r"status of 422")
def test_what_cannot_be_placed_is_said(page: Page):
    page.goto("/pole-placement?plant=(s%2B2)/((s%2B1)(s%2B2))&poles=-3;-4;-5")
    message = page.locator(".analysis-message.wrong")
    expect(message).to_contain_text("share the root -2", timeout=15_000)
    page.get_by_role("textbox", name="G(s) =").fill("exp(-0.5s)/(s+1)")
    expect(message).to_contain_text("dead time", timeout=10_000)
    order = page.get_by_role("textbox", name="Order of the Padé approximation")
    order.fill("2")
    page.keyboard.press("Enter")
    expect(page.locator("#panel-placed-controller")).to_contain_text("Padé approximation of order 2", timeout=10_000)


def test_a_predictor_meets_a_plant_that_differs(page: Page):
    page.goto("/smith-predictor?model=exp(-4s)/(2s%2B1)")
    ready(page, "smith-response")
    ready(page, "smith-region")
    table = page.get_by_role("table", name="On the plant as it is")
    row = table.get_by_role("row", name=re.compile("^Ms, no mismatch"))
    assert row.inner_text().split("\t")[1:] == ["1.60", "1.60", "1.60"]

    handle = page.get_by_role("button", name=re.compile("^The plant: dead time 0 per cent, gain 0"))
    handle.scroll_into_view_if_needed()
    page.locator("#panel-smith-region").scroll_into_view_if_needed()
    box = handle.bounding_box()
    assert box
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + 240, box["y"] - 150, steps=4)
    page.mouse.up()
    expect(
        page.get_by_role("button", name=re.compile(r"^The plant: dead time \d{2,3} per cent, gain \d{2,3}"))
    ).to_be_visible()
    expect(table.get_by_role("row", name=re.compile("^Stable"))).to_contain_text("no", timeout=15_000)
    expect(page).to_have_url(re.compile("theta="))
    assert float(query(page)["theta"][0]) > 50

    page.get_by_role("button", name="Integrating").click()
    expect(page.locator(".design-note").first).to_contain_text("offset", timeout=15_000)


@pytest.mark.parametrize("path", PAGES)
def test_pages_fit_a_phone_and_have_no_barriers(page: Page, path: str):
    page.set_viewport_size({"width": 360, "height": 740})
    page.goto(path)
    if path != "/design":
        expect(page.locator(".panel .js-line").first).to_be_attached(timeout=20_000)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert barriers(page) == []
