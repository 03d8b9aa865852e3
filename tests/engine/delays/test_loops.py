"""Loops with actuator, sensor and disturbance: where a dead time sits, and what the signals are."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from looplab.engine.delays import Block, delay_verdict, frequency_response, in_feedback, in_series, loop_system
from looplab.engine.delays import step_response as delay_step
from looplab.engine.errors import IllPosedLoop, ImproperSystem, InvalidInput
from looplab.engine.frequency import margins
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step, default_horizon, step_metrics, step_response
from looplab.engine.stability import closed_loop_poles, closed_loop_verdict, internal_stability
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import controllers, effort, magnitudes, systems

OMEGA = np.logspace(-2, 1.5, 40)


def late(G: TransferFunction, theta: float) -> TransferFunction:
    return TransferFunction(G.zeros, G.poles, G.gain, theta)


def size_of(values: np.ndarray) -> np.ndarray:
    return np.maximum(1.0, np.maximum.accumulate(np.abs(values)))


@effort(15)
@given(systems(order=(1, 3)), controllers(), st.sampled_from([0.25, 0.5, 1.0]))
def test_a_dead_time_that_moves_around_the_loop_shifts_y_and_nothing_else(
    P: TransferFunction, C: PID, theta: float
) -> None:
    """y_r with the dead time in plant or actuator is the same; in the sensor it comes theta earlier. y_d comes later
    only when the dead time is in the plant."""
    one = TransferFunction((), (), 1.0, theta)
    plant = closed_loop_step(FeedbackLoop(late(P, theta), C), 12.0, 481)
    actuator = closed_loop_step(FeedbackLoop(P, C, actuator=one), 12.0, 481)
    sensor = closed_loop_step(FeedbackLoop(P, C, sensor=one), 12.0, 481)
    h = plant.t[1]
    for other in (actuator, sensor):
        np.testing.assert_allclose(other.t[1], h, rtol=1e-12)
    K = round(theta / h)
    n = min(r.setpoint.y.size for r in (plant, actuator, sensor)) - K
    m = min(r.load.y.size for r in (plant, actuator, sensor)) - K
    assume(n > 50 and m > 50)
    y = plant.setpoint.y
    size = size_of(y)[:n]
    assert (np.abs(actuator.setpoint.y[:n] - y[:n]) / size).max() <= 1e-10
    assert (np.abs(sensor.setpoint.y[:n] - y[K : K + n]) / size_of(y)[K : K + n]).max() <= 1e-10
    d = plant.load.y
    size = size_of(d)[K : K + m]
    assert (np.abs(actuator.load.y[:m] - d[K : K + m]) / size).max() <= 1e-10
    assert (np.abs(sensor.load.y[:m] - d[K : K + m]) / size).max() <= 1e-10
    # What the controller sees is y as it was.
    assert sensor.setpoint.y_m is not None
    np.testing.assert_allclose(sensor.setpoint.y_m[K : K + n], sensor.setpoint.y[:n], rtol=1e-9, atol=1e-10)
    assert actuator.setpoint.y_m is None


@effort(20)
@given(
    systems(order=(1, 3), theta=True), systems(order=(1, 2), theta=True), systems(order=(1, 2), theta=True),
    systems(order=(1, 2), theta=True), controllers(),
)  # fmt: skip
def test_every_response_is_its_quotient(
    P: TransferFunction, A: TransferFunction, H: TransferFunction, G: TransferFunction, C: PID
) -> None:
    """y/r = PAC/(1+L), y/d = P/(1+L) or Gd/(1+L), u/r = C/(1+L), u/d = -CH P/(1+L), y_m = H y, with L = CAPH."""
    for disturbance in (None, G):
        loop = FeedbackLoop(P, C, A, H, disturbance)
        s = 1j * OMEGA
        p, a, h, c = P(s), A(s), H(s), loop.C(s)
        L = loop.open_loop(s)
        np.testing.assert_allclose(L, c * a * p * h, rtol=1e-9)
        assume(np.abs(1 + L).min() > 1e-3)
        enters = p if disturbance is None else G(s)
        found = frequency_response(loop_system(loop), OMEGA)
        S = 1 / (1 + L)
        expected = np.array(
            [[p * a * c * S, enters * S], [c * S, -c * h * enters * S], [h * p * a * c * S, h * enters * S]]
        )
        for i in range(3):
            for j in range(2):
                e = expected[i, j]
                np.testing.assert_allclose(found[:, i, j], e, rtol=1e-7, atol=1e-9 * np.abs(e).max())
        np.testing.assert_allclose(S + L * S, 1.0, rtol=1e-9)


@effort(10)
@given(
    systems(order=(1, 2), theta=True), systems(order=(1, 2), theta=True), systems(order=(1, 2), theta=True),
    controllers(), magnitudes,
)  # fmt: skip
def test_the_kernel_and_the_method_of_steps_agree(
    P: TransferFunction, A: TransferFunction, H: TransferFunction, C: PID, theta: float
) -> None:
    """Two ways that share no line of the solution: the shift series with moved outputs, and collocation."""
    controller = late(C.to_transfer_function(), min(theta, 2.0))
    G = TransferFunction((), [-0.7], 1.3, 0.45)
    loop = FeedbackLoop(P, controller, A, H, G)
    fast = closed_loop_step(loop, 10.0, 201)
    slow = delay_step(loop_system(loop), float(fast.t[-1]), fast.t.size)
    for j, response in enumerate((fast.setpoint, fast.load)):
        n = min(response.y.size, slow.y.shape[0])
        for i, name in enumerate(("y", "u", "y_m")):
            values = slow.y[:n, i, j]
            assert (np.abs(getattr(response, name)[:n] - values) / size_of(values)).max() <= 1e-9, (name, j)


def test_moved_outputs_keep_the_grid_of_the_loop() -> None:
    """The outputs' shifts make the series larger than the loop's own, which must not change its samples."""
    lag = TransferFunction((), [-1.0])
    loop = FeedbackLoop(late(lag, 1.0), late(PID(1.0).to_transfer_function(), 1.0), late(lag, 0.178), late(lag, 0.555))
    fast = closed_loop_step(loop, 10.0, 201)
    slow = delay_step(loop_system(loop), float(fast.t[-1]), fast.t.size)
    np.testing.assert_allclose(fast.setpoint.y, slow.y[:, 0, 0], atol=1e-10)


def test_nothing_arrives_before_its_dead_time() -> None:
    loop = FeedbackLoop(
        parse_transfer_function("exp(-0.5s)/(s+1)"),
        parse_transfer_function("2 exp(-0.25s)"),
        parse_transfer_function("exp(-0.75s)"),
        parse_transfer_function("exp(-1s)"),
    )
    r = closed_loop_step(loop, 10.0, 401)
    first = {
        "y": (r.setpoint.y, 1.5), "u": (r.setpoint.u, 0.25), "y_m": (r.setpoint.y_m, 2.5),
        "load y": (r.load.y, 0.5), "load u": (r.load.u, 0.5 + 1.0 + 0.25), "load y_m": (r.load.y_m, 1.5),
    }  # fmt: skip
    for name, (values, at) in first.items():
        assert np.abs(np.asarray(values)[r.t < at - 1e-9]).max() <= 1e-13, name
        assert np.abs(np.asarray(values)[r.t > at + 0.05]).max() > 0.1, name
    # u jumps to 2 exactly when the controller's own dead time is over.
    assert r.setpoint.u[np.searchsorted(r.t, 0.25 - 1e-9)] == pytest.approx(2.0, abs=1e-12)


def test_a_load_may_come_long_before_or_after_the_plant_answers() -> None:
    P, C = parse_transfer_function("exp(-2s)/(s+1)"), PID(0.4, 1.5)
    for theta in (0.0, 0.3, 5.0):
        Gd = TransferFunction((), [-0.5], 0.5, theta)
        r = closed_loop_step(FeedbackLoop(P, C, disturbance=Gd), 20.0, 401)
        alone = step_response(Gd, float(r.t[-1]), r.t.size)
        expected = np.interp(r.t, alone.t, alone.y)
        early = r.t < theta + 2.0
        np.testing.assert_allclose(r.load.y[early], expected[early], atol=2e-4)
        np.testing.assert_array_equal(
            r.setpoint.y.round(12), closed_loop_step(FeedbackLoop(P, C), 20.0, r.t.size).setpoint.y.round(12)
        )


def test_final_values_by_hand() -> None:
    """Integral action brings H y to r: y rests at 1/H(0). Without, y = PAC/(1 + PACH)."""
    P, A, H = (parse_transfer_function(t) for t in ("2 exp(-0.3s)/(s+1)", "1.5/(0.1s+1)", "0.8 exp(-0.2s)"))
    Gd = parse_transfer_function("3/(5s+1)")
    r = closed_loop_step(FeedbackLoop(P, PID(0.2, 1.0), A, H, Gd), 60.0)
    assert r.setpoint.final_y == pytest.approx(1 / 0.8)
    assert r.setpoint.y[-1] == pytest.approx(1 / 0.8, abs=1e-6)
    assert r.load.final_y == 0.0
    assert step_metrics(r.setpoint, setpoint=1.0, stable=True).offset == pytest.approx(-0.25)
    r = closed_loop_step(FeedbackLoop(P, PID(0.2), A, H, Gd), 80.0)
    assert r.setpoint.final_y == pytest.approx(0.6 / 1.48)
    assert r.load.final_y == pytest.approx(3 / 1.48)
    assert r.load.y[-1] == pytest.approx(3 / 1.48, abs=1e-5)
    weighted = closed_loop_step(FeedbackLoop(P, PID(0.2, beta=0.5), A, H, Gd), 80.0)
    assert weighted.setpoint.final_y == pytest.approx(0.3 / 1.48)
    assert weighted.setpoint.y[-1] == pytest.approx(0.3 / 1.48, abs=1e-9)
    # A drifting load under P control on an integrating path: both integrators meet, the rest is Gd/L.
    r = closed_loop_step(
        FeedbackLoop(parse_transfer_function("1/s"), PID(0.5), disturbance=parse_transfer_function("2/s")), 40.0
    )
    assert r.load.final_y == pytest.approx(4.0)
    assert r.load.y[-1] == pytest.approx(4.0, abs=1e-6)


@effort(8)
@given(systems(order=(1, 3), theta=True), systems(order=(1, 2), theta=True), controllers())
def test_margins_verdict_and_poles_are_those_of_the_open_loop(P: TransferFunction, H: TransferFunction, C: PID) -> None:
    split, whole = FeedbackLoop(P, C, sensor=H), FeedbackLoop(H * P, C)
    assert split.theta == whole.theta
    assert split.open_loop.key == whole.open_loop.key
    assert margins(split.open_loop) == margins(whole.open_loop)
    assert closed_loop_verdict(split) == closed_loop_verdict(whole)
    np.testing.assert_array_equal(closed_loop_poles(split).poles, closed_loop_poles(whole).poles)
    assert internal_stability(split).internally_stable == internal_stability(whole).internally_stable
    assert default_horizon(split) == default_horizon(whole)
    verdict = closed_loop_verdict(split)
    if verdict.verdict != "marginal":
        assert delay_verdict(loop_system(split)).rhp_poles == verdict.rhp_poles


def test_a_diagram_of_the_same_loop_is_the_same_loop() -> None:
    P, A, H = (parse_transfer_function(t) for t in ("exp(-0.5s)/(2s+1)", "exp(-0.1s)/(0.3s+1)", "exp(-0.25s)"))
    C = PID(1.2, 2.0)
    forward = in_series([Block.of(G) for G in (C.to_transfer_function(), A, P)])
    diagram = in_feedback(forward, Block.of(H))
    expected = frequency_response(loop_system(FeedbackLoop(P, C, A, H)), OMEGA)[:, 0, 0]
    np.testing.assert_allclose(frequency_response(diagram.system, OMEGA)[:, 0, 0], expected, rtol=1e-11)


def test_what_cannot_be_is_refused() -> None:
    P, C = parse_transfer_function("1/(s+1)"), PID(1.0)
    for name in ("actuator", "sensor", "disturbance"):
        with pytest.raises(ImproperSystem) as caught:
            FeedbackLoop(P, C, **{name: parse_transfer_function("s")})
        assert caught.value.field == name
    with pytest.raises(InvalidInput, match="grows by itself") as refused:
        FeedbackLoop(P, C, disturbance=parse_transfer_function("1/(s-1)"))
    assert refused.value.field == "disturbance"
    with pytest.raises(IllPosedLoop):
        FeedbackLoop(parse_transfer_function("2"), PID(0.5), sensor=parse_transfer_function("-1"))
    # Behind a dead time it is no algebraic loop.
    FeedbackLoop(parse_transfer_function("2"), PID(0.5), sensor=parse_transfer_function("-exp(-s)"))
