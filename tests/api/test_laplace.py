"""POST /laplace and POST /approximate: the notes' examples, degenerate cases with reasons, refusals with a field."""

import math
from typing import Any

import pytest

from looplab.api.answers.base import Error
from looplab.api.answers.laplace import ApproximateAnswer, LaplaceAnswer


def expr(text: str) -> dict[str, str]:
    return {"type": "expr", "text": text}


@pytest.fixture
def laplace(post: Any) -> Any:
    def ask(**request: Any) -> dict[str, Any]:
        answer = post("/laplace", request)
        assert answer.status_code == 200, answer.text
        LaplaceAnswer.model_validate_json(answer.content)
        body: dict[str, Any] = answer.json()
        return body

    return ask


@pytest.fixture
def approximate(post: Any) -> Any:
    def ask(plant: dict[str, Any], **request: Any) -> dict[str, Any]:
        answer = post("/approximate", {"plant": plant, **request})
        assert answer.status_code == 200, answer.text
        ApproximateAnswer.model_validate_json(answer.content)
        body: dict[str, Any] = answer.json()
        return body

    return ask


def test_the_example_of_the_notes(laplace: Any) -> None:
    """y'' + y = 1 at rest."""
    found = laplace(ode={"a": [1, 0, 1], "b": [1], "initial": [0, 0]}, input={"type": "step"})
    assert found["text"] == "1 - cos(t)"
    assert found["expansion"]["text"] == "1/s - s/(s^2 + 1)"
    assert found["transform"]["text"] == "1/(s (s^2 + 1))"
    assert found["initial_value"] == 0
    assert found["final_value"] is None
    assert found["reasons"]["final_value"].startswith("no final value: pole at ±j")
    beside = found["response"]
    assert beside["simulated_y"] == pytest.approx([1 - math.cos(t) for t in beside["simulated_t"]], abs=1e-9)
    assert len(beside["simulated_t"]) > 100
    # What the theorem would claim if its condition were not looked at.
    assert found["formula"]["final_value"] == 1
    assert found["accuracy"]["simulation_difference"] < 1e-9
    assert found["partial_fractions"][0] == {"pole": [0, 0], "power": 1, "coefficient": [1, 0]}
    assert (found["forced"]["text"], found["free"]["text"]) == ("1 - cos(t)", "0")


def test_a_double_lag_with_dead_time(laplace: Any) -> None:
    found = laplace(system=expr("2exp(-0.5s)/(s+1)^2"))
    assert found["text"] == "(2 - e^(-(t - 0.5)) (2 + 2 (t - 0.5))) 1(t - 0.5)"
    assert (found["initial_value"], found["final_value"], found["theta"]) == (0, 2, 0.5)
    assert "<math" in found["mathml"] and "<math" in found["expansion"]["mathml"]
    assert found["character"]["classification"] == "critically damped"
    assert found["response"]["y"][0] == 0
    assert found["response"]["y"][-1] == pytest.approx(2, abs=0.02)
    assert found["forced"] is None


def test_the_transform_of_a_system_itself(laplace: Any) -> None:
    found = laplace(system=expr("(s+3)/(s+1)"), input=None)
    assert (found["text"], found["direct"]) == ("delta(t) + 2 e^(-t)", 1)
    assert found["initial_value"] is None
    assert "not strictly proper" in found["reasons"]["initial_value"]
    assert found["accuracy"]["simulation_difference"] is None
    assert found["accuracy"]["simulation_reason"]


def test_written_out_polynomials_get_their_repeated_pole_back(laplace: Any) -> None:
    found = laplace(system={"type": "tf", "num": [1], "den": [1, 5, 10, 10, 5, 1]}, input={"type": "impulse"})
    assert found["accuracy"]["cluster_tolerance"] > 0
    assert [f["power"] for f in found["partial_fractions"]] == [5]


def test_growth_is_cut(laplace: Any) -> None:
    found = laplace(system=expr("1/(s-1)"), horizon=100)
    assert found["response"]["truncated_at"] == pytest.approx(20.7, abs=0.5)
    assert max(found["response"]["y"]) < 1e9
    assert "right half-plane" in found["reasons"]["final_value"]


@pytest.mark.parametrize("text", ["0/(s+1)", "3", "exp(-s)", "1/s^3", "1/(s+1)^50", "(s-1)/((s-1)(s+2))"])
@pytest.mark.parametrize("kind", ["impulse", "step", "ramp", "sine", "exponential"])
def test_degenerate_systems_have_an_answer(laplace: Any, text: str, kind: str) -> None:
    found = laplace(system=expr(text), input={"type": kind}, points=20)
    for name in ("initial_value", "final_value"):
        assert (found[name] is None) == (name in found["reasons"])


def test_a_long_sum_is_not_typeset(laplace: Any) -> None:
    poles = [[-(1.4**k), sign * 1.4**k] for k in range(25) for sign in (1, -1)]
    found = laplace(system={"type": "zpk", "poles": poles, "k": 1e90}, points=20)
    assert found["mathml"] is None
    assert len(found["partial_fractions"]) == 51
    assert found["accuracy"]["simulation_difference"] < 1e-6


def test_packed_arrays(laplace: Any) -> None:
    assert laplace(system=expr("1/(s+1)"), arrays="f4")["response"]["y"]["dtype"] == "f4"


def test_models_beside_each_other(approximate: Any) -> None:
    """Seborg et al., Process Dynamics and Control, 3rd ed., example 6.4."""
    found = approximate(expr("(1-0.1s)/((5s+1)(3s+1)(0.5s+1))"))
    by_name = {(m["method"], m["type"]): m for m in found["models"]}
    half, taylor = by_name["half_rule", "FOPDT"], by_name["taylor", "FOPDT"]
    assert (half["tau"], half["theta"]) == pytest.approx((6.5, 2.1))
    assert (taylor["tau"], taylor["theta"]) == pytest.approx((5, 3.6))
    assert by_name["half_rule", "SOPDT"]["tau_1"] == pytest.approx(5)
    assert half["max_deviation"] < taylor["max_deviation"]
    assert half["max_deviation_pct"] == pytest.approx(100 * half["max_deviation"])
    assert len(found["t"]) == len(found["y"]) == len(half["y"]) == 300
    assert by_name["two_point", "SOPDT"]["valid"] is False
    assert found["character"] is None
    assert found["reason"] is None


def test_a_plant_that_does_not_settle(approximate: Any) -> None:
    found = approximate(expr("1/(s(s+1))"))
    assert (found["t"], found["y"]) == (None, None)
    assert "does not settle" in found["reason"]
    assert not any(m["valid"] for m in found["models"])
    assert found["character"]["classification"] == "integrating"


@pytest.mark.parametrize(
    ("route", "body", "path"),
    [
        ("/laplace", {}, ""),
        ("/laplace", {"system": expr("1/s"), "ode": {"a": [1, 1]}}, ""),
        ("/laplace", {"system": expr("s")}, "system"),
        ("/laplace", {"system": expr("1/(s2)")}, "system.text"),
        ("/laplace", {"system": expr("1/s"), "input": {"type": "saw"}}, "input"),
        ("/laplace", {"system": expr("1/s"), "input": {"type": "sine", "omega": 0}}, "input.omega"),
        ("/laplace", {"ode": {"a": [0, 1]}}, "ode.a"),
        ("/laplace", {"ode": {"a": [1, 1], "b": [1, 0, 0]}}, "ode.b"),
        ("/laplace", {"ode": {"a": [1, 1], "initial": [1, 2]}}, "ode.initial"),
        ("/laplace", {"system": expr("1/s"), "points": 3}, "points"),
        ("/laplace", {"system": {"type": "zpk", "poles": [-1e-10, -1e10], "k": 1}, "horizon": -1}, "horizon"),
        ("/approximate", {"points": 20}, "plant"),
        ("/approximate", {"plant": expr("s")}, "plant"),
        ("/approximate", {"plant": expr("1/(s+1)"), "methods": ["magic"]}, "methods[0]"),
        ("/approximate", {"plant": expr("1/(s+1)"), "types": []}, "types"),
    ],
)
def test_a_bad_request_names_its_field(post: Any, route: str, body: dict[str, Any], path: str) -> None:
    response = post(route, body)
    assert response.status_code == 422, response.text
    assert Error.model_validate_json(response.content).error.path == path


@pytest.mark.parametrize(
    "system",
    [
        {"type": "zpk", "zeros": [1e12], "poles": [-1e12, -1e-12, -1e-12], "k": 1e300},
        {"type": "zpk", "poles": [-1e12] * 25 + [-1e-12] * 25, "k": 1e-300},
        {"type": "zpk", "poles": [[0, 1e12], [0, -1e12]] * 25, "k": 1},
        {"type": "zpk", "poles": [-1e-12] * 50, "k": 1e300},
        {"type": "fopdt", "K": 1e300, "tau": 1e-12, "theta": 1e12},
        {"type": "zpk", "poles": [1e12], "k": 1},
        {"type": "zpk", "poles": [-3.3e7], "k": 1e5, "theta": 1e11},
        {"type": "zpk", "zeros": [-1.5], "poles": [-0.73], "k": 1.45, "theta": 1.37},
        {"type": "zpk", "zeros": [-1e-9], "poles": [-1, -1e9], "k": 1},
    ],
)
def test_extreme_numbers_are_answered_or_refused(post: Any, system: dict[str, Any]) -> None:
    for route, body in (("/laplace", {"system": system}), ("/approximate", {"plant": system})):
        response = post(route, {**body, "points": 20})
        assert response.status_code in (200, 422), response.text
        assert b"NaN" not in response.content
        if response.status_code == 200:
            (LaplaceAnswer if route == "/laplace" else ApproximateAnswer).model_validate_json(response.content)
