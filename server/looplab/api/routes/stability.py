"""Notions of stability: of a system, of a matrix, and inside a loop."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.responses import Response

from looplab.api.answers.stability import StabilityAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import complex_pairs, json_response
from looplab.api.strict import StrictRoute
from looplab.engine.stability import (
    BIBO,
    InternalStability,
    StabilityNotion,
    axis_poles_are_simple,
    bibo,
    closed_loop_poles,
    closed_loop_verdict,
    internal_stability,
    matrix_stability,
    state_space_bibo,
    system_stability,
)
from looplab.schemas import Loop, Model, System, located

router = APIRouter(tags=["stability"], route_class=StrictRoute)

Matrix = Annotated[list[Annotated[list[float], Field(min_length=1, max_length=50)]], Field(min_length=1, max_length=50)]


class StabilityRequest(Model):
    """A system, a state matrix (with B and C for BIBO), or a loop."""

    system: System | None = None
    A: Matrix | None = None
    B: Matrix | None = None
    C: Matrix | None = None
    loop: Loop | None = None

    @model_validator(mode="after")
    def _one(self) -> StabilityRequest:
        if sum(x is not None for x in (self.system, self.A, self.loop)) != 1:
            raise ValueError("give one of system, A or loop")
        if (self.B is None) != (self.C is None) or (self.B is not None and self.A is None):
            raise ValueError("B and C go together, and with A")
        return self


def _notion(found: StabilityNotion) -> dict[str, Any]:
    modes = [asdict(m) | {"eigenvalue": [m.eigenvalue.real, m.eigenvalue.imag]} for m in found.axis_modes]
    return {
        "poles": complex_pairs(found.poles),
        "complete": True,
        "verdict": found.verdict,
        "because": found.because,
        "lyapunov_stable": found.lyapunov_stable,
        "asymptotically_stable": found.asymptotically_stable,
        "axis_modes": modes,
    }


def _bibo(found: BIBO) -> dict[str, Any]:
    return {
        "stable": found.stable,
        "poles": complex_pairs(found.poles),
        "cancelled": complex_pairs(found.cancelled),
        "because": found.because,
        "unbounded": asdict(found.unbounded) if found.unbounded else None,
    }


def _internal(found: InternalStability) -> dict[str, Any]:
    members = {}
    for name in ("S", "PS", "CS", "T"):
        member = getattr(found, name)
        members[name] = asdict(member) | {"poles": complex_pairs(member.poles)}
    cancellations = [asdict(c) | {"root": [c.root.real, c.root.imag]} for c in found.cancellations]
    return members | {
        "cancellations": cancellations,
        "internally_stable": found.internally_stable,
        "because": found.because,
    }


def _loop(request: Loop) -> dict[str, Any]:
    with located("loop"):
        loop = request.to_engine()
    found, verdict, inside = closed_loop_poles(loop), closed_loop_verdict(loop), internal_stability(loop)
    word, because = verdict.verdict, verdict.because
    if verdict.closed_loop_stable != inside.internally_stable:
        # A hidden mode on the axis beside dead time: Nyquist's count does not see it.
        word, because = ("unstable" if word == "unstable" else "marginal"), inside.because
    if word == "marginal" and not axis_poles_are_simple(loop):
        word, because = "unstable", "a repeated closed-loop pole lies on the imaginary axis"
    stable_T = inside.T.stable
    see = "T" if stable_T else inside.T.because
    return {
        "poles": complex_pairs(found.poles),
        "complete": found.complete,
        "verdict": word,
        "because": because,
        "lyapunov_stable": word != "unstable",
        "asymptotically_stable": inside.internally_stable,
        "axis_modes": None,
        "bibo": {
            "stable": stable_T,
            "poles": complex_pairs(inside.T.poles),
            "cancelled": [],
            "because": "from the setpoint to y (T) every bounded input gives a bounded output" if stable_T else see,
            "unbounded": None,
        },
        "internal": _internal(inside),
    }


EXAMPLES = {
    "a hidden unstable mode": {
        "value": {
            "loop": {
                "plant": {"type": "expr", "text": "3/((s+4)(s-4))"},
                "controller": {"type": "expr", "text": "(s-4)/s"},
            }
        }
    },
    "a resonance": {"value": {"system": {"type": "expr", "text": "1/(s^2+1)"}}},
    "a Jordan block": {"value": {"A": [[0, 1], [0, 0]], "B": [[0], [1]], "C": [[1, 0]]}},
}


@router.post("/stability", summary="Notions of stability", responses={200: {"model": StabilityAnswer}, **ERRORS})
def stability(request: Annotated[StabilityRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Lyapunov, asymptotic, marginal; bounded input and output; and what a loop hides inside.

    On the imaginary axis the Jordan structure decides, by the singular values that are in the answer. A system that is
    not BIBO stable comes with a bounded input that proves it. A loop comes with the poles of S, PS, CS and T after
    cancellation, and with each cancellation by name.
    """
    reasons: dict[str, str] = {}
    if request.loop is not None:
        answer = _loop(request.loop)
        reasons["axis_modes"] = "given for a system or a matrix"
        if not answer["bibo"]["stable"]:
            reasons["bibo.unbounded"] = "given for a system"
        return json_response(answer | {"reasons": reasons})
    reasons["internal"] = "only a loop has an inside: send a loop"
    if request.system is not None:
        with located("system"):
            system = request.system.to_engine()
        answer = _notion(system_stability(system)) | {"bibo": _bibo(bibo(system))}
    else:
        assert request.A is not None
        answer = _notion(matrix_stability(request.A)) | {"bibo": None}
        if request.B is None or request.C is None:
            reasons["bibo"] = "BIBO is a matter of inputs and outputs: give B and C"
        else:
            answer["bibo"] = _bibo(state_space_bibo(request.A, request.B, request.C))
    return json_response(answer | {"internal": None, "reasons": reasons})
