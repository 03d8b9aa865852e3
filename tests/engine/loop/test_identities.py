"""Identities that hold for every loop: superposition, time shift, sensitivities, final values, static balance."""

import numpy as np
import pytest
from hypothesis import assume, given

from looplab.engine.frequency import nyquist_count
from looplab.engine.loop import PID, ClosedLoopStep, FeedbackLoop, closed_loop_step, step_response
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import controllers, effort, systems

plants = systems(order=(1, 4), excess=1) | systems(order=(1, 3), excess=1, theta=True)


def simulate(P: TransferFunction, C: PID | TransferFunction, horizon: float = 10.0) -> ClosedLoopStep:
    return closed_loop_step(FeedbackLoop(plant=P, controller=C), horizon=horizon, points=101)


@effort(60)
@given(plants, controllers())
def test_control_of_a_load_is_minus_the_setpoint_response(P: TransferFunction, C: PID) -> None:
    """Both transfer functions are PC/(1+PC): u_d(t) = -y_r(t)."""
    r = simulate(P, C)
    n = min(r.setpoint.y.size, r.load.u.size)
    size = np.maximum(1.0, np.maximum.accumulate(np.abs(r.setpoint.y[:n])))
    assert (np.abs(r.load.u[:n] + r.setpoint.y[:n]) / size).max() <= 1e-9


@effort(60)
@given(plants, controllers())
def test_u_is_the_controller_applied_to_the_error(P: TransferFunction, C: PID) -> None:
    """For a P controller u = Kc (1 - y) at each instant; a load leaves u = -Kc y."""
    only_P = PID(C.Kc)
    r = simulate(P, only_P)
    np.testing.assert_allclose(r.setpoint.u, C.Kc * (1 - r.setpoint.y), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(r.load.u, -C.Kc * r.load.y, rtol=1e-12, atol=1e-12)


@effort(40)
@given(plants, controllers())
def test_time_shift(P: TransferFunction, C: PID) -> None:
    """A load reaches y one dead time late, then through the loop: nothing before theta, the open step up to 2 theta."""
    assume(P.theta > 0.3)
    r = simulate(P, C)
    for response in (r.load, r.setpoint):
        early = response.t < P.theta * (1 - 1e-9)
        late = response.t < 2 * P.theta * (1 - 1e-9)
        size = max(1.0, np.abs(response.y[late]).max(), np.abs(response.u[late]).max())
        assert np.abs(response.y[early]).max() <= 1e-12 * size
    once = r.load.t < 2 * P.theta * (1 - 1e-9)
    n = min(int(once.sum()), r.load.y.size)
    h = r.t[1]
    late = round(P.theta / h)
    assume(n > late + 2)
    open_loop = step_response(P.without_dead_time(), horizon=h * 400, points=401)
    size = max(1.0, np.abs(open_loop.y[: n - late]).max())
    np.testing.assert_allclose(r.load.y[late:n], open_loop.y[: n - late], rtol=0, atol=1e-10 * size)


@effort(30)
@given(systems(order=(1, 4)), controllers())
def test_a_dead_time_beyond_the_horizon_leaves_the_controller_alone(P: TransferFunction, C: PID) -> None:
    """y stays zero and u is the controller's own step response."""
    late = TransferFunction(P.zeros, P.poles, P.gain, 11.0)
    r = simulate(late, C)
    assert np.abs(r.setpoint.y).max() == pytest.approx(0.0, abs=1e-11)
    own = step_response(C.to_transfer_function(), horizon=float(r.t[-1]), points=r.t.size)
    np.testing.assert_allclose(r.setpoint.u, own.y, rtol=1e-10, atol=1e-10)


@effort(30)
@given(systems(order=(1, 3)))
def test_small_gain_is_the_open_loop(P: TransferFunction) -> None:
    """To first order in Kc: y_r = Kc (open step), y_d = open step; the difference shrinks like Kc."""
    k = 1e-6
    open_loop = step_response(P, horizon=10.0, points=101)
    r = simulate(P, PID(k))
    scale = max(1.0, np.abs(open_loop.y).max())
    assert np.abs(r.load.y - open_loop.y).max() <= 30 * k * scale**2
    assert np.abs(r.setpoint.y / k - open_loop.y).max() <= 30 * k * scale**2


@effort(40)
@given(systems(order=(1, 3)), controllers())
def test_no_gain_means_no_control(P: TransferFunction, C: PID) -> None:
    r = simulate(P, PID(0.0, C.tau_I, C.tau_D, C.alpha))
    assert not np.abs(r.setpoint.y).any()
    assert not np.abs(r.setpoint.u).any()
    open_loop = step_response(P, horizon=10.0, points=101)
    np.testing.assert_allclose(r.load.y, open_loop.y, rtol=1e-9, atol=1e-10)


@effort(60)
@given(plants, controllers())
def test_final_value(P: TransferFunction, C: PID) -> None:
    loop = FeedbackLoop(P, C)
    assume(nyquist_count(loop.open_loop).Z == 0)
    assume(abs(1 + P.dc_gain * C.Kc) > 0.05)
    slow = closed_loop_step(loop, horizon=400.0, points=201)
    tail = slow.setpoint.y[-20:]
    assume(np.ptp(tail) < 1e-7)
    expected = 1.0 if C.tau_I is not None else C.Kc * P.dc_gain / (1 + C.Kc * P.dc_gain)
    assume(P.dc_gain != 0)
    assert tail[-1] == pytest.approx(expected, abs=1e-6)
    assert slow.setpoint.final_y == pytest.approx(expected, abs=1e-9)
    load = 0.0 if C.tau_I is not None else P.dc_gain / (1 + C.Kc * P.dc_gain)
    assert slow.load.y[-1] == pytest.approx(load, abs=1e-6)
    assert slow.load.final_y == pytest.approx(load, abs=1e-9)


@effort(40)
@given(systems(order=(1, 4), theta=True) | systems(order=(1, 4)), controllers())
def test_sensitivities_add_to_one(P: TransferFunction, C: PID) -> None:
    loop = FeedbackLoop(P, C)
    omega = np.logspace(-2, 2, 50)
    L = loop.open_loop.response(omega)
    np.testing.assert_allclose(L, P.response(omega) * loop.C.response(omega), rtol=1e-12)
    np.testing.assert_allclose(1 / (1 + L) + L / (1 + L), 1.0, rtol=1e-9)


def test_a_setpoint_weight_is_a_load_of_its_own() -> None:
    """u = C e + F r: the response is the one of beta = 1 plus F times the load response; F itself adds to u."""
    P = parse_transfer_function("exp(-0.4 s)/((s + 1)(0.5 s + 1))")
    C = PID(1.5, 1.2, 0.3)
    whole, weighted = simulate(P, C), simulate(P, PID(1.5, 1.2, 0.3, beta=0.4))
    F = 1.5 * (0.4 - 1)
    np.testing.assert_allclose(weighted.setpoint.y, whole.setpoint.y + F * whole.load.y, rtol=0, atol=1e-12)
    np.testing.assert_allclose(weighted.setpoint.u, whole.setpoint.u + F * (1 + whole.load.u), rtol=0, atol=1e-12)
    np.testing.assert_allclose(weighted.load.y, whole.load.y, rtol=0, atol=1e-13)


def test_a_direct_controller_is_a_negative_gain() -> None:
    P = parse_transfer_function("-2 exp(-0.4 s)/(3 s + 1)")
    a, b = simulate(P, PID(0.8, 3.0, action="direct")), simulate(P, PID(-0.8, 3.0))
    np.testing.assert_array_equal(a.setpoint.y, b.setpoint.y)


def test_a_typed_controller_equals_the_pid() -> None:
    P = parse_transfer_function("exp(-0.4 s)/(3 s + 1)")
    pid = PID(1.2, 2.0, 0.5, 0.2)
    typed = parse_transfer_function("1.2*(1 + 1/(2 s) + 0.5 s/(0.1 s + 1))")
    a, b = simulate(P, pid), simulate(P, typed)
    np.testing.assert_allclose(a.setpoint.y, b.setpoint.y, rtol=0, atol=1e-12)
    np.testing.assert_allclose(a.setpoint.u, b.setpoint.u, rtol=0, atol=1e-11)


@effort(30)
@given(plants, controllers())
def test_slopes_are_those_of_the_curves(P: TransferFunction, C: PID) -> None:
    """dy/dt against a chord of a finer grid, away from kinks."""
    loop = FeedbackLoop(P, C)
    r = closed_loop_step(loop, horizon=2.0, points=2001)
    y, dy, t = r.setpoint.y, r.setpoint.dy, r.setpoint.t
    assume(y.size > 100)
    chord = (y[2:] - y[:-2]) / (t[2:] - t[:-2])
    bend = np.abs(np.diff(dy))
    smooth = (bend[1:] < 0.02 * (1 + np.abs(dy).max())) & (bend[:-1] < 0.02 * (1 + np.abs(dy).max()))
    assert (np.abs(chord - dy[1:-1])[smooth] <= 0.02 * (1 + np.abs(dy).max())).all()
