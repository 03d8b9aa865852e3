"""One slider move: everything a feedback loop can show, in one request."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.loop import LoopAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.panels import PANELS, LoopContext
from looplab.api.panels.context import content_key
from looplab.api.strict import StrictRoute
from looplab.engine.errors import EngineError, InvalidInput
from looplab.labs.text import render_math
from looplab.schemas import Loop, Model, located

router = APIRouter(tags=["loop"], route_class=StrictRoute)

PanelName = Literal[
    "verdict", "step", "bode", "nyquist", "root_locus", "poles", "margins", "metrics", "sensitivity",
    "asymptotes", "gang_steps", "root_locus_negative",
]  # fmt: skip
# What explains the rest more closely is computed for those who ask for it by name.
ON_REQUEST = ("asymptotes", "gang_steps", "root_locus_negative")
DEFAULT: list[PanelName] = [name for name in PanelName.__args__ if name not in ON_REQUEST]  # type: ignore[attr-defined]

EXAMPLE: dict[str, Any] = {
    "loop": {
        "plant": {"type": "expr", "text": "1/(s+1)^3"},
        "controller": {"type": "pid", "Kc": 3.6, "tau_I": 3.023},
    },
    "want": ["verdict", "margins", "metrics"],
    "horizon": 30,
}


class LoopRequest(Model):
    """A loop and the panels wanted of it."""

    loop: Loop
    want: Annotated[list[PanelName], Field(max_length=16)] = Field(default=DEFAULT)
    have: Annotated[
        dict[PanelName, Annotated[str, Field(max_length=64)]],
        Field(description="Keys of panels the caller already holds; a panel whose key is unchanged is left out."),
    ] = Field(default={})
    horizon: Annotated[float, Field(ge=1e-9, le=1e9, description="Length of the step responses [time].")] | None = None
    points: Annotated[int, Field(ge=20, le=5000)] = 500
    omega: Annotated[list[Annotated[float, Field(gt=0)]], Field(min_length=2, max_length=2)] | None = None
    arrays: Literal["list", "f4"] = "list"


def _summary(request: LoopRequest, context: LoopContext) -> dict[str, Any]:
    loop = context.loop
    texts: dict[str, dict[str, Any] | None] = {}
    for name, shape, system in (
        ("plant", request.loop.plant, loop.plant),
        ("controller", request.loop.controller, loop.C),
        ("actuator", request.loop.actuator, loop.actuator),
        ("sensor", request.loop.sensor, loop.sensor),
        ("disturbance", request.loop.disturbance, loop.disturbance),
    ):
        if shape is None or system is None:
            texts[name] = None
            continue
        latex = shape.to_latex()
        text: dict[str, Any] = {"text": system.to_text(), "latex": latex, "mathml": render_math(latex)}
        texts[name] = text if name == "controller" else text | {"order": system.order, "theta": system.theta}
    return texts


ACTUATOR_AND_SENSOR: dict[str, Any] = {
    "loop": {
        "plant": {"type": "fopdt", "K": 1, "tau": 2, "theta": 0.5},
        "controller": {"type": "pid", "Kc": 1.2, "tau_I": 2},
        "actuator": {"type": "expr", "text": "exp(-0.1s)/(0.3s+1)"},
        "sensor": {"type": "expr", "text": "exp(-0.25s)/(0.1s+1)"},
    },
    "want": ["verdict", "margins", "step"],
    "horizon": 20,
    "points": 101,
}
EXAMPLES: dict[str, Any] = {
    "PI on 1/(s+1)^3": {"value": EXAMPLE},
    "dead times in valve and sensor": {"value": ACTUATOR_AND_SENSOR},
}


@router.post("/loop", summary="Analyse and simulate a feedback loop", responses={200: {"model": LoopAnswer}, **ERRORS})
def loop(
    request: Annotated[LoopRequest, Body(openapi_examples=EXAMPLES)],
) -> Response:
    """Step responses, Bode, Nyquist, root locus, margins, metrics and the stability verdict of one loop.

    Ask for panels by name with `want`; send back the `key` of each under `have` to be spared what did not change.
    """
    with located("loop"):
        engine_loop = request.loop.to_engine()
    omega = None
    if request.omega is not None:
        if not request.omega[0] < request.omega[1]:
            raise InvalidInput("omega must be [low, high] with low < high", field="omega")
        omega = (request.omega[0], request.omega[1])
    context = LoopContext(engine_loop, request.horizon, request.points, omega)
    panels: dict[str, Any] = {}
    unchanged: list[str] = []
    for name in dict.fromkeys(request.want):
        panel = PANELS[name]
        key = content_key(name, panel.depends_on(context))
        if request.have.get(name) == key:
            unchanged.append(name)
            continue
        try:
            panels[name] = {"key": key, **panel.compute(context)}
        except EngineError as error:
            if error.field in ("plant", "controller", "theta", "actuator", "sensor", "disturbance"):
                error.field = "loop.plant" if error.field == "theta" else f"loop.{error.field}"
            raise
    answer = {"time_unit": "s", **_summary(request, context), "unchanged": unchanged, "panels": panels}
    return json_response(answer, request.arrays)
