"""Steady states, continuation, linear models, phase planes and balances over REST; a plant as a system."""

import math
from typing import Any

import numpy as np
import pytest

from looplab.api.answers import steady
from looplab.api.answers.base import Error

CUBIC: dict[str, Any] = {
    "id": "cubic",
    "title": "Cubic",
    "inputs": [{"name": "u", "value": 0, "unit": "kg/h", "min": -1, "max": 1}],
    "states": [
        {"name": "x", "initial": 0.5, "equation": "u + x - x^3", "unit": "m", "min": -3, "max": 3},
        {"name": "y", "initial": 0, "equation": "x - y", "min": -3, "max": 3},
    ],
    "operating_points": [{"name": "above", "inputs": {"u": 0.1}, "near": {"x": 1}}],
}
DRIFT: dict[str, Any] = {
    "id": "drift",
    "title": "Drift",
    "states": [{"name": "x", "initial": 0, "equation": "1 + x^2"}],
}
REACTOR = {"type": "plant", "id": "cstr", "operating_point": "middle", "input": "Q", "output": "T"}


def ask(post: Any, path: str, body: Any, shape: Any) -> dict[str, Any]:
    response = post(path, body)
    assert response.status_code == 200, response.text
    shape.model_validate_json(response.content)
    answer: dict[str, Any] = response.json()
    return answer


def refused(post: Any, path: str, body: Any) -> Any:
    response = post(path, body)
    assert response.status_code == 422, response.text
    return Error.model_validate_json(response.content).error


def test_steady_states(post: Any) -> None:
    answer = ask(post, "/plants/cstr/steady-states", {"starts": 60}, steady.SteadyStatesAnswer)
    assert [round(state["x"]["T"], 1) for state in answer["steady_states"]] == [529.6, 385.1, 331.1]
    for state in answer["steady_states"]:
        variables = state["variables"]
        assert variables["heat_generated"] == pytest.approx(variables["heat_removed"], rel=1e-9)
        assert state["outputs"]["T"] == state["x"]["T"]
    own = ask(post, "/models/steady-states", {"model": CUBIC, "operating_point": "above"}, steady.SteadyStatesAnswer)
    roots = np.sort(np.roots([-1, 0, 1, 0.1]).real)
    assert [state["x"]["x"] for state in own["steady_states"]] == pytest.approx(roots, rel=1e-10)
    none = ask(post, "/models/steady-states", {"model": DRIFT}, steady.SteadyStatesAnswer)
    assert (none["steady_states"], none["converged"]) == ([], 0)


def test_continuation(post: Any) -> None:
    answer = ask(post, "/models/continuation", {"model": CUBIC, "over": "u"}, steady.ContinuationAnswer)
    fold = 2 / 27**0.5
    assert sorted(point["value"] for point in answer["turning_points"]) == pytest.approx([-fold, fold], rel=1e-10)
    assert answer["hopf_points"] == answer["branch_points"] == []
    (branch,) = answer["branches"]
    pieces = branch["pieces"]
    assert [piece["stable"] for piece in pieces] == [True, False, True]
    # Neighbouring pieces share the turning point, and together they are the whole branch.
    assert [piece["last"] for piece in pieces[:-1]] == [piece["first"] for piece in pieces[1:]]
    assert {piece["first"] for piece in pieces[1:]} == {point["index"] for point in answer["turning_points"]}
    assert (pieces[0]["first"], pieces[-1]["last"]) == (0, len(branch["values"]) - 1)
    assert branch["outputs"]["x"] == branch["states"]["x"]
    assert len(answer["steady_states"]) == 3
    nothing = ask(
        post,
        "/models/continuation",
        {"model": {**DRIFT, "inputs": CUBIC["inputs"]}, "over": "u"},
        steady.ContinuationAnswer,
    )
    assert nothing["branches"] == []


def test_linear_model(post: Any) -> None:
    body = {"operating_point": "lower", "input": "Q", "output": "T", "steps": [1e4], "horizon": 5}
    answer = ask(post, "/plants/cstr/linearize", body, steady.LinearizeAnswer)
    assert answer["equilibrium"]
    channel = answer["channel"]
    assert channel["gain_unit"] == "K/(cal/min)"
    # The three ways to open it elsewhere are one system: the one its matrices say.
    A, B, C = (np.array(channel["ss"][name]) for name in "ABC")
    omega = [0.1, 1.0, 10.0]
    exact = [20 * math.log10(abs((C @ np.linalg.solve(1j * w * np.eye(2) - A, B))[0, 0])) for w in omega]
    for system in (channel["ss"], channel["zpk"], channel["plant"]):
        response = post("/frequency", {"system": system, "omega": omega})
        assert response.status_code == 200, response.text
        assert response.json()["mag_dB"] == pytest.approx(exact, abs=1e-8)
    (response,) = answer["responses"]
    assert response["linear"][0] == response["nonlinear"][0] == answer["x"]["T"]
    assert response["largest_deviation"] < 0.02 * abs(channel["gain"]) * 1e4


def test_a_point_that_is_no_equilibrium(post: Any) -> None:
    body = {"model": CUBIC, "at": "point", "near": {"x": 0.5, "y": 0.5}}
    answer = ask(post, "/models/linearize", body, steady.LinearizeAnswer)
    assert not answer["equilibrium"]
    assert answer["f"] == {"x": 0.375, "y": 0}
    assert "not an equilibrium" in answer["remark"]
    assert answer["A"] == [[0.25, 0], [1, -1]]
    assert answer["channel"]["gain_unit"] == "m/(kg/h)"
    assert answer["channel"]["plant"] is None
    without = ask(post, "/models/linearize", {"model": DRIFT, "at": "point"}, steady.LinearizeAnswer)
    assert (without["channel"], without["channel_reason"]) == (None, "the model has no input")


def test_phase_plane_and_balance(post: Any) -> None:
    body = {"model": CUBIC, "ranges": {"x": [-2, 2], "y": [-2, 2]}, "grid": 7, "starts": [{"x": 0.2, "y": -1}]}
    answer = ask(post, "/models/phase-plane", body, steady.PhasePlaneAnswer)
    kinds = sorted((round(state["x"]["x"], 6), state["kind"]) for state in answer["steady_states"])
    assert kinds == [(-1, "stable node"), (0, "saddle"), (1, "stable node")]
    assert answer["trajectories"][0]["horizontal"][-1] == pytest.approx(1, abs=1e-4)
    assert [line["state"] for line in answer["nullclines"]] == ["x", "y"]
    assert np.array(answer["field"]["d_vertical"]).shape == (7, 7)
    balance = ask(post, "/plants/cstr/balance", {"state": "T", "low": 300, "high": 600}, steady.BalanceAnswer)
    assert [curve["name"] for curve in balance["curves"]] == ["heat_generated", "heat_removed"]
    assert balance["rate_unit"] == "K/min"
    assert len(balance["steady_states"]) == 3


@pytest.mark.parametrize(
    ("path", "body", "field"),
    [
        ("/plants/cstr/steady-states", {"inputs": {"Q": -1}}, "inputs.Q"),
        ("/plants/cstr/steady-states", {"box": {"T": [400, 300]}}, "box.T"),
        ("/plants/cstr/steady-states", {"operating_point": "nowhere"}, "operating_point"),
        ("/plants/cstr/continuation", {"over": "T"}, "over"),
        ("/plants/cstr/continuation", {"over": "Ti", "low": 0}, "low"),
        ("/plants/cstr/linearize", {"output": "Q"}, "output"),
        ("/plants/cstr/linearize", {"operating_point": "middle", "steps": [1e9]}, "steps[0]"),
        ("/plants/cstr/phase-plane", {"vertical": "cA"}, "vertical"),
        ("/plants/cstr/phase-plane", {"ranges": {"x": [0, 1]}}, "ranges.x"),
        ("/plants/gravity-drained-tank/phase-plane", {}, "horizontal"),
        ("/plants/cstr/balance", {"state": "T", "curves": ["x"]}, "curves[0]"),
        ("/models/linearize", {"model": DRIFT}, "near"),
        (
            "/models/steady-states",
            {"model": {**DRIFT, "states": [{"name": "x", "initial": 0, "equation": "x +"}]}},
            "model.states[0].equation",
        ),
    ],
)
def test_errors_have_their_places(post: Any, path: str, body: Any, field: str) -> None:
    assert refused(post, path, body).path == field


def test_no_such_plant(post: Any) -> None:
    assert post("/plants/nowhere/steady-states", {}).status_code == 404


def test_a_plant_in_a_loop(post: Any) -> None:
    """The reactor at its unstable state, held by its cooling if the gain is high enough."""
    A = np.array(post("/state-space", {"system": REACTOR}).json()["A"])
    assert A.shape == (2, 2)
    for Kc, stable in ((-1e5, False), (-5e5, True)):
        loop = {"plant": REACTOR, "controller": {"type": "pid", "Kc": Kc}}
        answer = post("/loop", {"loop": loop})
        assert answer.status_code == 200, answer.text
        # T = C x with C = [0, 1], and Q acts on T alone: feedback adds to A[1][1].
        closed = A + np.array([[0, 0], [0, 1e-5 * Kc]])
        assert bool((np.linalg.eigvals(closed).real < 0).all()) == stable
        assert answer.json()["panels"]["verdict"]["closed_loop_stable"] == stable


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"id": "nowhere"}, "system.id"),
        ({"input": "T"}, "system.input"),
        ({"output": "Q"}, "system.output"),
        ({"operating_point": "nowhere"}, "system.operating_point"),
        ({"params": {"V": 1e9}}, "system.params.V"),
        ({"inputs": {"X": 1}}, "system.inputs.X"),
    ],
)
def test_a_plant_system_that_is_wrong(post: Any, change: dict[str, Any], path: str) -> None:
    assert refused(post, "/frequency", {"system": {**REACTOR, **change}}).path == path
