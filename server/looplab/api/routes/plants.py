"""The plant library: the list, one plant, and its simulation."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any

from fastapi import APIRouter, Body, Path
from starlette.responses import Response

from looplab.api.answers.nonlinear import ControlAnswer, PlantAnswer, PlantList, SimulationAnswer
from looplab.api.docs import BUSY, ERRORS
from looplab.api.encode import json_response
from looplab.api.errors import ApiError
from looplab.api.simulations import (
    ControlRequest,
    RunRequest,
    Workers,
    control_loops,
    matrix_settings,
    open_loop_settings,
)
from looplab.api.strict import StrictRoute
from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import CompiledModel, latex_equations, slowest_time_constant
from looplab.jobs.tasks import PLANT, ModelSource, control, simulate, simulate_matrix
from looplab.labs.text import render_math
from looplab.plants import (
    UnknownPlant,
    group_of,
    load_plant,
    load_transfer_matrix,
    plant_document,
    plant_drawing,
    plant_ids,
    shelved,
    transfer_matrix_document,
    transfer_matrix_ids,
)
from looplab.plants.transfer_matrix import TransferMatrix

router = APIRouter(tags=["plants"], route_class=StrictRoute)

PlantId = Annotated[str, Path(description="The plant's id, as the list has it.", examples=["cstr"])]
NOT_FOUND: dict[int | str, dict[str, Any]] = {404: {**ERRORS[422], "description": "There is no plant of this id."}}
EXAMPLES: dict[str, Any] = {
    "as it is": {"value": {"horizon": 20, "points": 101}},
    "with another solver": {"value": {"horizon": 5, "points": 51, "method": "BDF"}},
}
HELD: dict[str, Any] = {"horizon": 8, "points": 161, "operating_point": "middle"}
COOLED = {"output": "T", "input": "Q"}
CONTROL_EXAMPLES: dict[str, Any] = {
    "the reactor held where it is unstable": {
        "value": {
            **HELD,
            "loops": [
                {
                    **COOLED,
                    "setpoint": {"level": 385.1107, "add": [{"type": "step", "amplitude": 5, "start": 1}]},
                    "controller": {"type": "pid", "Kc": 1e6, "tau_I": 0.5, "action": "direct"},
                    "anti_windup": "back_calculation",
                    "sensor": {"lag": {"tau": 0.05}},
                }
            ],
        }
    },
    "with a sampled controller, noise and a dead time, first in manual": {
        "value": {
            **HELD,
            "loops": [
                {
                    **COOLED,
                    "setpoint": 385.1107,
                    "controller": {"type": "pid", "Kc": 5e5, "tau_I": 1, "action": "direct"},
                    "sampling_time": 0.05,
                    "sensor": {"theta": 0.05},
                    "noise": {"std": 0.2, "seed": 1},
                    "modes": [{"t": 0, "mode": "manual"}, {"t": 0.5, "mode": "auto"}],
                }
            ],
        }
    },
}


@cache
def _summaries() -> list[dict[str, Any]]:
    matrices = transfer_matrix_ids()
    return [
        _matrix_summary(load_transfer_matrix(plant_id)) if plant_id in matrices else _summary(load_plant(plant_id))
        for plant_id in shelved([*plant_ids(), *matrices])
    ]


def _matrix_summary(matrix: TransferMatrix) -> dict[str, Any]:
    return {
        **{name: getattr(matrix, name) for name in ("id", "title", "summary", "notes", "time_unit")},
        "kind": "transfer-matrix",
        "group": group_of(matrix.id),
        "inputs": [each.name for each in matrix.inputs],
        "states": [],
        "outputs": [each.name for each in matrix.outputs],
        "operating_points": [],
        "drawing": plant_drawing(matrix.id),
        "values": {each.name: each.value for each in (*matrix.inputs, *matrix.outputs)},
    }


def _summary(model: CompiledModel) -> dict[str, Any]:
    document = model.document
    return {
        **{name: getattr(document, name) for name in ("id", "title", "summary", "notes", "time_unit")},
        "kind": "nonlinear",
        "group": group_of(document.id),
        "inputs": model.input_names,
        "states": model.state_names,
        "outputs": model.output_names,
        "operating_points": [point.name for point in document.operating_points],
        "drawing": plant_drawing(document.id),
        "values": _values(model),
    }


def _values(model: CompiledModel) -> dict[str, float]:
    """Every signal at the model's own initial state."""
    at = (0.0, model.x0, model.u0, model.p0)
    return {
        **dict(zip(model.parameter_names, model.p0, strict=True)),
        **dict(zip(model.input_names, model.u0, strict=True)),
        **dict(zip(model.variable_names, model.variables(*at), strict=True)),
        **dict(zip(model.output_names, model.outputs(*at), strict=True)),
        **dict(zip(model.state_names, model.x0, strict=True)),
    }


def find_plant(plant_id: str) -> CompiledModel:
    """The plant; raises ApiError 404."""
    if plant_id in transfer_matrix_ids():
        raise InvalidInput("this plant is linear, a transfer matrix", field="plant_id", hint="read or simulate it")
    try:
        return load_plant(plant_id)
    except UnknownPlant as error:
        raise ApiError(404, "not_found", error.message, "plant_id", error.hint) from None


@router.get("/plants", summary="The plants there are", responses={200: {"model": PlantList}})
def list_plants() -> Response:
    """Title, section of the notes and names of the signals of every plant."""
    return json_response({"plants": _summaries()})


def _matrix_answer(matrix: TransferMatrix) -> dict[str, Any]:
    equations = []
    for i, (output, row) in enumerate(zip(matrix.outputs, matrix.entries, strict=True)):
        for j, (given, entry) in enumerate(zip(matrix.inputs, row, strict=True)):
            latex = rf"\frac{{{output.latex}(s)}}{{{given.latex}(s)}} = {entry.to_latex()}"
            path = f"entries[{i}][{j}]"
            equations.append({"path": path, "latex": latex, "mathml": render_math(latex, display=True)})
    return {
        "kind": "transfer-matrix",
        "document": transfer_matrix_document(matrix.id),
        "equations": equations,
        "group": group_of(matrix.id),
        "drawing": plant_drawing(matrix.id),
        "values": {each.name: each.value for each in (*matrix.inputs, *matrix.outputs)},
        "time_scale": max(lag for row in matrix.entries for entry in row for lag in entry.lags),
    }


@router.get(
    "/plants/{plant_id}",
    summary="One plant",
    responses={200: {"model": PlantAnswer}, 422: ERRORS[422], **NOT_FOUND},
)
def show_plant(plant_id: PlantId) -> Response:
    """The plant's document, as an author would write it, its equations as formulas, and its drawing."""
    if plant_id in transfer_matrix_ids():
        return json_response(_matrix_answer(load_transfer_matrix(plant_id)))
    model = find_plant(plant_id)
    equations = [
        {"path": each.path, "latex": each.latex, "mathml": render_math(each.latex, display=True)}
        for each in latex_equations(model)
    ]
    return json_response(
        {
            "kind": "nonlinear",
            "document": plant_document(plant_id),
            "equations": equations,
            "group": group_of(plant_id),
            "drawing": plant_drawing(plant_id),
            "values": _values(model),
            "time_scale": slowest_time_constant(model),
        }
    )


@router.post(
    "/plants/{plant_id}/simulate",
    summary="Simulate a plant",
    responses={200: {"model": SimulationAnswer}, **ERRORS, **NOT_FOUND, **BUSY},
)
async def simulate_plant(
    plant_id: PlantId, request: Annotated[RunRequest, Body(openapi_examples=EXAMPLES)], workers: Workers
) -> Response:
    """States, outputs and inputs of a plant over time, from its own initial state or another one.

    Inputs step, ramp, oscillate, follow a table or carry noise, each a sum of these; events are located. A transfer
    matrix starts at rest, and all its signals are deviations.
    """
    if plant_id in transfer_matrix_ids():
        answer = await workers.run(simulate_matrix, plant_id, matrix_settings(request, load_transfer_matrix(plant_id)))
        return json_response(answer, request.arrays)
    settings = open_loop_settings(request, find_plant(plant_id).document, request.start)
    answer = await workers.run(simulate, ModelSource(PLANT, plant_id), settings)
    return json_response(answer, request.arrays)


@router.post(
    "/plants/{plant_id}/control",
    summary="Control a plant",
    responses={200: {"model": ControlAnswer}, **ERRORS, **NOT_FOUND, **BUSY},
)
async def control_plant(
    plant_id: PlantId, request: Annotated[ControlRequest, Body(openapi_examples=CONTROL_EXAMPLES)], workers: Workers
) -> Response:
    """A plant with up to three PID loops, continuous or sampled, with saturation, manual and auto, valve and sensor."""
    settings = open_loop_settings(request, find_plant(plant_id).document)
    answer = await workers.run(control, ModelSource(PLANT, plant_id), settings, control_loops(request))
    return json_response(answer, request.arrays)
