"""The JSON shapes of systems, controllers and loops, shared by the API and the labs, and their way to the engine."""

from looplab.schemas.base import Model, located
from looplab.schemas.controllers import Controller, ParallelPID, StandardPID
from looplab.schemas.loops import Loop
from looplab.schemas.systems import (
    ExpressionSystem,
    FOPDTSystem,
    PolynomialSystem,
    SOPDTSystem,
    System,
    ZPKSystem,
)

__all__ = [
    "Controller",
    "ExpressionSystem",
    "FOPDTSystem",
    "Loop",
    "Model",
    "ParallelPID",
    "PolynomialSystem",
    "SOPDTSystem",
    "StandardPID",
    "System",
    "ZPKSystem",
    "located",
]
