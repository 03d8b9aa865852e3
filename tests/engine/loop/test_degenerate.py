"""Loops at the edge of what a loop is: each gives a right answer or says what is wrong."""

import numpy as np
import pytest

from looplab.engine.errors import EngineError, ImproperSystem, InvalidInput, NoConvergence
from looplab.engine.frequency import bode, margins, nyquist_count, nyquist_curve
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step, default_horizon, step_metrics, step_response
from looplab.engine.stability import closed_loop_poles, closed_loop_verdict, root_locus
from looplab.engine.systems import TransferFunction, parse_transfer_function

PLANTS = [
    "2",
    "-2",
    "0.8 exp(-s)",
    "1/s",
    "1/s^3",
    "exp(-s)/s^2",
    "s/(s+1)^2",
    "s^2/(s+1)^3",
    "1/(s^2+1)",
    "exp(-0.3 s)/(s^2+4)",
    "(s^2+1)/(s+1)^3",
    "1/((s+1)^5 (s+1.001)^5)",
    "1/(s+1)^50",
    "exp(-0.5 s)/(s+1)^20",
    "1/(s-1)^3",
    "(s-1)/(s+2)",
    "0.5(s-1)/(s+2) exp(-s)",
    "1/(1e-6 s + 1)",
    "exp(-1e-3 s)/(1e4 s + 1)",
    "(s+1)/(s+1)",
    "0/(s+1)",
    "1e-30/(s+1)",
    "1e9/(s+1)^2",
    "exp(-s)/(s-1)",
    "1/((s+1e-8)(s+1e8))",
    "(s+1e-3)/(s^2 (s+1e3)) exp(-0.01 s)",
]
CONTROLLERS = [
    PID(0.0),
    PID(0.4),
    PID(-0.4),
    PID(0.4, 2.0),
    PID(0.4, 2.0, 0.5, 0.1),
    PID(0.4, None, 0.5, 0.2),
    PID(1e6),
    PID(0.0, 1.0),
]


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize("C", CONTROLLERS, ids=lambda c: f"{c.type}{c.Kc:g}")
def test_everything_answers_with_finite_numbers_or_refuses_in_words(plant: str, C: PID) -> None:
    P = parse_transfer_function(plant)
    try:
        loop = FeedbackLoop(P, C)
    except EngineError as refusal:
        assert refusal.message
        return
    horizon = default_horizon(loop)
    assert np.isfinite(horizon)
    assert horizon > 0
    verdict, m = closed_loop_verdict(loop), margins(loop.open_loop)
    assert verdict.because
    if verdict.verdict == "stable" and nyquist_count(loop.open_loop).P == 0:
        assert m.closed_loop_stable
    if verdict.verdict == "unstable" and verdict.rhp_poles:
        assert not m.closed_loop_stable
    for name in ("GM", "GM_dB", "omega_180", "PM_deg", "omega_c", "delay_margin", "Ms", "omega_Ms", "Mt", "omega_Mt"):
        value = getattr(m, name)
        assert (value is None and m.reasons[name]) or np.isfinite(value), name
    assert np.isfinite(closed_loop_poles(loop).poles).all()
    curve = nyquist_curve(loop.open_loop)
    assert np.isfinite(curve.re).all()
    assert np.isfinite(curve.im).all()
    assert np.isfinite(bode(P).phase_deg).all()
    try:
        r = closed_loop_step(loop, horizon)
    except (NoConvergence, InvalidInput) as refusal:
        assert P.theta
        assert refusal.hint
        return
    for response, setpoint in ((r.setpoint, 1.0), (r.load, 0.0)):
        for signal in (response.y, response.u):
            assert np.isfinite(signal).all()
            assert signal.size >= 1
        assert (response.truncated_at is None) == (response.y.size == r.t.size)
        if verdict.verdict == "unstable" and verdict.rhp_poles == 0 and response.truncated_at is not None:
            assert response.truncated_reason
        metrics = step_metrics(response, setpoint=setpoint, stable=verdict.closed_loop_stable)
        assert metrics is not None
    if not P.theta and loop.open_loop.order and loop.locus_system.gain:
        try:
            locus = root_locus(loop.locus_system)
        except EngineError as refusal:
            assert refusal.message
        else:
            assert np.isfinite(locus.branches).all()


@pytest.mark.parametrize(
    ("plant", "Kc", "horizon"), [("1/(s-1)", 0.5, 200.0), ("1/(s+1)^3", 50.0, 200.0), ("exp(-s)/s", 4.0, 200.0)]
)
def test_an_unstable_response_is_cut_with_its_reason(plant: str, Kc: float, horizon: float) -> None:
    r = closed_loop_step(FeedbackLoop(parse_transfer_function(plant), PID(Kc)), horizon)
    for response in (r.setpoint, r.load):
        assert response.y.size == response.u.size == response.t.size < r.t.size
        assert 0 < response.truncated_at <= horizon
        assert "unstable" in response.truncated_reason
        assert np.abs(response.y).max() <= 1e9


@pytest.mark.parametrize(
    "arguments",
    [
        dict(horizon=0.0),
        dict(horizon=-1.0),
        dict(horizon=np.nan),
        dict(horizon=np.inf),
        dict(horizon=1.0, points=1),
        dict(horizon=1.0, points=10**6),
    ],
)
def test_horizon_and_points_are_bounded(arguments: dict) -> None:
    loop = FeedbackLoop(parse_transfer_function("1/(s+1)"), PID(1.0))
    with pytest.raises(InvalidInput) as caught:
        closed_loop_step(loop, **arguments)
    assert caught.value.field in ("horizon", "points")


def test_a_dead_time_below_a_millionth_of_the_horizon_is_refused() -> None:
    loop = FeedbackLoop(parse_transfer_function("exp(-1e-6 s)/(s+1)"), PID(1.0))
    with pytest.raises(InvalidInput) as caught:
        closed_loop_step(loop, 10.0)
    assert caught.value.field == "theta"
    assert caught.value.hint
    closed_loop_step(loop, 0.9)


def test_improper_plants_and_controllers_are_refused_with_a_hint() -> None:
    for plant, controller, field in (
        ("s", "1", "plant"),
        ("1/(s+1)", "s+1", "controller"),
        ("s^2/(s+1)", "1", "plant"),
    ):
        with pytest.raises(ImproperSystem) as caught:
            FeedbackLoop(parse_transfer_function(plant), parse_transfer_function(controller))
        assert caught.value.field == field
        assert caught.value.hint
    with pytest.raises(ImproperSystem):
        step_response(parse_transfer_function("s"), 1.0)


def test_an_algebraic_loop_without_solution_is_refused() -> None:
    with pytest.raises(EngineError) as caught:
        FeedbackLoop(parse_transfer_function("-2"), PID(0.5))
    assert caught.value.message


def test_a_neutral_loop_past_its_limit_grows_at_every_high_frequency() -> None:
    """|Dc Dp| = 1.2: the response is exact (references/delayed_loops.json), the verdict says why it is hopeless."""
    loop = FeedbackLoop(parse_transfer_function("(2 s + 1)/(s + 1) exp(-s)"), PID(0.6))
    verdict = closed_loop_verdict(loop)
    assert verdict.verdict == "unstable"
    assert verdict.rhp_poles is None
    r = closed_loop_step(loop, 50.0)
    jumps = np.abs(r.setpoint.y[np.searchsorted(r.t, [10.0, 20.0, 30.0]) - 0])
    assert jumps[2] > jumps[1] > jumps[0]


def test_pure_gain_and_pure_dead_time_in_closed_form() -> None:
    r = closed_loop_step(FeedbackLoop(parse_transfer_function("2"), PID(0.7)), 5.0)
    np.testing.assert_allclose(r.setpoint.y, 1.4 / 2.4, rtol=1e-14)
    np.testing.assert_allclose(r.load.y, 2 / 2.4, rtol=1e-14)
    r = closed_loop_step(FeedbackLoop(TransferFunction((), (), 1.0, 1.0), PID(0.6)), 10.0, 201)
    # y = sum of -(-0.6)^k from k = 1 to floor(t): the echo of a geometric series
    echoes = np.floor(r.t + 1e-9)
    np.testing.assert_allclose(r.setpoint.y, 0.6 * (1 - (-0.6) ** echoes) / 1.6, atol=1e-13)


def test_open_step_responses_in_closed_form() -> None:
    r = step_response(parse_transfer_function("2 exp(-0.5 s)/(s+1)"), 10.0, 401)
    np.testing.assert_allclose(r.y, np.where(r.t < 0.5 - 1e-9, 0, -2 * np.expm1(-(r.t - 0.5))), atol=1e-13)
    r = step_response(parse_transfer_function("1/s^3"), 10.0, 401)
    np.testing.assert_allclose(r.y, r.t**3 / 6, rtol=1e-12, atol=1e-13)
    r = step_response(parse_transfer_function("1/(s^2+1)"), 50.0, 401)
    np.testing.assert_allclose(r.y, 1 - np.cos(r.t), atol=1e-11)
    r = step_response(parse_transfer_function("exp(-20 s)/(s+1)"), 10.0, 50)
    assert not r.y.any()
    r = step_response(parse_transfer_function("exp(-0.001 s)/(s+1)"), 10.0, 50)
    np.testing.assert_allclose(r.y, np.where(r.t > 0.0009, -np.expm1(-np.maximum(r.t - 0.001, 0)), 0), atol=1e-13)
