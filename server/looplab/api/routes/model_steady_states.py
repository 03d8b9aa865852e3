"""Steady states of models that come with the request, their linear models, phase planes and balances."""

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
from looplab.jobs.tasks import ModelSource
from looplab.schemas import NonlinearModel

router = APIRouter(tags=["models"], route_class=StrictRoute)

ALLEE: dict[str, Any] = {
    "id": "herd",
    "title": "A herd with a least size",
    "parameters": [{"name": "least", "value": 0.3, "min": 0.01, "max": 1}],
    "inputs": [{"name": "hunt", "value": 0, "min": 0, "max": 0.5}],
    "variables": [{"name": "growth", "expression": "n*(n - least)*(1 - n)"}],
    "states": [
        {"name": "n", "initial": 1, "equation": "growth - hunt*n", "min": -0.1, "max": 2},
        {"name": "hunters", "initial": 0.1, "equation": "hunt - hunters", "min": -0.1, "max": 2},
    ],
}
EXAMPLES: dict[str, dict[str, Any]] = {
    "steady-states": {"a herd": {"value": {"model": ALLEE, "starts": 30}}},
    "continuation": {"hunting": {"value": {"model": ALLEE, "over": "hunt", "starts": 10}}},
    "linearize": {
        "at the large herd": {"value": {"model": ALLEE, "near": {"n": 1}, "steps": [0.01, 0.2]}},
        "no equilibrium": {"value": {"model": ALLEE, "at": "point", "near": {"n": 0.5}}},
    },
    "phase-plane": {"a herd": {"value": {"model": ALLEE, "grid": 11, "starts": [{"n": 0.5}]}}},
    "balance": {"growth": {"value": {"model": ALLEE, "state": "n", "curves": ["growth"]}}},
}


class ModelSteadyStatesRequest(SteadyStatesRequest):
    """The same of a model."""

    model: NonlinearModel


class ModelContinuationRequest(ContinuationRequest):
    """The same of a model."""

    model: NonlinearModel


class ModelLinearizeRequest(LinearizeRequest):
    """The same of a model."""

    model: NonlinearModel


class ModelPhasePlaneRequest(PhasePlaneRequest):
    """The same of a model."""

    model: NonlinearModel


class ModelBalanceRequest(BalanceRequest):
    """The same of a model."""

    model: NonlinearModel


@router.post(
    "/models/steady-states",
    summary="Steady states of a model",
    responses={200: {"model": SteadyStatesAnswer}, **ERRORS, **BUSY},
)
async def model_steady_states(
    request: Annotated[ModelSteadyStatesRequest, Body(openapi_examples=EXAMPLES["steady-states"])], workers: Workers
) -> Response:
    """Every steady state that many starts lead to, with eigenvalues and verdict.

    Not finding one proves nothing: `starts` and `converged` say how far the search went.
    """
    source = ModelSource.document(request.model.to_document())
    return json_response(await workers.run(steady_states, source, request.settings(request.model), request.options()))


@router.post(
    "/models/continuation",
    summary="Steady states over a quantity, of a model",
    responses={200: {"model": ContinuationAnswer}, **ERRORS, **BUSY},
)
async def model_continuation(
    request: Annotated[ModelContinuationRequest, Body(openapi_examples=EXAMPLES["continuation"])], workers: Workers
) -> Response:
    """Steady states followed over an input or a parameter, around turning points, stable and unstable ones.

    Turning points and Hopf points are located; a branch that no search meets is missed.
    """
    source = ModelSource.document(request.model.to_document())
    return json_response(await workers.run(continuation, source, request.settings(request.model), request.options()))


@router.post(
    "/models/linearize",
    summary="The linear model of a model",
    responses={200: {"model": LinearizeAnswer}, **ERRORS, **BUSY},
)
async def model_linearize(
    request: Annotated[ModelLinearizeRequest, Body(openapi_examples=EXAMPLES["linearize"])], workers: Workers
) -> Response:
    """A, B, C, D by exact derivatives at a steady state or at any point, and one channel of it.

    Steps show how far it holds: the same step of the input, by the linear and by the nonlinear model.
    """
    source = ModelSource.document(request.model.to_document())
    return json_response(await workers.run(linear_model, source, request.settings(request.model), request.options()))


@router.post(
    "/models/phase-plane",
    summary="The phase plane of a model",
    responses={200: {"model": PhasePlaneAnswer}, **ERRORS, **BUSY},
)
async def model_phase_plane(
    request: Annotated[ModelPhasePlaneRequest, Body(openapi_examples=EXAMPLES["phase-plane"])], workers: Workers
) -> Response:
    """Directions, nullclines, steady states and trajectories of two states, the others held."""
    source = ModelSource.document(request.model.to_document())
    return json_response(await workers.run(plane, source, request.settings(request.model), request.options()))


@router.post(
    "/models/balance",
    summary="A balance over one state of a model",
    responses={200: {"model": BalanceAnswer}, **ERRORS, **BUSY},
)
async def model_balance(
    request: Annotated[ModelBalanceRequest, Body(openapi_examples=EXAMPLES["balance"])], workers: Workers
) -> Response:
    """The rate of one state with the others at rest, and variables along it: heat generated and removed, say."""
    source = ModelSource.document(request.model.to_document())
    return json_response(await workers.run(balance, source, request.settings(request.model), request.options()))
