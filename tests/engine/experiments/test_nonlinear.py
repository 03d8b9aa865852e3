"""Experiments on nonlinear plants: with small swings they are those on the linear model at the same point."""

import numpy as np
import pytest

from looplab.engine.experiments.linear_relay import linear_relay
from looplab.engine.experiments.nonlinear import (
    Point,
    nonlinear_relay,
    nonlinear_ring,
    nonlinear_ultimate_cycle,
    rest_point,
)
from looplab.engine.experiments.oscillation import oscillation
from looplab.engine.experiments.relay import Relay
from looplab.engine.nonlinear.control_loop import Instrument, Lag
from looplab.engine.nonlinear.steady_states.linearize import linearize
from looplab.engine.systems import SOPDT, TransferFunction
from looplab.engine.tuning import ultimate_point
from looplab.plants import load_plant

# Plant, input, output and the lag of the sensor.
PLANTS = {
    "five tanks in a row": ("tanks-in-series", "c_0", "c_5", None),
    "two tanks": ("two-tanks", "Fi", "h2", Lag(0.3)),
    "two tanks that interact": ("two-tanks-interacting", "Fi", "h2", Lag(1.9)),
    "a stirred reactor": ("cstr", "Q", "T", Lag(0.3, 0.7)),
}


def at_rest(plant: str, input: str, output: str) -> tuple[Point, TransferFunction]:
    """A plant at rest by its own inputs, and its linear model there."""
    model = load_plant(plant)
    u, p = model.inputs({}), model.parameters({})
    state = dict(zip(model.state_names, model.initial_state(u, p), strict=True))
    point = rest_point(model, input, output, dict(zip(model.input_names, u, strict=True)), {}, state)
    assert point.at_rest
    linear = linearize(model, tuple(point.initial.values()), tuple(u), tuple(p))
    return point, linear.transfer_function(model.output_names.index(output), model.input_names.index(input))


def with_sensor(plant: TransferFunction, lag: Lag | None) -> TransferFunction:
    if lag is None:
        return plant
    if lag.zeta is None:
        return plant * TransferFunction((), (-1 / lag.tau,), 1 / lag.tau)
    return plant * SOPDT(1.0, lag.tau, lag.zeta, 0.0).to_transfer_function()


@pytest.mark.parametrize("name", PLANTS)
def test_the_ultimate_gain_of_a_nonlinear_plant_is_that_of_its_linear_model(name):
    plant, input, output, lag = PLANTS[name]
    point, P = at_rest(plant, input, output)
    exact = ultimate_point(with_sensor(P, lag))
    bump = 1e-3 * max(abs(point.y0), 1.0)
    found, ringing = nonlinear_ultimate_cycle(point, 0.1 / P.dc_gain, bump, 20 * exact.Pu, Instrument(lag))
    assert found.Ku == pytest.approx(exact.Ku, rel=0.01)
    assert found.Pu == pytest.approx(exact.Pu, rel=0.01)
    assert ringing.oscillation.decay_ratio == pytest.approx(1.0, abs=0.02)


def test_what_a_settled_run_leaves_of_the_solver_is_no_oscillation():
    """u = 0.1 (r - y) on two tanks rings not at all: the swings at its end are errors of the integration."""
    point, _ = at_rest("two-tanks-interacting", "Fi", "h2")
    assert nonlinear_ring(point, 0.1, 1e-3, 150.0, sensor=Instrument(Lag(1.9), 0.7)).oscillation.growth is None


def test_swings_below_the_noise_do_not_count():
    """A decaying cosine whose swings of 1e-6 and less are left out: ln(swing) falls by 1 in its period of 2."""
    t = np.linspace(0.0, 60.0, 6001)
    y = np.exp(-0.5 * t) * np.cos(np.pi * t)
    dy = -0.5 * y - np.pi * np.exp(-0.5 * t) * np.sin(np.pi * t)
    seen = oscillation(t, y, dy, noise=1e-6)
    assert seen.growth == pytest.approx(-1.0, rel=1e-6)
    assert 1e-6 < np.abs(np.diff(seen.y)).min() < 2e-6


@pytest.mark.parametrize("plant", ["two-tanks", "two-tanks-interacting"])
def test_a_small_relay_cycles_as_around_the_linear_model(plant):
    """The describing function's bias is in both: two lags have no ultimate gain, a relay finds one all the same."""
    point, P = at_rest(plant, "Fi", "h2")
    relay = Relay(1e-3, 1e-5)
    exact = linear_relay(P, relay)
    found = nonlinear_relay(point, relay, 60.0 * exact.Pu, exact.Pu)
    assert found.Pu == pytest.approx(exact.Pu, rel=2e-3)
    assert found.swing == pytest.approx(exact.swing, rel=2e-3)
    assert found.point.Ku == pytest.approx(exact.point.Ku, rel=4e-3)
