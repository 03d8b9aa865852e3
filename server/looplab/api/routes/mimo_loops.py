"""Several loops over time and over frequency: their responses, and what one loop sees of the others."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.mimo import InteractionAnswer, SeveralResponses
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.routes.mimo import WOOD_BERRY, Frequencies, frequencies
from looplab.api.strict import StrictRoute
from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.mimo import Change, MultiLoop, interaction, simulate_loops
from looplab.engine.stability.closed_loop import Verdict
from looplab.schemas import Model
from looplab.schemas.mimo import Number, SeveralLoops

router = APIRouter(tags=["mimo"], route_class=StrictRoute)

Horizon = Annotated[float, Field(ge=1e-9, le=1e9, description="Left out: that of the process [time].")]
Points = Annotated[int, Field(ge=20, le=5000)]


class ChangeShape(Model):
    """A step of a setpoint, of a load that enters with an input, or of the output of a controller in manual."""

    kind: Literal["setpoint", "load", "manual"]
    loop: Annotated[Number, Field(description="Number of the output, of a load that of the input.")]
    size: Annotated[float, Field(ge=-1e9, le=1e9)] = 1.0
    start: Annotated[float, Field(ge=0, le=1e9, description="[time]")] = 0.0


class SimulateSeveralRequest(SeveralLoops):
    """Several loops, and what happens to them."""

    changes: Annotated[list[ChangeShape], Field(min_length=1, max_length=10)]
    horizon: Horizon | None = None
    points: Points = 500
    verdict: Annotated[bool, Field(description="false: without it, which takes longer than the responses.")] = True
    arrays: Literal["list", "f4"] = "list"


PI_LOOPS: list[dict[str, Any]] = [
    {"controller": {"type": "pid", "Kc": 0.375, "tau_I": 8.29}},
    {"controller": {"type": "pid", "Kc": -0.075, "tau_I": 23.6}},
]
SIMULATE_EXAMPLES = {
    "both loops closed": {
        "value": {
            "plant": WOOD_BERRY,
            "loops": PI_LOOPS,
            "changes": [{"kind": "setpoint", "loop": 1}, {"kind": "load", "loop": 2, "size": 0.1, "start": 80}],
            "points": 201,
        }
    },
    "decoupled, loop 2 in manual": {
        "value": {
            "plant": WOOD_BERRY,
            "loops": [PI_LOOPS[0], {**PI_LOOPS[1], "mode": "manual"}],
            "decoupler": "dynamic",
            "changes": [{"kind": "setpoint", "loop": 1}],
            "points": 201,
        }
    },
}


def _verdict(found: Verdict) -> dict[str, Any]:
    return {
        "verdict": found.verdict,
        "stable": found.closed_loop_stable,
        "because": found.because,
        "rhp_poles": found.rhp_poles,
    }


@router.post("/mimo/simulate", summary="Simulate several loops", responses={200: {"model": SeveralResponses}, **ERRORS})
def simulate(request: Annotated[SimulateSeveralRequest, Body(openapi_examples=SIMULATE_EXAMPLES)]) -> Response:
    """Every output and input of up to five PID loops in any pairing, each automatic or manual, dead times exact."""
    loops = request.to_engine()
    horizon = request.horizon or loops.process.horizon()
    changes = [Change(each.kind, each.loop - 1, each.size, each.start) for each in request.changes]
    found = simulate_loops(loops, changes, horizon, request.points)
    reasons: dict[str, str] = {}
    verdict = None
    if request.verdict:
        try:
            verdict = _verdict(loops.verdict)
        except EngineError as error:
            reasons["verdict"] = error.message
    else:
        reasons["verdict"] = "not asked for"
    n = loops.process.size
    answer = {
        "time_unit": request.plant.units()[0],
        "horizon": horizon,
        "t": found.t,
        "y": [found.y[:, i].copy() for i in range(n)],
        "u": [found.u[:, i].copy() for i in range(n)],
        "verdict": verdict,
        "truncated_at": found.truncated_at,
        "truncated_reason": found.truncated_reason,
        "reasons": reasons,
    }
    return json_response(answer, request.arrays)


class InteractionRequest(SeveralLoops):
    """Several loops, and the one that is looked at; modes do not matter: the others are all opened, and all closed."""

    loop: Number = 1
    omega: Frequencies | None = Field(default=None, description="[low, high]; left out, chosen [rad/time].")
    horizon: Horizon | None = None
    points: Points = 300
    arrays: Literal["list", "f4"] = "list"


INTERACTION_EXAMPLES = {
    "loop 1 of Wood and Berry's column": {"value": {"plant": WOOD_BERRY, "loops": PI_LOOPS, "points": 101}},
    "loop 2, decoupled": {
        "value": {"plant": WOOD_BERRY, "loops": PI_LOOPS, "loop": 2, "decoupler": "static", "points": 101}
    },
}


def _curve(values: np.ndarray) -> dict[str, Any]:
    with np.errstate(divide="ignore"):
        size = 20.0 * np.log10(np.maximum(np.abs(values), 1e-300))
    return {"mag_dB": size, "phase_deg": np.degrees(np.unwrap(np.angle(values)))}


def _response(loops: MultiLoop, loop: int, horizon: float, points: int) -> dict[str, Any]:
    found = simulate_loops(loops, [Change("setpoint", loop, 1.0)], horizon, points)
    return {
        "t": found.t,
        "y": found.y[:, loop].copy(),
        "u": found.u[:, loops.pairing[loop]].copy(),
        "truncated_at": found.truncated_at,
        "truncated_reason": found.truncated_reason,
    }


@router.post(
    "/mimo/interaction",
    summary="What a loop sees of the others",
    responses={200: {"model": InteractionAnswer}, **ERRORS},
)
def interaction_of(request: Annotated[InteractionRequest, Body(openapi_examples=INTERACTION_EXAMPLES)]) -> Response:
    """One loop with the others in manual and in automatic: the process that its controller sees, margins, responses.

    With integral action in the others the gain at rest becomes the loop's own gain over its relative gain.
    """
    loops = request.to_engine()
    n = loops.process.size
    loop = request.loop - 1
    if loop >= n:
        raise InvalidInput(f"there is no loop {request.loop}", field="loop", hint=f"1 to {n}")
    closed = loops.with_others(loop, True).with_loop(loop, True)
    alone = closed.with_others(loop, False)
    omega = frequencies(loops.process, request.omega, request.points)
    found = interaction(closed, loop, omega)
    horizon = request.horizon or loops.process.horizon()
    answer = {
        "time_unit": request.plant.units()[0],
        "omega": omega,
        "own": _curve(found.own),
        "effective": _curve(found.effective),
        **{name: getattr(found, name) for name in ("own_gain", "effective_gain", "relative_gain")},
        "own_margins": found.own_margins and asdict(found.own_margins),
        "effective_margins": found.effective_margins and asdict(found.effective_margins),
        "others": found.others and _verdict(found.others),
        "horizon": horizon,
        "own_response": None,
        "effective_response": None,
        "reasons": found.reasons,
    }
    for name, which in (("own_response", alone), ("effective_response", closed)):
        try:
            answer[name] = _response(which, loop, horizon, request.points)
        except EngineError as error:
            found.reasons[name] = error.message
    return json_response(answer, request.arrays)
