"""What every simulation of a nonlinear model is asked with, and the workers it runs on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Literal, Protocol

from fastapi import Depends, Request
from pydantic import Field

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.control_loop import ControlLoop
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.jobs import WorkerPool
from looplab.jobs.tasks import OpenLoopSettings
from looplab.schemas import ControlLoopShape, InputCourses, Model, located
from looplab.schemas.operating_points import OperatingPointParts, find_operating_point

Values = Annotated[dict[str, float], Field(max_length=200)]


class SimulationRequest(Model):
    """How long, with which inputs, from where."""

    horizon: Annotated[float, Field(ge=1e-9, le=1e9, description="[time]")]
    points: Annotated[int, Field(ge=2, le=5000)] = 500
    operating_point: Annotated[
        str | None, Field(max_length=64, description="Its inputs, parameters and states are the nominal ones.")
    ] = None
    inputs: InputCourses = Field(default={})
    parameters: Annotated[Values, Field(description="Left out: nominal.")] = Field(default={})
    initial: Annotated[Values, Field(description="States at the start; left out: the model's own.")] = Field(default={})
    method: Annotated[
        Literal["LSODA", "RK45", "Radau", "BDF"], Field(description="LSODA changes between stiff and not by itself.")
    ] = "LSODA"
    arrays: Literal["list", "f4"] = "list"


class RunRequest(SimulationRequest):
    """A simulation that may go on where another one ended."""

    start: Annotated[float, Field(ge=0, le=1e9, description="Time at the start; inputs know it [time].")] = 0.0


class ControlRequest(SimulationRequest):
    """A simulation with controllers; the course of an input that one of them moves is its bias, a number."""

    loops: Annotated[list[ControlLoopShape], Field(min_length=1, max_length=3)]


class Named(Protocol):
    """What an input's document and its request shape have in common."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def value(self) -> float:
        """Its nominal value."""


class ModelParts(Protocol):
    """What a document and its request shape have in common."""

    @property
    def inputs(self) -> Sequence[Named]:
        """Inputs."""

    @property
    def operating_points(self) -> Sequence[OperatingPointParts]:
        """Operating points."""


def workers(request: Request) -> WorkerPool:
    """The application's workers."""
    pool: WorkerPool = request.app.state.workers
    return pool


Workers = Annotated[WorkerPool, Depends(workers)]


def open_loop_settings(request: SimulationRequest, model: ModelParts, start: float = 0.0) -> OpenLoopSettings:
    """The request as a worker takes it: operating point and nominal values put in.

    Raises
    ------
    InvalidInput
        The model has no such operating point, or an input's course makes no sense.
    """
    point = find_operating_point(request.operating_point, model.operating_points)
    at_point: Mapping[str, float] = point.inputs if point else {}
    nominal = {each.name: each.value for each in model.inputs} | dict(at_point)
    inputs: dict[str, float | InputCourse] = dict(at_point)
    for name, course in request.inputs.items():
        if isinstance(course, float | int):
            inputs[name] = course
            continue
        with located(f"inputs.{name[:40]}"):
            inputs[name] = course.to_engine(nominal.get(name, 0.0), start + request.horizon)
    return OpenLoopSettings(
        request.horizon,
        request.points,
        inputs,
        {**(point.parameters if point else {}), **request.parameters},
        {**(point.near if point else {}), **request.initial},
        request.method,
        start,
    )


def matrix_settings(request: RunRequest, matrix: ModelParts) -> OpenLoopSettings:
    """The request for a transfer matrix, which has inputs and nothing else to set.

    Raises
    ------
    InvalidInput
        Something else is set.
    """
    for name, given in (("parameters", request.parameters), ("initial", request.initial), ("start", request.start)):
        if given:
            raise InvalidInput("a transfer matrix starts at rest at t = 0 and has no parameters", field=name)
    return open_loop_settings(request, matrix)


def control_loops(request: ControlRequest) -> list[ControlLoop]:
    """The loops of a request as a worker takes them; raises EngineError naming the field."""
    out = []
    for index, loop in enumerate(request.loops):
        with located(f"loops[{index}]"):
            out.append(loop.to_engine(request.horizon))
    return out
