"""State feedback: the design, its runs on the linear and the nonlinear plant, and the region it works from."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.state_feedback import FeedbackRunAnswer, RegionAnswer, StateFeedbackAnswer
from looplab.api.docs import BUSY, ERRORS
from looplab.api.encode import json_response
from looplab.api.simulations import Values, Workers
from looplab.api.strict import StrictRoute
from looplab.engine.errors import InvalidInput
from looplab.engine.state_space import StateSpaceModel
from looplab.jobs.feedback_tasks import (
    FeedbackProblem,
    FeedbackRunSettings,
    NonlinearSource,
    design,
    region,
    simulate_feedback,
)
from looplab.jobs.points import PointSettings
from looplab.jobs.tasks import PLANT, ModelSource
from looplab.plants import load_plant
from looplab.schemas import Model, located
from looplab.schemas.operating_points import find_operating_point
from looplab.schemas.state_feedback import (
    FeedbackGain,
    FeedbackPlant,
    LibraryFeedbackPlant,
    LinearFeedbackPlant,
    ObserverGain,
    SignalName,
    SignalNames,
)

router = APIRouter(tags=["state space"], route_class=StrictRoute)

# Starts of one worker task, which have its processor time together, and of one request.
STRIP = 20
MOST_STARTS = 1_000
Horizon = Annotated[float, Field(ge=1e-6, le=1e6, description="[time]")]
Limits = Annotated[
    dict[str, Annotated[list[float], Field(min_length=2, max_length=2)]],
    Field(max_length=10, description="[least, greatest] by input; left out: the range that the model declares."),
]


class StateFeedbackRequest(Model):
    """A plant, how its gains are found, and what is measured and held."""

    plant: FeedbackPlant
    gain: FeedbackGain
    observer: Annotated[ObserverGain | None, Field(description="null: every state is measured.")] = None
    measured: Annotated[SignalNames | None, Field(description="Outputs that the observer sees; null: all.")] = None
    controlled: Annotated[SignalNames, Field(description="Outputs with a setpoint.")] = Field(default=[])
    integral: Annotated[bool, Field(description="Integrate their errors; else a gain N leads to the setpoints.")] = (
        False
    )

    def problem(self) -> FeedbackProblem:
        """The request as a worker takes it; raises EngineError naming the field."""
        return FeedbackProblem(
            _plant(self.plant),
            self.gain.to_engine(),
            None if self.observer is None else self.observer.to_engine(),
            None if self.measured is None else tuple(self.measured),
            tuple(self.controlled),
            self.integral,
        )


class PushShape(Model):
    """A pulse added to an input of the plant, after the limits."""

    input: Annotated[SignalName | None, Field(description="null: the first.")] = None
    size: Annotated[float, Field(ge=-1e9, le=1e9)]
    start: Annotated[float, Field(ge=0, le=1e6)] = 0.0
    duration: Annotated[float, Field(ge=1e-6, le=1e6)]


class FeedbackRunRequest(StateFeedbackRequest):
    """The same, and what the run begins with."""

    horizon: Horizon
    points: Annotated[int, Field(ge=2, le=5000)] = 501
    initial: Annotated[Values, Field(description="States; left out: at the steady state, as the observer is.")] = Field(
        default={}
    )
    setpoints: Annotated[Values, Field(description="Of controlled outputs, from t = 0 on.")] = Field(default={})
    limits: Limits = Field(default={})
    pushes: Annotated[list[PushShape], Field(max_length=8)] = Field(default=[])
    arrays: Literal["list", "f4"] = "list"


class Axis(Model):
    """One axis of a grid of starts."""

    state: SignalName
    low: Annotated[float, Field(ge=-1e9, le=1e9)]
    high: Annotated[float, Field(ge=-1e9, le=1e9)]
    count: Annotated[int, Field(ge=1, le=61)] = 21

    def values(self) -> list[float]:
        """The starts along it."""
        found: list[float] = np.linspace(self.low, self.high, self.count).tolist()
        return found


class RegionRequest(StateFeedbackRequest):
    """The same, and the grid of starts."""

    horizon: Horizon
    horizontal: Axis
    vertical: Axis
    limits: Limits = Field(default={})


def _plant(plant: Any) -> StateSpaceModel | NonlinearSource:
    with located("plant"):
        if isinstance(plant, LinearFeedbackPlant):
            return plant.to_model()
        if isinstance(plant, LibraryFeedbackPlant):
            document: Any = load_plant(plant.id).document
            source = ModelSource(PLANT, plant.id)
        else:
            document, source = plant.model, ModelSource.document(plant.model.to_document())
        point = find_operating_point(plant.operating_point, document.operating_points)
    settings = PointSettings(
        {**(point.inputs if point else {}), **plant.inputs},
        {**(point.parameters if point else {}), **plant.parameters},
        {**(point.near if point else {}), **plant.near},
    )
    return NonlinearSource(source, settings, None if plant.actuators is None else tuple(plant.actuators))


def _limits(limits: dict[str, list[float]]) -> dict[str, tuple[float, float]]:
    for name, (low, high) in limits.items():
        if not low < high:
            raise InvalidInput("the first limit must be below the second", field=f"limits.{name[:40]}")
    return {name: (low, high) for name, (low, high) in limits.items()}


def _pendulum(**more: Any) -> dict[str, Any]:
    return {
        "plant": {"type": "plant", "id": "cart-pendulum", "operating_point": "upright"},
        "gain": {"method": "poles", "poles": [[-2, 1], [-2, -1], -5, -6]},
        "controlled": ["x"],
        **more,
    }


_OSCILLATOR: dict[str, Any] = {
    "plant": {"type": "ss", "A": [[0, 1], [-1, 0]], "B": [[0], [1]], "C": [[1, 0]]},
    "gain": {"method": "lqr", "Q": [1, 0, 1], "R": [1]},
    "controlled": ["y1"],
    "integral": True,
}
EXAMPLES: dict[str, Any] = {
    "the pendulum on its cart, with an observer": {
        "value": _pendulum(observer={"method": "faster", "speed": 4}, measured=["phi", "x"])
    },
    "matrices, weights and an integrator": {"value": _OSCILLATOR},
}
RUN_EXAMPLES: dict[str, Any] = {
    "let go at 15 degrees": {
        "value": _pendulum(
            horizon=5,
            points=101,
            initial={"phi": 0.2618},
            limits={"F": [-20, 20]},
            pushes=[{"size": 5, "start": 3, "duration": 0.1}],
        )
    },
    "a setpoint": {"value": {**_OSCILLATOR, "horizon": 10, "points": 51, "setpoints": {"y1": 1}}},
}
REGION_EXAMPLES: dict[str, Any] = {
    "tilt and speed of turning": {
        "value": _pendulum(
            horizon=5,
            horizontal={"state": "phi", "low": -1, "high": 1, "count": 5},
            vertical={"state": "omega", "low": -4, "high": 4, "count": 3},
            limits={"F": [-20, 20]},
        )
    }
}


@router.post(
    "/state-feedback",
    summary="Design a state feedback",
    responses={200: {"model": StateFeedbackAnswer}, **ERRORS, **BUSY},
)
async def state_feedback(
    request: Annotated[StateFeedbackRequest, Body(openapi_examples=EXAMPLES)], workers: Workers
) -> Response:
    """K by poles or weights, an observer's L, the gain N or integrators for setpoints, on the plant's linear model.

    The poles obtained stand beside those desired, and the margins are those where the input enters the plant. A mode
    that no input moves, or no output shows, is refused by name unless it is among the poles.
    """
    return json_response(await workers.run(design, request.problem()))


@router.post(
    "/state-feedback/simulate",
    summary="Run a plant under state feedback",
    responses={200: {"model": FeedbackRunAnswer}, **ERRORS, **BUSY},
)
async def state_feedback_run(
    request: Annotated[FeedbackRunRequest, Body(openapi_examples=RUN_EXAMPLES)], workers: Workers
) -> Response:
    """The plant's own equations under the feedback, with limits, pushes and setpoints, beside the linear prediction.

    An observer begins at the steady state: it does not know where the plant starts.
    """
    run = FeedbackRunSettings(
        request.horizon,
        request.points,
        request.initial,
        request.setpoints,
        _limits(request.limits),
        tuple((push.input, push.size, push.start, push.duration) for push in request.pushes),
    )
    return json_response(await workers.run(simulate_feedback, request.problem(), run), request.arrays)


@router.post(
    "/state-feedback/region",
    summary="From where a state feedback catches the plant",
    responses={200: {"model": RegionAnswer}, **ERRORS, **BUSY},
)
async def state_feedback_region(
    request: Annotated[RegionRequest, Body(openapi_examples=REGION_EXAMPLES)], workers: Workers
) -> Response:
    """The plant is run from every point of a grid over two states; the others begin at the steady state.

    Each point is answered by how its run ends: caught, the first event that happened, stopped, or unsettled.
    """
    first, second = request.horizontal, request.vertical
    if first.state == second.state:
        raise InvalidInput("the two axes must be two states", field="vertical.state")
    if first.count * second.count > MOST_STARTS:
        raise InvalidInput(
            f"{first.count} x {second.count} starts are more than {MOST_STARTS}",
            field="vertical.count",
            hint="ask for the grid in bands",
        )
    horizontal, vertical = first.values(), second.values()
    starts = [(x, y) for y in vertical for x in horizontal]
    run = FeedbackRunSettings(request.horizon, 2, {}, {}, _limits(request.limits), ())
    problem = request.problem()
    # One request takes no more of the workers than there are.
    free = asyncio.Semaphore(workers.workers)

    async def strip(begin: int) -> list[str]:
        async with free:
            return await workers.run(region, problem, run, (first.state, second.state), starts[begin : begin + STRIP])

    strips = await asyncio.gather(*map(strip, range(0, len(starts), STRIP)))
    found = [outcome for each in strips for outcome in each]
    rows = [found[k : k + len(horizontal)] for k in range(0, len(found), len(horizontal))]
    return json_response({"horizontal": horizontal, "vertical": vertical, "outcomes": rows})
