"""Simulation of nonlinear models in time."""

from looplab.engine.nonlinear.inputs import InputCourse, noise, table
from looplab.engine.nonlinear.simulation.arguments import call_budget
from looplab.engine.nonlinear.simulation.open_loop import simulate_open_loop
from looplab.engine.nonlinear.simulation.result import EventRecord, Simulation
from looplab.engine.nonlinear.simulation.solvers import METHODS

__all__ = [
    "METHODS",
    "EventRecord",
    "InputCourse",
    "Simulation",
    "call_budget",
    "noise",
    "simulate_open_loop",
    "table",
]
