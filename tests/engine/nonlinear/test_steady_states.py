"""Steady states against mpmath and closed forms, and searches that find none, several or a continuum."""

import json
import math
from typing import Any

import mpmath
import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import CompiledModel, compile_model
from looplab.engine.nonlinear.steady_states import SteadyStateSearch, find_steady_states, steady_state_near
from looplab.plants import load_plant, plant_ids
from models import model, parameters

PENDULUM = model(
    ["x2", "F - 0.1*x2", "x4", "9.81*sin(x3) - 0.2*x4 + F*cos(x3)"],
    [0.5, 0, 0.1, 0],
    inputs=parameters(F=0),
    operating_points=[{"name": "hanging", "near": {"x3": 3.1}}],
)


def search(document: dict[str, Any], **more: Any) -> SteadyStateSearch:
    compiled = compile_model(document)
    return find_steady_states(compiled, compiled.u0, compiled.p0, **more)


def reactor_root(Q: str, guess: tuple[float, float]) -> tuple[float, float]:
    """Both equations of notes 3.1 written out again, solved with 40 digits."""
    with mpmath.workdps(40):
        Q_ = mpmath.mpf(Q)

        def f(cA: Any, T: Any) -> tuple[Any, Any]:
            r = mpmath.mpf("7.2e10") * mpmath.exp(-10000 / T) * cA
            return 1 - cA - r, 350 - T + 200 * r - Q_ / 100000

        cA, T = mpmath.findroot(f, guess)
    return float(cA), float(T)


def test_the_reactor_has_three() -> None:
    """Right values of notes 3.3: 331.1 K, 385.1 K (unstable) and 529.6 K at Q = 2e6 cal/min and Ti = 350 K."""
    reactor = load_plant("cstr")
    found = find_steady_states(reactor, reactor.u0, reactor.p0).steady_states
    assert [round(state.x[1], 1) for state in found] == [529.6, 385.1, 331.1]
    assert [state.verdict for state in found] == ["stable", "unstable", "stable"]
    assert [state.kind for state in found] == ["stable node", "saddle", "stable node"]
    for state, guess in zip(found, [(0.002, 530), (0.72, 385), (0.99, 331)], strict=True):
        np.testing.assert_allclose(state.x, reactor_root("2e6", guess), rtol=1e-10)
        assert state.residual < 1e-9
        assert state.found_by >= 1
        # Eigenvalues of the Jacobian written out by hand.
        cA, T = state.x
        k = 7.2e10 * math.exp(-1e4 / T)
        slope = k * cA * 1e4 / T**2
        A = np.array([[-1 - k, -slope], [200 * k, -1 + 200 * slope]])
        np.testing.assert_allclose(np.sort(state.eigenvalues.real), np.sort(np.linalg.eigvals(A).real), rtol=1e-9)


def test_the_search_says_what_it_did() -> None:
    found = search(model("x*(1 - x)*(x - 3)", 0.5), box={"x": (-1, 4)}, starts=50)
    assert [round(state.x[0], 9) for state in found.steady_states] == [0, 1, 3]
    assert [state.verdict for state in found.steady_states] == ["stable", "unstable", "stable"]
    assert found.starts == 51
    assert sum(state.found_by for state in found.steady_states) == found.converged <= found.starts
    assert "may miss" in found.remark
    again = search(model("x*(1 - x)*(x - 3)", 0.5), box={"x": (-1, 4)}, starts=50)
    assert [state.x for state in again.steady_states] == [state.x for state in found.steady_states]


def test_many_steady_states_of_a_transcendental_equation() -> None:
    """tan is not needed: cos(x) = x/10 has seven roots (mpmath finds each between its neighbours)."""
    found = search(model("10*cos(x) - x", 0), box={"x": (-11, 11)}, starts=200)
    grid = np.linspace(-11, 11, 2001)
    values = 10 * np.cos(grid) - grid
    brackets = [(a, b) for a, b, f, g in zip(grid, grid[1:], values, values[1:], strict=False) if f * g < 0]
    roots = [float(mpmath.findroot(lambda x: 10 * mpmath.cos(x) - x, pair, solver="anderson")) for pair in brackets]
    np.testing.assert_allclose([state.x[0] for state in found.steady_states], roots, rtol=1e-10)


def test_none_is_said_to_be_none() -> None:
    found = search(model("1 + x^2"))
    assert found.steady_states == ()
    assert found.converged == 0
    assert "probably there is no steady state" in found.remark
    compiled = compile_model(model("1 + x^2"))
    with pytest.raises(InvalidInput) as caught:
        steady_state_near(compiled, (), (), (1.0,))
    assert caught.value.field == "near"


def test_an_integrator_leaves_a_state_free() -> None:
    """A cart and its pendulum, at rest anywhere on the track: upright and hanging, x1 free."""
    found = search(PENDULUM, box={"x3": (-1, 5)}).steady_states
    assert [state.free for state in found] == [("x1",), ("x1",)]
    np.testing.assert_allclose([state.x for state in found], [[0.5, 0, 0, 0], [0.5, 0, math.pi, 0]], atol=1e-12)
    upright, hanging = found
    assert upright.verdict == "unstable"
    assert hanging.verdict == "marginal"
    assert "linear model alone does not decide" in hanging.because


def test_a_double_root_is_no_continuum() -> None:
    found = search(model("x^2", 1)).steady_states
    assert len(found) == 1
    assert found[0].free == ()
    assert abs(found[0].x[0]) < 1e-7


def test_a_continuum_of_two_states_together() -> None:
    """x1 + x2 keeps its value: the steady states are the line x1 = x2."""
    (found,) = search(model(["x2 - x1", "x1 - x2"], [1, 3])).steady_states
    assert found.free == ("x1", "x2")
    assert found.x[0] == pytest.approx(found.x[1], abs=1e-12)


def test_units_do_not_matter() -> None:
    """The same model with x2 counted in millionths."""
    box = {"x1": (0.0, 5.0), "x2": (0.0, 5e6)}
    found = search(model(["x1*(1 - x1) - x1*x2/1e6", "x2*(x1 - 0.5)"], [1, 1e5]), box=box).steady_states
    np.testing.assert_allclose([state.x for state in found], [[0, 0], [0.5, 5e5], [1, 0]], atol=1e-6)
    assert [state.kind for state in found] == ["saddle", "stable focus", "saddle"]


@pytest.mark.parametrize("plant_id", plant_ids())
def test_every_operating_point_is_near_a_steady_state(plant_id: str) -> None:
    plant: CompiledModel = load_plant(plant_id)
    for point in plant.document.operating_points:
        u, p = plant.inputs(point.inputs), plant.parameters(point.parameters)
        start = plant.states(point.near, plant.initial_state(u, p))
        state = steady_state_near(plant, u, p, start)
        assert state.residual <= 1e-8 * max(1.0, *map(abs, state.x))
        for name, value in point.near.items():
            assert state.x[plant.state_names.index(name)] == pytest.approx(value, rel=0.02, abs=1e-3)


def test_what_cannot_be_searched_is_refused() -> None:
    with pytest.raises(InvalidInput) as caught:
        search(model("sin(t) - x"))
    assert caught.value.field == "states"
    for more, field in (
        ({"box": {"y": (0, 1)}}, "box.y"),
        ({"box": {"x": (1, 0)}}, "box.x"),
        ({"starts": 0}, "starts"),
        ({"starts": 401}, "starts"),
    ):
        with pytest.raises(InvalidInput) as caught:
            search(model("-x"), **more)
        assert caught.value.field == field


def test_the_models_own_mistakes_end_no_search() -> None:
    """sqrt and log are undefined over half the box."""
    found = search(model("1 - sqrt(x)", 0.5), box={"x": (-2, 4)})
    assert [state.x[0] for state in found.steady_states] == [pytest.approx(1, rel=1e-12)]
    assert json.dumps(found.box.tolist()) == "[[-2.0, 4.0]]"


def test_a_bent_continuum_is_counted_once() -> None:
    """x1 never changes, x2 follows its square or stays away from it: two lines, both at the x1 that is known."""
    found = search(model(["0*x1", "(x1^2 - x2)*(x2 + 3)"], [0.5, 1]), box={"x1": (-1, 1), "x2": (-4, 4)}).steady_states
    np.testing.assert_allclose([state.x for state in found], [[0.5, -3], [0.5, 0.25]], atol=1e-9)
    assert all("x1" in state.free for state in found)
