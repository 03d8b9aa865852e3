"""The analyses pass axe in light and dark, wide and narrow; what is shown is chosen by keyboard."""

import re

import pytest
from playwright.sync_api import Page, expect

from access import barriers
from workbench import open_analyses, open_workbench, settled

# Not all on one page: a change of theme draws every plot anew.
GROUPS = (
    ("response", "laplace", "routh", "stability", "state_space", "low_order", "compare", "gain_map"),
    ("limits", "bode_integral", "spectrum"),
)
FULL = (
    "response.sum=superposition&response.input=sampled&response.y=1&laplace.a=1,3,2&laplace.initial=1,0"
    "&compare.spread_pct=20"
)


@pytest.mark.parametrize("names", GROUPS, ids=" ".join)
@pytest.mark.parametrize("width", [1440, 360])
def test_every_analysis_passes_axe(page: Page, width: int, names: tuple[str, ...]):
    page.set_viewport_size({"width": width, "height": 900})
    open_analyses(page, *names, query=FULL)
    settled(page)
    assert barriers(page, colours=width > 1000) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_plots_and_analyses_are_two_named_groups(page: Page):
    open_workbench(page)
    analyses = page.get_by_role("group", name="Analyses")
    expect(page.get_by_role("group", name="Plots").get_by_role("button", pressed=True)).to_have_count(5)
    expect(analyses.get_by_role("button", pressed=True)).to_have_count(0)
    expect(page.get_by_label("Show", exact=True)).to_be_hidden()
    routh = analyses.get_by_role("button", name="Routh")
    routh.focus()
    routh.press("Space")
    expect(page.locator("#panel-routh .routh-array")).to_be_visible()
    expect(routh).to_have_attribute("aria-pressed", "true")
    expect(page).to_have_url(re.compile("show=step,bode,nyquist,root_locus,numbers,routh"))
    routh.press("Enter")
    expect(page.locator("#panel-routh")).to_have_count(0)


def test_on_a_narrow_page_a_list_picks_what_is_shown(page: Page):
    page.set_viewport_size({"width": 360, "height": 740})
    open_workbench(page)
    shown = page.get_by_label("Show", exact=True)
    expect(page.get_by_role("group", name="Analyses")).to_be_hidden()
    expect(shown).to_have_value("step")
    shown.focus()
    shown.press("l")
    expect(page.locator("#panel-laplace math").first).to_be_visible()
    expect(page.locator("#panel-step")).to_have_count(0)
    expect(page).to_have_url(re.compile("show=laplace"))


def test_every_control_of_an_analysis_is_reached_by_tab(page: Page):
    open_analyses(page, "response")
    page.locator("#panel-response").get_by_role("radio", name=re.compile("without feedback")).focus()
    reached = set()
    for _ in range(16):
        page.keyboard.press("Tab")
        reached.add(
            page.evaluate(
                "document.activeElement.labels?.[0]?.textContent || document.activeElement.getAttribute('aria-label')"
                " || document.activeElement.textContent"
            )
        )
    assert {"Input u(t)", "Amplitude", "Begins at", "Starts", "Examples", "How to read Response"} <= reached, reached


def test_an_analysis_can_fill_the_stage_and_be_saved(page: Page):
    open_analyses(page, "routh", "state_space")
    page.get_by_role("button", name="Enlarge Routh").click()
    expect(page.locator("#panel-state_space")).to_have_count(0)
    page.get_by_role("button", name="Enlarge Routh").click()
    expect(page.locator("#panel-state_space .matrix").first).to_be_visible()
    with page.expect_download() as download:
        page.get_by_role("button", name="Download the numbers of State space as CSV").click()
    lines = download.value.path().read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("Re,Im,stable")
    assert len(lines) == 4
