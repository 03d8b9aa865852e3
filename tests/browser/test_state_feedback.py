"""State feedback: the pendulum is let go and caught, pushed, lost from 60 degrees, and its poles are dragged."""

import re

from playwright.sync_api import Page, expect

from access import violations

# The run is drawn: the server has answered, and a press of Let go plays it.
READY = "#panel-feedback-run .js-line"
WAIT = 15_000


def ready(page: Page, query: str = "") -> None:
    page.goto(f"/state-feedback?{query}")
    expect(page.locator(READY).first).to_be_attached(timeout=WAIT)


def test_it_is_caught_pushed_and_caught_again(page: Page):
    ready(page)
    expect(page.locator(".feedback-verdict")).to_have_text("Tilt the rod, then press Let go.")
    # K of (s + 2 - i)(s + 2 + i)(s + 5)(s + 6) for the notes' pendulum, by Ackermann's formula
    expect(page.locator("table.matrix").first).to_have_text("−3.367−4.086−26.25−4.778")
    page.get_by_role("button", name="Let go").click()
    expect(page.locator(".feedback-clock")).to_have_text(re.compile(r"t = 0\.[3-9]|t = [1-9]"))
    with page.expect_response(lambda answer: answer.url.endswith("/state-feedback/simulate")) as pushed:
        page.get_by_role("button", name="Push →").click()
    assert len(pushed.value.request.post_data_json["pushes"]) == 1
    page.get_by_label("Moment of the run").press("End")
    expect(page.locator(".feedback-verdict")).to_contain_text("Caught.")


def test_from_sixty_degrees_it_is_lost_and_the_page_finds_out_why(page: Page):
    ready(page, "start.phi=1.0472")
    page.get_by_role("button", name="Let go").click()
    verdict = page.locator(".feedback-verdict")
    expect(verdict).to_contain_text("The cart hits the end of the track after 0.29 s", timeout=WAIT)
    expect(verdict).to_contain_text("at its limit of 20.0")
    page.get_by_role("button", name="Why?").click()
    because = page.locator(".feedback-because")
    expect(because.get_by_role("listitem")).to_have_count(3, timeout=WAIT)
    expect(because).to_contain_text("Neither motor nor track is to blame")
    # from 45 degrees a longer track is all that is missing
    field = page.get_by_role("textbox", name="Tilt, in °")
    field.fill("45")
    field.press("Enter")
    page.get_by_role("checkbox", name="Endless track").check()
    page.get_by_label("Moment of the run").press("End")
    expect(verdict).to_contain_text("Caught.", timeout=WAIT)
    expect(page).to_have_url(re.compile("endless=1"))
    # the map shows where that is, row by row; a click runs from there
    page.get_by_role("button", name="Map the region").click()
    expect(page.locator("#panel-feedback-map .point").nth(40)).to_be_attached(timeout=WAIT)
    plot = page.locator("#panel-feedback-map .plot")
    box = plot.bounding_box()
    assert box
    plot.click(position={"x": 0.25 * box["width"], "y": 0.5 * box["height"]})
    expect(page).to_have_url(re.compile(r"start\.phi=-\d"), timeout=WAIT)


def test_a_pole_is_dragged_and_the_address_keeps_it(page: Page):
    ready(page)
    handle = page.get_by_role("button", name=re.compile("^Closed-loop pole pair"))
    expect(handle).to_be_visible(timeout=WAIT)
    box = handle.bounding_box()
    assert box
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - 10, y - 12, steps=4)
    page.mouse.up()
    expect(page).to_have_url(re.compile("poles="))
    poles = page.get_by_role("textbox", name="Poles")
    typed = poles.input_value()
    first = re.search(r"(-[\d.]+)\+([\d.]+)i", typed)
    assert first and float(first[1]) < -2 and float(first[2]) > 1
    page.reload()
    expect(poles).to_have_value(typed, timeout=WAIT)
    # an observer gives the guarantee away, by weights too
    page.get_by_role("radio", name=re.compile("^LQR")).check()
    margin = page.get_by_role("row", name=re.compile("^Phase margin"))
    expect(margin).to_have_text(re.compile(r"margin[67]\d\.\d°"), timeout=WAIT)
    page.get_by_role("radio", name=re.compile("^Outputs only")).check()
    expect(margin).to_have_text(re.compile(r"margin[12]\d\.\d°"), timeout=WAIT)


def test_the_page_passes_axe_and_fits(page: Page):
    ready(page, "observer=4&integral=1&poles=-2%2B1i,-2-1i,-5,-6,-1")
    for scheme, width in (("light", 1440), ("dark", 360)):
        page.set_viewport_size({"width": width, "height": 900})
        page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
        expect(page.locator("html")).to_have_attribute("data-theme", scheme)
        page.wait_for_timeout(300)
        assert violations(page) == []
        assert page.evaluate("document.documentElement.scrollWidth") == width
