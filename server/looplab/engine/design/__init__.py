"""Controllers that are computed: pole placement by the Diophantine equation."""

from looplab.engine.design.coprimality import SharedRoot, shared_roots
from looplab.engine.design.diophantine import Diophantine, solve_diophantine, sylvester_matrix
from looplab.engine.design.pade import pade
from looplab.engine.design.pid_form import PIDForm, pid_form
from looplab.engine.design.pole_placement import PolePlacement, pole_placement

__all__ = [
    "Diophantine",
    "PIDForm",
    "PolePlacement",
    "SharedRoot",
    "pade",
    "pid_form",
    "pole_placement",
    "shared_roots",
    "solve_diophantine",
    "sylvester_matrix",
]
