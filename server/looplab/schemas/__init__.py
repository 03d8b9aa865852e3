"""The JSON shapes of systems, controllers and loops, shared by the API and the labs, and their way to the engine."""

from looplab.schemas.base import Model, json_path, located
from looplab.schemas.control_loops import ControlLoopShape
from looplab.schemas.controllers import AnyPID, Controller, ParallelPID, StandardPID
from looplab.schemas.courses import Course, InputCourses
from looplab.schemas.inputs import InputShape
from looplab.schemas.loops import Loop
from looplab.schemas.models import NonlinearModel
from looplab.schemas.state_space import Matrices, StateSpaceSystem, state_space_latex
from looplab.schemas.systems import (
    ExpressionSystem,
    FOPDTSystem,
    PolynomialSystem,
    SOPDTSystem,
    System,
    ZPKSystem,
)

__all__ = [
    "AnyPID",
    "ControlLoopShape",
    "Controller",
    "Course",
    "ExpressionSystem",
    "FOPDTSystem",
    "InputCourses",
    "InputShape",
    "Loop",
    "Matrices",
    "Model",
    "NonlinearModel",
    "ParallelPID",
    "PolynomialSystem",
    "SOPDTSystem",
    "StandardPID",
    "StateSpaceSystem",
    "System",
    "ZPKSystem",
    "json_path",
    "located",
    "state_space_latex",
]
