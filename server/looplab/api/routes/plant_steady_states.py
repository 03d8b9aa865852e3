"""Steady states of plants, their linear models, phase planes and balances."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body
from starlette.responses import Response

from looplab.api.answers.steady import (
    BalanceAnswer,
    ContinuationAnswer,
    LinearizeAnswer,
    PhasePlaneAnswer,
    SteadyStatesAnswer,
)
from looplab.api.docs import BUSY, ERRORS
from looplab.api.encode import json_response
from looplab.api.routes.plants import NOT_FOUND, PlantId, find_plant
from looplab.api.simulations import Workers
from looplab.api.steady import (
    BalanceRequest,
    ContinuationRequest,
    LinearizeRequest,
    PhasePlaneRequest,
    SteadyStatesRequest,
)
from looplab.api.strict import StrictRoute
from looplab.jobs.linear_tasks import linear_model, plane
from looplab.jobs.steady_tasks import balance, continuation, steady_states
from looplab.jobs.tasks import PLANT, ModelSource

router = APIRouter(tags=["plants"], route_class=StrictRoute)

EXAMPLES: dict[str, dict[str, Any]] = {
    "steady-states": {
        "a reactor": {"value": {"operating_point": "middle"}},
        "looked for in part of the range": {"value": {"box": {"T": [300, 400]}, "starts": 20}},
    },
    "continuation": {
        "over an input": {"value": {"over": "Ti"}},
        "over part of a parameter's range": {"value": {"over": "V", "low": 50, "high": 200, "starts": 10}},
    },
    "linearize": {
        "small and large steps": {
            "value": {"operating_point": "lower", "input": "Q", "output": "T", "steps": [-1e5, -1.5e6], "horizon": 10}
        },
        "at a point": {"value": {"at": "point", "near": {"T": 400}}},
    },
    "phase-plane": {
        "a reactor": {
            "value": {
                "ranges": {"cA": [0, 1], "T": [300, 600]},
                "grid": 11,
                "starts": [{"cA": 0.5, "T": 400}, {"cA": 0.9, "T": 350}],
            }
        }
    },
    "balance": {"heat generated and removed": {"value": {"state": "T", "low": 300, "high": 600}}},
}


@router.post(
    "/plants/{plant_id}/steady-states",
    summary="Steady states of a plant",
    responses={200: {"model": SteadyStatesAnswer}, **ERRORS, **NOT_FOUND, **BUSY},
)
async def plant_steady_states(
    plant_id: PlantId,
    request: Annotated[SteadyStatesRequest, Body(openapi_examples=EXAMPLES["steady-states"])],
    workers: Workers,
) -> Response:
    """Every steady state that many starts lead to, with eigenvalues and verdict.

    Not finding one proves nothing: `starts` and `converged` say how far the search went.
    """
    settings = request.settings(find_plant(plant_id).document)
    return json_response(await workers.run(steady_states, ModelSource(PLANT, plant_id), settings, request.options()))


@router.post(
    "/plants/{plant_id}/continuation",
    summary="Steady states over a quantity, of a plant",
    responses={200: {"model": ContinuationAnswer}, **ERRORS, **NOT_FOUND, **BUSY},
)
async def plant_continuation(
    plant_id: PlantId,
    request: Annotated[ContinuationRequest, Body(openapi_examples=EXAMPLES["continuation"])],
    workers: Workers,
) -> Response:
    """Steady states followed over an input or a parameter, around turning points, stable and unstable ones.

    Turning points and Hopf points are located; a branch that no search meets is missed.
    """
    settings = request.settings(find_plant(plant_id).document)
    return json_response(await workers.run(continuation, ModelSource(PLANT, plant_id), settings, request.options()))


@router.post(
    "/plants/{plant_id}/linearize",
    summary="The linear model of a plant",
    responses={200: {"model": LinearizeAnswer}, **ERRORS, **NOT_FOUND, **BUSY},
)
async def plant_linearize(
    plant_id: PlantId,
    request: Annotated[LinearizeRequest, Body(openapi_examples=EXAMPLES["linearize"])],
    workers: Workers,
) -> Response:
    """A, B, C, D by exact derivatives at a steady state or at any point, and one channel of it.

    Steps show how far it holds: the same step of the input, by the linear and by the nonlinear model.
    """
    settings = request.settings(find_plant(plant_id).document)
    return json_response(await workers.run(linear_model, ModelSource(PLANT, plant_id), settings, request.options()))


@router.post(
    "/plants/{plant_id}/phase-plane",
    summary="The phase plane of a plant",
    responses={200: {"model": PhasePlaneAnswer}, **ERRORS, **NOT_FOUND, **BUSY},
)
async def plant_phase_plane(
    plant_id: PlantId,
    request: Annotated[PhasePlaneRequest, Body(openapi_examples=EXAMPLES["phase-plane"])],
    workers: Workers,
) -> Response:
    """Directions, nullclines, steady states and trajectories of two states, the others held."""
    settings = request.settings(find_plant(plant_id).document)
    return json_response(await workers.run(plane, ModelSource(PLANT, plant_id), settings, request.options()))


@router.post(
    "/plants/{plant_id}/balance",
    summary="A balance over one state of a plant",
    responses={200: {"model": BalanceAnswer}, **ERRORS, **NOT_FOUND, **BUSY},
)
async def plant_balance(
    plant_id: PlantId, request: Annotated[BalanceRequest, Body(openapi_examples=EXAMPLES["balance"])], workers: Workers
) -> Response:
    """The rate of one state with the others at rest, and variables along it: heat generated and removed, say."""
    settings = request.settings(find_plant(plant_id).document)
    return json_response(await workers.run(balance, ModelSource(PLANT, plant_id), settings, request.options()))
