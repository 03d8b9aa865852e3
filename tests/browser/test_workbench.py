"""The workbench does what a student asks of it: plants, gains, rules, undo, links."""

import re

import pytest
from playwright.sync_api import Page, expect

from workbench import chip, field, open_workbench, settled, slider, verdict


def test_it_opens_with_a_stable_loop_on_every_plot(page: Page):
    open_workbench(page)
    expect(verdict(page)).to_have_attribute("data-verdict", "stable")
    expect(chip(page, "GM")).to_have_text("3.31 (10.4 dB)")
    for plot in ("step", "bode", "nyquist", "root_locus"):
        expect(page.locator(f"#panel-{plot} .js-line").first).to_be_attached()
    expect(page.locator("#panel-nyquist .panel-note")).to_contain_text("Z = N + P = 0 + 0 = 0")
    # Values of an independent computation for 1.4 (1 + 1/(2.2 s))/(s+1)^3.
    expect(page.get_by_role("row", name=re.compile("^Phase margin"))).to_contain_text("45.7")


@pytest.mark.allow_console("status of 422")
def test_a_typed_plant_is_drawn_and_a_wrong_one_says_where(page: Page):
    open_workbench(page)
    text = page.get_by_label("P(s) =")
    text.fill("2/((s-1)(0.1s+1))")
    expect(page.locator("#panel-nyquist .panel-note")).to_contain_text("Z = N + P = −1 + 1 = 0")
    text.fill("2/((s-1)(10s+1))")
    expect(verdict(page)).to_have_attribute("data-verdict", "unstable")

    text.fill("2/((s-1)(0.1q+1))")
    expect(page.get_by_role("alert").filter(has_text="q")).to_contain_text("column 13")
    expect(text).to_have_attribute("aria-invalid", "true")
    # The mark stands under the 13th character.
    expect(page.locator("#card-plant .caret-line")).to_have_text("\u00a0" * 12 + "▲", use_inner_text=False)
    expect(page.locator("#panel-step")).to_have_class(re.compile("stale"))

    text.fill("1/(s+1)")
    expect(text).not_to_have_attribute("aria-invalid", "true")
    expect(verdict(page)).to_have_attribute("data-verdict", "stable")


def test_a_picked_plant_brings_a_loop_that_works(page: Page):
    open_workbench(page)
    page.get_by_role("button", name="Pick a plant").click()
    page.get_by_role("menuitem", name="Lag with dead time").click()
    expect(page.get_by_role("slider", name="dead time theta")).to_be_visible()
    expect(verdict(page)).to_have_attribute("data-verdict", "stable")
    page.get_by_role("button", name="Undo").last.click()
    expect(page.get_by_label("P(s) =")).to_have_value("1/(s+1)^3")


def test_keys_move_a_gain(page: Page):
    open_workbench(page)
    gain = slider(page, "controller gain")
    gain.press("ArrowRight")
    expect(field(page, "Kc")).to_have_value("1.43")
    expect(gain).to_have_attribute("aria-valuetext", "1.43")
    gain.press("Shift+ArrowRight")
    expect(field(page, "Kc")).to_have_value("1.8")
    expect(chip(page, "GM")).to_contain_text("2.58")
    gain.press("End")
    expect(field(page, "Kc")).to_have_value("100")
    expect(verdict(page)).to_have_attribute("data-verdict", "unstable")
    gain.press("Home")
    expect(field(page, "Kc")).to_have_value("0.1")
    expect(verdict(page)).to_have_attribute("data-verdict", "stable")


def test_the_pointer_moves_a_gain(page: Page):
    open_workbench(page)
    before = chip(page, "GM").inner_text()
    box = slider(page, "controller gain").bounding_box()
    assert box is not None
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.38 * box["width"], middle)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], middle, steps=5)
    expect(chip(page, "GM")).not_to_have_text(before)
    page.mouse.up()
    value = float(field(page, "Kc").input_value())
    assert 2.5 < value < 4.0, "the middle of 0.1 ... 100 on a logarithmic scale"
    # GM times the gain is the gain at the limit of stability, whatever the gain.
    expect(chip(page, "GM")).to_have_text(re.compile(r"^\d"))
    settled(page)
    assert float(chip(page, "GM").inner_text().split()[0]) * value == pytest.approx(4.635, rel=5e-3)


def test_a_typed_gain_may_leave_the_range_of_its_slider_but_not_be_nonsense(page: Page):
    open_workbench(page)
    box = field(page, "Kc")
    box.fill("0,02")
    box.press("Enter")
    expect(slider(page, "controller gain")).to_have_attribute("aria-valuetext", "0.0200")
    box.fill("-1")
    expect(page.locator("gain-slider[name=Kc] .field-message")).to_have_text("Must be above 0.")
    box.fill("two")
    expect(page.locator("gain-slider[name=Kc] .field-message")).to_contain_text("Not a number")
    box.press("Escape")
    expect(box).to_have_value("0.02")


def test_a_rule_fills_the_gains_and_shows_its_formula(page: Page):
    open_workbench(page)
    page.get_by_role("button", name=re.compile("^Tune")).click()
    rule = page.locator("details.rule", has_text="ultimate cycle")
    expect(rule.locator(".basis")).to_contain_text("8.000")
    expect(rule.locator("math").first).to_be_visible()
    expect(rule.locator(".source")).to_contain_text("ASME 64 (1942)")
    page.get_by_role("button", name=re.compile("^Use Ziegler.* PID$")).click()
    # Ziegler-Nichols on three equal lags: Kc 4.8, tau_I 1.8138, tau_D 0.45345 (Ku = 8, Pu = 2 pi / sqrt 3).
    for name, value in (("Kc", "4.8"), ("tau_I", "1.8138"), ("tau_D", "0.45345")):
        expect(field(page, name)).to_have_value(re.compile(f"^{re.escape(value)}"))
    expect(chip(page, "overshoot_pct")).to_have_text("42.7\u202f%")
    expect(chip(page, "Ms")).to_have_text("2.24")
    page.keyboard.press("Control+z")
    expect(field(page, "Kc")).to_have_value("1.4")
    page.keyboard.press("Control+Shift+z")
    expect(field(page, "Kc")).to_have_value("4.8")


def test_a_rule_that_does_not_apply_says_why(page: Page):
    open_workbench(page, "plant=1/(s%2B1)&type=P&Kc=2")
    page.get_by_role("button", name=re.compile("^Tune")).click()
    family = page.get_by_role("region", name="From the ultimate cycle")
    refused = family.locator(".refused", has_text="Ziegler–Nichols (ultimate cycle)")
    expect(refused).to_contain_text("do not apply. The plant has no ultimate gain")
    expect(family.get_by_role("button")).to_have_count(0)
    expect(page.get_by_role("button", name=re.compile("^Use Cohen"))).to_have_count(0)


def test_rules_are_grouped_and_open_one_by_one(page: Page):
    """SIMC PI on 1/(s+1)^3: half rule theta = 1.5, tau = 1.5, tau_c = theta: Kc = 0.5, tau_I = 1.5."""
    open_workbench(page)
    page.get_by_role("button", name=re.compile("^Tune")).click()
    family = page.get_by_role("region", name="From a model, with a closed-loop time constant")
    simc = family.locator("details.rule", has_text="SIMC")
    expect(simc.locator("math").first).to_be_hidden()
    simc.locator("summary").press("Enter")
    expect(simc.locator(".basis").first).to_contain_text("Half rule")
    expect(simc).to_contain_text("series form")
    page.get_by_role("button", name="Use SIMC (Skogestad), PI", exact=True).click()
    expect(field(page, "Kc")).to_have_value("0.5")
    expect(field(page, "tau_I")).to_have_value("1.5")
    expect(simc).to_have_class(re.compile("in-force"))


def test_the_address_holds_the_loop(page: Page):
    open_workbench(page)
    page.get_by_role("radio", name="PID").check()
    field(page, "Kc").fill("3.3")
    field(page, "Kc").press("Enter")
    page.get_by_label("P(s) =").fill("(s+3)/(s+1)^4")
    page.get_by_role("button", name="Sensitivity", exact=True).click()
    expect(page).to_have_url(re.compile(r"type=PID&Kc=3\.3&.*sensitivity"))
    expect(page).to_have_url(re.compile(r"plant=\(s"))
    settled(page)
    shown = chip(page, "Ms").inner_text()

    page.goto(page.url)
    expect(field(page, "Kc")).to_have_value("3.3")
    expect(page.get_by_label("P(s) =")).to_have_value("(s+3)/(s+1)^4")
    expect(page.get_by_role("radio", name="PID")).to_be_checked()
    expect(page.locator("#panel-sensitivity .js-line").first).to_be_attached()
    expect(chip(page, "Ms")).to_have_text(shown)


def test_an_address_full_of_nonsense_opens_the_usual_loop(page: Page):
    open_workbench(page, "type=XX&Kc=-4&tau_I=inf&alpha=&horizon=nope&show=a,b&signal=q&form=<b>")
    expect(field(page, "Kc")).to_have_value("1.4")
    expect(verdict(page)).to_have_attribute("data-verdict", "stable")


def test_the_diagram_leads_to_its_cards(page: Page):
    open_workbench(page)
    card = page.get_by_role("button", name=re.compile("^Test"))
    expect(card).to_have_attribute("aria-expanded", "false")
    page.get_by_role("button", name=re.compile("^Load d")).press("Enter")
    expect(card).to_have_attribute("aria-expanded", "true")
    expect(card).to_be_focused()
    page.locator("#card-test").get_by_role("radio", name="Load d").check()
    expect(page.locator("#panel-step").get_by_role("radio", name=re.compile("Unit step of the load"))).to_be_checked()
    expect(chip(page, "overshoot_pct")).to_have_text("—")
    expect(page.get_by_role("button", name=re.compile("overshoot"))).to_have_accessible_description(
        re.compile("setpoint step")
    )


def test_numbers_of_a_plot_as_table_and_file(page: Page):
    open_workbench(page)
    page.get_by_role("button", name="Numbers of Step as a table").click()
    table = page.get_by_role("region", name="Numbers of Step")
    expect(table.get_by_role("columnheader").first).to_have_text("t [s]")
    page.get_by_role("button", name="More for Step").click()
    with page.expect_download() as download:
        page.get_by_role("menuitem", name=re.compile("Download numbers")).click()
    lines = download.value.path().read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("t [s],")
    assert len(lines) > 400
    assert [float(cell) for cell in lines[1].split(",")] == [0.0, 0.0, 1.4, 0.0, 0.0]


def test_a_kept_response_stays_to_compare_with(page: Page):
    open_workbench(page)
    lines = page.locator("#panel-step .js-line")
    expect(lines).to_have_count(4)
    page.get_by_role("button", name="Keep").click()
    expect(lines).to_have_count(6)
    slider(page, "controller gain").press("Shift+ArrowRight")
    page.get_by_role("list", name="Kept responses").get_by_role("button").first.click()
    expect(field(page, "Kc")).to_have_value("1.4")
    page.get_by_role("button", name=re.compile("^Drop")).click()
    expect(lines).to_have_count(4)


def test_one_plot_can_fill_the_stage_and_go_back(page: Page):
    open_workbench(page)
    page.get_by_role("button", name="Enlarge Bode").click()
    expect(page.locator(".slot")).to_have_count(1)
    page.get_by_role("button", name="Enlarge Bode").click()
    expect(page.locator(".slot")).to_have_count(5)


def test_the_theme_is_remembered(page: Page):
    page.emulate_media(color_scheme="light")
    page.goto("/")
    html = page.locator("html")
    expect(html).to_have_attribute("data-theme", "light")
    toggle = page.get_by_role("button", name=re.compile("^Theme"))
    toggle.click()
    toggle.click()
    expect(html).to_have_attribute("data-theme", "dark")
    page.goto("/workbench")
    expect(html).to_have_attribute("data-theme", "dark")


def test_the_home_page_is_alive(page: Page):
    page.goto("/")
    curve = page.locator(".teaser-y")
    expect(curve).to_have_attribute("d", re.compile("^M"))
    before = curve.get_attribute("d")
    slider(page, "controller gain").press("End")
    expect(curve).not_to_have_attribute("d", before or "")
    expect(page.locator(".teaser-verdict")).to_contain_text("unstable")
    expect(page.get_by_role("link", name="Open the workbench")).to_have_attribute("href", "/workbench")
    expect(page.locator("labs-list li").first).to_be_visible()


@pytest.mark.allow_console("ERR_FAILED|ERR_ABORTED")
def test_a_server_that_is_away_is_said_and_asked_again(page: Page):
    open_workbench(page)
    settled(page)
    page.route("**/api/v1/loop", lambda route: route.abort())
    slider(page, "controller gain").press("ArrowRight")
    expect(page.get_by_role("status").filter(has_text="cannot be reached")).to_be_visible()
    page.unroute("**/api/v1/loop")
    expect(chip(page, "GM")).to_have_text("3.24 (10.2 dB)")
