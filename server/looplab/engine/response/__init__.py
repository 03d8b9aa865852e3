"""Responses of one system to any input of the notes, from any initial state, and what they are made of."""

from looplab.engine.response.final_value import FinalValue, final_value
from looplab.engine.response.horizon import response_horizon
from looplab.engine.response.inputs import (
    InputSignal,
    held_samples,
    impulse,
    joined_samples,
    pulse,
    ramp,
    sine,
    step,
)
from looplab.engine.response.simulate import SystemResponse, simulate
from looplab.engine.response.superposition import Convolution, Superposition, Term, convolution, superposition

__all__ = [
    "Convolution",
    "FinalValue",
    "InputSignal",
    "Superposition",
    "SystemResponse",
    "Term",
    "convolution",
    "final_value",
    "held_samples",
    "impulse",
    "joined_samples",
    "pulse",
    "ramp",
    "response_horizon",
    "simulate",
    "sine",
    "step",
    "superposition",
]
