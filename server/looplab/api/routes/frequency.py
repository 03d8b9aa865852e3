"""Frequency response, margins and the Nyquist curve of an open loop."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.frequency import FrequencyAnswer
from looplab.api.answers.loop import MarginsAnswer, NyquistAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.open_loop import EXAMPLES, OpenLoopRequest, asymptotes_answer, nyquist_answer
from looplab.api.strict import StrictRoute
from looplab.engine.errors import InvalidInput
from looplab.engine.frequency import (
    bandwidth,
    bode,
    closed_loop_bandwidth,
    frequency_grid,
    margins,
)
from looplab.engine.stability import closed_loop_verdict

router = APIRouter(tags=["frequency"], route_class=StrictRoute)


class FrequencyRequest(OpenLoopRequest):
    """An open loop, and the frequencies wanted of it."""

    omega: Annotated[list[Annotated[float, Field(gt=0)]], Field(min_length=1, max_length=5000)] | None = Field(
        default=None, description="Frequencies [rad/time], increasing; left out, an adaptive grid."
    )
    arrays: Literal["list", "f4"] = "list"


class CurveRequest(OpenLoopRequest):
    """An open loop whose Nyquist curve is wanted."""

    arrays: Literal["list", "f4"] = "list"


@router.post("/frequency", summary="Frequency response", responses={200: {"model": FrequencyAnswer}, **ERRORS})
def frequency(request: Annotated[FrequencyRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Magnitude and phase (dead time exact, phase anchored at low frequency), bandwidth, straight-line asymptotes."""
    L = request.open_loop()
    if request.omega is None:
        omega = frequency_grid(L)
    else:
        omega = np.array(request.omega)
        if (np.diff(omega) <= 0).any():
            raise InvalidInput("the frequencies must increase", field="omega")
    data = bode(L, omega)
    return json_response(
        {
            "omega": data.omega,
            "mag_dB": np.nan_to_num(data.mag_dB, neginf=-400.0, posinf=400.0),
            "phase_deg": data.phase_deg,
            "bandwidth": asdict(bandwidth(L)),
            "closed_loop_bandwidth": asdict(closed_loop_bandwidth(L)),
            "asymptotes": asymptotes_answer(L, float(omega[0]), float(max(omega[-1], omega[0] * 10))),
        },
        request.arrays,
    )


def _stable(request: OpenLoopRequest) -> bool:
    """The verdict: of plant and controller where they are known (hidden modes count), else Nyquist's."""
    loop = request.feedback_loop()
    if loop is not None:
        return closed_loop_verdict(loop).closed_loop_stable
    return margins(request.open_loop()).closed_loop_stable


@router.post("/margins", summary="Stability margins", responses={200: {"model": MarginsAnswer}, **ERRORS})
def stability_margins(request: Annotated[OpenLoopRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """All crossovers, GM, PM, delay margin, Ms and Mt, with the closed-loop verdict; null with a reason if infinite."""
    result = asdict(margins(request.open_loop()))
    return json_response({**result, "closed_loop_stable": _stable(request)})


@router.post("/nyquist", summary="Nyquist curve and count", responses={200: {"model": NyquistAnswer}, **ERRORS})
def nyquist(request: Annotated[CurveRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """The curve for omega > 0 (mirror it for omega < 0), its arcs at infinity, Z = N + P, and Bode's criterion."""
    return json_response(nyquist_answer(request.open_loop(), _stable(request)), request.arrays)
