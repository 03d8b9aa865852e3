"""Steady states of nonlinear models: all of them, over an input, in the phase plane, and the linear model at each."""

from looplab.engine.nonlinear.steady_states.balance import BalanceBranch, BalanceCurve, balance_curve
from looplab.engine.nonlinear.steady_states.continuation import (
    SpecialPoint,
    SteadyStateCurves,
    continue_steady_states,
)
from looplab.engine.nonlinear.steady_states.linearize import (
    Comparison,
    LinearModel,
    compare_step,
    linear_step,
    linearize,
)
from looplab.engine.nonlinear.steady_states.phase_plane import PhasePlane, Trajectory, phase_plane, trajectories
from looplab.engine.nonlinear.steady_states.search import (
    SteadyState,
    SteadyStateSearch,
    find_steady_states,
    outputs_at,
    steady_state_near,
)

__all__ = [
    "BalanceBranch",
    "BalanceCurve",
    "Comparison",
    "LinearModel",
    "PhasePlane",
    "SpecialPoint",
    "SteadyState",
    "SteadyStateCurves",
    "SteadyStateSearch",
    "Trajectory",
    "balance_curve",
    "compare_step",
    "continue_steady_states",
    "find_steady_states",
    "linear_step",
    "linearize",
    "outputs_at",
    "phase_plane",
    "steady_state_near",
    "trajectories",
]
