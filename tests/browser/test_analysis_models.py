"""State space and Low order: ranks, hidden modes, typed matrices, models with their deviation, character."""

import re

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from workbench import curve, open_analyses, settled


def test_a_hidden_mode_and_what_is_left_without_it(page: Page):
    open_analyses(page, "state_space", query="plant=(s%2B1)/((s%2B1)(s%2B2))")
    panel = page.locator("#panel-state_space")
    expect(panel).to_contain_text("Eigenvalues: −1, −2")
    expect(panel).to_contain_text("Rank 1 of 2.")
    expect(panel).to_contain_text("Hidden from the transfer function: −1.")
    expect(panel).to_contain_text("Order 1 instead of 2.")
    expect(panel.get_by_role("group", name="Minimal")).to_contain_text("2")
    mode = panel.get_by_role("table", name=re.compile("^Each mode")).get_by_role("row", name=re.compile("^−1 "))
    assert mode.inner_text().split().count("no") == 1

    panel.get_by_label("Zeros cancel poles up to a distance of").fill("0.01")
    panel.get_by_label("Zeros cancel poles up to a distance of").press("Enter")
    page.get_by_label("P(s) =").fill("(s+1.001)/((s+1)(s+2))")
    expect(panel).to_contain_text("Order 1 instead of 2.")
    expect(panel).to_contain_text("(distance 0.0010)")
    expect(page).to_have_url(re.compile("cancel_tolerance=0.01"))


def test_gramians_of_a_lag_and_none_of_an_integrator(page: Page):
    """x' = -2x + bu, y = cx: both Gramians b^2/4 and c^2/4, and the Hankel singular value |bc|/4."""
    open_analyses(page, "state_space", query="plant=ss&A=-2&B=2&C=3&D=0")
    panel = page.locator("#panel-state_space")
    expect(panel.get_by_role("region", name="Controllability, 1 × 1")).to_have_text("1")
    expect(panel.get_by_role("region", name="Observability, 1 × 1")).to_have_text("2.25")
    expect(panel).to_contain_text("Hankel singular values: 1.50")
    page.get_by_role("radio", name=re.compile("Any transfer function")).check()
    page.get_by_label("P(s) =").fill("1/s")
    expect(panel).to_contain_text("The pole at 0 does not decay")


def test_matrices_are_typed_as_the_plant(page: Page):
    open_analyses(page, "state_space")
    modes = page.locator("#panel-state_space").get_by_role("table", name=re.compile("^Each mode"))
    expect(modes.get_by_role("rowheader")).to_have_text(["−1 (3×)"])
    page.get_by_role("button", name="Type matrices as the plant").click()
    card = page.locator("#card-plant")
    expect(card.get_by_role("button", name=re.compile("^Plant"))).to_be_focused()
    A = card.get_by_label("A n × n")
    assert A.input_value().split() == ["-1", "0", "0", "1", "-1", "0", "0", "1", "-1"]
    A.fill("0 1\n-2 -3 4")
    A.blur()
    expect(card.get_by_role("alert").last).to_contain_text("A is no matrix")
    A.fill("0 1\n-2 -3")
    A.blur()
    expect(card.get_by_role("alert").last).to_contain_text("B must be a column of 2.")
    for name, text in (("B n × 1", "0\n1"), ("C 1 × n", "1 0")):
        card.get_by_label(name).fill(text)
        card.get_by_label(name).blur()
    expect(card.locator(".matrix-editor .field-message")).to_be_empty()
    expect(page.locator("#panel-state_space")).to_contain_text("Eigenvalues: −1, −2")
    expect(page).to_have_url(re.compile(r"plant=ss&A=0,1;-2,-3&B=0;1&C=1,0&D=0"))
    page.keyboard.press("Control+z")
    expect(A).to_have_value(re.compile(r"^-1\s+0\s+0"))


def test_models_of_three_lags(page: Page):
    """1/(s+1)^3 by the half rule: first order 1.5 and 1.5; second order 1.5, 1 and 0.5 (Skogestad 2003)."""
    open_analyses(page, "low_order")
    panel = page.locator("#panel-low_order")
    rule = panel.get_by_role("table").get_by_role("row", name=re.compile("^half rule"))
    expect(rule.locator("td").nth(2)).to_have_text("1.5")
    expect(rule.locator("td").nth(3)).to_have_text("1.5")
    settled(page)
    t, y = (np.array(values) for values in curve(page, "low_order", "y"))
    true = 1 - np.exp(-t) * (1 + t + t**2 / 2)
    np.testing.assert_allclose(y, true, atol=1e-6)
    _, model = curve(page, "low_order", "half_rule")
    off = np.abs(np.array(model) - true).max()
    shown = float(rule.locator("td").nth(4).inner_text().split()[0])
    assert shown == pytest.approx(100 * off, abs=0.5)

    panel.get_by_role("radio", name=re.compile("2ζτs")).check()
    expect(rule.locator("td").nth(2)).to_have_text("1.225")
    expect(page).to_have_url(re.compile("model_type=SOPDT"))
    expect(panel).to_contain_text("No two points:")
    expect(panel).to_contain_text("This plant has order 3")

    panel.get_by_role("button", name=re.compile("^Use the SOPDT model by half rule")).click()
    expect(page.get_by_role("slider", name="damping zeta")).to_be_visible()
    expect(panel).to_contain_text("Second order, overdamped.")
    expect(panel.get_by_role("heading", name="Low order")).to_be_focused()


def test_the_character_of_a_second_order_plant(page: Page):
    """zeta = 0.3, tau = 1: overshoot exp(-0.3 pi/sqrt(0.91)) = 37.2 %, period 2 pi/sqrt(0.91) = 6.587."""
    open_analyses(page, "low_order", query="plant=sopdt&K=2&tau=1&zeta=0.3")
    panel = page.locator("#panel-low_order")
    expect(panel).to_contain_text("Second order, underdamped.")
    expect(panel.get_by_role("row", name=re.compile("^Overshoot"))).to_contain_text("37.2")
    expect(panel.get_by_role("row", name=re.compile("^Period"))).to_contain_text("6.587")
    expect(panel.get_by_role("row", name=re.compile("^Decay ratio"))).to_contain_text("0.1386")
    slow = panel.get_by_role("row", name=re.compile("^Slow lag")).locator(".why")
    expect(slow).to_have_accessible_description(re.compile("poles are complex"))


def test_a_plant_that_does_not_settle_has_no_models(page: Page):
    open_analyses(page, "low_order", query="plant=1/(s-1)")
    panel = page.locator("#panel-low_order")
    expect(panel).to_contain_text("The plant does not settle after a step")
    expect(panel.locator(".analysis-plot")).to_be_hidden()
    expect(panel).to_contain_text("First order, unstable.")
