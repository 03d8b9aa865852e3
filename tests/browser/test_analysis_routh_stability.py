"""Routh and Stability against the notes' examples, and against the roots themselves."""

import re

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from workbench import curve, field, open_analyses, settled


def test_the_routh_example_of_the_notes(page: Page):
    """PI on 1/(s^2+2s+2): stable for 0 < Kc < 4/(1/tau_I - 2) where tau_I < 0.5, for all Kc > 0 above."""
    open_analyses(page, "routh", query="plant=1/(s^2%2B2s%2B2)&type=PI&Kc=1&tau_I=0.25")
    ranges = page.locator("#panel-routh .gain-ranges")
    expect(ranges.locator("strong")).to_have_text("0 < Kc < 2")
    expect(page.locator("#panel-routh")).to_contain_text("Now Kc = 1: inside a stable range.")
    settled(page)
    x, y = curve(page, "routh", "stable")
    left, right = x[0], max(value for value in x if value is not None)
    corners = [(K, tau) for K, tau in zip(x, y, strict=True) if K is not None and left < K < right]
    assert len([K for K, _ in corners if K > 1.001 * min(value for value in x if value is not None)]) > 5
    for K, tau in corners:
        if K > 1.001 * min(value for value in x if value is not None):
            assert pytest.approx(4 / (1 / tau - 2), rel=1e-6) == K
    assert curve(page, "routh", "present") == ([1], [0.25])

    field(page, "tau_I").fill("0.6")
    field(page, "tau_I").press("Enter")
    expect(ranges.locator("strong")).to_have_text("Kc > 0")
    settled(page)
    assert curve(page, "routh", "present") == ([1], [0.6])


def test_direct_action_has_its_region_too(page: Page):
    query = "plant=-1/(s^2%2B2s%2B2)&type=PI&Kc=1&tau_I=0.25&action=direct"
    open_analyses(page, "routh", query=query)
    expect(page.locator("#panel-routh .gain-ranges strong").first).to_have_text("−2 < Kc < 0")
    settled(page)
    x, y = curve(page, "routh", "stable")
    inside = [(K, tau) for K, tau in zip(x, y, strict=True) if K is not None and 0.2 < K < 5]
    assert inside
    for K, tau in inside:
        assert pytest.approx(4 / (1 / tau - 2), rel=1e-6) == K


def test_a_row_of_zeros_is_explained(page: Page):
    """s^5 + 2s^4 + 24s^3 + 48s^2 - 25s - 50 = (s+1)(s-1)(s^2+25)(s+2)."""
    open_analyses(page, "routh", query="routh.polynomial=1,2,24,48,-25,-50")
    panel = page.locator("#panel-routh")
    rows = [row.inner_text().split() for row in panel.locator(".routh-array tr").all()]
    assert rows[2][:3] == ["s³", "8", "96"] and "auxiliary" in rows[2]
    assert rows[4][:2] == ["s", "338/3"]
    assert rows[5][:2] == ["s⁰", "−50"] and rows[5][-2:] == ["sign", "change"]
    expect(panel).to_contain_text("its 4 roots lie symmetric to the origin")
    counts = panel.get_by_role("table", name="Roots of the polynomial").locator("tbody tr")
    assert counts.inner_text().split() == ["1", "2", "2"]
    expect(panel.locator(".analysis-plot")).to_be_hidden()

    typed = panel.get_by_label("Coefficients, highest power first")
    typed.fill("1 1 2 2 3 5")
    typed.press("Enter")
    expect(panel).to_contain_text("multiplied by 1 - s^2")
    right = int(np.count_nonzero(np.roots([1, 1, 2, 2, 3, 5]).real > 0))
    expect(counts.locator("th")).to_have_text(str(right))


def test_several_stable_ranges_of_the_gain(page: Page):
    """K (s^2+2s+4)/(s (s+4)(s+6)(s^2+1.4s+1)): the roots lie left inside the ranges and not just outside of them."""
    query = "plant=(s^2%2B2s%2B4)/(s(s%2B4)(s%2B6)(s^2%2B1.4s%2B1))&type=P&Kc=10"
    open_analyses(page, "routh", query=query)
    texts = page.locator("#panel-routh .gain-ranges strong").all_inner_texts()
    ends = [[float(number) for number in re.findall(r"\d+(?:\.\d+)?", text)] for text in texts]
    assert len(ends) == 2 and ends[0][0] == 0
    D = np.poly([0, -4, -6, *np.roots([1, 1.4, 1])]).real

    def stable(K: float) -> bool:
        return bool(np.roots(np.polyadd(D, K * np.array([1, 2, 4]))).real.max() < 0)

    for low, high in ends:
        assert stable(1.001 * low + 1e-6) and stable(0.999 * high)
        assert not stable(1.001 * high)
        assert low == 0 or not stable(0.999 * low)
    expect(page.locator("#panel-routh")).to_contain_text("Choose PI in the Controller card")


def test_dead_time_has_no_array_but_exact_ranges(page: Page):
    """exp(-s)/s under P: the phase is -180 deg where w = pi/2, so K < pi/2."""
    open_analyses(page, "routh", query="plant=exp(-s)/s&type=P&Kc=1")
    panel = page.locator("#panel-routh")
    expect(panel).to_contain_text("no polynomial")
    expect(panel.locator(".gain-ranges strong")).to_have_text("0 < Kc < 1.5708")


def test_notions_of_stability_side_by_side(page: Page):
    """A PI zero at -1/2 on the lag 1/(2s+1): T = 0.7/(s+0.7), and PS still has the pole at -0.5."""
    open_analyses(page, "stability", query="plant=1/(2s%2B1)&type=PI&Kc=1.4&tau_I=2")
    panel = page.locator("#panel-stability")
    gang = panel.get_by_role("table", name="The gang of four after cancellation")
    expect(gang.get_by_role("row", name=re.compile("^T "))).to_contain_text("−0.7")
    expect(gang.get_by_role("row", name=re.compile("^T "))).not_to_contain_text("−0.5")
    expect(gang.get_by_role("row", name=re.compile("^PS "))).to_contain_text("−0.5")
    expect(panel.locator(".cancellations")).to_contain_text("cancels")
    expect(panel).to_contain_text("Internally stable.")
    settled(page)
    assert curve(page, "stability", "plant")[0] == [pytest.approx(-0.5)]
    assert sorted(curve(page, "stability", "closed loop")[0]) == [pytest.approx(-0.7), pytest.approx(-0.5)]


def test_the_jordan_structure_decides_on_the_axis(page: Page):
    open_analyses(page, "stability", query="plant=ss&A=0,1;0,0&B=0;1&C=1,0&D=0&type=PD")
    panel = page.locator("#panel-stability")
    jordan = panel.get_by_role("table", name=re.compile("^Jordan")).locator("tbody tr")
    assert jordan.inner_text().split() == ["0", "2", "1", "2", "grows", "like", "t"]
    notions = panel.get_by_role("table", name="Which notion of stability holds")
    assert notions.get_by_role("row", name=re.compile("^Lyapunov")).inner_text().split()[-2:] == ["no", "yes"]


def test_an_oscillator_is_marginal_and_not_BIBO_stable(page: Page):
    open_analyses(page, "stability", query="plant=1/(s^2%2B4)&type=PD")
    notions = page.locator("#panel-stability").get_by_role("table", name="Which notion of stability holds")
    words = {row.inner_text().split()[0]: row.inner_text().split()[-2] for row in notions.locator("tbody tr").all()}
    assert words == {"Lyapunov": "yes", "Asymptotically": "no", "Marginal": "yes", "BIBO": "no"}
    expect(page.locator("#panel-stability")).to_contain_text("u = sin(2 t)")
