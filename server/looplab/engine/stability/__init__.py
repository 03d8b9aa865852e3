"""Closed-loop poles, stability verdicts and notions, the Routh array, stable gain ranges and the root locus."""

from looplab.engine.stability.axis_poles import axis_poles_are_simple
from looplab.engine.stability.bibo import BIBO, BoundedInput, bibo
from looplab.engine.stability.characteristic import characteristic_polynomial
from looplab.engine.stability.closed_loop import ClosedLoopPoles, Verdict, closed_loop_poles, closed_loop_verdict
from looplab.engine.stability.gain_ranges import GainEnd, GainRange, GainRanges, gain_ranges
from looplab.engine.stability.internal import Cancellation, GangMember, InternalStability, internal_stability
from looplab.engine.stability.locus import (
    AxisCrossing,
    Breakaway,
    RootLocus,
    axis_crossings,
    breakaway_points,
    count_in_rectangle,
    root_locus,
)
from looplab.engine.stability.minimal_modes import state_space_bibo
from looplab.engine.stability.notions import Mode, StabilityNotion, matrix_stability, system_stability
from looplab.engine.stability.pi_region import PIBoundary, PIRegion, pi_boundary, pi_gain_ranges, pi_region
from looplab.engine.stability.routh import RouthArray, RouthRow, routh_array
from looplab.engine.stability.setpoint_transfer import setpoint_transfer

__all__ = [
    "BIBO",
    "AxisCrossing",
    "BoundedInput",
    "Breakaway",
    "Cancellation",
    "ClosedLoopPoles",
    "GainEnd",
    "GainRange",
    "GainRanges",
    "GangMember",
    "InternalStability",
    "Mode",
    "PIBoundary",
    "PIRegion",
    "RootLocus",
    "RouthArray",
    "RouthRow",
    "StabilityNotion",
    "Verdict",
    "axis_crossings",
    "axis_poles_are_simple",
    "bibo",
    "breakaway_points",
    "characteristic_polynomial",
    "closed_loop_poles",
    "closed_loop_verdict",
    "count_in_rectangle",
    "gain_ranges",
    "internal_stability",
    "matrix_stability",
    "pi_boundary",
    "pi_gain_ranges",
    "pi_region",
    "root_locus",
    "routh_array",
    "setpoint_transfer",
    "state_space_bibo",
    "system_stability",
]
