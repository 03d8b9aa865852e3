"""Models from recorded data."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from looplab.api.answers.experiments import IdentifyAnswer
from looplab.api.docs import BUSY, ERRORS
from looplab.api.encode import json_response
from looplab.api.limits import MAX_UPLOAD
from looplab.api.simulations import Workers
from looplab.api.strict import StrictRoute
from looplab.engine.errors import EngineError
from looplab.engine.identification.csv_record import Columns, read_csv
from looplab.engine.identification.exact_response import LowOrder
from looplab.engine.identification.identify import METHODS, MethodName, identify
from looplab.engine.identification.intervals import ASSUMPTIONS
from looplab.engine.identification.least_squares import Unknowns
from looplab.engine.identification.record import Record, make_record
from looplab.engine.identification.step_data import Choices
from looplab.engine.systems import FOPDT, SOPDT
from looplab.jobs import TooSlow, WorkerPool
from looplab.schemas import Model, located

router = APIRouter(tags=["identification"], route_class=StrictRoute)

MAX_ROWS = 100_000
Numbers = Annotated[list[float], Field(max_length=MAX_ROWS)]
Gappy = Annotated[list[float | None], Field(max_length=MAX_ROWS)]


class Data(Model):
    """Recorded columns; null where a value is missing."""

    t: Annotated[Numbers, Field(description="Strictly increasing; any start, any steps [time].")]
    u: Gappy
    y: Gappy


class ColumnNames(Model):
    """Names of the columns of a CSV text, where its header leaves doubt."""

    t: Annotated[str, Field(max_length=200)]
    u: Annotated[str, Field(max_length=200)]
    y: Annotated[str, Field(max_length=200)]


class StepChoices(Model):
    """What the methods that read a step response may be told by hand."""

    y0: float | None = None
    y_final: float | None = None
    window: Annotated[float | None, Field(ge=0, description="Width of the smoothing window; 0: the least [time].")] = (
        None
    )
    t_inflection: Annotated[float | None, Field(description="Where the tangent touches [time].")] = None
    y_inflection: float | None = None
    slope: float | None = None


class IdentifyRequest(Model):
    """A record as arrays or as CSV text, and the method."""

    data: Data | None = None
    csv: Annotated[
        str | None,
        Field(
            max_length=MAX_UPLOAD,
            description="Cells parted by ; tab or comma, decimal commas with the first two; a header may carry units.",
        ),
    ] = None
    columns: ColumnNames | None = None
    hold: Annotated[
        Literal["zero", "linear"], Field(description="u keeps its value to the next sample, or goes there in a line.")
    ] = "zero"
    u_before: Annotated[float | None, Field(description="u before the record; left out: its first value.")] = None
    method: MethodName = "least_squares"
    compare: Annotated[bool, Field(description="All methods side by side, in `methods`.")] = False
    free_start: Annotated[
        bool, Field(description="Least squares: the plant need not be at rest when the record begins.")
    ] = False
    drift: Annotated[bool, Field(description="Least squares: a straight line is added to the output.")] = False
    step: StepChoices = Field(default=StepChoices())
    arrays: Literal["list", "f4"] = "list"

    @model_validator(mode="after")
    def _one(self) -> IdentifyRequest:
        if (self.data is None) == (self.csv is None):
            raise ValueError("give either data or csv")
        return self


_T = [0, 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 17, 20, 25, 30]
_U = [1, 1, *[2] * 14]
_Y = [5.0, 5.01, 4.99, 5.0, 5.42, 5.81, 6.11, 6.36, 6.54, 6.84, 7.0, 7.14, 7.27, 7.33, 7.41, 7.42]
EXAMPLES: dict[str, Any] = {
    "a step test, all methods": {"value": {"data": {"t": _T, "u": _U, "y": _Y}, "compare": True}},
    "CSV with decimal commas": {
        "value": {
            "csv": "t [min];u [%];y [K]\n"
            + "".join(f"{t};{u};{y}\n".replace(".", ",") for t, u, y in zip(_T, _U, _Y, strict=True)),
            "method": "two_point",
        }
    },
    "a tangent drawn by hand": {
        "value": {
            "data": {"t": _T, "u": _U, "y": _Y},
            "method": "tangent",
            "step": {"t_inflection": 4, "slope": 0.4, "y_final": 7.45},
        }
    },
}


def _finite(values: np.ndarray) -> list[float | None] | np.ndarray:
    """nan as null."""
    if np.isfinite(values).all():
        return values
    return [v if np.isfinite(v) else None for v in values.tolist()]


def _system(model: LowOrder) -> dict[str, Any]:
    if isinstance(model, FOPDT):
        return {"type": "fopdt", "K": model.K, "tau": model.tau, "theta": model.theta}
    if isinstance(model, SOPDT):
        return {"type": "sopdt", "K": model.K, "tau": model.tau, "zeta": model.zeta, "theta": model.theta}
    return {"type": "tf", "num": [model.K], "den": [1.0, 0.0], "theta": model.theta}


async def _answer(
    workers: WorkerPool, record: Record, method: MethodName, choices: Choices, unknowns: Unknowns
) -> dict[str, Any]:
    try:
        found = await workers.run(identify, record, method, choices, unknowns)
    except TooSlow as error:
        error.field, error.hint = "method", "a record with fewer samples, or a method with fewer unknowns"
        raise
    fitted, model = found.fitted, found.fitted.model
    intervals = fitted.intervals
    parameters = {"K": model.K, "theta": model.theta} if _system(model)["type"] == "tf" else dict(vars(model))
    return {
        **_about(method),
        "model": parameters,
        "system": _system(model),
        "fit_pct": found.fit_pct,
        "intervals": None if intervals is None else {name: list(ends) for name, ends in intervals.items()},
        "intervals_note": ASSUMPTIONS if intervals else "the method reads points of the curve: it has no intervals",
        "estimated": dict(fitted.estimated),
        "construction": dict(fitted.construction),
        "y_hat": found.y_hat,
        "residuals": _finite(found.residuals),
        "warnings": list(found.warnings),
        "reason": None,
    }


def _about(method: MethodName) -> dict[str, Any]:
    return {"method": method, "name": METHODS[method].name, "source": METHODS[method].source}


def _refused(method: MethodName, error: EngineError) -> dict[str, Any]:
    empty = dict.fromkeys(("model", "system", "fit_pct", "intervals", "y_hat", "residuals"))
    rest = {"estimated": {}, "construction": {}, "warnings": [], "reason": error.message}
    return {**_about(method), **empty, "intervals_note": "the method does not apply", **rest}


def _record(request: IdentifyRequest) -> tuple[Record, Columns | None]:
    if request.csv is not None:
        names = None if request.columns is None else request.columns.model_dump()
        read = read_csv(request.csv, names)
        with located("csv"):
            return make_record(read.t, read.u, read.y, request.hold, request.u_before), read
    assert request.data is not None
    with located("data"):
        return make_record(request.data.t, request.data.u, request.data.y, request.hold, request.u_before), None


@router.post(
    "/identify", summary="A model of recorded data", responses={200: {"model": IdentifyAnswer}, **ERRORS, **BUSY}
)
async def identify_model(
    request: Annotated[IdentifyRequest, Body(openapi_examples=EXAMPLES)], workers: Workers
) -> Response:
    """A first- or second-order or integrating model with dead time, from t, u and y.

    Tangent, two points and areas read a step response; least squares takes any input, sampled at any times, and gives
    95 % confidence intervals. Up to 2 MiB; beyond 5000 samples the record is thinned, and says so. Each method has 2 s
    of computing.
    """
    record, read = await run_in_threadpool(_record, request)
    choices = Choices(**request.step.model_dump())
    unknowns = Unknowns(request.free_start, request.drift)
    try:
        chosen = await _answer(workers, record, request.method, choices, unknowns)
    except TooSlow:
        raise
    except EngineError as error:
        place = "step" if error.field in StepChoices.model_fields else "csv" if request.data is None else "data"
        error.field = f"{place}.{error.field}" if error.field else place
        raise
    methods = None
    if request.compare:
        methods = []
        for method in METHODS:
            if method == request.method:
                methods.append(chosen)
                continue
            try:
                methods.append(await _answer(workers, record, method, choices, unknowns))
            except EngineError as error:
                methods.append(_refused(method, error))
    about = {
        "t": record.t,
        "u": record.u,
        "y": _finite(record.y),
        "hold": record.hold,
        "u_before": record.u_before,
        "time_unit": read.time_unit if read else None,
        "names": dict(read.names) if read else {},
        "units": dict(read.units) if read else {},
        "notes": list(record.notes),
    }
    return json_response({**chosen, "record": about, "methods": methods}, request.arrays)
