"""Closed-loop poles, stability verdicts and the root locus."""

from looplab.engine.stability.closed_loop import ClosedLoopPoles, Verdict, closed_loop_poles, closed_loop_verdict
from looplab.engine.stability.root_locus import (
    AxisCrossing,
    Breakaway,
    RootLocus,
    axis_crossings,
    breakaway_points,
    root_locus,
)

__all__ = [
    "AxisCrossing",
    "Breakaway",
    "ClosedLoopPoles",
    "RootLocus",
    "Verdict",
    "axis_crossings",
    "breakaway_points",
    "closed_loop_poles",
    "closed_loop_verdict",
    "root_locus",
]
