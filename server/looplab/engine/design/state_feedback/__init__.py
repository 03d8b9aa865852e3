"""State feedback: pole placement, regulators, observers, setpoints, and the loop that they make."""

from looplab.engine.design.state_feedback.full_state import (
    GainResult,
    StateFeedback,
    design_state_feedback,
    separated_poles,
    whole_loop_poles,
)
from looplab.engine.design.state_feedback.linear_loop import (
    LinearLoop,
    LinearRun,
    Push,
    linear_loop,
    linear_run,
    loop_transfer,
)
from looplab.engine.design.state_feedback.lqr import Regulator, lqr
from looplab.engine.design.state_feedback.placement import Placement, place_poles
from looplab.engine.design.state_feedback.reference_gain import reference_gain, with_integrators
from looplab.engine.design.state_feedback.settings import ByPoles, ByWeights, DesignSettings, Faster

__all__ = [
    "ByPoles",
    "ByWeights",
    "DesignSettings",
    "Faster",
    "GainResult",
    "LinearLoop",
    "LinearRun",
    "Placement",
    "Push",
    "Regulator",
    "StateFeedback",
    "design_state_feedback",
    "linear_loop",
    "linear_run",
    "loop_transfer",
    "lqr",
    "place_poles",
    "reference_gain",
    "separated_poles",
    "whole_loop_poles",
    "with_integrators",
]
