"""Controllers that are computed from a model: pole placement by the Diophantine equation, the Smith predictor, and (in
``state_feedback``) feedback of every state."""

from looplab.engine.design.coprimality import SharedRoot, shared_roots
from looplab.engine.design.diophantine import Diophantine, solve_diophantine, sylvester_matrix
from looplab.engine.design.mismatch import Axis, MismatchLoop
from looplab.engine.design.pade import pade
from looplab.engine.design.pid_form import PIDForm, pid_form
from looplab.engine.design.pole_placement import PolePlacement, pole_placement, required_degree
from looplab.engine.design.smith_loop import known_failures, smith_loop
from looplab.engine.design.smith_tuning import SmithTuning, smith_tuning
from looplab.engine.design.stable_region import RANGES, Plane, Region, stable_intervals, stable_region

__all__ = [
    "RANGES",
    "Axis",
    "Diophantine",
    "MismatchLoop",
    "PIDForm",
    "Plane",
    "PolePlacement",
    "Region",
    "SharedRoot",
    "SmithTuning",
    "known_failures",
    "pade",
    "pid_form",
    "pole_placement",
    "required_degree",
    "shared_roots",
    "smith_loop",
    "smith_tuning",
    "solve_diophantine",
    "stable_intervals",
    "stable_region",
    "sylvester_matrix",
]
