"""Closed-loop poles, stability verdicts and the root locus."""

from looplab.engine.stability.closed_loop import ClosedLoopPoles, Verdict, closed_loop_poles, closed_loop_verdict
from looplab.engine.stability.locus import (
    AxisCrossing,
    Breakaway,
    RootLocus,
    axis_crossings,
    breakaway_points,
    count_in_rectangle,
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
    "count_in_rectangle",
    "root_locus",
]
