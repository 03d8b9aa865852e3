"""Limits, Bode integral and Spectrum against closed forms; what they are told is in the address."""

import re

from playwright.sync_api import Page, expect

from workbench import curve, open_analyses, settled

FOPDT = "plant=fopdt&K=1&tau=5&theta=1&type=PI&Kc=2&tau_I=5"


def test_the_window_follows_what_is_typed(page: Page):
    """1/(5s+1) e^-s: below 1/theta = 1; with u up to 4, |P| = 1/4 at sqrt(15)/5 = 0.775."""
    open_analyses(page, "limits", query=FOPDT)
    panel = page.locator("#panel-limits")
    expect(panel.locator("tr.binding")).to_have_count(1)
    expect(panel.locator("tr.binding")).to_contain_text("Dead time")
    typed = panel.get_by_label("Largest u for r = 1")
    typed.fill("4")
    typed.press("Enter")
    expect(panel.locator("tr.binding")).to_contain_text(["< 0.775"])
    expect(panel).to_contain_text("below 0.7746")
    expect(page).to_have_url(re.compile(r"limits\.u_limit=4"))
    settled(page)
    x, _ = curve(page, "limits", "edges")
    assert any(abs(w - 15**0.5 / 5) < 1e-6 for w in x)
    # |L| = 2/(5 w) = 1 at 0.4
    x, _ = curve(page, "limits", "now")
    assert abs(x[0] - 0.4) < 1e-6


def test_a_plant_that_leaves_nothing(page: Page):
    open_analyses(page, "limits", query="plant=(s-1.5)/((s-1)(s%2B5))&type=P&Kc=1")
    panel = page.locator("#panel-limits")
    expect(panel).to_contain_text("No bandwidth is left: it should be above 2 and below 0.75")
    expect(panel).to_contain_text("The loop is not stable")


def test_lemmas_and_constraints_are_listed(page: Page):
    open_analyses(page, "limits", query="plant=(1-s)exp(-0.5s)/(s%2B1)^2&type=PI&Kc=0.3&tau_I=2")
    rows = page.get_by_role("table", name=re.compile("^Integrals over")).locator("tbody tr")
    expect(rows).to_have_count(3)
    expect(rows.nth(1).locator("td")).to_have_text(["setpoint", "1", "1"])
    expect(page.get_by_role("table", name=re.compile("^S and T"))).to_contain_text("zero 1")
    expect(page.locator("#panel-limits")).to_contain_text("It first moves the wrong way.")


def test_bodes_areas(page: Page):
    open_analyses(page, "bode_integral", query="plant=1/(s%2B4)&type=P&Kc=1")
    panel = page.locator("#panel-bode_integral")
    expect(panel).to_contain_text("∫ ln |S| dω = −1.57080")
    expect(panel).to_contain_text("They agree to rounding.")
    # ln|S| at rest: 1/(1 + 1/4)
    _, y = curve(page, "bode_integral", "S")
    assert abs(y[0] + 0.22314355) < 1e-6


def test_an_integral_that_does_not_exist_says_why(page: Page):
    open_analyses(page, "bode_integral", query="plant=2(s%2B1)/(s%2B4)&type=P&Kc=1")
    expect(page.locator("#panel-bode_integral")).to_contain_text("L has as many zeros as poles")


def test_a_sine_is_seen_at_its_alias(page: Page):
    open_analyses(page, "spectrum", query="spectrum.frequency=9&spectrum.samples=40")
    panel = page.locator("#panel-spectrum")
    expect(panel).to_contain_text("is seen at |f − 1 fs| = 1 per s")
    expect(panel).to_contain_text("No leakage: 4 periods")
    settled(page)
    x, y = curve(page, "spectrum", "bins")
    assert x[y.index(max(y))] == 1
    slider = panel.get_by_role("slider", name="Sampling rate fs slider").first
    slider.focus()
    slider.press("End")
    expect(panel).to_contain_text("is below fs/2 = 20 per s")
    panel.get_by_role("radio", name=re.compile("Fades in")).check()
    expect(page).to_have_url(re.compile(r"spectrum\.rate=40.*spectrum\.window=hann"))


def test_signals_of_the_loop(page: Page):
    open_analyses(page, "spectrum", query=FOPDT)
    panel = page.locator("#panel-spectrum")
    panel.get_by_role("radio", name=re.compile("u of the loop")).check()
    expect(panel).to_contain_text("it has the shape of |CS|")
    expect(panel.get_by_role("slider", name="Noise of the sensor slider")).to_be_visible()
    expect(panel.get_by_role("slider", name="Frequency f slider")).to_be_hidden()
