"""Response and Laplace show what the closed forms say, and are asked only when it makes sense to."""

import re

import numpy as np
import pytest
from playwright.sync_api import Page, Request, expect

from workbench import curve, field, open_analyses, settled


def test_resonance_is_bounded_in_and_unbounded_out(page: Page):
    """1/(s^2+4) under sin 2t: y = (sin 2t - 2t cos 2t)/8."""
    open_analyses(page, "response")
    page.get_by_role("button", name="Examples").click()
    page.get_by_role("menuitem", name=re.compile("^Resonance")).click()
    panel = page.locator("#panel-response")
    expect(panel.locator(".finding").first).to_contain_text("No final value.")
    expect(panel.locator(".finding").first).to_contain_text("± 2j")
    expect(page).to_have_url(re.compile(r"response\.input=sine&.*response\.omega=2"))
    settled(page)
    t, y = (np.array(values) for values in curve(page, "response", "y"))
    np.testing.assert_allclose(y, (np.sin(2 * t) - 2 * t * np.cos(2 * t)) / 8, atol=5e-5)

    page.goto(page.url)
    expect(panel.get_by_label("ω")).to_have_value("2")
    expect(page.get_by_label("P(s) =")).to_have_value("1/(s^2+4)")


def test_a_staircase_is_the_sum_of_its_steps(page: Page):
    open_analyses(page, "response", query="plant=1/(s%2B1)&response.input=sampled&response.sum=superposition")
    panel = page.locator("#panel-response")
    expect(panel).to_contain_text("3 terms add up to y")
    settled(page)
    terms = panel.locator(".plot").evaluate(
        "(plot) => plot.data.filter(({ name }) => name === 'term').map(({ y }) => Array.from(y))"
    )
    t, y = (np.array(values) for values in curve(page, "response", "y"))
    steps = [size * -np.expm1(-np.maximum(t - at, 0)) for size, at in ((1, 0), (2, 3), (-1, 6))]
    np.testing.assert_allclose(terms, steps, atol=1e-6)
    np.testing.assert_allclose(y, np.sum(steps, axis=0), atol=1e-6)

    panel.get_by_label("Times").fill("0, 3, 2")
    panel.get_by_label("Times").press("Enter")
    expect(panel.get_by_label("Times")).to_have_accessible_description(re.compile("Times must grow, from 0 on."))
    panel.get_by_label("Input u(t)").select_option("Ramp")
    expect(panel).to_contain_text("Only a staircase is a sum of steps")


def test_convolution_adds_up_impulses(page: Page):
    """The terms drawn are w_k h(t - t_k) with h = exp(-t), and add up to the sum that the server gives."""
    query = "plant=1/(s%2B1)&response.input=pulse&response.width=2&response.sum=convolution&response.slices=20"
    open_analyses(page, "response", query=query)
    settled(page)
    terms = np.array(
        page.locator("#panel-response .plot").evaluate(
            "(plot) => plot.data.filter(({ name }) => name === 'term').map(({ y }) => Array.from(y))"
        )
    )
    t, total = (np.array(values) for values in curve(page, "response", "sum"))
    width = t[-1] / 20
    middles = [at for k in range(20) if (at := (k + 0.5) * width) < 2]
    assert len(terms) == len(middles)
    for term, at in zip(terms, middles, strict=True):
        # Between two samples h is joined by a straight line, at its jump too.
        away = np.abs(t - at) > t[1]
        np.testing.assert_allclose(term[away], np.where(t > at, width * np.exp(at - t), 0)[away], atol=1e-4)
    np.testing.assert_allclose(terms.sum(axis=0)[t > 2.1], total[t > 2.1], atol=1e-3)


def test_a_response_follows_the_loop_but_asks_nothing_while_a_knob_moves(page: Page):
    """3/s closed is 3/(s+3): behind a ramp by 1/3 in the end."""
    asked: list[str] = []

    def note(request: Request) -> None:
        if request.url.endswith("/response"):
            asked.append(request.post_data or "")

    page.on("request", note)
    query = "plant=1/s&type=P&Kc=3&response.of=closed_loop&response.input=ramp"
    open_analyses(page, "response", query=query)
    settled(page)
    t, y = (np.array(values) for values in curve(page, "response", "y"))
    np.testing.assert_allclose(y, t + np.expm1(-3 * t) / 3, atol=1e-5)
    assert len(asked) == 1

    box = page.get_by_role("slider", name="controller gain").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 0.45 * box["width"], box["y"] + box["height"] / 2)
    page.mouse.down()
    for share in (0.5, 0.55, 0.6):
        page.mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2)
        page.wait_for_timeout(80)
    assert len(asked) == 1
    page.mouse.up()
    settled(page)
    assert len(asked) == 2
    gain = float(field(page, "Kc").input_value())
    t, y = (np.array(values) for values in curve(page, "response", "y"))
    np.testing.assert_allclose(y, t + np.expm1(-gain * t) / gain, atol=1e-4)


def test_a_start_away_from_rest(page: Page):
    """No input, y(0) = 1, y'(0) = 0 on 1/((s+1)(s+2)): y = 2 exp(-t) - exp(-2t)."""
    open_analyses(page, "response", query="plant=1/((s%2B1)(s%2B2))&response.input=step&response.amplitude=0")
    panel = page.locator("#panel-response")
    panel.get_by_label("Starts").select_option("From y, y′, y″ …")
    expect(panel.get_by_label("Just before t = 0")).to_have_value("1, 0")
    expect(page).to_have_url(re.compile(r"response\.y=1,0"))
    settled(page)
    t, y = (np.array(values) for values in curve(page, "response", "y"))
    np.testing.assert_allclose(y, 2 * np.exp(-t) - np.exp(-2 * t), atol=1e-6)


def test_partial_fractions_of_three_lags(page: Page):
    """1/(s (s+1)^3) = 1/s - 1/(s+1) - 1/(s+1)^2 - 1/(s+1)^3."""
    open_analyses(page, "laplace")
    panel = page.locator("#panel-laplace")
    terms = panel.get_by_role("table", name=re.compile("^Terms"))
    cells = [row.inner_text().split() for row in terms.locator("tbody tr").all()]
    assert cells == [["0", "1", "1"], ["−1", "1", "−1"], ["−1", "2", "−1"], ["−1", "3", "−1"]]
    plot = panel.get_by_role("img", name="y(t) = 1 - e^(-t) (1 + t + 0.5 t^2)")
    expect(plot).to_be_visible()
    expect(panel.locator("math").first).to_be_visible()
    expect(panel.get_by_role("row", name=re.compile("^y\\(∞\\)"))).to_contain_text("the theorem holds")
    settled(page)
    t, y = (np.array(values) for values in curve(page, "laplace", "simulated"))
    np.testing.assert_allclose(y, 1 - np.exp(-t) * (1 + t + t**2 / 2), atol=1e-6)


def test_no_final_value_is_said_with_its_pole(page: Page):
    open_analyses(page, "laplace", query="plant=1/(s^2%2B1)")
    row = page.locator("#panel-laplace").get_by_role("row", name=re.compile("^y\\(∞\\)"))
    expect(row).to_contain_text("No final value: pole at ±j")
    expect(row).to_contain_text("would say 1")


def test_an_equation_with_initial_values(page: Page):
    """y'' + 3y' + 2y = 0 from y = 1, y' = 0: y = 2 exp(-t) - exp(-2t)."""
    open_analyses(page, "laplace")
    panel = page.locator("#panel-laplace")
    panel.get_by_role("radio", name=re.compile("linear differential equation")).check()
    panel.get_by_label("Input u(t)").select_option("None: G(s) itself")
    expect(panel.locator(".equation")).to_have_text("y″ + 3 y′ + 2 y = u")
    expect(panel.get_by_role("img", name="y(t) = 2 e^(-t) - e^(-2 t)")).to_be_visible()
    a = panel.get_by_label("Coefficients of y, highest derivative first")
    a.fill("1, x")
    a.press("Enter")
    expect(a).to_have_attribute("aria-invalid", "true")
    a.fill("1 0 1")
    a.press("Enter")
    expect(panel.get_by_role("img", name="y(t) = cos(t)")).to_be_visible()
    expect(page).to_have_url(re.compile(r"laplace\.a=1,0,1"))


@pytest.mark.allow_console("status of 422")
def test_what_cannot_be_answered_says_what_to_do(page: Page):
    open_analyses(page, "laplace")
    page.get_by_label("P(s) =").fill("s + 1")
    message = page.locator("#panel-laplace .analysis-message")
    expect(message).to_contain_text("differentiates")
    expect(page.locator("#panel-laplace")).to_have_class(re.compile("stale"))
    page.get_by_label("P(s) =").fill("1/(s + 1)")
    expect(message).to_be_hidden()
