"""A block diagram of systems, connected exactly: dead times stay dead times wherever they are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.connect import ConnectAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import complex_pairs, json_response
from looplab.api.strict import StrictRoute
from looplab.engine.delays import (
    Block,
    delay_bode,
    delay_margins,
    delay_nyquist,
    delay_verdict,
    minimal_delay_system,
    rightmost_poles,
    step_response,
    transfer_matrix,
)
from looplab.engine.errors import EngineError
from looplab.engine.response import response_horizon
from looplab.engine.response import step as unit_step
from looplab.labs.text import render_math
from looplab.schemas.diagrams import BlockDiagram

router = APIRouter(tags=["systems"], route_class=StrictRoute)

Want = Literal["step", "frequency", "margins", "nyquist", "minimal"]


class ConnectRequest(BlockDiagram):
    """A block diagram, and what is wanted of the whole."""

    want: Annotated[list[Want], Field(max_length=8)] = Field(default=["step", "frequency"])
    horizon: Annotated[float, Field(ge=1e-9, le=1e9, description="Length of the step response [time].")] | None = None
    points: Annotated[int, Field(ge=20, le=5000)] = 500
    omega: Annotated[list[Annotated[float, Field(gt=0)]], Field(min_length=2, max_length=2)] | None = Field(
        default=None, description="[low, high] of the frequency response [rad/time]; left out, chosen."
    )
    tolerance: Annotated[float, Field(ge=1e-15, le=1e-2, description="Of the minimal form.")] = 1e-10
    arrays: Literal["list", "f4"] = "list"


SMITH: dict[str, Any] = {
    "systems": {
        "P": {"type": "fopdt", "K": 1.1, "tau": 1, "theta": 1.3},
        "C": {"type": "pid", "Kc": 2, "tau_I": 1},
        "ahead": {"type": "fopdt", "K": 1, "tau": 1},
        "model": {"type": "fopdt", "K": 1, "tau": 1, "theta": 1},
    },
    "diagram": {
        "op": "feedback",
        "forward": {
            "op": "series",
            "of": [
                {
                    "op": "feedback",
                    "forward": "C",
                    "backward": {"op": "parallel", "of": ["ahead", "model"], "signs": [1, -1]},
                },
                "P",
            ],
        },
    },
    "horizon": 20,
    "points": 201,
}
SENSOR: dict[str, Any] = {
    "systems": {
        "C": {"type": "pid", "Kc": 1.2, "tau_I": 2},
        "valve": {"type": "expr", "text": "exp(-0.1s)/(0.3s+1)"},
        "P": {"type": "fopdt", "K": 1, "tau": 2, "theta": 0.5},
        "sensor": {"type": "expr", "text": "exp(-0.25s)/(0.1s+1)"},
    },
    "diagram": {"op": "feedback", "forward": {"op": "series", "of": ["C", "valve", "P"]}, "backward": "sensor"},
    "want": ["step", "minimal"],
    "points": 101,
}
OPEN: dict[str, Any] = {
    "diagram": {"op": "series", "of": [{"type": "pid", "Kc": 1}, {"type": "expr", "text": "2 exp(-0.5s)/(s+1)"}]},
    "want": ["margins", "nyquist"],
}
EXAMPLES = {
    "a Smith predictor whose model is wrong": {"value": SMITH},
    "dead times in valve and sensor": {"value": SENSOR},
    "margins of an open loop": {"value": OPEN},
}


def _transfer_function(block: Block) -> dict[str, str] | None:
    if block.transfer_function is None:
        return None
    latex = block.transfer_function.to_latex()
    return {"text": block.transfer_function.to_text(), "latex": latex, "mathml": render_math(latex)}


def _verdict(block: Block) -> dict[str, Any]:
    found = delay_verdict(block.system)
    return {
        "verdict": found.verdict,
        "stable": found.closed_loop_stable,
        "because": found.because,
        "rhp_poles": found.rhp_poles,
    }


def _step(block: Block, request: ConnectRequest, stable: bool) -> dict[str, Any]:
    system = block.system
    horizon = request.horizon
    if horizon is None:
        horizon = response_horizon(rightmost_poles(system).poles, unit_step(), float(system.tau.sum()))
    found = step_response(system, horizon, request.points)
    return {
        "horizon": horizon,
        "t": found.t,
        "y": found.y[:, 0, 0].copy(),
        "final_value": float(transfer_matrix(system, 0.0)[0, 0, 0].real) if stable else None,
        "breakpoints": found.breakpoints[:200].tolist(),
        "truncated_at": found.truncated_at,
        "truncated_reason": found.truncated_reason,
    }


def _frequency(block: Block, request: ConnectRequest) -> dict[str, Any]:
    low, high = request.omega or (None, None)
    return asdict(delay_bode(block.system, low, high))


def _nyquist(block: Block) -> dict[str, Any]:
    curve, count = delay_nyquist(block.system)
    return {**asdict(curve), "N": count.N, "P": count.P, "Z": count.Z, "reason": count.reason}


def _minimal(block: Block, tolerance: float) -> dict[str, Any]:
    found = minimal_delay_system(block.system, tolerance)
    return {
        "order": found.system.order,
        "delays": found.system.tau.tolist(),
        "removed": [asdict(m) | {"pole": [m.pole.real, m.pole.imag]} for m in found.removed],
        "removed_delays": list(found.removed_delays),
        "tolerance": found.tolerance,
        "smallest_kept": found.smallest_kept,
        "largest_removed": found.largest_removed,
    }


@router.post("/connect", summary="Connect systems", responses={200: {"model": ConnectAnswer}, **ERRORS})
def connect(request: Annotated[ConnectRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Series, parallel and feedback connections of any systems, exact with every dead time where it is.

    Answers the order, the dead times inside, the verdict with its reason, step and frequency response, margins as an
    open loop, the minimal form, and the transfer function where the whole is one with a single dead time.
    """
    block = request.to_engine()
    poles = rightmost_poles(block.system)
    reasons: dict[str, str] = {}
    answer: dict[str, Any] = {
        "time_unit": "s",
        "order": block.system.order,
        "delays": block.system.tau.tolist(),
        "transfer_function": _transfer_function(block),
        "poles": complex_pairs(poles.poles),
        "complete": poles.complete,
    }
    if block.reason is not None:
        reasons["transfer_function"] = block.reason
    if poles.reason is not None:
        reasons["poles"] = poles.reason

    def attempt(name: str, compute: Callable[[], dict[str, Any]]) -> None:
        """What cannot be computed for this diagram is null, with the reason; the rest is answered all the same."""
        try:
            answer[name] = compute()
        except EngineError as error:
            answer[name], reasons[name] = None, error.message

    attempt("verdict", lambda: _verdict(block))
    stable = bool(answer["verdict"] and answer["verdict"]["stable"])
    parts: dict[str, Callable[[], dict[str, Any]]] = {
        "step": lambda: _step(block, request, stable),
        "frequency": lambda: _frequency(block, request),
        "margins": lambda: asdict(delay_margins(block.system)),
        "nyquist": lambda: _nyquist(block),
        "minimal": lambda: _minimal(block, request.tolerance),
    }
    for name, compute in parts.items():
        if name in request.want:
            attempt(name, compute)
        else:
            answer[name], reasons[name] = None, "not asked for: name it in want"
    if answer["step"] and answer["step"]["final_value"] is None:
        reasons["step.final_value"] = "undefined: the system is not stable"
    return json_response(answer | {"reasons": reasons}, request.arrays)
