"""First- and second-order systems: what they are, and how systems of higher order are approximated by them."""

from looplab.engine.low_order.character import Character, characterize
from looplab.engine.low_order.comparison import (
    METHODS,
    Approximation,
    Comparison,
    Deviation,
    Method,
    MethodName,
    approximate,
    largest_deviation,
)
from looplab.engine.low_order.half_rule import half_rule
from looplab.engine.low_order.integrating import integrating_half_rule, ramp_asymptote
from looplab.engine.low_order.least_squares import least_squares_fit
from looplab.engine.low_order.models import MODEL_TYPES, Lags, ModelType, real_lags, time_constants
from looplab.engine.low_order.step_curve import StepCurve, model_step
from looplab.engine.low_order.taylor import taylor

__all__ = [
    "METHODS",
    "MODEL_TYPES",
    "Approximation",
    "Character",
    "Comparison",
    "Deviation",
    "Lags",
    "Method",
    "MethodName",
    "ModelType",
    "StepCurve",
    "approximate",
    "characterize",
    "half_rule",
    "integrating_half_rule",
    "largest_deviation",
    "least_squares_fit",
    "model_step",
    "ramp_asymptote",
    "real_lags",
    "taylor",
    "time_constants",
]
