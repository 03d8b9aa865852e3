"""Metrics against exact values from sums of exponentials, closed forms, and a piecewise polynomial with dead time."""

import dataclasses
import itertools
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given

from looplab.engine.frequency import nyquist_count
from looplab.engine.loop import PID, FeedbackLoop, StepMetrics, closed_loop_step, default_horizon, step_metrics
from looplab.engine.systems import TransferFunction, parse_transfer_function
from references import cases
from strategies import controllers, effort, systems

# relative; the curves between 500 samples are cubics through exact values and slopes
TOLERANCES = {
    "final_value": 1e-12,
    "offset": 1e-12,
    "overshoot_pct": 1e-5,
    "peak": 1e-7,
    "t_peak": 1e-5,
    "t_rise": 1e-6,
    "t_settle": 1e-5,
    "decay_ratio": 1e-4,
    "IAE": 1e-5,
    "ISE": 1e-5,
    "ITAE": 1e-5,
    "TV": 1e-5,
}


def judge(loop: FeedbackLoop, horizon: float, points: int = 500) -> tuple[StepMetrics, StepMetrics]:
    r = closed_loop_step(loop, horizon=horizon, points=points)
    stable = nyquist_count(loop.open_loop).Z == 0
    return step_metrics(r.setpoint, setpoint=1.0, stable=stable), step_metrics(r.load, setpoint=0.0, stable=stable)


@pytest.mark.parametrize("case", cases("step_metrics"))
@pytest.mark.parametrize("side", ["setpoint", "load"])
def test_metrics_equal_the_exact_ones(case: dict[str, Any], side: str) -> None:
    loop = FeedbackLoop(parse_transfer_function(case["plant"]), PID(**case["controller"]))
    found = judge(loop, case["horizon"])[0 if side == "setpoint" else 1]
    for name, expected in case[side].items():
        value = getattr(found, name)
        if expected is None:
            assert value is None
            assert "undefined" in found.reasons[name]
        else:
            assert value == pytest.approx(expected, rel=TOLERANCES[name], abs=1e-9), name


@pytest.mark.parametrize("zeta", [0.1, 0.3, 0.5, 0.7])
def test_second_order_closed_forms(zeta: float) -> None:
    """1/(s(s + 2 zeta)): overshoot e^{-pi zeta/r}, t_peak = pi/r, decay e^{-2 pi zeta/r}, r = sqrt(1 - zeta^2)."""
    loop = FeedbackLoop(TransferFunction((), (0.0, -2 * zeta), 1.0), PID(1.0))
    m, _ = judge(loop, 40.0, 2000)
    root = np.sqrt(1 - zeta**2)
    assert m.overshoot_pct == pytest.approx(100 * np.exp(-np.pi * zeta / root), rel=1e-7)
    assert m.t_peak == pytest.approx(np.pi / root, rel=1e-7)
    assert m.decay_ratio == pytest.approx(np.exp(-2 * np.pi * zeta / root), rel=1e-6)


def test_first_order_closed_forms() -> None:
    """y = 1 - e^{-t/T}: IAE = T, ISE = T/2, ITAE = T^2, rise T ln 9, settling T ln 50 (long horizon)."""
    T = 1.5
    m, _ = judge(FeedbackLoop(TransferFunction((), (0.0,), 1 / T), PID(1.0)), 60.0, 2000)
    assert m.IAE == pytest.approx(T, rel=1e-9)
    assert m.ISE == pytest.approx(T / 2, rel=1e-8)
    assert m.ITAE == pytest.approx(T**2, rel=1e-8)
    assert m.t_rise == pytest.approx(T * np.log(9), rel=1e-8)
    assert m.t_settle == pytest.approx(T * np.log(50), rel=1e-8)
    assert m.overshoot_pct == 0
    assert m.t_peak is None
    assert m.decay_ratio is None


def test_integrals_with_dead_time_are_those_of_the_piecewise_polynomial() -> None:
    """e^{-s}/s, Kc = 0.5: e is a polynomial of degree k on [k, k+1], integrated exactly between its zeros."""
    Kc, horizon = Fraction(1, 2), 12
    pieces = [np.polynomial.Polynomial([1.0])]
    for _ in range(1, horizon):  # e' = -Kc e(t - 1), in local time
        before = pieces[-1]
        pieces.append(before(1.0) - float(Kc) * before.integ())
    IAE = ISE = ITAE = 0.0
    for k, p in enumerate(pieces):
        cuts = [0.0, *sorted(r.real for r in p.roots() if abs(r.imag) < 1e-12 and 0 < r.real < 1), 1.0]
        t = np.polynomial.Polynomial([k, 1.0])
        for a, b in itertools.pairwise(cuts):
            IAE += abs(p.integ()(b) - p.integ()(a))
            ITAE += abs((t * p).integ()(b) - (t * p).integ()(a))
        ISE += (p * p).integ()(1.0) - (p * p).integ()(0.0)
    m, _ = judge(FeedbackLoop(TransferFunction((), (0.0,), 1.0, 1.0), PID(0.5)), float(horizon), 12 * 40 + 1)
    assert m.IAE == pytest.approx(IAE, rel=1e-8)
    assert m.ISE == pytest.approx(ISE, rel=1e-8)
    assert m.ITAE == pytest.approx(ITAE, rel=1e-8)


@effort(40)
@given(systems(order=(1, 4)) | systems(order=(1, 3), theta=True), controllers())
def test_metrics_do_not_hang_on_the_grid(P: TransferFunction, C: PID) -> None:
    """Against a plain fine recomputation: 5000 samples, trapezoids, largest sample, last sample outside the band."""
    loop = FeedbackLoop(P, C)
    assume(nyquist_count(loop.open_loop).Z == 0)
    r = closed_loop_step(loop, horizon=30.0, points=5000)
    coarse, _ = judge(loop, 30.0, 500)
    y, t = r.setpoint.y, r.setpoint.t
    assume(r.setpoint.truncated_at is None)
    # the comparison needs a curve that 500 samples resolve
    assume(np.abs(np.diff(y)).max() < 0.01 * max(1.0, np.abs(y).max()))
    assume(np.abs(np.diff(r.setpoint.u)).max() < 0.01 * max(1.0, np.abs(r.setpoint.u).max()))
    e = np.abs(1 - y)
    span = t[-1] / 30.0
    assert coarse.IAE == pytest.approx(np.trapezoid(e, t) / span, rel=0.02, abs=1e-3)
    assert coarse.ISE == pytest.approx(np.trapezoid(e**2, t) / span, rel=0.03, abs=1e-3)
    final = coarse.final_value
    if final is not None and abs(final) > 1e-3:
        top = 100 * ((y - final) * np.sign(final)).max() / abs(final)
        if coarse.overshoot_pct:
            assert coarse.overshoot_pct == pytest.approx(top, rel=0.02, abs=0.1)
        if coarse.t_settle is not None and coarse.t_settle < 29:
            outside = np.abs(y - final) > 0.0205 * abs(final)
            inside_for_good = t[np.flatnonzero(outside)[-1]] if outside.any() else 0.0
            assert coarse.t_settle >= inside_for_good - 0.1


def test_undefined_is_none_with_a_reason() -> None:
    loop = FeedbackLoop(parse_transfer_function("1/(s+1)^3"), PID(12.0))
    for m in judge(loop, 20.0):
        for field in dataclasses.fields(m):
            if field.name != "reasons":
                assert getattr(m, field.name) is None
                assert "not stable" in m.reasons[field.name]


@pytest.mark.parametrize("plant", ["1/(s+1)^3", "exp(-0.4 s)/(s+1)", "2", "s/(s+1)^2", "1/s", "exp(-10 s)/(s+1)"])
@pytest.mark.parametrize("Kc", [0.0, 0.3])
def test_every_missing_number_has_a_reason(plant: str, Kc: float) -> None:
    loop = FeedbackLoop(parse_transfer_function(plant), PID(Kc))
    for m in judge(loop, 8.0):
        for field in dataclasses.fields(m):
            value = getattr(m, field.name)
            if field.name != "reasons":
                assert value is not None or m.reasons[field.name]
                assert value is None or np.isfinite(value)


@pytest.mark.parametrize(
    "plant", ["1/(s+1)^3", "exp(-0.4 s)/(5s+1)", "1/s", "1/(s-1)", "2", "exp(-3s)", "1/(s^2+0.02s+1)", "1/s^2"]
)
def test_default_horizon_suits_the_plant(plant: str) -> None:
    P = parse_transfer_function(plant)
    horizon = default_horizon(FeedbackLoop(P, PID(0.1)))
    assert horizon > 3 * P.theta
    slow = max((1 / abs(p) for p in P.poles if p), default=0)
    assert 2 * slow <= horizon <= 1000 * (slow + P.theta + 1)
    assert horizon == default_horizon(FeedbackLoop(P, PID(0.7, 2.0)))


def test_a_response_that_jumps_needs_no_time_to_rise() -> None:
    """A pure gain is at its end at once; (s + 9)/(9 s + 1) jumps to 1/10 and rises to 9/10.

    Closed it is (s + 9)/(10 (s + 1)): y = 0.9 - 0.8 exp(-t) passes 90 % of its end, 0.81, at ln(0.8/0.09).
    """
    for plant, rises in (("0.5", 0.0), ("(s+9)/(9 s+1)", np.log(0.8 / 0.09))):
        loop = FeedbackLoop(parse_transfer_function(plant), TransferFunction())
        m = step_metrics(closed_loop_step(loop, 10.0, 501).setpoint, setpoint=1.0, stable=True)
        assert m.t_rise == pytest.approx(rises, abs=1e-6)


def test_integrals_that_end_before_the_response_does_say_so() -> None:
    """The Ziegler-Nichols PI of 1/(s+1)^3 rings longer than the default horizon."""
    loop = FeedbackLoop(parse_transfer_function("1/(s+1)^3"), PID(3.6, 3.023))
    short, long = (step_metrics(closed_loop_step(loop, T).setpoint, setpoint=1.0, stable=True) for T in (30.0, 80.0))
    for name in ("IAE", "ISE", "ITAE", "TV"):
        assert "up to the horizon" in short.reasons[name]
        assert name not in long.reasons
        assert getattr(short, name) < getattr(long, name)


def test_the_default_horizon_can_be_simulated_with_a_dead_time_as_short() -> None:
    loop = FeedbackLoop(parse_transfer_function("exp(-0.001 s)/(s (s+0.000001))"), PID(1.0))
    assert closed_loop_step(loop, default_horizon(loop)).setpoint.t.size >= 2
