"""Continuous PID: linear plants against the exact linear loop, the reactor against another integrator."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from control_loops import THIRD_ORDER, compiled, unit_step
from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
from looplab.engine.nonlinear.control_loop import ControlLoop, Instrument, Lag
from looplab.engine.nonlinear.control_loop.simulation import simulate_control
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.response import step
from looplab.engine.systems import parse_transfer_function
from models import CSTR

CONTROLLERS = {
    "P": PID(2.0),
    "PI": PID(1.5, 2.5),
    "PD": PID(3.0, None, 0.7),
    "PID": PID(3.0, 2.0, 0.5, 0.2),
    "PID, setpoint weight": PID(3.0, 2.0, 0.5, 0.1, beta=0.4),
}


def exact(plant: str, controller: PID, horizon: float, points: int = 101):
    return closed_loop_step(FeedbackLoop(parse_transfer_function(plant), controller), horizon, points)


@pytest.mark.parametrize("name", CONTROLLERS)
def test_a_linear_plant_is_the_exact_linear_loop(name):
    controller = CONTROLLERS[name]
    linear = exact("1/(s+1)^3", controller, 15.0)
    plant = compiled(THIRD_ORDER)
    loop = ControlLoop("y", "u", unit_step(), controller)
    found = simulate_control(plant, linear.t, [loop], rtol=1e-10)
    np.testing.assert_allclose(found.y[:, 0], linear.setpoint.y, atol=1e-8)
    np.testing.assert_allclose(found.loops[0].u, linear.setpoint.u, atol=1e-7)
    quiet = ControlLoop("y", "u", InputCourse(0.0), controller)
    found = simulate_control(plant, linear.t, [quiet], {"d": unit_step()}, rtol=1e-10)
    np.testing.assert_allclose(found.y[:, 0], linear.load.y, atol=1e-8)
    np.testing.assert_allclose(found.loops[0].u, linear.load.u, atol=1e-7)


def test_reverse_and_direct_action_are_each_others_mirror():
    t = np.linspace(0, 5, 21)
    up = simulate_control(compiled(THIRD_ORDER), t, [ControlLoop("y", "u", unit_step(), PID(-2.0, 1.0))])
    down = simulate_control(
        compiled(THIRD_ORDER), t, [ControlLoop("y", "u", unit_step(), PID(2.0, 1.0, action="direct"))]
    )
    assert np.array_equal(up.y, down.y)


def test_valve_and_sensor_are_lags_in_the_loop():
    """Valve 1/(0.5 s + 1), sensor 1/(0.09 s^2 + 0.36 s + 1): u sees both; y is the sensor's input."""
    controller = PID(1.5, 2.0, 0.3)
    sensor = "(0.3^2*s^2 + 2*0.6*0.3*s + 1)"
    linear = exact(f"1/((s+1)^3*(0.5*s+1)*{sensor})", controller, 20.0)
    loop = ControlLoop(
        "y", "u", unit_step(), controller, valve=Instrument(Lag(0.5)), sensor=Instrument(Lag(0.3, zeta=0.6))
    )
    found = simulate_control(compiled(THIRD_ORDER), linear.t, [loop], rtol=1e-10)
    np.testing.assert_allclose(found.loops[0].y_m, linear.setpoint.y, atol=1e-8)
    np.testing.assert_allclose(found.loops[0].u, linear.setpoint.u, atol=1e-7)
    # What enters the plant is behind the valve: it begins at rest.
    assert found.u[0, 0] == 0.0
    assert found.loops[0].u[0] > 1.0


@pytest.mark.parametrize("where", ["sensor", "valve"])
@pytest.mark.parametrize("name", ["PI", "PID"])
def test_dead_time_is_that_of_the_exact_delayed_loop(where, name):
    controller = CONTROLLERS[name]
    linear = exact("exp(-0.8*s)/(s+1)^3", controller, 16.0)
    loop = ControlLoop("y", "u", unit_step(), controller, **{where: Instrument(theta=0.8)})
    found = simulate_control(compiled(THIRD_ORDER), linear.t, [loop], rtol=1e-10)
    y = found.loops[0].y_m if where == "sensor" else found.y[:, 0]
    np.testing.assert_allclose(y, linear.setpoint.y, atol=2e-8)
    np.testing.assert_allclose(found.loops[0].u, linear.setpoint.u, atol=1e-7)
    assert found.loops[0].history_error is not None
    assert found.loops[0].history_error < 1e-8


def test_two_dead_times_that_are_no_multiples_add_up():
    controller = PID(1.0, 2.5)
    linear = exact("exp(-0.83*s)/(s+1)^3", controller, 12.0)
    loop = ControlLoop("y", "u", unit_step(), controller, valve=Instrument(theta=0.53), sensor=Instrument(theta=0.3))
    found = simulate_control(compiled(THIRD_ORDER), linear.t, [loop], rtol=1e-9)
    np.testing.assert_allclose(found.loops[0].u, linear.setpoint.u, atol=1e-7)


def reactor(_, x, setpoint=390.0):
    """The reactor and its PI controller by hand: Q = 2e6 - Kc (e + 1/tau_I int e), direct action."""
    cA, T, integral = x
    r = 7.2e10 * math.exp(-1e4 / T) * cA
    e = setpoint - T
    Q = min(max(2e6 - 1e6 * (e + integral / 0.5), 0.0), 4e6)
    return [1 - cA - r, 350 - T + 200 * r - Q / 1e5, e]


def test_the_reactor_is_held_where_it_is_unstable():
    t = np.linspace(0, 8, 81)
    loop = ControlLoop("T", "Q", InputCourse(390.0), PID(1e6, 0.5, action="direct"), u_min=0.0, u_max=4e6)
    found = simulate_control(compiled(CSTR), t, [loop], initial={"cA": 0.72, "T": 386.0}, rtol=1e-11)
    assert 0 < found.loops[0].metrics.saturated_pct < 50
    # A corner at a limit is an end of a step for neither: both are as good as their tolerance.
    by_hand = solve_ivp(reactor, (0, 8), [0.72, 386.0, 0.0], "DOP853", t, rtol=1e-12, atol=1e-12, max_step=0.002)
    np.testing.assert_allclose(found.x, by_hand.y[:2].T, rtol=1e-8)
    assert found.y[-1, 1] == pytest.approx(390.0, abs=1e-3)


def test_three_loops_at_once_are_three_loops():
    """Three plants side by side in one model do what each does alone."""
    names = ("a", "b", "c")
    document = {
        "id": "three", "title": "Three tanks",
        "inputs": [{"name": f"u{n}", "value": 0} for n in names],
        "states": [{"name": n, "initial": 0, "equation": f"-{n} + u{n}"} for n in names],
    }  # fmt: skip
    controllers = (PID(2.0, 1.0), PID(5.0), PID(1.0, 0.5, 0.2))
    loops = [ControlLoop(n, f"u{n}", unit_step(), c) for n, c in zip(names, controllers, strict=True)]
    found = simulate_control(compiled(document), np.linspace(0, 6, 61), loops, rtol=1e-10)
    for index, controller in enumerate(controllers):
        linear = exact("1/(s+1)", controller, 6.0, 61)
        np.testing.assert_allclose(found.y[:, index], linear.setpoint.y, atol=1e-8)


def test_the_derivative_may_leave_the_setpoint_alone():
    """gamma = 0: no kick; u jumps by Kc alone."""
    t = np.linspace(0, 1, 11)
    controller = PID(2.0, 3.0, 0.5)
    kick, none = (
        simulate_control(compiled(THIRD_ORDER), t, [ControlLoop("y", "u", unit_step(), controller, gamma=g)])
        for g in (1.0, 0.0)
    )
    assert kick.loops[0].u[0] == pytest.approx(2.0 + 2.0 / 0.1)
    assert none.loops[0].u[0] == pytest.approx(2.0)


def test_metrics_are_integrals_of_the_error():
    """P control of 1/(s+1): e = 1/3 + 2/3 exp(-3 t) for Kc = 2."""
    plant = compiled({"id": "p", "title": "P", "inputs": [{"name": "u", "value": 0}],
                      "states": [{"name": "x", "initial": 0, "equation": "-x + u"}]})  # fmt: skip
    t = np.linspace(0, 4, 801)
    m = simulate_control(plant, t, [ControlLoop("x", "u", unit_step(), PID(2.0))], rtol=1e-10).loops[0].metrics
    q = math.exp(-12)
    assert m.IAE == pytest.approx(4 / 3 + 2 / 9 * (1 - q), rel=1e-6)
    assert m.ISE == pytest.approx(4 / 9 + 4 / 27 * (1 - q) + 2 / 27 * (1 - q * q), rel=1e-6)
    assert m.TV == pytest.approx(2.0 - (2 / 3 + 4 / 3 * q), rel=1e-6)
    assert m.overshoot_pct is None
    assert "2 %" in m.reasons["overshoot_pct"]


def test_step_metrics_where_there_is_one_step():
    """A second-order answer from 300 to 310 at t = 2: overshoot exp(-pi zeta/sqrt(1 - zeta^2))."""
    zeta = 0.5
    plant = compiled(
        {"id": "p", "title": "P", "inputs": [{"name": "u", "value": 0}],
         "states": [{"name": "v", "initial": 0, "equation": f"u - {2 * zeta}*v"},
                    {"name": "x", "initial": 300, "equation": "v"}]}
    )  # fmt: skip
    loop = ControlLoop("x", "u", InputCourse(300.0).plus(step(10.0, 2.0)), PID(1.0))
    m = simulate_control(plant, np.linspace(0, 22, 1101), [loop], rtol=1e-9).loops[0].metrics
    assert m.overshoot_pct == pytest.approx(100 * math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), abs=1e-3)
    assert m.t_settle is not None


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"output": "z"}, "loops[0].output"),
        ({"input": "z"}, "loops[0].input"),
        ({"u_min": 2.0, "u_max": 1.0}, "loops[0].u_max"),
    ],
)
def test_what_is_wrong_has_its_place(change, field):
    loop = ControlLoop(**{"output": "y", "input": "u", "setpoint": unit_step(), "controller": PID(1.0), **change})
    with pytest.raises(InvalidInput) as error:
        simulate_control(compiled(THIRD_ORDER), [0, 1], [loop])
    assert error.value.field == field


def test_two_loops_may_not_move_one_input():
    loop = ControlLoop("y", "u", unit_step(), PID(1.0))
    with pytest.raises(InvalidInput, match="moved by") as error:
        simulate_control(compiled(THIRD_ORDER), [0, 1], [loop, loop])
    assert error.value.field == "loops[1].input"
