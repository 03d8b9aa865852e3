"""Zeros and poles on the right: constraints, lemmas on the actual response, bounds, a worked example of the course."""

import mpmath
import numpy as np
import pytest
from scipy.integrate import simpson

from looplab.engine.errors import InvalidInput
from looplab.engine.frequency import margins
from looplab.engine.limits import (
    interpolation_constraints,
    lemma_integrals,
    overshoot_bound,
    peak_bounds,
    plant_step_shape,
    pole_bound,
    step_shape,
    undershoot_bound,
    weighted_integrals,
    zero_bound,
)
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step, step_response
from looplab.engine.stability import internal_stability
from looplab.engine.systems import parse_transfer_function
from placed_loops import placed_loops
from random_loops import random_loops


def loop_of(text: str, controller: PID) -> FeedbackLoop:
    return FeedbackLoop(parse_transfer_function(text), controller)


def test_undershoot_of_the_worked_example() -> None:
    """G = (s^2 - 3 s + 2)/(s+1)^4 over its gain of 2 (lecture notes, section 22.6, and its errata)."""
    found = plant_step_shape(parse_transfer_function("(s^2-3s+2)/(s+1)^4"))

    def y(t: float) -> mpmath.mpf:
        return mpmath.invertlaplace(lambda s: (s - 1) * (s - 2) / (2 * s * (s + 1) ** 4), t, method="talbot")

    with mpmath.workdps(25):
        assert found.undershoot_pct == pytest.approx(float(-100 * y(2)), rel=1e-8)
        assert float(y(found.t_settle)) == pytest.approx(0.98, abs=1e-9)
        slope = mpmath.diff(y, 2, h=1e-6)
    assert abs(float(slope)) < 1e-9
    assert found.t_undershoot == pytest.approx(2.0, abs=1e-6)
    assert round(found.undershoot_pct, 2) == 8.27
    assert round(found.t_settle, 2) == 10.28
    assert found.starts_up is True
    by_zero = {effect.c: effect for effect in found.effects}
    assert {c: e.effect for c, e in by_zero.items()} == {1.0: "undershoot", 2.0: "undershoot"}
    assert by_zero[1.0].bound_pct / 100 == pytest.approx(3.4e-5, rel=0.01)
    assert by_zero[1.0].bound_pct / 100 == pytest.approx(0.98 / np.expm1(found.t_settle), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "controller"),
    [
        ("(1-s)exp(-0.5s)/(s+1)^2", PID(0.3, 2.0)),
        ("4(s+1)/((s-1)(s-2))", PID(2.0, 5.0)),
        ("(s-4)/((s-0.2)(s+2))", PID(-1.0)),
        ("exp(-0.2s)/(s-1)", PID(2.5, 10.0, beta=0.4)),
    ],
)
def test_the_lemmas_hold_on_the_response(text: str, controller: PID) -> None:
    found = lemma_integrals(loop_of(text, controller))
    assert found
    for integral in found:
        assert integral.value == pytest.approx(integral.theorem, abs=1e-12), integral


def test_a_weighted_integral_is_that_of_the_sampled_response() -> None:
    """Under a weight that no lemma speaks of, with dead time: against Simpson's rule on the samples."""
    loop = loop_of("exp(-0.5s)/(s+1)^3", PID(1.0, 2.0))
    c = 0.7
    steps = closed_loop_step(loop, 36.0 / c, 5000)
    w = np.exp(-c * steps.t)
    found = weighted_integrals(loop, c)
    for column, y in enumerate((steps.setpoint.y, steps.load.y)):
        assert found[0, column] == pytest.approx(simpson(w * y, x=steps.t), abs=1e-8)
    with pytest.raises(InvalidInput):
        weighted_integrals(loop, 0.0)


def test_random_loops_keep_their_constraints() -> None:
    zeros = poles = 0
    for loop in [*(r.loop for r in random_loops(200)), *(loop for loop, _, _ in placed_loops())]:
        if not internal_stability(loop).internally_stable:
            continue
        m = margins(loop.open_loop)
        Ms, Mt = peak_bounds(loop.open_loop)
        # Peaks found over frequency are never below what zeros and poles ask for.
        assert m.Ms is None or m.Ms >= Ms * (1 - 1e-9), loop
        assert m.Mt is None or m.Mt >= Mt * (1 - 1e-9), loop
        for found in interpolation_constraints(loop):
            at_zero = found.kind == "zero"
            zeros, poles = zeros + at_zero, poles + (not at_zero)
            assert found.S == pytest.approx(1.0 if at_zero else 0.0, abs=1e-6), loop
            assert found.T == pytest.approx(0.0 if at_zero else 1.0, abs=1e-6), loop
        for integral in lemma_integrals(loop):
            assert integral.value == pytest.approx(integral.theorem, abs=1e-8 * max(1.0, 1.0 / integral.root)), loop
    assert zeros >= 10
    assert poles >= 40


def test_peak_bounds_in_closed_form() -> None:
    L = parse_transfer_function("(s-4)exp(-0.5s)/((s-0.2)(s+2))")
    Ms, Mt = peak_bounds(L)
    assert Ms == pytest.approx(4.2 / 3.8, rel=1e-12)
    assert Mt == pytest.approx(np.exp(0.1) * 4.2 / 3.8, rel=1e-12)


def test_bounds_on_the_bandwidth_are_where_their_weights_reach_one() -> None:
    for root in (1.7 + 0j, 0.4 + 2j, 1 + 1j):
        for w, value in (
            (zero_bound(root), 0.5 + zero_bound(root) / root),
            (pole_bound(root), root / pole_bound(root) + 0.5),
        ):
            assert w > 0
            assert abs(value) == pytest.approx(1.0, rel=1e-12)
    assert zero_bound(3 + 0j) == pytest.approx(1.5)
    assert pole_bound(3 + 0j) == pytest.approx(6.0)


def test_a_slow_zero_overshoots_at_least_as_the_lemma_says() -> None:
    G = parse_transfer_function("(10s+1)/((s+1)(0.5s+1))")
    found = step_shape(step_response(G, 40.0, 4001), G.zeros, 1.0)
    [effect] = found.effects
    assert (effect.c, effect.effect) == (-0.1, "overshoot")
    # y = 1 + 18 e^-t - 19 e^-2t
    top = -np.log(18 / 38)
    assert found.overshoot_pct == pytest.approx(100 * (18 * np.exp(-top) - 19 * np.exp(-2 * top)), rel=1e-7)
    assert 50 < effect.bound_pct <= found.overshoot_pct
    # The error decays as 18 e^-t: K e^{-p ts} is 0.02 (and a little more at the end), eta = 0.1.
    ts = found.t_settle
    expected = (1 - 0.1 / 0.9 * 18 * np.exp(-ts) * np.exp(0.1 * ts)) / np.expm1(0.1 * ts)
    assert effect.bound_pct == pytest.approx(100 * expected, rel=1e-3)
    assert overshoot_bound(-0.1, 7000.0, 1.0, 0.02) == 0.0


def test_bounds_refuse_what_they_are_not_about() -> None:
    with pytest.raises(InvalidInput):
        undershoot_bound(-1.0, 2.0)
    with pytest.raises(InvalidInput):
        overshoot_bound(-2.0, 2.0, 1.0, 0.02)
    unsettled = step_response(parse_transfer_function("1/(10s+1)"), 5.0, 100)
    shape = step_shape(unsettled, np.zeros(0, dtype=complex), 0.1)
    assert shape.t_settle is None
    assert shape.reason
    for text in ("1/s", "s/(s+1)", "3", "1/(s-1)"):
        assert plant_step_shape(parse_transfer_function(text)).reason
