"""Actuator and sensor on the workbench: typed, drawn, in the address, and taken back."""

import re

import pytest
from playwright.sync_api import Page, expect

from workbench import chip, open_workbench, settled, verdict


def test_a_sensor_is_drawn_measured_and_taken_back(page: Page):
    open_workbench(page)
    lines = page.locator("#panel-step .js-line")
    expect(lines).to_have_count(4)
    card = page.get_by_role("button", name=re.compile("^Actuator and sensor"))
    expect(card).to_contain_text("none")
    expect(page.get_by_role("button", name=re.compile("^Sensor:"))).to_have_count(0)
    card.click()
    page.get_by_label("H(s) =").fill("exp(-0.5s)/(0.2s+1)")
    # The sensor stands in the loop: a block, a curve of what it measures, less margin.
    block = page.get_by_role("button", name=re.compile(r"^Sensor: exp\(-0.5s\)"))
    expect(block).to_be_visible()
    expect(lines).to_have_count(5)
    expect(page.locator("#panel-step .legend")).to_contain_text("yₘ")
    expect(chip(page, "GM")).not_to_have_text("3.31 (10.4 dB)")
    expect(page).to_have_url(re.compile("sensor=exp"))
    settled(page)
    shown = chip(page, "GM").inner_text()

    page.goto(page.url)
    expect(page.get_by_label("H(s) =")).to_have_value("exp(-0.5s)/(0.2s+1)")
    expect(chip(page, "GM")).to_have_text(shown)

    page.get_by_label("A(s) =").fill("exp(-0.3s)/(0.4s+1)")
    expect(page.get_by_role("button", name=re.compile("^Actuator:"))).to_be_visible()
    expect(chip(page, "GM")).not_to_have_text(shown)
    page.get_by_role("button", name="Undo").first.click()
    expect(page.get_by_label("A(s) =")).to_have_value("")
    expect(chip(page, "GM")).to_have_text(shown)
    page.get_by_label("H(s) =").fill("")
    expect(lines).to_have_count(4)
    expect(page).not_to_have_url(re.compile("sensor"))


@pytest.mark.allow_console("status of 422")
def test_a_mistyped_sensor_says_where(page: Page):
    open_workbench(page, "sensor=1/(0.1s%2B1)")
    text = page.get_by_label("H(s) =")
    text.fill("1/(0.1q+1)")
    expect(page.get_by_role("alert").filter(has_text="q")).to_contain_text("column 7")
    expect(text).to_have_attribute("aria-invalid", "true")
    expect(page.get_by_label("P(s) =")).not_to_have_attribute("aria-invalid", "true")
    text.fill("1/(0.1s+1)")
    expect(text).not_to_have_attribute("aria-invalid", "true")
    expect(verdict(page)).to_have_attribute("data-verdict", "stable")


def test_the_block_leads_to_the_card(page: Page):
    open_workbench(page, "sensor=exp(-s)&actuator=1/(0.1s%2B1)")
    card = page.get_by_role("button", name=re.compile("^Actuator and sensor"))
    card.click()
    expect(card).to_have_attribute("aria-expanded", "false")
    page.get_by_role("button", name=re.compile("^Actuator:")).press("Enter")
    expect(card).to_have_attribute("aria-expanded", "true")
