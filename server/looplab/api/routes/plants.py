"""The plant library: the list, one plant, and its simulation."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any

from fastapi import APIRouter, Body, Path
from starlette.responses import Response

from looplab.api.answers.nonlinear import PlantAnswer, PlantList, SimulationAnswer
from looplab.api.docs import BUSY, ERRORS
from looplab.api.encode import json_response
from looplab.api.errors import ApiError
from looplab.api.simulations import SimulationRequest, Workers, open_loop_settings
from looplab.api.strict import StrictRoute
from looplab.engine.nonlinear import CompiledModel, latex_equations
from looplab.jobs.tasks import PLANT, ModelSource, simulate
from looplab.labs.text import render_math
from looplab.plants import UnknownPlant, load_plant, plant_document, plant_ids

router = APIRouter(tags=["plants"], route_class=StrictRoute)

PlantId = Annotated[str, Path(description="The plant's id, as the list has it.", examples=["cstr"])]
NOT_FOUND: dict[int | str, dict[str, Any]] = {404: {**ERRORS[422], "description": "There is no plant of this id."}}
EXAMPLES: dict[str, Any] = {
    "as it is": {"value": {"horizon": 20, "points": 101}},
    "with another solver": {"value": {"horizon": 5, "points": 51, "method": "BDF"}},
}


@cache
def _summaries() -> list[dict[str, Any]]:
    return [_summary(load_plant(plant_id)) for plant_id in plant_ids()]


def _summary(model: CompiledModel) -> dict[str, Any]:
    document = model.document
    return {
        **{name: getattr(document, name) for name in ("id", "title", "summary", "notes", "time_unit")},
        "inputs": model.input_names,
        "states": model.state_names,
        "outputs": model.output_names,
        "operating_points": [point.name for point in document.operating_points],
    }


def _find(plant_id: str) -> CompiledModel:
    try:
        return load_plant(plant_id)
    except UnknownPlant as error:
        raise ApiError(404, "not_found", error.message, "plant_id", error.hint) from None


@router.get("/plants", summary="The plants there are", responses={200: {"model": PlantList}})
def list_plants() -> Response:
    """Title, section of the notes and names of the signals of every plant."""
    return json_response({"plants": _summaries()})


@router.get(
    "/plants/{plant_id}",
    summary="One plant",
    responses={200: {"model": PlantAnswer}, 422: ERRORS[422], **NOT_FOUND},
)
def show_plant(plant_id: PlantId) -> Response:
    """The plant's document, as an author would write it, and its equations as formulas."""
    equations = [
        {"path": each.path, "latex": each.latex, "mathml": render_math(each.latex, display=True)}
        for each in latex_equations(_find(plant_id))
    ]
    return json_response({"document": plant_document(plant_id), "equations": equations})


@router.post(
    "/plants/{plant_id}/simulate",
    summary="Simulate a plant",
    responses={200: {"model": SimulationAnswer}, **ERRORS, **NOT_FOUND, **BUSY},
)
async def simulate_plant(
    plant_id: PlantId, request: Annotated[SimulationRequest, Body(openapi_examples=EXAMPLES)], workers: Workers
) -> Response:
    """States, outputs and inputs of a plant over time, from its own initial state or another one.

    Inputs step, ramp, oscillate, follow a table or carry noise, each a sum of these; events are located.
    """
    settings = open_loop_settings(request, _find(plant_id).document)
    answer = await workers.run(simulate, ModelSource(PLANT, plant_id), settings)
    return json_response(answer, request.arrays)
