"""Asymptotes, Nichols plot, arcs at infinity, Bode's criterion and the gang of six, as the workbench draws them."""

import cmath
import math
import re

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from access import violations
from workbench import open_workbench, settled, slider

# The drawn turns of the closed curve about -1, clockwise, for the server's answer to /nyquist.
DRAWN_TURNS = """
async ([texts, radius]) => {
  const { closedCurve } = await import("/static/plots/nyquist_rim.js");
  const turns = [];
  for (const text of texts) {
    const answer = await fetch("/api/v1/nyquist", {
      method: "POST", headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ system: { type: "expr", text } }),
    });
    const nyquist = await answer.json();
    const { x, y } = closedCurve(nyquist, radius);
    let turned = 0;
    const n = x.length;
    for (let i = 0; i < n; i++) {
      const [ax, ay, bx, by] = [x[i] + 1, y[i], x[(i + 1) % n] + 1, y[(i + 1) % n]];
      turned += Math.atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
    turns.push([-turned / (2 * Math.PI), nyquist.N]);
  }
  return turns;
}
"""
LOOPS = [
    "1.4(2.2s+1)/(2.2s(s+1)^3)",
    "12/(s+1)^3",
    "2/(s-1)",
    "6(s+1)/(s(s-4))",
    "3(s+6)^2/(s(s+1)^2)",
    "0.4(s+1)^2/s^3",
    "2(s+1)^2/s^3",
    "(0.5s+1) exp(-0.5 s)/s^2",
    "5 exp(-s)/s",
    "2 exp(-0.2s)/((s^2+4)(s+1))",
    "(s+1)(s-0.1) exp(-s)/(s^2 (s-0.1))",
    "-4/((s^2+1)(s+1))",
    "0.3(s+1)/(s(s^2+1)(s^2+9))",
    "-1/s^3",
]


def points(page: Page, panel: str) -> int:
    """Markers in sight."""
    return page.locator(f"#panel-{panel} path.point:not([transform*='-99999'])").count()


@pytest.mark.parametrize("radius", [1.6, 40.0])
def test_the_curve_as_drawn_turns_as_often_as_is_counted(page: Page, radius: float):
    """Curve, arcs at infinity and what is laid on the rim: one closed line, and N its clockwise turns about -1."""
    page.goto("/workbench")
    for text, (drawn, counted) in zip(LOOPS, page.evaluate(DRAWN_TURNS, [LOOPS, radius]), strict=True):
        assert drawn == pytest.approx(counted, abs=1e-6), text


def test_arcs_at_infinity_and_the_contour_are_shown(page: Page):
    open_workbench(page, "plant=1/(s^2(s%2B1))&type=PD&Kc=1&tau_D=4&show=nyquist")
    note = page.locator("#panel-nyquist .panel-note")
    expect(note).to_contain_text("360° ↻ for the 2 poles at 0")
    expect(note.get_by_role("img", name="round the pole on it")).to_be_visible()
    expect(page.locator("#panel-nyquist .annotation-text")).to_have_text("∞: 360° ↻")
    for part in ("The whole curve", "The neighbourhood of −1"):
        page.get_by_role("radio", name=part).check()
        settled(page)
        shown = page.evaluate("document.querySelector('#panel-nyquist .plot').data.map((t) => [t.name, t.x, t.y])")
        (arc,) = [(x, y) for name, x, y in shown if name == "at infinity"]
        size = np.hypot(*(np.array(part, dtype=float) for part in arc))
        frame = page.evaluate("document.querySelector('#panel-nyquist .plot').layout.xaxis.range")
        # On the rim: inside the picture, and well outside of -1.
        assert 1.2 < np.nanmax(size) < max(map(abs, frame))
        assert np.nanmin(size) == pytest.approx(np.nanmax(size))


def test_without_poles_on_the_axis_there_is_no_arc(page: Page):
    open_workbench(page, "plant=1/(s%2B1)^3&type=P&Kc=2&show=nyquist")
    expect(page.locator("#panel-nyquist .panel-note .contour-sketch")).to_have_count(0)
    expect(page.locator("#panel-nyquist .annotation-text")).to_have_count(0)


def test_bodes_criterion_stands_beside_nyquists(page: Page):
    """Astrom & Murray, 2nd ed., sec. 10.2: 3(s+6)^2/(s(s+1)^2) is stable, with |L| = 12 at one of its crossovers."""
    open_workbench(page, "plant=(s%2B6)^2/(s(s%2B1)^2)&type=P&Kc=3&show=nyquist")
    verdicts = page.locator("#panel-nyquist .bode-criterion")
    expect(verdicts).to_contain_text("Bode: unstable, but Nyquist: stable")
    expect(verdicts).to_contain_text("there are 2 phase crossovers")
    verdicts.focus()
    expect(verdicts).to_have_accessible_description(re.compile(r"\|L\| = 12 > 1 at ω180 = 2.*Nyquist is right"))
    verdicts.click()
    expect(page.get_by_role("tooltip")).to_contain_text("They disagree")
    assert violations(page) == []


def test_asymptotes_are_laid_over_the_curve_and_explained(page: Page):
    open_workbench(page, "plant=1/(s%2B1)^3&type=PI&Kc=1.4&tau_I=2&show=bode")
    settled(page)
    before = points(page, "bode")
    toggle = page.get_by_role("button", name="asymptotes")
    expect(toggle).to_have_attribute("aria-pressed", "false")
    toggle.click()
    expect(toggle).to_have_attribute("aria-pressed", "true")
    settled(page)
    assert points(page, "bode") == before + 2, "the zero of the controller and the three equal lags"
    page.get_by_role("button", name="Numbers of Bode as a table").click()
    table = page.get_by_role("region", name="Numbers of Bode")
    expect(table).to_contain_text("Pole at the origin: slope −20 dB/decade from the left, phase −90°")
    expect(table).to_contain_text("Zero at −0.5: slope +20 dB/decade more, phase +90° between 0.05 and 5 rad/s")
    expect(table).to_contain_text("Triple pole at −1: slope −60 dB/decade more, phase −270° between 0.1 and 10 rad/s")
    page.get_by_role("button", name="Numbers of Bode as a table").click()
    toggle.click()
    settled(page)
    assert points(page, "bode") == before


def test_asymptotes_move_with_the_gain(page: Page):
    open_workbench(page, "plant=1/(s%2B1)&type=P&Kc=10&show=bode")
    page.get_by_role("button", name="asymptotes").click()
    settled(page)
    level = "document.querySelector('#panel-bode .plot').data.find((t) => t.name === 'asymptotes of |L|').y[0]"
    before = page.evaluate(level)
    slider(page, "controller gain").press("Shift+ArrowRight")
    settled(page)
    gain = float(page.locator("gain-slider[name=Kc] input[type=text]").input_value())
    assert page.evaluate(level) - before == pytest.approx(20 * math.log10(gain / 10), abs=1e-4)


def test_nichols_contours_are_where_the_closed_loop_has_their_value(page: Page):
    page.goto("/workbench")
    contours = page.evaluate(
        """async () => {
          const { mContour, nContour } = await import("/static/plots/nichols_grid.js");
          return [[2, mContour(2)], [0.5, mContour(0.5)], [-60, nContour(-60)], [-200, nContour(-200)]];
        }"""
    )
    for value, contour in contours:
        for phase_deg, mag_dB in zip(contour["phase_deg"], contour["mag_dB"], strict=True):
            assert -360 <= phase_deg <= 0
            L = 10 ** (mag_dB / 20) * cmath.exp(1j * math.radians(phase_deg))
            T = L / (1 + L)
            if value > 0:
                assert abs(T) == pytest.approx(value, rel=1e-6)
            else:
                assert math.degrees(cmath.phase(T)) % 360 == pytest.approx(value % 360, abs=1e-6)


def test_the_nichols_plot_marks_the_margins_and_moves_with_the_gain(page: Page):
    """4/(s+1)^3: GM 2 at -180 deg; |L| = 1 where 1 + w^2 = 4^(2/3)."""
    open_workbench(page, "plant=1/(s%2B1)^3&type=P&Kc=4&show=nichols")
    settled(page)
    read = """(name) => { const t = document.querySelector('#panel-nichols .plot').data.find((t) => t.name === name);
      return [t.x, t.y]; }"""
    x, y = page.evaluate(read, "margins")
    crossover = math.sqrt(4 ** (2 / 3) - 1)
    assert (x[0], y[0]) == (pytest.approx(-180), pytest.approx(-20 * math.log10(2)))
    assert (x[1], y[1]) == (pytest.approx(-3 * math.degrees(math.atan(crossover))), pytest.approx(0))
    # The highest closed-loop contour that the curve touches is |T| = Mt.
    phase, level = (np.array(part, dtype=float) for part in page.evaluate(read, "|T| = Mt"))
    there = np.isfinite(phase)
    L = 10 ** (level[there] / 20) * np.exp(1j * np.radians(phase[there]))
    omega = np.geomspace(0.1, 10, 20001)
    loop = 4 / (1j * omega + 1) ** 3
    Mt = np.abs(loop / (1 + loop)).max()
    assert np.abs(L / (1 + L))[0] == pytest.approx(Mt, rel=1e-6)
    slider(page, "controller gain").press("ArrowRight")
    page.wait_for_timeout(100)
    assert page.evaluate("window.drawings.filter((d) => d.panel === 'panel-nichols' && d.way === 'fast').length") > 0
    settled(page)
    expect(page.locator("#panel-nichols .plot")).to_have_attribute("aria-label", re.compile("gain margin 1.9"))
    assert violations(page) == []


def test_the_gang_of_six_shows_the_setpoint_weight(page: Page):
    open_workbench(page, "plant=1/(s%2B1)&type=P&Kc=2&beta=0.5&show=sensitivity")
    note = page.locator("#panel-sensitivity .panel-note")
    expect(note).to_contain_text("F = Kc(β − 1) = −1.00")
    for name in ("CFS", "TF"):
        toggle = page.get_by_role("button", name=re.compile(f"^{name}:"))
        expect(toggle).to_have_attribute("aria-pressed", "false")
        toggle.click()
    settled(page)
    assert page.locator("#panel-sensitivity .js-line").count() == 6
    page.get_by_role("radio", name="Responses to unit steps").check()
    settled(page)
    # P = 1/(s+1), C = 2, C + F = 1: TF = 1/(s+3), T twice that.
    ends = page.evaluate(
        "Object.fromEntries(document.querySelector('#panel-sensitivity .plot').data.map((t) => [t.name, t.y.at(-1)]))"
    )
    expected = {"S": 1 / 3, "PS": 1 / 3, "CS": 2 / 3, "T": 2 / 3, "CFS": 1 / 3, "TF": 1 / 3}
    assert ends == {name: pytest.approx(value, abs=1e-5) for name, value in expected.items()}
    page.get_by_text("Form, action, setpoint weight").click()
    weight = page.locator("gain-slider[name=beta] input[type=text]")
    expect(weight).to_have_value("0.5")
    weight.fill("1")
    weight.press("Enter")
    expect(note).to_contain_text("CFS is CS, and TF is T")
    expect(page).not_to_have_url(re.compile("beta="))
    assert violations(page) == []


def test_a_loop_that_is_cut_is_drawn_with_what_is_left(page: Page):
    open_workbench(page, "plant=0/(s%2B1)&type=PI&Kc=1&tau_I=2&show=bode,nichols,root_locus,sensitivity")
    for panel in ("bode", "nichols"):
        expect(page.locator(f"#panel-{panel} .panel-note")).to_contain_text("L = 0: the loop is cut")
    expect(page.locator("#panel-root_locus .panel-note")).to_contain_text("no poles that could move")
    traces = "document.querySelector('#panel-sensitivity .plot').data"
    drawn = page.evaluate(f"Object.fromEntries({traces}.map((t) => [t.name, Array.from(t.y)]))")
    assert set(drawn["S"]) == {0}
    assert drawn["T"] == drawn["PS"] == []
    # CS is C = 1 + 1/(2 s), which falls to 0 dB.
    assert drawn["CS"][0] > drawn["CS"][-1] > 0
    page.get_by_role("button", name="asymptotes").click()
    settled(page)
    page.locator("#panel-bode").get_by_role("button", name="Numbers of Bode as a table").click()
    expect(page.locator("#panel-bode table")).to_contain_text("|C| [dB]")
