"""Bode's integral against the theorem, on worked and on random loops; its areas against mpmath."""

import mpmath
import numpy as np
import pytest

from looplab.engine.limits import bode_integral
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.stability import closed_loop_verdict
from looplab.engine.systems import TransferFunction, parse_transfer_function
from placed_loops import placed_loops
from random_loops import random_loops

ONE = TransferFunction([], [], 1.0)


def loop_of(text: str) -> FeedbackLoop:
    return FeedbackLoop(parse_transfer_function(text), ONE)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        # Lecture notes, section 22.7.
        ("1/(s(s+4))", 0.0),
        ("1/(s+4)", -np.pi / 2),
        ("exp(-0.3s)/(s+4)", 0.0),
        # Unstable poles 1 and 2, relative degree 1: pi (1 + 2) - (pi/2) 4.
        ("4(s+1)/((s-1)(s-2))", np.pi),
        ("2.5(0.1s+1)exp(-0.2s)/((s-1)(0.02s+1))", np.pi),
        # A pair in the right half-plane, 0.3 +- 2j, relative degree 2.
        ("30(s+2)/((s^2-0.6s+4.09)(s+10))", 0.6 * np.pi),
        # S is zero on the axis, at 1 and at sqrt(3).
        ("10(s+1)(s^2+2.1)/((s^2+1)(s^2+3))", -5 * np.pi),
        # Corners far apart, and three integrators.
        ("100(s+1)^2/(s^3(0.001s+1))", 0.0),
    ],
)
def test_worked_values(text: str, value: float) -> None:
    found = bode_integral(loop_of(text))
    assert found.reason is None
    assert found.theorem == pytest.approx(value, abs=1e-12)
    assert found.value == pytest.approx(value, abs=1e-9)
    assert found.origin + found.middle + found.tail == found.value
    assert found.area_above - found.area_below + found.tail == pytest.approx(found.value, abs=1e-9)


def test_the_areas_of_a_loop_with_dead_time() -> None:
    """Both areas by mpmath at 20 digits, on panels that end where |S| = 1; a plain trapz says nothing of the origin."""
    found = bode_integral(loop_of("2exp(-0.5s)/(s(s+4))"))

    def ln_S(w: mpmath.mpf) -> mpmath.mpf:
        s = mpmath.mpc(0, w)
        return -mpmath.log(abs(1 + 2 * mpmath.exp(-s / 2) / (s * (s + 4))))

    with mpmath.workdps(20):
        grid = np.linspace(1e-6, found.omega_high, 4001)
        values = np.array([float(ln_S(mpmath.mpf(w))) for w in grid])
        at = np.flatnonzero(np.diff(np.sign(values)))
        ends = [mpmath.findroot(ln_S, (grid[i], grid[i + 1]), solver="anderson") for i in at]
        edges = [mpmath.mpf(0), *ends, mpmath.mpf(found.omega_high)]
        parts = [mpmath.quad(ln_S, edges[i : i + 2]) for i in range(len(edges) - 1)]
    assert found.area_below == pytest.approx(float(-sum(p for p in parts if p < 0)), rel=1e-9)
    assert found.area_above == pytest.approx(float(sum(p for p in parts if p > 0)), rel=1e-9)


def test_random_loops() -> None:
    tried = {"stable": 0, "dead time": 0, "relative degree 1": 0}
    for r in random_loops(120):
        L = r.loop.open_loop
        found = bode_integral(r.loop)
        if not closed_loop_verdict(r.loop).closed_loop_stable or L.relative_degree == 0:
            assert found.value is None
            assert found.reason
            continue
        poles = np.array(r.roots[1])
        expected = np.pi * poles.real[poles.real > 1e-9].sum()
        if L.relative_degree == 1 and not L.theta:
            expected -= np.pi / 2 * r.loop.gain * r.roots[2]
        scale = max(found.area_below, found.area_above)
        assert found.value == pytest.approx(expected, abs=1e-6 * max(scale, 1e-3)), r.number
        assert abs(found.value - expected) <= 1e-8 * scale + 10 * found.error, r.number
        tried["stable"] += 1
        tried["dead time"] += bool(L.theta)
        tried["relative degree 1"] += L.relative_degree == 1
    assert min(tried.values()) >= 5, tried


def test_unstable_plants_pay_with_their_poles() -> None:
    for loop, unstable, k in placed_loops(25):
        found = bode_integral(loop)
        expected = np.pi * sum(p.real for p in unstable) - np.pi / 2 * k
        assert found.theorem == pytest.approx(expected, rel=1e-12)
        assert found.value == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("10/((s-1)(s+20))", "not"),
        ("2(s+1)/(s+4)", "as many zeros as poles"),
        ("0.5(s+1)exp(-s)/(s+4)", "turns around without end"),
        ("4/(s^2+4)", "imaginary axis"),
    ],
)
def test_no_value_without_convergence(text: str, why: str) -> None:
    found = bode_integral(loop_of(text))
    assert found.value is found.origin is found.middle is found.tail is found.area_below is None
    assert why in found.reason


def test_a_cut_loop_gains_and_loses_nothing() -> None:
    found = bode_integral(FeedbackLoop(parse_transfer_function("1/(s+1)"), PID(0.0)))
    assert found.value == found.area_below == found.area_above == 0.0
    assert not found.ln_S.any()
