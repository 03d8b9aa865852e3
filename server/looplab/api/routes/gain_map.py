"""The plane of Kc and tau_I of a PI controller."""

from __future__ import annotations

from math import isfinite
from typing import Annotated, Any

from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.compare import GainMapAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.strict import StrictRoute
from looplab.engine.tuning import Aim, Criterion, gain_map
from looplab.engine.tuning.gain_map import FloatArray
from looplab.schemas import Model, System, located

router = APIRouter(tags=["tuning"], route_class=StrictRoute)

Positive = Annotated[float, Field(gt=0)]
Range = Annotated[list[Positive], Field(min_length=2, max_length=2)]
Count = Annotated[int, Field(ge=4, le=40)]


class GainMapRequest(Model):
    """A plant, the window, and how fine."""

    plant: System
    Kc_range: Annotated[
        Range | None, Field(description="Sizes of the gain, smaller first; left out, around the stable region.")
    ] = None
    tau_I_range: Annotated[
        Range | None, Field(description="Integral times, smaller first; left out, around the plant's time scale.")
    ] = None
    points: Annotated[list[Count], Field(min_length=2, max_length=2, description="Gains, integral times.")] = Field(
        default=[24, 24]
    )
    criterion: Criterion = "IAE"
    aim: Aim = "load"


def _nullable(values: FloatArray) -> list[Any]:
    """The numbers as lists, null for NaN."""
    if values.ndim > 1:
        return [_nullable(row) for row in values]
    return [value if isfinite(value) else None for value in values.tolist()]


EXAMPLES = {
    "first order with dead time": {
        "value": {"plant": {"type": "fopdt", "K": 1, "tau": 5, "theta": 1}, "points": [8, 8]}
    },
    "a window": {
        "value": {
            "plant": {"type": "expr", "text": "1/(s+1)^3"},
            "Kc_range": [0.2, 8],
            "tau_I_range": [0.5, 20],
            "points": [8, 8],
            "aim": "setpoint",
        }
    },
}


@router.post("/gain-map", summary="Map of PI settings", responses={200: {"model": GainMapAnswer}, **ERRORS})
def gain_plane(request: Annotated[GainMapRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Where in the plane of Kc and tau_I the loop is stable, its Ms and its error integral there, dead time exact.

    At most 40 by 40 settings, evenly spaced in the logarithm; the boundary of stability is exact.
    """
    with located("plant"):
        plant = request.plant.to_engine().require_proper()
    ranges = [(r[0], r[1]) if r else None for r in (request.Kc_range, request.tau_I_range)]
    found = gain_map(
        plant, ranges[0], ranges[1], (request.points[0], request.points[1]), request.criterion, request.aim
    )
    return json_response(
        {
            "Kc": found.Kc,
            "tau_I": found.tau_I,
            "criterion": request.criterion,
            "aim": request.aim,
            "Ms": _nullable(found.Ms),
            "value": _nullable(found.value),
            "boundary": {"Kc": _nullable(found.boundary_Kc), "tau_I": _nullable(found.boundary_tau_I)},
            "reasons": {
                "Ms": "null where the loop is not stable",
                "value": "null where the loop is not stable, or does not settle within twenty ultimate periods",
            },
        }
    )
