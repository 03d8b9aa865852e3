"""Saturation, windup and what is done about it, manual and auto: each by its definition."""

import math
from itertools import pairwise

import numpy as np
import pytest

from control_loops import FIRST_ORDER, THIRD_ORDER, compiled, unit_step
from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID
from looplab.engine.nonlinear.control_loop import ControlLoop, Instrument, Lag, ModeChange
from looplab.engine.nonlinear.control_loop.simulation import simulate_control
from looplab.engine.nonlinear.inputs import InputCourse, table
from looplab.engine.response import step

SAMPLED = [None, 0.05]


def run(horizon=20.0, plant=FIRST_ORDER, points=401, **more):
    fields = {"output": "y", "input": "u", "setpoint": unit_step(), "controller": PID(2.0, 1.0), **more}
    return simulate_control(compiled(plant), np.linspace(0, horizon, points), [ControlLoop(**fields)], rtol=1e-10)


def integral(found, Kc):
    """What of a PI controller's output is not proportional."""
    loop = found.loops[0]
    return loop.u_command - Kc * (loop.r - loop.y_m)


@pytest.mark.parametrize("h", SAMPLED)
def test_u_is_the_command_between_its_limits(h):
    loop = run(u_min=-0.2, u_max=1.3, sampling_time=h).loops[0]
    np.testing.assert_array_equal(loop.u, np.clip(loop.u_command, -0.2, 1.3))
    assert loop.u_command.max() > 1.3


@pytest.mark.parametrize("h", SAMPLED)
def test_windup_goes_on_as_long_as_the_error(h):
    """u is not enough: y settles at 0.5, and the integral grows by Kc/tau_I e for ever."""
    found = run(u_max=0.5, sampling_time=h)
    slope = np.diff(integral(found, 2.0)[-101:]) / 0.05
    np.testing.assert_allclose(slope, 2.0 * 0.5, rtol=1e-6)
    assert found.loops[0].metrics.saturated_pct > 95


@pytest.mark.parametrize("h", SAMPLED)
@pytest.mark.parametrize("T_t", [0.4, None])
def test_back_calculation_settles_where_both_pulls_are_equal(h, T_t):
    """Kc e/tau_I = (v - u)/T_t, T_t = tau_I where it is not given."""
    loop = run(u_max=0.5, sampling_time=h, anti_windup="back_calculation", T_t=T_t).loops[0]
    assert loop.u_command[-1] - loop.u[-1] == pytest.approx((T_t or 1.0) * 2.0 * 0.5, rel=1e-6)


@pytest.mark.parametrize("h", SAMPLED)
def test_clamping_holds_the_integral_while_it_would_wind_up(h):
    found = run(u_max=0.5, sampling_time=h, anti_windup="clamping")
    loop, held = found.loops[0], integral(found, 2.0)
    stuck = (loop.u_command > 0.5) & (loop.r > loop.y_m)
    assert stuck.mean() > 0.9
    pairs = stuck[1:] & stuck[:-1]
    # A sampled controller at a limit: the samples between two times of the answer are all at it too.
    np.testing.assert_allclose(np.diff(held)[pairs], 0.0, atol=1e-9)


@pytest.mark.parametrize("h", SAMPLED)
def test_clamping_lets_the_integral_go_back(h):
    """The setpoint falls below y while u is at its upper limit by the integral: that may shrink."""
    setpoint = InputCourse(0.0).plus(step(1.0), step(-0.9, 6.0))
    found = run(horizon=12.0, setpoint=setpoint, u_max=0.5, sampling_time=h, anti_windup="clamping", points=241)
    assert abs(found.y[-1, 0] - 0.1) < 1e-2
    wound = run(horizon=12.0, setpoint=setpoint, u_max=0.5, sampling_time=h, points=241)
    assert wound.loops[0].metrics.IAE > 1.3 * found.loops[0].metrics.IAE


@pytest.mark.parametrize("method", ["none", "back_calculation", "clamping"])
def test_without_saturation_there_is_nothing_to_do(method):
    """Far limits leave the loop what it is; the first-order loop with Kc = tau_I = 1 is 1 - exp(-t)."""
    for h in SAMPLED:
        found = run(controller=PID(1.0, 1.0), u_min=-50.0, u_max=50.0, anti_windup=method, sampling_time=h)
        if h is None:
            np.testing.assert_allclose(found.y[:, 0], 1 - np.exp(-found.t), atol=1e-8)
        free = run(controller=PID(1.0, 1.0), sampling_time=h)
        np.testing.assert_allclose(found.y, free.y, atol=1e-8)


def test_the_limits_are_the_range_of_the_input():
    document = {**FIRST_ORDER, "inputs": [{"name": "u", "value": 0.0, "min": -1.0, "max": 0.7}]}
    loop = run(plant=document).loops[0]
    assert loop.u.max() == 0.7
    with pytest.raises(InvalidInput) as error:
        run(plant=document, u_max=0.9)
    assert error.value.field == "loops[0].u_max"


@pytest.mark.parametrize("h", SAMPLED)
@pytest.mark.parametrize("controller", [PID(2.0), PID(2.0, 1.0), PID(2.0, 1.0, 0.3), PID(2.0, 1.0, 0.3, beta=0.3)])
def test_u_does_not_jump_from_manual_to_auto(h, controller):
    """Manual at 0.6 until t = 3, far from the setpoint; u goes on from there, to the setpoint with an integral."""
    modes = (ModeChange(0.0, "manual", 0.6), ModeChange(3.0, "auto"))
    found = run(setpoint=InputCourse(1.0), controller=controller, modes=modes, sampling_time=h, horizon=12.0)
    loop = found.loops[0]
    before, after = found.t < 3.0 - 1e-9, found.t >= 3.0 - 1e-9
    assert (loop.u[before] == 0.6).all()
    assert not loop.auto[before].any()
    assert loop.auto[after].all()
    assert loop.u[after][0] == pytest.approx(0.6, abs=1e-12)
    if controller.tau_I:
        assert found.y[-1, 0] == pytest.approx(1.0, abs=1e-3)
    else:
        # A P controller that took over holds y there: u = 0.6 + Kc (y(3) - y) = y at rest.
        assert found.y[-1, 0] == pytest.approx((0.6 + 2.0 * 0.6 * (1 - math.exp(-3.0))) / 3.0, rel=1e-6)


@pytest.mark.parametrize("h", SAMPLED)
def test_manual_without_a_value_keeps_u(h):
    modes = (ModeChange(1.0, "manual"), ModeChange(4.0, "manual", 0.2), ModeChange(6.0, "auto"))
    found = run(modes=modes, sampling_time=h, horizon=10.0, points=1001)
    loop = found.loops[0]
    kept = loop.u[(found.t >= 1.0) & (found.t < 4.0)]
    before = loop.u[found.t < 1.0 - 1e-9][-1]
    assert (kept == kept[0]).all()
    # Continuous u moves by its slope in 0.01; a sampled u stays what its last sample was.
    assert kept[0] == pytest.approx(before, abs=0.0 if h else 0.05)
    assert (loop.u[(found.t >= 4.0) & (found.t < 6.0 - 1e-9)] == 0.2).all()
    assert loop.u[found.t >= 6.0 - 1e-9][0] == pytest.approx(0.2, abs=1e-12)


def test_a_saturated_transfer_takes_over_from_what_the_valve_gets():
    """Manual beyond the limit: u is the limit, and auto goes on from the limit."""
    modes = (ModeChange(0.0, "manual", 5.0), ModeChange(2.0, "auto"))
    loop = run(modes=modes, u_max=0.8, setpoint=InputCourse(0.5)).loops[0]
    assert loop.u_command[0] == 5.0
    assert loop.u[0] == 0.8
    assert loop.u_command[40] == pytest.approx(0.8, abs=1e-12)


def test_the_loop_begins_where_its_input_is():
    """With an error of zero nothing moves; the bias is the number given for the input."""
    plant, loop = compiled(FIRST_ORDER), ControlLoop("y", "u", InputCourse(0.4), PID(3.0, 1.0, 0.2, beta=0.1))
    found = simulate_control(plant, np.linspace(0, 5, 11), [loop], {"u": 0.4}, initial={"x": 0.4})
    np.testing.assert_allclose(found.y[:, 0], 0.4, rtol=1e-12)
    np.testing.assert_allclose(found.u[:, 0], 0.4, rtol=1e-12)


def test_a_slow_valve_moves_no_faster_than_it_can():
    found = run(controller=PID(5.0), valve=Instrument(Lag(0.05, rate=0.5)), points=801, horizon=8.0)
    slope = np.diff(found.u[:, 0]) / np.diff(found.t)
    assert np.abs(slope).max() <= 0.5 * (1 + 1e-6)
    np.testing.assert_allclose(slope[:30], 0.5, rtol=1e-6)
    assert found.y[-1, 0] == pytest.approx(5 / 6, abs=1e-4)


def test_a_setpoint_may_be_a_table():
    found = run(controller=PID(20.0, 0.5), setpoint=table([0, 2, 4], [1.0, 0.2, 0.7]), horizon=6.0, points=61)
    for (a, b), level in zip(pairwise((0, 2, 4, 6)), (1.0, 0.2, 0.7), strict=True):
        assert found.y[(found.t < b - 1e-9) & (found.t > a)][-1, 0] == pytest.approx(level, abs=2e-2)
    assert found.loops[0].r[20] == pytest.approx(0.2, rel=1e-15)


def test_a_mode_change_in_a_loop_with_dead_time():
    modes = (ModeChange(0.0, "manual", 0.3), ModeChange(5.0, "auto"))
    found = run(
        plant=THIRD_ORDER, controller=PID(1.0, 2.0), modes=modes, valve=Instrument(theta=0.7), horizon=30.0,
        setpoint=InputCourse(1.0), points=301,
    )  # fmt: skip
    # The manual value reaches the plant after the dead time.
    assert (found.u[found.t < 0.7 - 1e-9, 0] == 0.0).all()
    assert found.u[found.t > 0.7][0, 0] == pytest.approx(0.3, abs=1e-12)
    assert found.loops[0].u[50] == pytest.approx(0.3, abs=1e-12)
    assert found.y[-1, 0] == pytest.approx(1.0, abs=1e-2)
