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

router = APIRouter(tags=["stability"], route_class=StrictRoute)

EXAMPLES: dict[str, Any] = {
    "the notes' example": {"value": {"system": {"type": "expr", "text": "2(s+1)/(s(s-4))"}}},
    "dead time": {"value": {"system": {"type": "expr", "text": "exp(-s)/s"}}},
    "negative gains": {"value": {"system": {"type": "expr", "text": "1/(s+1)^3"}, "gains": "negative"}},
}


class RootLocusRequest(OpenLoopRequest):
    """An open loop for K = 1; of a loop, the gain of its controller is what varies."""

    gains: Literal["positive", "negative"] = Field(default="positive", description="Sign of K.")
    arrays: Literal["list", "f4"] = "list"


@router.post("/root-locus", summary="Root locus", responses={200: {"model": RootLocusAnswer}, **ERRORS})
def root_locus(request: Annotated[RootLocusRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Branches joined right, asymptotes, breakaways, axis crossings, angles and real-axis segments; dead time exact."""
    loop = request.feedback_loop()
    L = loop.locus_system if loop is not None else request.open_loop()
    L = L * -1.0 if request.gains == "negative" else L
    return json_response(locus_answer(L), request.arrays)
