"""Loops that cannot go on: a cut with its reason, or a clear error, soon."""

import time

import numpy as np
import pytest

from control_loops import THIRD_ORDER, compiled, unit_step
from looplab.engine.errors import EngineError, IllPosedLoop, InvalidInput, NonFinite
from looplab.engine.loop import PID
from looplab.engine.nonlinear.control_loop import ControlLoop, Instrument, Lag, MeasurementNoise
from looplab.engine.nonlinear.control_loop.simulation import simulate_control
from looplab.engine.nonlinear.inputs import InputCourse
from models import CSTR, model, parameters

# y = x + 0.5 u: what u does is seen at once.
FEEDTHROUGH = model("-x + u", 0.0, inputs=parameters(u=0.0), outputs=[{"name": "y", "expression": "x + 0.5*u"}])


def go(document, horizon=20.0, points=201, output="y", **more):
    fields = {"output": output, "input": "u", "setpoint": unit_step(), "controller": PID(2.0, 1.0), **more}
    return simulate_control(compiled(document), np.linspace(0, horizon, points), [ControlLoop(**fields)])


@pytest.mark.parametrize(
    "more",
    [
        {"controller": PID(1e9, 1.0)},
        {"controller": PID(1e9, 1e-3), "sampling_time": 0.1},
        {"controller": PID(1e9, 1e-3), "sampling_time": 0.1, "u_min": -1.0, "u_max": 1.0},
        {"controller": PID(1e9, 1e-3, 1.0), "u_min": -1.0, "u_max": 1.0, "anti_windup": "clamping"},
        {"controller": PID(1e12, 1e-6, 1e3), "u_min": -1.0, "u_max": 1.0, "anti_windup": "back_calculation"},
        {"controller": PID(1e9, 1.0), "sensor": Instrument(theta=0.3)},
        {"controller": PID(50.0, 0.1), "valve": Instrument(theta=0.01), "u_min": -1.0, "u_max": 1.0},
        {"controller": PID(1e9, 1e-3), "valve": Instrument(Lag(1e-6, zeta=0.0))},
        {"controller": PID(5.0, 1e-9), "noise": MeasurementNoise(1e6, 0.02)},
    ],
)
def test_it_ends(more):
    spent = time.process_time()
    found = go(THIRD_ORDER, **more)
    assert time.process_time() - spent < 6.0
    assert np.isfinite(found.x).all()
    assert np.isfinite(found.loops[0].u).all()
    assert (found.truncated_at is None) == (found.t[-1] == 20.0)
    if found.truncated_at is not None:
        assert found.truncated_reason
        assert found.t[-1] == found.truncated_at


def test_an_unstable_loop_is_cut_where_it_runs_away():
    for h in (None, 0.1):
        found = go(THIRD_ORDER, horizon=400.0, controller=PID(100.0, 1.0), sampling_time=h)
        assert found.truncated_reason is not None
        assert "runs away" in found.truncated_reason
        assert found.loops[0].metrics.t_settle is None


def test_an_algebraic_loop_is_refused():
    with pytest.raises(IllPosedLoop, match="algebraic") as error:
        go(FEEDTHROUGH)
    assert error.value.field == "loops[0]"
    assert error.value.hint is not None
    for way_out in ({"sampling_time": 0.1}, {"valve": Instrument(Lag(0.01))}, {"sensor": Instrument(theta=0.1)}):
        assert go(FEEDTHROUGH, controller=PID(0.5, 1.0), **way_out).truncated_at is None


def test_an_algebraic_loop_through_two_controllers_is_refused():
    document = {
        "id": "crossed", "title": "Crossed", "inputs": parameters(u=0, v=0),
        "states": [{"name": "x", "initial": 0, "equation": "-x + u + v"}],
        "outputs": [{"name": "y", "expression": "x + v"}, {"name": "z", "expression": "x + u"}],
    }  # fmt: skip
    loops = [ControlLoop(y, u, unit_step(), PID(1.0)) for y, u in (("y", "u"), ("z", "v"))]
    with pytest.raises(IllPosedLoop):
        simulate_control(compiled(document), [0, 1, 2], loops)
    # Alone each of them is in order.
    assert simulate_control(compiled(document), [0, 1, 2], loops[:1]).truncated_at is None


def test_an_equation_that_ends_under_control_is_a_cut():
    found = go(model("u - sqrt(x)", 1.0, inputs=parameters(u=1.0)), output="x", setpoint=InputCourse(-1.0))
    assert found.truncated_reason is not None
    assert "sqrt" in found.truncated_reason
    with pytest.raises(NonFinite):
        go(model("u + log(x)", -1.0, inputs=parameters(u=1.0)), output="x")


def test_events_and_bounds_hold_under_control():
    document = {
        **model("u", 0.0, inputs=parameters(u=0.0)),
        "events": [
            {"name": "half", "when": "x > 0.5"},
            {"name": "full", "when": "x >= 0.9", "action": "stop", "message": "it is full"},
        ],
    }
    for h in (None, 0.1):
        found = go(document, output="x", controller=PID(1.0), sampling_time=h)
        assert [event.name for event in found.events] == ["half", "full"]
        assert len(found.events[0].x) == 1
        assert found.truncated_reason == "it is full"
        # x = 1 - exp(-t), or from sample to sample 1 - 0.9^k
        expected = np.log(10) if h is None else 2.1 + 0.1 * (0.9 - (1 - 0.9**21)) / (0.1 * 0.9**21)
        assert found.truncated_at == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("more", "field"),
    [
        ({"sampling_time": 1e-6}, "loops[0].sampling_time"),
        ({"sensor": Instrument(theta=1e-6)}, "loops[0].sensor.theta"),
        ({"sampling_time": 0.01, "noise": MeasurementNoise(1.0, 1e-7)}, "loops[0].noise.interval"),
    ],
)
def test_too_much_work_is_refused_at_once(more, field):
    with pytest.raises(InvalidInput) as error:
        go(THIRD_ORDER, **more)
    assert error.value.field == field


@pytest.mark.parametrize(
    ("more", "field"),
    [
        ({"controller": PID(1.0, 1.0, form="series")}, "controller.form"),
        ({"controller": PID(1e13)}, "controller.Kc"),
        ({"anti_windup": "hope"}, "anti_windup"),
        ({"T_t": 0.0}, "T_t"),
        ({"sampling_time": float("nan")}, "sampling_time"),
        ({"sampling_time": 0.1, "discretization": "exact"}, "discretization"),
    ],
)
def test_settings_out_of_range_are_named(more, field):
    with pytest.raises(EngineError) as error:
        go(THIRD_ORDER, **more)
    assert error.value.field == field


def test_the_budget_cuts():
    loop = ControlLoop("T", "Q", InputCourse(390.0), PID(1e6, 0.5, action="direct"), sampling_time=0.02)
    found = simulate_control(compiled(CSTR), np.linspace(0, 10, 11), [loop], budget=500)
    assert found.truncated_reason is not None
    assert "500" in found.truncated_reason
    assert found.calls <= 501
