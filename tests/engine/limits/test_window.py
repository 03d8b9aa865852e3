"""The limits of sensor, actuator, load, model and dead time, and the window between them."""

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.frequency import closed_loop_bandwidth
from looplab.engine.limits import (
    Demands,
    Spread,
    actuator_demand,
    bandwidth_window,
    ideal_delay_loop,
    load_left,
    mismatch,
    multiplicative_weight,
    noise_passed,
)
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
from looplab.engine.stability import closed_loop_verdict
from looplab.engine.systems import FOPDT, parse_transfer_function


def loop_of(text: str, controller: PID) -> FeedbackLoop:
    return FeedbackLoop(parse_transfer_function(text), controller)


def test_the_actuator_example() -> None:
    """C = 10(s+10)(s+1)/(s(s+12)) on 10/((s+10)(s+1)): T = 100/(s^2+12s+100) (lecture notes, section 22.2)."""
    loop = FeedbackLoop(parse_transfer_function("10/((s+10)(s+1))"), parse_transfer_function("10(s+10)(s+1)/(s(s+12))"))
    found = actuator_demand(loop)
    # A step of the disturbance at the output: u goes from -10 to -1.
    assert -found.initial == pytest.approx(-10.0, rel=1e-12)
    assert -found.final == pytest.approx(-1.0, rel=1e-12)
    assert found.ratio == pytest.approx(10.0, rel=1e-12)
    assert round(found.plant.omega, 3) == 0.990
    assert round(found.loop.omega, 2) == 11.48
    assert round(found.peak.value, 2) == 12.54
    # |Su|^2 = 100 (x + 100)(x + 1)/((100 - x)^2 + 144 x) with x = omega^2: its derivative is zero there.
    top = np.polymul([1.0, 100.0], [1.0, 1.0])
    bottom = np.array([1.0, -56.0, 1e4])
    turns = np.roots(np.polysub(np.polymul(np.polyder(top), bottom), np.polymul(top, np.polyder(bottom))))
    [x] = [t.real for t in turns if abs(t.imag) < 1e-9 and t.real > 0]
    assert found.peak.omega == pytest.approx(np.sqrt(x), rel=1e-8)
    assert found.peak.value == pytest.approx(10 * np.sqrt(np.polyval(top, x) / np.polyval(bottom, x)), rel=1e-12)
    u = closed_loop_step(loop, 3.0, 400).setpoint.u
    assert u[0] == pytest.approx(10.0, rel=1e-12)


def test_the_peak_may_lie_at_the_end_of_the_axis() -> None:
    found = actuator_demand(loop_of("1/(s+1)", PID(3.0)))
    # C/(1 + L) = 3 (s+1)/(s+4): rises to 3 and stays there.
    assert found.peak.omega is None
    assert found.peak.value == pytest.approx(3.0, rel=1e-9)
    assert found.final == pytest.approx(0.75, rel=1e-12)


def test_the_ideal_loop_around_a_dead_time() -> None:
    omega = np.array([1e-9, 0.3, np.pi / 6, 2.0])
    S, T = ideal_delay_loop(2.0, omega)
    assert S + T == pytest.approx(np.ones(4), abs=1e-15)
    assert np.abs(T) == pytest.approx(np.ones(4), rel=1e-14)
    assert abs(S[2]) == pytest.approx(1.0, rel=1e-14)  # pi/(3 theta)
    assert abs(S[0]) == pytest.approx(2e-9, rel=1e-12)


def test_the_weight_covers_every_plant_of_the_spread() -> None:
    """Random plants within the spread never exceed it, and some come as near as the grid of factors allows."""
    K, tau, theta = 2.0, 3.0, 0.8
    omega = np.geomspace(0.01, 30.0, 60)
    weight = multiplicative_weight(FOPDT(K, tau, theta).to_transfer_function(), Spread(20.0, 30.0, 25.0), omega)
    rng = np.random.default_rng(4)
    s, most = 1j * omega, np.zeros(omega.size)
    nominal = K * np.exp(-theta * s) / (tau * s + 1)
    k, t, d = (
        np.concatenate([rng.uniform(1 - p, 1 + p, 20_000), rng.choice([1 - p, 1 + p], 20_000)])
        for p in (0.2, 0.3, 0.25)
    )
    for i, si in enumerate(s):
        errors = np.abs(k * K * np.exp(-d * theta * si) / (t * tau * si + 1) / nominal[i] - 1.0)
        most[i] = errors.max()
    assert (most <= weight * (1 + 1e-3)).all()
    assert (most >= weight * (1 - 0.02)).all()
    # Without a spread of the gain and the lag: |e^{-i x} - 1| = 2 sin(x/2) up to half a turn.
    only = multiplicative_weight(FOPDT(K, tau, theta).to_transfer_function(), Spread(0.0, 0.0, 25.0), omega)
    assert only == pytest.approx(2 * np.sin(np.minimum(0.25 * theta * omega, np.pi) / 2), abs=1e-12)


def test_a_robust_loop_is_stable_on_every_plant_tried() -> None:
    spread = Spread(30.0, 30.0, 30.0)
    robust = mismatch(FeedbackLoop(FOPDT(1, 5, 1).to_transfer_function(), PID(2.0, 5.0)), spread)
    assert robust.robustly_stable
    assert robust.worst_S == pytest.approx(1 / (1 - robust.peak), rel=1e-12)
    tight = mismatch(FeedbackLoop(FOPDT(1, 5, 1).to_transfer_function(), PID(6.5, 5.0)), spread)
    assert not tight.robustly_stable
    assert tight.worst_S is None
    rng = np.random.default_rng(1)
    lost = 0
    for k, t, d in rng.choice([0.7, 1.0, 1.3], (12, 3)).tolist():
        plant = FOPDT(k, 5 * t, d).to_transfer_function()
        assert closed_loop_verdict(FeedbackLoop(plant, PID(2.0, 5.0))).closed_loop_stable
        lost += not closed_loop_verdict(FeedbackLoop(plant, PID(6.5, 5.0))).closed_loop_stable
    assert lost


def test_the_window_of_a_lag_with_dead_time() -> None:
    loop = loop_of("exp(-s)/(5s+1)", PID(2.0, 5.0))
    found = bandwidth_window(loop, Demands(u_limit=4.0, noise_omega=20.0, load_error=0.5))
    omega = {limit.id: limit.omega for limit in found.limits}
    assert omega["pole"] is omega["zero"] is None
    assert omega["dead_time"] == 1.0
    assert omega["noise"] == pytest.approx(2.0)
    # |1/(5 i w + 1)| = 1/4 and = 1/2
    assert omega["actuator"] == pytest.approx(np.sqrt(15) / 5, rel=1e-12)
    assert omega["load"] == pytest.approx(np.sqrt(3) / 5, rel=1e-12)
    w = np.array([omega["mismatch"]])
    assert multiplicative_weight(loop.plant, Spread(), w) == pytest.approx(np.ones(1), rel=1e-9)
    assert {limit.id for limit in found.limits if limit.binding} == {"load", "actuator"}
    assert (found.low, found.high, found.open) == (omega["load"], omega["actuator"], True)
    assert noise_passed(loop, 20.0) < 0.1
    left, at = load_left(loop)
    s = 1j * at
    P, C = np.exp(-s) / (5 * s + 1), 2 * (1 + 1 / (5 * s))
    assert left == pytest.approx(abs(P / (1 + P * C)), rel=1e-12)
    assert closed_loop_bandwidth(loop.open_loop).omega < 1.0


def test_a_plant_may_leave_nothing() -> None:
    """A pole at 1 and a zero at 1.5: faster than 2, slower than 0.75."""
    found = bandwidth_window(loop_of("(s-1.5)/((s-1)(s+5))", PID(1.0)))
    assert found.low == pytest.approx(2.0)
    assert found.high == pytest.approx(0.75)
    assert found.open is False
    weak = bandwidth_window(loop_of("1/(s+1)", PID(1.0)), Demands(u_limit=0.5))
    assert weak.high == 0.0
    assert weak.open is False


@pytest.mark.parametrize(
    "wrong", [{"u_limit": 0.0}, {"noise_omega": -1.0}, {"noise_gain": 1.0}, {"load_error": np.inf}]
)
def test_demands_are_positive(wrong: dict[str, float]) -> None:
    with pytest.raises(InvalidInput) as caught:
        Demands(**wrong)
    assert caught.value.field in wrong


def test_a_spread_has_bounds() -> None:
    with pytest.raises(InvalidInput):
        Spread(K_pct=95.0)
