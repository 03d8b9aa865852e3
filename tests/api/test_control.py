"""/plants/{id}/control and /models/control: answers, errors with their places, hostile loops."""

from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from looplab.api.answers.base import Error
from looplab.api.answers.nonlinear import ControlAnswer
from looplab.api.routes.models import CONTROL_EXAMPLES
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
from looplab.engine.systems import parse_transfer_function

LAG: dict[str, Any] = {
    "id": "lag",
    "title": "Two lags",
    "inputs": [{"name": "u", "value": 0, "min": -5, "max": 5}],
    "states": [{"name": "x", "initial": 0, "equation": "u - x"}, {"name": "y", "initial": 0, "equation": "x - y"}],
}
LOOP: dict[str, Any] = {
    "output": "y",
    "input": "u",
    "setpoint": {"level": 0, "add": [{"type": "step"}]},
    "controller": {"type": "pid", "Kc": 3, "tau_I": 2},
}
BODY: dict[str, Any] = {"model": LAG, "horizon": 10, "points": 101, "loops": [LOOP]}


def controlled(post: Any, path: str, body: Any) -> dict[str, Any]:
    response = post(path, body)
    assert response.status_code == 200, response.text
    ControlAnswer.model_validate_json(response.content)
    answer: dict[str, Any] = response.json()
    return answer


def changed(**more: Any) -> dict[str, Any]:
    return {**BODY, "loops": [{**LOOP, **more}]}


def test_a_linear_model_is_the_linear_loop(post: Any) -> None:
    answer = controlled(post, "/models/control", BODY)
    exact = closed_loop_step(FeedbackLoop(parse_transfer_function("1/(s+1)^2"), PID(3.0, 2.0)), 10.0, 101).setpoint
    np.testing.assert_allclose(answer["outputs"]["y"], exact.y, atol=1e-6)
    loop = answer["loops"][0]
    np.testing.assert_allclose(loop["u"], exact.u, atol=1e-6)
    assert loop["u"] == answer["inputs"]["u"]
    assert loop["y_m"] == answer["outputs"]["y"]
    assert loop["modes"] == [{"t": 0.0, "mode": "auto"}]
    assert loop["metrics"]["overshoot_pct"] > 10
    assert answer["truncated_at"] is None


def test_the_parallel_form_is_the_same_controller(post: Any) -> None:
    parallel = changed(controller={"type": "pid", "form": "parallel", "Kp": 3, "Ki": 1.5})
    ours, theirs = controlled(post, "/models/control", BODY), controlled(post, "/models/control", parallel)
    assert ours["outputs"] == theirs["outputs"]


def test_modes_and_saturation_show(post: Any) -> None:
    body = changed(
        modes=[{"t": 2, "mode": "manual", "value": 0.5}, {"t": 5, "mode": "auto"}], u_max=1.2, sampling_time=0.1
    )
    loop = controlled(post, "/models/control", body)["loops"][0]
    assert loop["modes"] == [{"t": 0, "mode": "auto"}, {"t": 2, "mode": "manual"}, {"t": 5, "mode": "auto"}]
    assert max(loop["u"]) == 1.2 < max(loop["u_command"])
    assert loop["metrics"]["saturated_pct"] > 0


def test_a_plant_with_two_loops(post: Any) -> None:
    body = {
        "horizon": 2,
        "points": 41,
        "operating_point": "middle",
        "loops": [
            {**LOOP, "output": "T", "input": "Q", "setpoint": 385.1107,
             "controller": {"type": "pid", "Kc": 1e6, "tau_I": 0.5, "action": "direct"}},
            {**LOOP, "output": "cA", "input": "cAi", "setpoint": 0.724446,
             "controller": {"type": "pid", "Kc": 0.5, "tau_I": 2}, "sampling_time": 0.1},
        ],
    }  # fmt: skip
    answer = controlled(post, "/plants/cstr/control", body)
    np.testing.assert_allclose(answer["outputs"]["T"], 385.1107, atol=1e-2)
    assert [loop["input"] for loop in answer["loops"]] == ["Q", "cAi"]


def test_arrays_may_be_packed(post: Any) -> None:
    answer = controlled(post, "/models/control", {**BODY, "arrays": "f4"})
    assert answer["loops"][0]["u"]["dtype"] == "f4"


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"output": "z"}, "loops[0].output"),
        ({"u_max": 9}, "loops[0].u_max"),
        ({"setpoint": {"add": [{"type": "step"}]}}, "loops[0].setpoint.level"),
        ({"setpoint": {"table": {"times": [1, 1], "values": [0, 0]}}}, "loops[0].setpoint.table.times"),
        ({"controller": {"type": "tf", "num": [1], "den": [1]}}, "loops[0].controller"),
        ({"controller": {"type": "pid", "Kc": 1, "tau_D": 1, "alpha": 0}}, "loops[0].controller.alpha"),
        ({"controller": {"type": "pid", "Kc": 1, "form": "series"}}, "loops[0].controller.form"),
        ({"valve": {"lag": {"tau": 1, "zeta": 1, "rate": 1}}}, "loops[0].valve.lag.rate"),
        ({"sensor": {"lag": {"tau": 0}}}, "loops[0].sensor.lag.tau"),
        ({"modes": [{"t": 1, "mode": "auto", "value": 1}]}, "loops[0].modes[0].value"),
        ({"noise": {"std": 1}}, "loops[0].noise.interval"),
        ({"sampling_time": 1e-9}, "loops[0].sampling_time"),
        ({"hope": 1}, "loops[0].hope"),
    ],
)
def test_what_is_wrong_has_its_place(post: Any, change: dict[str, Any], path: str) -> None:
    response = post("/models/control", changed(**change))
    assert response.status_code == 422, response.text
    assert Error.model_validate_json(response.content).error.path == path


def test_an_algebraic_loop_is_refused_with_a_way_out(post: Any) -> None:
    body = deepcopy(BODY)
    body["model"]["outputs"] = [{"name": "y", "expression": "x + u"}]
    response = post("/models/control", body)
    assert response.status_code == 422
    error = Error.model_validate_json(response.content).error
    assert error.path == "loops[0]"
    assert "sampling time" in (error.hint or "")


def test_an_equation_that_fails_is_in_the_model(post: Any) -> None:
    body = deepcopy(BODY)
    body["model"]["states"][0]["equation"] = "u - log(x)"
    response = post("/models/control", body)
    assert response.status_code == 422
    assert Error.model_validate_json(response.content).error.path == "model.states[0].equation"


def test_a_wild_loop_is_cut_with_its_reason(post: Any) -> None:
    body = changed(controller={"type": "pid", "Kc": 1e9, "tau_I": 1e-3}, sampling_time=0.1, u_max=5)
    body["model"] = {**LAG, "inputs": [{"name": "u", "value": 0}]}
    answer = controlled(post, "/models/control", body)
    assert answer["truncated_at"] is not None
    assert answer["truncated_reason"]


def test_the_example_winds_up_and_clamping_does_not(post: Any) -> None:
    wound = deepcopy(CONTROL_EXAMPLES["a level whose integral winds up"]["value"])
    held = deepcopy(wound)
    held["loops"][0]["anti_windup"] = "clamping"
    errors = [controlled(post, "/models/control", body)["loops"][0]["metrics"]["IAE"] for body in (wound, held)]
    assert errors[0] > 1.3 * errors[1]
