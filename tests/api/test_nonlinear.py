"""/plants and /models: answers, errors with their places, and hostile models that are cut or refused."""

import math
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from looplab.api.answers.base import Error
from looplab.api.answers.nonlinear import ModelValidation, PlantAnswer, PlantList, SimulationAnswer

DECAY: dict[str, Any] = {
    "id": "decay",
    "title": "Decay",
    "parameters": [{"name": "k", "value": 2, "min": 0}],
    "inputs": [{"name": "u", "value": 0, "min": -5, "max": 5}],
    "states": [{"name": "x", "initial": 1, "equation": "-k*x + u"}],
    "operating_points": [{"name": "driven", "inputs": {"u": 1}, "parameters": {"k": 4}, "near": {"x": 0.25}}],
}


def one_state(equation: str, **more: Any) -> dict[str, Any]:
    return {"id": "test", "title": "Test", "states": [{"name": "x", "initial": 1, "equation": equation}], **more}


def simulated(post: Any, path: str, body: Any) -> dict[str, Any]:
    response = post(path, body)
    assert response.status_code == 200, response.text
    SimulationAnswer.model_validate_json(response.content)
    answer: dict[str, Any] = response.json()
    return answer


def refused(post: Any, path: str, body: Any) -> Any:
    response = post(path, body)
    assert response.status_code == 422, response.text
    return Error.model_validate_json(response.content).error


def test_the_list_of_plants(client: Any) -> None:
    answer = client.get("/api/v1/plants")
    plants = PlantList.model_validate_json(answer.content).plants
    reactor = next(plant for plant in plants if plant.id == "cstr")
    assert reactor.inputs == ["Fi", "cAi", "Ti", "Q"]
    assert reactor.time_unit == "min"
    assert "middle" in reactor.operating_points


def test_one_plant(client: Any, post: Any) -> None:
    answer = client.get("/api/v1/plants/gravity-drained-tank")
    plant = PlantAnswer.model_validate_json(answer.content)
    level = next(equation for equation in plant.equations if equation.path == "states[0].equation")
    assert level.latex == r"\frac{d h}{dt} = \frac{F_i - F}{A}"
    assert level.mathml.startswith("<math")
    # The document is one that the other routes take.
    assert post("/models/validate", plant.document).json()["valid"]
    body = {"horizon": 5, "points": 11}
    theirs = simulated(post, "/models/simulate", {"model": plant.document, **body})
    assert theirs == simulated(post, "/plants/gravity-drained-tank/simulate", body)


@pytest.mark.parametrize(
    "path", ["/plants/nowhere", "/plants/..%2fcstr", "/plants/cstr.json", "/plants/nowhere/simulate"]
)
def test_no_such_plant(client: Any, path: str) -> None:
    ask = client.post if path.endswith("simulate") else client.get
    answer = ask(f"/api/v1{path}", **({"json": {"horizon": 1}} if path.endswith("simulate") else {}))
    assert answer.status_code == 404
    assert Error.model_validate_json(answer.content).error.code == "not_found"


def test_a_simulation_against_its_closed_form(post: Any) -> None:
    """x' = -2 x + u: a step of 3 at t = 1 adds 1.5 (1 - e^{-2(t-1)})."""
    inputs = {"u": {"add": [{"type": "step", "amplitude": 3, "start": 1}]}}
    answer = simulated(post, "/models/simulate", {"model": DECAY, "horizon": 4, "points": 9, "inputs": inputs})
    t = np.array(answer["t"])
    exact = np.exp(-2 * t) + np.where(t > 1, 1.5 * (1 - np.exp(-2 * (t - 1))), 0)
    np.testing.assert_allclose(answer["states"]["x"], exact, rtol=1e-7)
    assert answer["outputs"] == answer["states"]
    assert answer["inputs"]["u"] == [0, 0, 3, 3, 3, 3, 3, 3, 3]
    assert answer["truncated_at"] is None
    assert answer["time_unit"] == "s"


def test_an_operating_point_sets_what_is_not_set(post: Any) -> None:
    body = {"model": DECAY, "horizon": 1, "points": 2, "operating_point": "driven"}
    assert simulated(post, "/models/simulate", body)["states"]["x"] == [0.25, pytest.approx(0.25, rel=1e-9)]
    other = simulated(post, "/models/simulate", {**body, "initial": {"x": 1}, "inputs": {"u": {"level": 2}}})
    assert other["states"]["x"][1] == pytest.approx(0.5 + 0.5 * math.exp(-4), rel=1e-7)
    added = simulated(post, "/models/simulate", {**body, "inputs": {"u": {"add": [{"type": "step", "amplitude": 1}]}}})
    assert added["inputs"]["u"] == [2, 2]


def test_arrays_can_be_packed(post: Any) -> None:
    body = {"horizon": 1, "points": 3, "arrays": "f4"}
    assert simulated(post, "/plants/cstr/simulate", body)["outputs"]["T"]["dtype"] == "f4"


def test_noise_is_repeatable(post: Any) -> None:
    inputs = {"u": {"add": [{"type": "noise", "std": 0.5, "interval": 0.1, "seed": 4}]}}
    body = {"model": DECAY, "horizon": 4, "points": 41, "inputs": inputs}
    first, again = (simulated(post, "/models/simulate", body) for _ in range(2))
    assert first == again
    assert len(set(first["inputs"]["u"])) > 30


def test_events_and_cuts_are_told(post: Any) -> None:
    body = {"horizon": 60, "points": 61, "inputs": {"Fi": 0.8}}
    answer = simulated(post, "/plants/gravity-drained-tank/simulate", body)
    assert [event["name"] for event in answer["events"]] == ["overflow"]
    assert answer["truncated_reason"] == "the tank overflows"
    assert answer["t"][-1] == answer["truncated_at"] == answer["events"][0]["t"]
    assert answer["states"]["h"][-1] == pytest.approx(2, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"horizon": -1}, "horizon"),
        ({"points": 5001}, "points"),
        ({"method": "Euler"}, "method"),
        ({"operating_point": "nowhere"}, "operating_point"),
        ({"inputs": {"v": 1}}, "inputs.v"),
        ({"inputs": {"u": 6}}, "inputs.u"),
        ({"inputs": {"u": "1"}}, "inputs.u"),
        ({"inputs": {"u": {"level": 1, "table": {"times": [0], "values": [1]}}}}, "inputs.u.table"),
        ({"inputs": {"u": {"table": {"times": [0, 1], "values": [1]}}}}, "inputs.u.table.values"),
        ({"inputs": {"u": {"add": [{"type": "impulse"}]}}}, "inputs.u.add[0]"),
        ({"inputs": {"u": {"add": [{"type": "noise", "std": 1, "interval": 1e-6}]}}}, "inputs.u.add[0].interval"),
        ({"inputs": {"u": {"add": [{"type": "ramp", "slope": 10}]}}}, "inputs.u"),
        ({"parameters": {"k": -1}}, "parameters.k"),
        ({"parameters": {"kk": 1}}, "parameters.kk"),
        ({"initial": {"y": 1}}, "initial.y"),
        ({"model": {**DECAY, "states": []}}, "model.states"),
        ({"model": {**DECAY, "nonsense": 1}}, "model.nonsense"),
        ({"model": one_state("-k*x")}, "model.states[0].equation"),
        ({"model": one_state("log(x - 2)")}, "model.states[0].equation"),
        ({"model": one_state("x", id="Not one")}, "model.id"),
    ],
)
def test_a_mistake_has_its_place(post: Any, change: dict[str, Any], path: str) -> None:
    error = refused(post, "/models/simulate", {"model": DECAY, "horizon": 1, **change})
    assert error.path == path, error


@pytest.mark.parametrize("method", ["LSODA", "RK45", "Radau", "BDF"])
@pytest.mark.parametrize(
    "equation",
    [
        *("x^2", "1000*x", "-sign(x)", "if(x > 0, -1, 1)*1e6", "sqrt(1 - t)*x", "exp(x)", "-1/x", "1e6*cos(1e6*t)"),
        *("1e308*x", "tan(t)", "-1e9*(x - cos(t))"),
    ],
)
def test_a_hostile_model_is_cut(post: Any, equation: str, method: str) -> None:
    """Within the workers' budget of 2 s of processor time, and with a reason."""
    body = {"model": one_state(equation), "horizon": 10, "method": method}
    answer = simulated(post, "/models/simulate", body)
    stiff_only = equation.startswith("-1e9") and method != "RK45"
    assert (answer["truncated_at"] is None) == stiff_only
    assert (answer["truncated_reason"] is None) == stiff_only


@pytest.mark.parametrize(
    ("equation", "words"),
    [
        ("9^9^9", "leave the range"),
        ("1e999*x", "too large"),
        ("(" * 60 + "x" + ")" * 60, "nested deeper"),
        ("exp(" * 60 + "x" + ")" * 60, "nested deeper"),
        ("x" + "+x" * 200, "more than 200 parts"),
        ("x + " + "1" * 600, "longer than 500"),
        ("__import__('os').system('true')", "cannot be read"),
        ("x.__class__", "cannot be read"),
        ("open(x)", "not a function"),
        ("f'{x}'", "cannot be read"),
        ("x; x", "cannot be read"),
    ],
)
def test_a_hostile_formula_is_refused(post: Any, equation: str, words: str) -> None:
    error = refused(post, "/models/simulate", {"model": one_state(equation), "horizon": 1})
    assert words in error.message
    assert error.path == "model.states[0].equation"


def test_a_model_with_too_many_operations_is_refused(post: Any) -> None:
    growing = [{"name": "v0", "expression": "x"}] + [
        {"name": f"v{i}", "expression": " + ".join(f"sin({k}*v{i - 1})" for k in range(2, 30))} for i in range(1, 36)
    ]
    error = refused(post, "/models/simulate", {"model": one_state("v35", variables=growing), "horizon": 1})
    assert "2000 operations" in error.message


def test_a_model_in_order_is_shown_as_formulas(post: Any) -> None:
    answer = ModelValidation.model_validate_json(post("/models/validate", DECAY).content)
    assert answer.valid
    assert [equation.latex for equation in answer.equations] == [r"\frac{d x}{dt} = -k \, x + u"]
    assert answer.equations[0].mathml.startswith("<math")


def test_every_formula_that_cannot_be_read_is_told_at_once(post: Any) -> None:
    draft = deepcopy(DECAY)
    draft["variables"] = [{"name": "v", "expression": "2*("}, {"name": "w", "expression": "q*v"}]
    draft["states"][0] |= {"equation": "-kk*x", "initial": "x"}
    draft["outputs"] = [{"name": "y", "expression": "2x"}]
    draft["events"] = [{"name": "e", "when": "x"}]
    answer = ModelValidation.model_validate_json(post("/models/validate", draft).content)
    assert not answer.valid
    assert {(problem.path, problem.column) for problem in answer.problems} == {
        ("variables[0].expression", 4),
        ("variables[1].expression", 1),
        ("states[0].equation", 2),
        ("states[0].initial", 1),
        ("outputs[0].expression", 2),
        ("events[0].when", 2),
    }
    assert next(p for p in answer.problems if p.path == "states[0].equation").hint == "did you mean k?"


@pytest.mark.parametrize(
    ("draft", "path"),
    [
        ({}, "id"),
        ({"id": "x", "title": "X", "states": 3}, "states"),
        (one_state("1/(x - 1)"), "states[0].equation"),
        (one_state("a", variables=[{"name": "a", "expression": "a"}]), "variables[0].expression"),
    ],
)
def test_a_draft_is_judged_not_refused(post: Any, draft: dict[str, Any], path: str) -> None:
    response = post("/models/validate", draft)
    assert response.status_code == 200
    assert response.json()["problems"][0]["path"] == path


@pytest.mark.parametrize("depth", [50, 400, 1000])
def test_a_document_nested_deeply_does_no_harm(post: Any, depth: int) -> None:
    nested = b'{"a":' * depth + b"1" + b"}" * depth
    for key in (b"schematic", b"states", b"x"):
        draft = b'{"id": "n", "title": "N", "states": [{"name": "x", "initial": 1, "equation": "-x"}], "%s": %s}'
        body = draft % (key, nested)
        for path, sent in (("/models/validate", body), ("/models/simulate", b'{"horizon": 1, "model": %s}' % body)):
            assert post(path, sent).status_code in (200, 400, 422)
    assert post("/models/validate", DECAY).json()["valid"]


def test_symbols_that_are_no_latex_leave_the_formula_out(post: Any) -> None:
    draft = deepcopy(DECAY)
    draft["states"][0]["latex"] = r"\frac{"
    answer = post("/models/validate", draft).json()
    assert answer["valid"]
    assert answer["equations"][0]["mathml"] == ""


def test_a_run_goes_on_where_one_ended(post: Any) -> None:
    course = {"T_f": {"add": [{"type": "step", "amplitude": 80, "start": 3}]}}
    whole = simulated(post, "/plants/thermometer/simulate", {"horizon": 6, "points": 61, "inputs": course})
    first = simulated(post, "/plants/thermometer/simulate", {"horizon": 2, "points": 21, "inputs": course})
    rest = simulated(
        post,
        "/plants/thermometer/simulate",
        {
            "start": 2,
            "horizon": 4,
            "points": 41,
            "inputs": course,
            "initial": {name: values[-1] for name, values in first["states"].items()},
        },
    )
    # The step comes at t = 3 of the clock, not of the request.
    assert rest["t"][0] == 2
    assert rest["t"][-1] == 6
    np.testing.assert_allclose(rest["states"]["T_m"], whole["states"]["T_m"][20:], rtol=1e-7)


def test_a_run_tells_the_variables(client: Any, post: Any) -> None:
    document = client.get("/api/v1/plants/gravity-drained-tank").json()["document"]
    beta = next(each["value"] for each in document["parameters"] if each["name"] == "beta")
    answer = simulated(post, "/plants/gravity-drained-tank/simulate", {"horizon": 5, "points": 11, "inputs": {"Fi": 1}})
    np.testing.assert_allclose(answer["variables"]["F"], beta * np.sqrt(answer["states"]["h"]), rtol=1e-14)


def test_a_plant_comes_with_its_drawing_its_values_and_its_pace(client: Any) -> None:
    plant = client.get("/api/v1/plants/gravity-drained-tank").json()
    values = {each["name"]: each["value"] for each in plant["document"]["parameters"]}
    h = plant["document"]["states"][0]["initial"]
    # dh/dt = (Fi - beta sqrt(h))/A: the time constant is 2 A sqrt(h)/beta.
    assert plant["time_scale"] == pytest.approx(2 * values["A"] * math.sqrt(h) / values["beta"], rel=1e-14)
    assert plant["values"]["F"] == pytest.approx(values["beta"] * math.sqrt(h), rel=1e-14)
    assert plant["drawing"]["shapes"]
    assert plant["group"] == "Tanks"


def test_a_transfer_matrix_among_the_plants(client: Any, post: Any) -> None:
    plants = PlantList.model_validate_json(client.get("/api/v1/plants").content).plants
    assert {plant.kind for plant in plants} == {"nonlinear", "transfer-matrix"}
    answer = PlantAnswer.model_validate_json(client.get("/api/v1/plants/ethanol-water").content)
    assert answer.kind == "transfer-matrix"
    assert answer.equations[0].path == "entries[0][0]"
    assert answer.equations[0].latex == r"\frac{y_1(s)}{u_1(s)} = \frac{0.66 e^{-2.6 s}}{6.7 s + 1}"
    steps = {"u1": {"add": [{"type": "step", "amplitude": 0.1, "start": 1}]}}
    found = simulated(post, "/plants/ethanol-water/simulate", {"horizon": 40, "points": 81, "inputs": steps})
    late = np.maximum(np.array(found["t"]) - 3.6, 0)
    np.testing.assert_allclose(found["outputs"]["y1"], 0.066 * (1 - np.exp(-late / 6.7)), atol=1e-12)
    assert found["states"] == {} and found["inputs"]["u2"] == [0.0] * 81


@pytest.mark.parametrize(
    ("more", "field"),
    [
        ({"parameters": {"K": 1}}, "parameters"),
        ({"initial": {"y1": 1}}, "initial"),
        ({"start": 2}, "start"),
        ({"operating_point": "nominal"}, "operating_point"),
        ({"inputs": {"R": 1}}, "inputs.R"),
    ],
)
def test_a_transfer_matrix_has_inputs_only(post: Any, more: dict[str, Any], field: str) -> None:
    assert refused(post, "/plants/ethanol-water/simulate", {"horizon": 10, **more}).path == field


def test_a_transfer_matrix_is_not_controlled(post: Any) -> None:
    loop = {"output": "y1", "input": "u1", "setpoint": 0, "controller": {"type": "pid", "Kc": 1}}
    assert refused(post, "/plants/ethanol-water/control", {"horizon": 10, "loops": [loop]}).path == "plant_id"
