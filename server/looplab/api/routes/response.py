"""The response of one system to an input, from any initial state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.responses import Response

from looplab.api.answers.response import ResponseAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.strict import StrictRoute
from looplab.engine.errors import InvalidInput
from looplab.engine.loop import FeedbackLoop
from looplab.engine.response import (
    InputSignal,
    convolution,
    final_value,
    response_horizon,
    simulate,
    superposition,
)
from looplab.engine.stability import closed_loop_poles, setpoint_transfer
from looplab.engine.state_space import StateSpaceModel, initial_state
from looplab.engine.systems import StateSpace, TransferFunction
from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.labs.text import render_math
from looplab.schemas import InputShape, Loop, Model, StateSpaceSystem, System, located

router = APIRouter(tags=["response"], route_class=StrictRoute)

InitialValues = Annotated[list[float], Field(max_length=50)]


class Initial(Model):
    """Where the system starts: its state, or the values of y, y', y'' ... just before t = 0."""

    x: InitialValues | None = Field(default=None, description="State, in the coordinates of the system's A.")
    y: InitialValues | None = Field(default=None, description="y, y', ...; those left out are 0.")

    @model_validator(mode="after")
    def _one(self) -> Initial:
        if (self.x is None) == (self.y is None):
            raise ValueError("give either x or y")
        return self


class ResponseRequest(Model):
    """A system or a part of a loop, an input, and where it starts."""

    system: System | None = Field(
        default=None, description="Proper; x of a state space is its own, else that of a cascade of sections."
    )
    loop: Loop | None = Field(default=None, description="Plant and controller.")
    of: Literal["closed_loop", "open_loop"] = Field(
        default="closed_loop", description="Of a loop: T = L/(1 + L), from setpoint to output, or L = P C."
    )
    input: InputShape
    initial: Initial | None = Field(default=None, description="Left out: at rest.")
    horizon: Annotated[float, Field(ge=1e-9, le=1e9, description="[time]")] | None = None
    points: Annotated[int, Field(ge=2, le=5000)] = 500
    want: Annotated[list[Literal["states", "superposition", "convolution"]], Field(max_length=8)] = Field(default=[])
    slices: Annotated[int, Field(ge=1, le=500, description="Slices of the input in the convolution sum.")] = 50
    arrays: Literal["list", "f4"] = "list"

    @model_validator(mode="after")
    def _one(self) -> ResponseRequest:
        if (self.system is None) == (self.loop is None):
            raise ValueError("give either system or loop")
        return self


SECOND_ORDER = {"type": "sopdt", "K": 1, "tau": 1, "zeta": 0.3, "theta": 0.5}
EXAMPLES: dict[str, Any] = {
    "a staircase as a sum of steps": {
        "value": {
            "system": SECOND_ORDER,
            "input": {"type": "sampled", "times": [0, 3, 6], "values": [1, 3, 2]},
            "want": ["superposition"],
            "points": 101,
        }
    },
    "resonance": {
        "value": {
            "system": {"type": "expr", "text": "1/(s^2+4)"},
            "input": {"type": "sine", "omega": 2},
            "horizon": 30,
            "points": 301,
        }
    },
    "a closed loop follows a ramp": {
        "value": {
            "loop": {
                "plant": {"type": "expr", "text": "1/(s(s+1))"},
                "controller": {"type": "pid", "Kc": 2},
            },
            "input": {"type": "ramp"},
            "points": 51,
        }
    },
    "free response of a state space": {
        "value": {
            "system": {"type": "ss", "A": [[0, 1], [-2, -3]], "B": [[0], [1]], "C": [[1, 0]], "D": [[0]]},
            "input": {"type": "step", "amplitude": 0},
            "initial": {"x": [1, 2]},
            "want": ["states"],
            "points": 51,
        }
    },
}


@dataclass(frozen=True)
class _Subject:
    """What is asked about: what is simulated, what tells how long and where to, and its formula."""

    source: StateSpace | FeedbackLoop
    theta: float
    order: int
    poles: ComplexArray
    dc_gain: float
    text: str
    latex: str

    @classmethod
    def of(cls, G: TransferFunction, latex: str | None = None, channel: StateSpace | None = None) -> _Subject:
        source = channel or StateSpaceModel.from_transfer_function(G).channel()
        return cls(source, G.theta, G.order, G.poles, G.dc_gain, G.to_text(), latex or G.to_latex())


def _subject(request: ResponseRequest) -> _Subject:
    if request.loop is not None:
        with located("loop"):
            loop = request.loop.to_engine()
            if request.of == "open_loop":
                return _Subject.of(loop.open_loop)
            if loop.theta and loop.open_loop.gain:
                return _delayed(loop)
            return _Subject.of(setpoint_transfer(loop))
    assert request.system is not None
    with located("system"):
        G = request.system.to_engine().require_proper()
        channel = None
        if isinstance(request.system, StateSpaceSystem):
            channel = request.system.to_model().require_single()
        return _Subject.of(G, request.system.to_latex(), channel)


def _delayed(loop: FeedbackLoop) -> _Subject:
    """A loop with dead time has no transfer function that is a fraction of polynomials: it is written with its L."""
    if loop.feedforward:
        raise InvalidInput("a setpoint weight is not part of T", field="controller.beta", hint="use beta 1")
    L = loop.open_loop
    gain = 1.0 if L.origin_order > 0 else L.dc_gain / (1.0 + L.dc_gain) if L.dc_gain != -1.0 else 0.0
    latex = rf"\frac{{L(s)}}{{1 + L(s)}}, \quad L(s) = {L.to_latex()}"
    poles = closed_loop_poles(loop).poles
    return _Subject(loop, loop.theta, L.order, poles, gain, f"L/(1 + L) with L = {L.to_text()}", latex)


def _start(initial: Initial | None, channel: StateSpace | FeedbackLoop) -> FloatArray:
    if isinstance(channel, FeedbackLoop):
        if initial is not None:
            raise InvalidInput(
                "a loop with dead time starts from rest: what is on its way is part of its state",
                field="initial",
                hint="leave the initial state out, or look at the plant alone",
            )
        return np.zeros(0)
    if initial is None:
        return np.zeros(channel.B.size)
    if initial.y is not None:
        with located("initial"):
            return initial_state(StateSpaceModel.from_channel(channel), initial.y)
    x0 = np.array(initial.x, dtype=float)
    if x0.size != channel.B.size:
        raise InvalidInput(f"the system has {channel.B.size} states, not {x0.size}", field="initial.x")
    return x0


def _superposition(
    channel: StateSpace | FeedbackLoop, theta: float, signal: InputSignal, x0: FloatArray, at: tuple[float, int]
) -> dict[str, Any]:
    found = superposition(channel, signal, *at, x0, theta)
    terms = [{"amplitude": term.amplitude, "start": term.start, "y": term.y} for term in found.terms]
    return {"terms": terms, "free": found.free, "total": found.total, "error": found.error}


def _convolution(
    channel: StateSpace | FeedbackLoop, theta: float, signal: InputSignal, slices: int, at: tuple[float, int]
) -> dict[str, Any]:
    found = convolution(channel, signal, *at, slices, theta)
    return {name: getattr(found, name) for name in ("times", "weights", "h", "total", "exact", "error")}


@router.post("/response", summary="Response of one system", responses={200: {"model": ResponseAnswer}, **ERRORS})
def response(request: Annotated[ResponseRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """y of one system, or of a loop from its setpoint, to a step, impulse, ramp, sine, pulse or samples.

    Exact, dead time too, inside a loop as well, from any initial state (a loop with dead time from rest).

    Superposition takes a staircase apart into shifted steps; convolution adds up impulse responses.
    """
    subject = _subject(request)
    source, theta = subject.source, subject.theta
    with located("input"):
        signal = request.input.to_engine()
    x0 = _start(request.initial, source)
    horizon = request.horizon or response_horizon(subject.poles, signal, theta)
    at = (horizon, request.points)
    found = simulate(source, signal, *at, x0, theta)
    final = final_value(subject.poles, subject.dc_gain, signal)
    text = {"text": subject.text, "latex": subject.latex, "mathml": render_math(subject.latex)}
    reasons = {} if final.reason is None else {"final_value": final.reason}
    if isinstance(source, FeedbackLoop) and "states" in request.want:
        reasons["states"] = "with dead time what is on its way is part of the state"
    sums: dict[str, Any] = {"superposition": None, "convolution": None}
    if "superposition" in request.want:
        sums["superposition"] = _superposition(source, theta, signal, x0, at)
    if "convolution" in request.want:
        sums["convolution"] = _convolution(source, theta, signal, request.slices, at)
    answer = {
        "time_unit": "s",
        "system": {**text, "order": subject.order, "theta": theta},
        "horizon": horizon,
        "t": found.t,
        "u": found.u,
        "y": found.y,
        "states": list(found.x.T.copy()) if "states" in request.want and "states" not in reasons else None,
        "initial_state": x0.tolist(),
        "impulses": [{"t": t, "area": area} for t, area in found.impulses],
        "final_value": final.value,
        "truncated_at": found.truncated_at,
        "truncated_reason": found.truncated_reason,
        **sums,
        "reasons": reasons,
    }
    return json_response(answer, request.arrays)
