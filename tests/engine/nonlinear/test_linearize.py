"""The linear model against complex steps and by hand, and how a small step agrees with it."""

import cmath
import math

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import compile_model
from looplab.engine.nonlinear.steady_states import LinearModel, compare_step, linear_step, linearize, steady_state_near
from looplab.plants import load_plant
from models import model, parameters

TIMES = np.linspace(0, 10, 201)


def reactor_at(T: float) -> LinearModel:
    reactor = load_plant("cstr")
    state = steady_state_near(reactor, reactor.u0, reactor.p0, reactor.states({"T": T}, (0.7, 0)))
    return linearize(reactor, state.x, reactor.u0, reactor.p0)


def test_derivatives_by_complex_steps() -> None:
    """f of the reactor written out for complex numbers: Im f(z + ih)/h is the derivative to the last digit."""

    def f(cA: complex, T: complex, Fi: complex, cAi: complex, Ti: complex, Q: complex) -> tuple[complex, complex]:
        r = 7.2e10 * cmath.exp(-1e4 / T) * cA
        return Fi / 100 * (cAi - cA) - r, Fi / 100 * (Ti - T) + 200 * r - Q / 1e5

    point = reactor_at(385)
    values = [*point.x, *point.u]
    step = 1e-30
    columns = []
    for index in range(6):
        moved: list[complex] = list(values)
        moved[index] += 1j * step
        columns.append([value.imag / step for value in f(*moved)])
    whole = np.array(columns).T
    np.testing.assert_allclose(point.jacobians.A, whole[:, :2], rtol=1e-12, atol=1e-300)
    np.testing.assert_allclose(point.jacobians.B, whole[:, 2:], rtol=1e-12, atol=1e-300)
    np.testing.assert_array_equal(point.jacobians.C, [[0, 1], [1, 0]])
    assert not point.jacobians.D.any()
    assert point.equilibrium
    assert point.verdict == "unstable"


def test_the_channel_has_the_gain_of_the_steady_states() -> None:
    """G(0) from Q to T is dT/dQ along the steady states: 1/(1e5 (-1 + 200 k'/(1 + k)^2))."""
    point = reactor_at(331)
    G = point.transfer_function(0, 3)
    T = point.x[1]
    k = 7.2e10 * math.exp(-1e4 / T)
    assert G.dc_gain == pytest.approx(1 / (1e5 * (-1 + 200 * k * 1e4 / T**2 / (1 + k) ** 2)), rel=1e-9)
    assert np.sort(G.poles.real) == pytest.approx(np.sort(np.linalg.eigvals(point.jacobians.A).real), rel=1e-9)
    assert point.time_constants == pytest.approx(np.sort(1 / -G.poles.real)[::-1], rel=1e-9)


def test_time_constants_count_a_pair_once_and_no_integrator() -> None:
    document = model(["x2", "-4*x1 - 0.4*x2", "u"], 0, inputs=parameters(u=0))
    compiled = compile_model(document)
    point = linearize(compiled, (0.0, 0.0, 0.0), (0.0,), ())
    assert point.time_constants == pytest.approx([5.0], rel=1e-12)
    assert point.verdict == "marginal"
    assert point.equilibrium


def test_a_linear_model_agrees_with_itself() -> None:
    document = model(["x2 + 1", "-2*x1 - 0.5*x2 + 3*u"], [0.3, 0.1], inputs=parameters(u=0.5))
    compiled = compile_model(document)
    # Not at rest: the constant part goes along.
    point = linearize(compiled, (0.3, 0.1), (0.5,), ())
    assert not point.equilibrium
    assert point.f == pytest.approx((1.1, 0.85), rel=1e-15)
    for output in (0, 1):
        found = compare_step(compiled, point, output, 0, 2.0, TIMES)
        np.testing.assert_allclose(found.linear, found.nonlinear, rtol=1e-6, atol=1e-6)
        assert found.relative is not None
        assert found.relative < 1e-6


def test_a_step_against_its_closed_form() -> None:
    """x' = u - x^2 at u = 4: linear 2 + s/4 (1 - e^{-4t}), nonlinear sqrt(4 + s) tanh(...)."""
    compiled = compile_model(model("u - x^2", 2, inputs=parameters(u=4)))
    point = linearize(compiled, (2.0,), (4.0,), ())
    t = np.linspace(0, 3, 301)
    np.testing.assert_allclose(linear_step(point, 0, 0, 5.0, t), 2 + 1.25 * (1 - np.exp(-4 * t)), rtol=1e-12)
    found = compare_step(compiled, point, 0, 0, 5.0, t)
    exact = 3 * np.tanh(3 * t + math.atanh(2 / 3))
    np.testing.assert_allclose(found.nonlinear, exact, rtol=1e-6)
    apart = np.abs(exact - found.linear)
    assert found.largest_deviation == pytest.approx(apart.max(), rel=1e-5)
    assert found.at == pytest.approx(t[np.argmax(apart)], abs=0.05)


def test_deviation_falls_with_the_square_of_the_step() -> None:
    reactor, point = load_plant("cstr"), reactor_at(331)
    large, small = (compare_step(reactor, point, 0, 3, size, TIMES) for size in (-1e5, -1e4))
    assert large.largest_deviation / small.largest_deviation == pytest.approx(100, rel=0.1)


def test_a_cut_simulation_and_an_input_out_of_range() -> None:
    compiled = compile_model(model("u + x^2 - 1", -1, inputs=[{"name": "u", "value": 0, "min": -1, "max": 10}]))
    point = linearize(compiled, (-1.0,), (0.0,), ())
    found = compare_step(compiled, point, 0, 0, 10.0, TIMES)
    assert found.truncated_at is not None
    assert found.truncated_reason
    assert found.t[-1] <= found.truncated_at
    assert found.t.size == found.linear.size == found.nonlinear.size
    with pytest.raises(InvalidInput) as caught:
        compare_step(compiled, point, 0, 0, 11.0, TIMES)
    assert caught.value.field == "inputs.u"


def test_a_linear_response_beyond_all_numbers() -> None:
    """The nonlinear model grows like t, its linear model like exp(t)."""
    compiled = compile_model(model("tanh(x) + u", 0, inputs=parameters(u=0)))
    point = linearize(compiled, (0.0,), (0.0,), ())
    with pytest.raises(InvalidInput) as caught:
        compare_step(compiled, point, 0, 0, 1.0, np.linspace(0, 5000, 101))
    assert caught.value.field == "horizon"
