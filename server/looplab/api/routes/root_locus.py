"""The root locus, rational or with exact dead time."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.loop import RootLocusAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.open_loop import OpenLoopRequest
from looplab.api.panels.stability import locus_answer
from looplab.api.strict import StrictRoute
from looplab.schemas import Model

router = APIRouter(tags=["stability"], route_class=StrictRoute)

EXAMPLES: dict[str, Any] = {
    "the notes' example": {"value": {"system": {"type": "expr", "text": "2(s+1)/(s(s-4))"}}},
    "dead time": {"value": {"system": {"type": "expr", "text": "exp(-s)/s"}}},
    "around a break-away point": {
        "value": {
            "system": {"type": "expr", "text": "1/(s(s+1)(s+2))"},
            "view": {"re": [-0.43, -0.41], "im": [-0.01, 0.01]},
        }
    },
    "negative gains": {"value": {"system": {"type": "expr", "text": "1/(s+1)^3"}, "gains": "negative"}},
}


class WindowOfS(Model):
    """Part of the s-plane [rad/time]."""

    re: Annotated[list[float], Field(min_length=2, max_length=2, description="[low, high]")]
    im: Annotated[list[float], Field(min_length=2, max_length=2, description="[low, high]")]


class RootLocusRequest(OpenLoopRequest):
    """An open loop for K = 1; of a loop, the gain of its controller is what varies."""

    gains: Literal["positive", "negative"] = Field(default="positive", description="Sign of K.")
    view: WindowOfS | None = Field(
        default=None, description="A window: the branches in it, with gains of their own that suit its scale."
    )
    arrays: Literal["list", "f4"] = "list"


@router.post("/root-locus", summary="Root locus", responses={200: {"model": RootLocusAnswer}, **ERRORS})
def root_locus(request: Annotated[RootLocusRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Branches joined right, asymptotes, breakaways, axis crossings, angles and real-axis segments; dead time exact."""
    loop = request.feedback_loop()
    L = loop.locus_system if loop is not None else request.open_loop()
    L = L * -1.0 if request.gains == "negative" else L
    view = None
    if request.view is not None:
        re, im = request.view.re, request.view.im
        view = ((re[0], re[1]), (im[0], im[1]))
    return json_response(locus_answer(L, view), request.arrays)
