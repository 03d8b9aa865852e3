"""The plants that come with looplab: every document is in order, and says what the notes say."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from looplab.engine.nonlinear import compile_model
from looplab.engine.nonlinear.simulation import InputCourse, simulate_open_loop
from looplab.engine.response import step
from looplab.plants import UnknownPlant, load_plant, plant_document, plant_ids
from looplab.plants.library import BUILDERS
from looplab.schemas import NonlinearModel
from looplab.schemas.models import json_schema
from looplab.schemas.schema_file import schema_text

FOLDER = Path("server/looplab/plants")


def test_the_list():
    assert {"cstr", "gravity-drained-tank"} <= set(plant_ids())
    assert plant_ids() == sorted(plant_ids())


@pytest.mark.parametrize("plant_id", ["", "CSTR", "../cstr", "models/cstr", "cstr.json", "ctsr", "x" * 1000, "\0"])
def test_an_id_is_looked_up_and_nothing_else(plant_id):
    for find in (load_plant, plant_document):
        with pytest.raises(UnknownPlant):
            find(plant_id)


def test_an_id_mistyped_is_answered_with_the_right_one():
    with pytest.raises(UnknownPlant) as caught:
        load_plant("ctsr")
    assert caught.value.hint == "did you mean cstr?"


def test_a_document_is_the_callers_own():
    plant_document("cstr")["title"] = "changed"
    assert plant_document("cstr")["title"] == "Stirred tank reactor"
    assert load_plant("cstr") is load_plant("cstr")


@pytest.mark.parametrize("plant_id", plant_ids())
def test_a_document_fits_the_schema_and_can_be_computed(plant_id):
    document = plant_document(plant_id)
    assert document["id"] == plant_id
    shape = NonlinearModel.model_validate_json(json.dumps(document))
    plant = load_plant(plant_id)
    if plant_id not in BUILDERS:
        # Within the limits of any author: what is built in is not privileged.
        assert compile_model(shape.to_document()).document == plant.document
    for point in plant.document.operating_points:
        u, p = plant.inputs(point.inputs), plant.parameters(point.parameters)
        x = plant.states(point.near, plant.initial_state(u, p))
        assert plant.jacobians(0.0, x, u, p).A.shape == (len(x), len(x))
        plant.outputs(0.0, x, u, p)


@pytest.mark.parametrize("plant_id", plant_ids())
def test_a_document_explains_itself(plant_id):
    document = plant_document(plant_id)
    assert document["summary"]
    assert re.fullmatch(r"\d+(\.\d+)*(, \d+(\.\d+)*)*", document["notes"])
    for kind in ("parameters", "inputs", "variables", "states", "outputs"):
        for item in document[kind]:
            assert item["meaning"], (kind, item["name"])
            assert item["unit"], (kind, item["name"])
            assert kind not in ("parameters", "inputs") or item["source"]


def test_the_schema_for_editors_is_current(repository):
    written = (repository / FOLDER / "model.schema.json").read_text(encoding="utf-8")
    assert written == schema_text(json_schema()), (
        "run: looplab models schema -o server/looplab/plants/model.schema.json"
    )


def test_every_file_names_the_schema(repository):
    folder = repository / FOLDER / "models"
    for path in folder.glob("*.json"):
        assert (folder / json.loads(path.read_text(encoding="utf-8"))["$schema"]).is_file(), path.name


@pytest.mark.parametrize("name", ["lower", "middle", "upper"])
def test_the_reactor_has_three_steady_states(name):
    """Notes 3.1 with Q = 2e6 at Ti = 350 K: 331.1, 385.1 (unstable) and 529.6 K."""
    plant = load_plant("cstr")
    point = next(point for point in plant.document.operating_points if point.name == name)
    cA, T = point.near["cA"], point.near["T"]
    assert round(T, 1) == {"lower": 331.1, "middle": 385.1, "upper": 529.6}[name]
    # One Newton step from there is shorter than the digits that are given.
    x = plant.states(point.near, plant.x0)
    move = np.linalg.solve(plant.state_jacobian(0.0, x, plant.u0, plant.p0), plant.f(0.0, x, plant.u0, plant.p0))
    assert abs(move[0]) < 1e-5 * max(cA, 0.1) and abs(move[1]) < 1e-3
    growth = np.linalg.eigvals(plant.state_jacobian(0.0, x, plant.u0, plant.p0)).real.max()
    assert (growth > 0) == (name == "middle")


def test_the_reactor_goes_out_from_the_notes_initial_state():
    """Notes 3.1, x0 = (1, 350), Ti from 350 to 450 K at t = 3 min: it lights, and stays hot."""
    plant, t = load_plant("cstr"), np.linspace(0, 100, 401)
    cold = simulate_open_loop(plant, t)
    assert cold.x[-1] == pytest.approx([0.99453, 331.094], rel=1e-5)
    hot = simulate_open_loop(plant, t, {"Ti": InputCourse(350.0).plus(step(100.0, 3.0))})
    k = 7.2e10 * math.exp(-1e4 / hot.x[-1, 1])
    # At rest the balances give cA = 1/(1 + k) and T = 430 + 200 k cA.
    assert hot.x[-1, 0] == pytest.approx(1 / (1 + k), rel=1e-6)
    assert hot.x[-1, 1] == pytest.approx(430 + 200 * k / (1 + k), rel=1e-6)
    assert hot.x[-1, 1] > 600


def test_the_tank_drains_in_the_time_of_torricelli():
    """h = (sqrt(h0) - beta t/(2A))^2 without inflow: from 1 m in 2 A/beta = 8 min; below 1 mm 8 (1 - sqrt(0.001))."""
    found = simulate_open_loop(load_plant("gravity-drained-tank"), np.linspace(0, 12, 241), {"Fi": 0.0})
    early = found.t < 7.9
    np.testing.assert_allclose(found.x[early, 0], (1 - found.t[early] / 8) ** 2, atol=1e-7)
    assert [event.message for event in found.events] == ["the tank is empty"]
    assert found.events[0].t == pytest.approx(8 * (1 - math.sqrt(0.001)), abs=1e-5)
    assert found.truncated_at is None
    assert abs(found.x[-1, 0]) < 1e-6


def test_the_tank_overflows():
    found = simulate_open_loop(load_plant("gravity-drained-tank"), np.linspace(0, 50, 201), {"Fi": 0.8})
    assert found.truncated_reason == "the tank overflows"
    assert found.x[-1, 0] == pytest.approx(2.0, abs=1e-9)
    # Separation of variables: t = (2 A/beta^2) [Fi ln((Fi - beta)/(Fi - beta sqrt 2)) - beta (sqrt 2 - 1)]
    exact = 2 * 2 / 0.25 * (0.8 * math.log((0.8 - 0.5) / (0.8 - 0.5 * math.sqrt(2))) - 0.5 * (math.sqrt(2) - 1))
    assert found.truncated_at == pytest.approx(exact, abs=1e-6)
