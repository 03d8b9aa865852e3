"""Nonlinear models written as formulas: read, differentiated exactly, simulated."""

from looplab.engine.nonlinear.document import (
    Event,
    ModelDocument,
    OperatingPoint,
    Quantity,
    Setting,
    State,
    read_document,
)
from looplab.engine.nonlinear.language import BUILT_IN, Limits
from looplab.engine.nonlinear.latex import LatexEquation, latex_equations
from looplab.engine.nonlinear.model import CompiledModel, Jacobians, compile_model
from looplab.engine.nonlinear.time_scale import slowest_time_constant

__all__ = [
    "BUILT_IN",
    "CompiledModel",
    "Event",
    "Jacobians",
    "LatexEquation",
    "Limits",
    "ModelDocument",
    "OperatingPoint",
    "Quantity",
    "Setting",
    "State",
    "compile_model",
    "latex_equations",
    "read_document",
    "slowest_time_constant",
]
