"""Fundamental limits of feedback, one a file: what no controller can do better, and what is left between them."""

from looplab.engine.limits.actuator import ActuatorDemand, Peak, actuator_demand, demand_peak
from looplab.engine.limits.bode_integral import BodeIntegral, bode_integral
from looplab.engine.limits.delay import delay_bound, ideal_delay_loop
from looplab.engine.limits.interpolation import Constraint, blaschke, interpolation_constraints, peak_bounds
from looplab.engine.limits.lemma_integrals import LemmaIntegral, lemma_integrals, weighted_integrals
from looplab.engine.limits.mismatch import Mismatch, Spread, mismatch, multiplicative_weight
from looplab.engine.limits.passed import load_left, noise_passed
from looplab.engine.limits.roots import pole_bound, zero_bound
from looplab.engine.limits.window import Demands, Limit, Window, bandwidth_window
from looplab.engine.limits.zeros import (
    StepShape,
    ZeroEffect,
    loop_step_shape,
    overshoot_bound,
    plant_step_shape,
    step_shape,
    undershoot_bound,
)

__all__ = [
    "ActuatorDemand",
    "BodeIntegral",
    "Constraint",
    "Demands",
    "LemmaIntegral",
    "Limit",
    "Mismatch",
    "Peak",
    "Spread",
    "StepShape",
    "Window",
    "ZeroEffect",
    "actuator_demand",
    "bandwidth_window",
    "blaschke",
    "bode_integral",
    "delay_bound",
    "demand_peak",
    "ideal_delay_loop",
    "interpolation_constraints",
    "lemma_integrals",
    "load_left",
    "loop_step_shape",
    "mismatch",
    "multiplicative_weight",
    "noise_passed",
    "overshoot_bound",
    "peak_bounds",
    "plant_step_shape",
    "pole_bound",
    "step_shape",
    "undershoot_bound",
    "weighted_integrals",
    "zero_bound",
]
