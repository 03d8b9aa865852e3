"""The root locus: branches (rational and with dead time), hand-construction points, and the count that proves them."""

from looplab.engine.stability.locus.construction import (
    Angle,
    Asymptotes,
    AxisCrossing,
    Breakaway,
    arrival_angles,
    asymptotes,
    axis_crossings,
    breakaway_points,
    departure_angles,
    real_axis_segments,
)
from looplab.engine.stability.locus.count import count_in_rectangle
from looplab.engine.stability.locus.root_locus import RootLocus, root_locus

__all__ = [
    "Angle",
    "Asymptotes",
    "AxisCrossing",
    "Breakaway",
    "RootLocus",
    "arrival_angles",
    "asymptotes",
    "axis_crossings",
    "breakaway_points",
    "count_in_rectangle",
    "departure_angles",
    "real_axis_segments",
    "root_locus",
]
