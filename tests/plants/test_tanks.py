"""Tanks in a row: their transfer functions, as the notes derive them, and what flows in and out."""

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import BUILT_IN, compile_model
from looplab.engine.nonlinear.simulation import InputCourse, simulate_open_loop
from looplab.engine.response import step
from looplab.plants import load_plant
from looplab.plants.tanks_in_series import tanks_in_series

A1, A2, R1, R2 = 2.0, 1.0, 0.5, 1.0
S = 1j * np.geomspace(1e-3, 1e3, 61)


def frequency_response(model, u=None, p=None):
    u, p = u or model.u0, p or model.p0
    linear = model.jacobians(0.0, model.initial_state(u, p), u, p)
    eye = np.eye(len(linear.A))
    return np.array([linear.C @ np.linalg.solve(s * eye - linear.A, linear.B) + linear.D for s in S])


def test_tanks_that_do_not_interact():
    """Notes 12.0.1: h2/Fi = Kp1 Kp2/((tau1 s + 1)(tau2 s + 1)) with tau = A R, h1/Fi = R1, h2/h1 = R2/R1."""
    found = frequency_response(load_plant("two-tanks"))
    first = R1 / (A1 * R1 * S + 1)
    assert found[:, 1, 0] == pytest.approx(first, rel=1e-9)
    assert found[:, 0, 0] == pytest.approx(first * (R2 / R1) / (A2 * R2 * S + 1), rel=1e-9)


def test_tanks_that_interact():
    """Notes 12.0.1: the term A1 R2 is what the interaction adds to the damping."""
    found = frequency_response(load_plant("two-tanks-interacting"))
    tau1, tau2 = A1 * R1, A2 * R2
    D = tau1 * tau2 * S**2 + (tau1 + tau2 + A1 * R2) * S + 1
    assert found[:, 1, 0] == pytest.approx((tau2 * R1 * S + R1 + R2) / D, rel=1e-9)
    assert found[:, 0, 0] == pytest.approx(R2 / D, rel=1e-9)


def test_interaction_makes_the_slow_pole_slower():
    """(tau s + 1)^2 against tau^2 s^2 + 4 tau s + 1: -1 twice against -2 +- sqrt 3."""
    poles = [
        np.sort(np.linalg.eigvals(load_plant(name).state_jacobian(0.0, [1.0, 1.0], [1.0], [A1, A2, R1, R2, 2.0])).real)
        for name in ("two-tanks", "two-tanks-interacting")
    ]
    assert poles[0] == pytest.approx([-1, -1], abs=1e-12)
    assert poles[1] == pytest.approx([-2 - np.sqrt(3), -2 + np.sqrt(3)], abs=1e-12)


@pytest.mark.parametrize("name", ["two-tanks", "two-tanks-interacting"])
def test_the_water_is_accounted_for(name):
    t = np.linspace(0, 10, 2001)
    found = simulate_open_loop(load_plant(name), t, {"Fi": InputCourse(1.0).plus(step(-0.5, 0.0))}, rtol=1e-10)
    stored = A1 * found.x[:, 0] + A2 * found.x[:, 1]
    outflow = found.x[:, 1] / R2
    # Simpson's rule on twice 1000 intervals
    out = (t[2] - t[0]) / 6 * (outflow[:-2:2] + 4 * outflow[1:-1:2] + outflow[2::2]).sum()
    assert stored[-1] - stored[0] == pytest.approx(0.5 * t[-1] - out, abs=1e-9)


def test_water_flows_back_where_the_second_level_is_higher():
    model = load_plant("two-tanks-interacting")
    assert model.variables(0.0, [0.5, 1.5], model.u0, model.p0)[0] == -2.0


@pytest.mark.parametrize("name", ["two-tanks", "two-tanks-interacting"])
def test_a_tank_overflows(name):
    found = simulate_open_loop(load_plant(name), np.linspace(0, 20, 101), {"Fi": 4.5})
    assert found.truncated_reason in {"the first tank overflows", "the second tank overflows"}
    assert found.x[-1].max() == pytest.approx(2.0, abs=1e-9)


@pytest.mark.parametrize("N", [1, 2, 5, 40])
def test_tanks_in_series_are_a_power_of_one(N):
    """c_N/c_0 = 1/(1 + s V/(N F))^N."""
    model = compile_model(tanks_in_series(N), BUILT_IN)
    found = frequency_response(model)[:, 0, 0]
    low = np.abs(S) < 10  # beyond, 40 tanks let nothing through
    assert found[low] == pytest.approx((1 + S[low] * 5 / N) ** -float(N), rel=1e-9, abs=1e-13)


def test_many_tanks_near_a_dead_time():
    """(1 + s theta/N)^-N = e^{-theta s} e^{(theta s)^2/(2N)} ...: at omega theta = 1 within 1/(2N)."""
    s = 0.2j
    for N in (20, 120):
        A = compile_model(tanks_in_series(N), BUILT_IN)
        linear = A.jacobians(0.0, A.x0, A.u0, A.p0)
        value = (linear.C @ np.linalg.solve(s * np.eye(N) - linear.A, linear.B))[0, 0]
        assert 0.4 / N < abs(value - np.exp(-5 * s)) < 0.5 / N


@pytest.mark.parametrize("N", [0, 121])
def test_the_number_of_tanks_has_ends(N):
    with pytest.raises(InvalidInput) as refused:
        tanks_in_series(N)
    assert refused.value.field == "N"
