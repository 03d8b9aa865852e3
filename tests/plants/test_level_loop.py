"""The level loop against its linear closed loop, and its controller's action."""

import numpy as np
import pytest

from looplab.engine.nonlinear.simulation import InputCourse, simulate_open_loop
from looplab.engine.response import step
from looplab.plants import load_plant

LAG = {"valve": [0.05**2, 2 * 0.7 * 0.05, 1.0], "sensor": [0.1**2, 2 * 0.8 * 0.1, 1.0]}
KC, TAU_I = 1.5, 3.0


def closed_loop(action):
    """Notes 14.3 with the outlet's sign: denominator of h(s), its numerators for inflow and setpoint."""
    lags = np.polymul(LAG["valve"], LAG["sensor"])
    integral = [TAU_I, 0.0]
    controller = action * KC * np.array([TAU_I, 1.0])
    den = np.polyadd(np.polymul([1.0, 0.0], np.polymul(lags, integral)), controller)
    return den, np.polymul(lags, integral), np.polymul(controller, LAG["sensor"])


def step_response(num, den, t):
    """Residues of num/(s den)."""
    poles = np.roots(den)
    residues = np.polyval(num, poles) / (poles * np.polyval(np.polyder(den), poles))
    return num[-1] / den[-1] + np.real(np.exp(np.outer(t, poles)) @ residues)


@pytest.mark.parametrize("action", [1.0, -1.0])
def test_the_linear_closed_loop(action):
    """Steps that keep the output of the controller off its ends are answered exactly as by residues."""
    t = np.linspace(0, 20 if action > 0 else 2, 101)
    model, inputs = load_plant("level-loop"), {"Fi": 0.54, "h_sp": 1.02}
    rest = dict(zip(model.state_names, model.x0, strict=True))
    run = simulate_open_loop(model, t, inputs, {"action": action}, rest, rtol=1e-11, atol=1e-12)
    den, load, setpoint = closed_loop(action)
    h = 1 + 0.04 * step_response(load, den, t) + 0.02 * step_response(setpoint, den, t)
    assert run.y[:, 2].min() > 0.01 and run.y[:, 2].max() < 0.99
    assert run.x[:, 0] == pytest.approx(h, abs=1e-9)


@pytest.mark.parametrize("action", [1.0, -1.0])
def test_poles(action):
    model = load_plant("level-loop")
    A = model.state_jacobian(0.0, model.x0, model.u0, model.parameters({"action": action}))
    poles = np.sort_complex(np.linalg.eigvals(A))
    assert poles == pytest.approx(np.sort_complex(np.roots(closed_loop(action)[0])), abs=1e-9)
    assert (poles.real.max() < 0) == (action > 0)


@pytest.mark.parametrize(("inflow", "end"), [(0.6, "the tank overflows"), (0.4, "the tank is empty")])
def test_a_valve_on_the_outlet_needs_direct_action(inflow, end):
    model, t = load_plant("level-loop"), np.linspace(0, 40, 201)
    courses = {"Fi": InputCourse(0.5).plus(step(inflow - 0.5, 1.0))}
    right = simulate_open_loop(model, t, courses)
    assert right.truncated_at is None
    assert right.x[-1, :2] == pytest.approx([1.0, inflow], abs=1e-6)
    wrong = simulate_open_loop(model, t, courses, {"action": -1.0})
    assert wrong.truncated_reason == end


def test_the_integral_waits_while_the_output_is_at_its_end():
    """More inflow than the open valve lets out for a while: the level is soon back."""
    courses = {"Fi": InputCourse(0.5).plus(step(0.6, 1.0), step(-0.6, 6.0))}
    t = np.linspace(0, 30, 301)
    kept = simulate_open_loop(load_plant("level-loop"), t, courses)
    assert kept.y[:, 2].max() == 1.0
    wound = simulate_open_loop(load_plant("level-loop"), t, courses, {"tau_t": 1000})
    assert kept.x[t > 6, 0].min() > wound.x[t > 6, 0].min() + 0.05
