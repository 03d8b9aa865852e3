"""POST /response: closed forms through the API, sums, cuts, and what is refused."""

from typing import Any

import numpy as np
import pytest

from looplab.api.answers.response import ResponseAnswer

STEP = {"type": "step"}


def ask(post: Any, system: Any, signal: dict[str, Any], **more: Any) -> dict[str, Any]:
    shape = {"type": "expr", "text": system} if isinstance(system, str) else system
    answer = post("/response", {"system": shape, "input": signal, **more})
    assert answer.status_code == 200, answer.text
    ResponseAnswer.model_validate_json(answer.content)
    return answer.json()


def test_a_lag_with_dead_time(post: Any) -> None:
    """2 exp(-t')/(3 s + 1), t' = 1: y = 3 (1 - exp(-(t-1)/3)) after a step of 1.5."""
    found = ask(post, "2 exp(-s)/(3s+1)", {"type": "step", "amplitude": 1.5}, horizon=20, points=201)
    t = np.array(found["t"])
    assert np.allclose(found["y"], np.where(t > 1, 3 * -np.expm1(-np.maximum(t - 1, 0) / 3), 0), atol=1e-13)
    assert found["final_value"] == pytest.approx(3)
    assert found["system"]["order"] == 1 and found["system"]["theta"] == 1
    assert found["u"] == [1.5] * 201
    assert found["superposition"] is None and found["states"] is None


def test_resonance(post: Any) -> None:
    found = ask(post, "1/(s^2+4)", {"type": "sine", "omega": 2}, horizon=30, points=301)
    t = np.array(found["t"])
    assert np.allclose(found["y"], (np.sin(2 * t) - 2 * t * np.cos(2 * t)) / 8, atol=1e-12)
    assert found["final_value"] is None and "± 2j" in found["reasons"]["final_value"]


def test_a_staircase_and_its_steps(post: Any) -> None:
    signal = {"type": "sampled", "times": [0, 2, 5], "values": [1, 4, 0]}
    found = ask(post, "1/(s+1)", signal, horizon=10, points=101, want=["superposition", "convolution"], slices=100)
    terms = found["superposition"]["terms"]
    assert [(term["amplitude"], term["start"]) for term in terms] == [(1, 0), (3, 2), (-4, 5)]
    assert np.allclose(np.sum([term["y"] for term in terms], axis=0), found["y"], atol=1e-13)
    assert found["superposition"]["error"] < 1e-13
    assert np.allclose(found["convolution"]["exact"], found["y"], atol=1e-13)
    assert found["convolution"]["error"] < 0.3


def loop_of(plant: str, **settings: Any) -> dict[str, Any]:
    return {"plant": {"type": "expr", "text": plant}, "controller": {"type": "pid", **settings}}


def test_a_loop_from_its_setpoint_and_opened(post: Any) -> None:
    """3/s under unit feedback is 3/(s+3): y = t - (1 - exp(-3t))/3 behind a ramp; opened, y = 3 t^2/2."""
    request = {"loop": loop_of("1/s", Kc=3), "input": {"type": "ramp"}, "horizon": 4, "points": 41}
    closed = post("/response", request).json()
    t = np.array(closed["t"])
    assert np.allclose(closed["y"], t + np.expm1(-3 * t) / 3, atol=1e-13)
    assert closed["system"]["order"] == 1
    opened = post("/response", {**request, "of": "open_loop"}).json()
    assert np.allclose(opened["y"], 1.5 * t**2, atol=1e-12)


def test_a_loop_with_dead_time(post: Any) -> None:
    """exp(-s)/s under Kc = 0.5: from a step y = 0.5 (t-1) - 0.5^2 (t-2)^2/2 + ..., each term from its t on."""
    request = {"loop": loop_of("exp(-s)/s", Kc=0.5), "horizon": 3, "points": 31}
    found = post("/response", {**request, "input": STEP, "want": ["states"]}).json()
    t = np.array(found["t"])
    first, second = np.maximum(t - 1, 0), np.maximum(t - 2, 0)
    assert np.allclose(found["y"], 0.5 * first - 0.125 * second**2, atol=1e-12)
    assert found["final_value"] == 1
    assert found["system"]["theta"] == 1 and found["system"]["mathml"].startswith("<math")
    assert found["states"] is None and "on its way" in found["reasons"]["states"]
    pulse = {"type": "pulse", "width": 0.77, "start": 0.33}
    sums = post("/response", {**request, "input": pulse, "want": ["superposition", "convolution"]}).json()
    assert sums["superposition"]["error"] < 1e-12
    assert np.allclose(sums["convolution"]["exact"], sums["y"], atol=1e-12)
    assert sums["convolution"]["error"] < 0.05
    ramp = post("/response", {**request, "input": {"type": "ramp"}}).json()
    assert "does not settle" in ramp["reasons"]["final_value"]


def test_free_response_of_a_state_space_and_of_its_equation(post: Any) -> None:
    model = {"type": "ss", "A": [[0, 1], [-2, -3]], "B": [[0], [1]], "C": [[1, 0]], "D": [[0]]}
    still = {"type": "step", "amplitude": 0}
    found = ask(post, model, still, initial={"x": [1, 2]}, want=["states"], horizon=5, points=51)
    t = np.array(found["t"])
    assert np.allclose(found["y"], 4 * np.exp(-t) - 3 * np.exp(-2 * t), atol=1e-13)
    assert np.allclose(found["states"][1], -4 * np.exp(-t) + 6 * np.exp(-2 * t), atol=1e-13)
    assert found["initial_state"] == [1, 2]
    same = ask(post, "1/((s+1)(s+2))", still, initial={"y": [1, 2]}, horizon=5, points=51)
    assert np.allclose(same["y"], found["y"], atol=1e-12)


def test_a_response_that_grows_is_cut_with_its_reason(post: Any) -> None:
    found = ask(post, "1/(s-1)", STEP, horizon=100, points=1001)
    assert len(found["y"]) < len(found["t"]) == 1001
    assert found["truncated_at"] == pytest.approx(20.8)
    assert "grows" in found["truncated_reason"]
    assert "pole at 1" in found["reasons"]["final_value"]


def test_an_impulse_that_passes_directly(post: Any) -> None:
    found = ask(post, "(2s+1)/(s+1)", {"type": "impulse", "area": 3, "start": 1}, horizon=5, points=51)
    assert found["impulses"] == [{"t": 1, "area": pytest.approx(6)}]


def test_packed_arrays(post: Any) -> None:
    found = ask(post, "1/(s+1)", STEP, arrays="f4", want=["states", "convolution"])
    for packed in (found["t"], found["y"], found["states"][0], found["convolution"]["h"]):
        assert packed["dtype"] == "f4"


@pytest.mark.parametrize("system", ["5", "exp(-2s)", "0/(s+1)", "1/s^3", "(s-1)/(s^2+1)", "1/(s+1)^50"])
def test_degenerate_systems_have_a_response(post: Any, system: str) -> None:
    for signal in (STEP, {"type": "ramp"}, {"type": "pulse", "width": 0.5}, {"type": "impulse"}):
        found = ask(post, system, signal, want=["states"])
        assert found["horizon"] > 0 and np.isfinite(found["y"]).all()


@pytest.mark.parametrize(
    ("request_", "path", "word"),
    [
        ({"system": {"type": "expr", "text": "s+1"}, "input": STEP}, "system", "differentiates"),
        ({"loop": loop_of("exp(-s)/s", Kc=1), "input": STEP, "initial": {"y": [1]}}, "initial", "from rest"),
        ({"loop": loop_of("exp(-s)/s", Kc=1, beta=0.5), "input": STEP}, "loop.controller.beta", "weight"),
        ({"loop": loop_of("exp(-s)/s", Kc=1), "input": STEP, "horizon": 1e7}, "loop.plant.theta", "millionth"),
        (
            {"loop": loop_of("exp(-s)", Kc=0.5), "input": {"type": "impulse"}},
            "input",
            "again and again",
        ),
        (
            {"loop": {**loop_of("exp(-s)/s"), "controller": {"type": "expr", "text": "exp(-s)"}}, "input": STEP},
            "loop.controller",
            "dead time of its own",
        ),
        ({"loop": loop_of("1/s", Kc=1), "system": {"type": "expr", "text": "1"}, "input": STEP}, "", "either"),
        ({"system": {"type": "expr", "text": "1/(s+1)"}, "input": STEP, "initial": {"x": [1, 2]}}, "initial.x", "1 s"),
        ({"system": {"type": "expr", "text": "1/(s+1)"}, "input": STEP, "initial": {"y": [1, 2]}}, "initial.y", "ord"),
        ({"system": {"type": "expr", "text": "1/(s+1)"}, "input": STEP, "initial": {}}, "initial", "either"),
        (
            {"system": {"type": "expr", "text": "1/(s+1)"}, "input": {"type": "ramp"}, "want": ["superposition"]},
            "input",
            "staircase",
        ),
        (
            {"system": {"type": "expr", "text": "1/(s+1)"}, "input": {"type": "sampled", "times": [1, 1],
             "values": [1, 2]}},
            "input.times",
            "increasing",
        ),
        (
            {"system": {"type": "ss", "A": [[-1]], "B": [[1, 2]], "C": [[1]]}, "input": STEP},
            "system.B",
            "2 inputs",
        ),
        ({"system": {"type": "ss", "A": [[-1, 0]], "B": [[1]], "C": [[1]]}, "input": STEP}, "system.A", "1 x 2"),
        ({"system": {"type": "expr", "text": "1/(s+1)"}, "input": {"type": "noise"}}, "input", "step"),
    ],
)  # fmt: skip
def test_refusals_name_the_place(post: Any, request_: dict[str, Any], path: str, word: str) -> None:
    answer = post("/response", request_)
    assert answer.status_code == 422, answer.text
    error = answer.json()["error"]
    assert error["path"] == path
    assert word in error["message"]
