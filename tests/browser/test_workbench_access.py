"""The pages pass axe in light and dark, wide and narrow, open and closed; nothing is cut off."""

import pytest
from playwright.sync_api import Page, expect

from access import barriers
from workbench import open_workbench, settled

SIZES = {"wide": {"width": 1440, "height": 900}, "narrow": {"width": 360, "height": 740}}
ALL_PLOTS = "show=step,bode,nyquist,nichols,root_locus,sensitivity,numbers"


@pytest.mark.parametrize("size", SIZES)
def test_the_workbench_passes_axe(page: Page, size: str):
    page.set_viewport_size(SIZES[size])
    open_workbench(page, ALL_PLOTS)
    for card in ("plant", "controller", "tune", "test"):
        toggle = page.locator(f"#card-{card} .card-toggle")
        if toggle.get_attribute("aria-expanded") == "false":
            toggle.click()
    page.get_by_text("Form, action, setpoint weight").click()
    expect(page.locator(".rule math").first).to_be_visible()
    settled(page)
    assert barriers(page, colours=size == "wide") == []


@pytest.mark.parametrize("size", SIZES)
def test_the_home_page_passes_axe(page: Page, size: str):
    page.set_viewport_size(SIZES[size])
    page.goto("/")
    expect(page.locator("labs-list li").first).to_be_visible()
    assert barriers(page, colours=size == "wide") == []


@pytest.mark.parametrize("width", [360, 768, 1024, 1440, 1920])
@pytest.mark.parametrize("path", ["/", "/workbench"])
def test_nothing_sticks_out_at_the_side(page: Page, path: str, width: int):
    page.set_viewport_size({"width": width, "height": 800})
    page.goto(path)
    expect(page.get_by_role("navigation")).to_be_visible()
    page.wait_for_timeout(300)
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_everything_of_the_rail_is_reached_by_tab(page: Page):
    open_workbench(page)
    settled(page)
    page.locator("body").press("Tab")
    expect(page.get_by_role("link", name="Skip to content")).to_be_focused()
    reached = set()
    for _ in range(45):
        page.keyboard.press("Tab")
        reached.add(
            page.evaluate("document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent")
        )
    wanted = {
        "Setpoint r: choose the test",
        "controller gain Kc slider",
        "controller gain Kc",
        "integral time tau I, in s",
    }
    assert wanted <= reached, reached


def test_a_chip_explains_itself_on_focus_and_hides_on_escape(page: Page):
    open_workbench(page)
    chip = page.locator(".chip-PM_deg")
    page.locator(".chip-GM").focus()
    page.keyboard.press("Tab")
    expect(chip).to_be_focused()
    hint = page.get_by_role("tooltip")
    expect(hint).to_contain_text("Phase margin")
    page.keyboard.press("Escape")
    expect(hint).to_be_hidden()


def test_motion_is_left_out_where_it_is_not_wanted(page: Page):
    page.emulate_media(reduced_motion="reduce")
    open_workbench(page)
    duration = page.evaluate("getComputedStyle(document.querySelector('.button')).transitionDuration")
    assert float(duration.split(",")[0].removesuffix("s")) < 0.001
