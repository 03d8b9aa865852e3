"""Laplace transforms: partial fractions, y(t) as an expression, initial and final values, linear ODEs."""

from looplab.engine.laplace.inputs import LaplaceInput, LaplaceInputType
from looplab.engine.laplace.inverse import (
    ExponentialSum,
    Mode,
    SimulationCheck,
    check_by_simulation,
    inverse_transform,
    suggested_horizon,
)
from looplab.engine.laplace.notation import LATEX, TEXT, fractions_sum
from looplab.engine.laplace.ode import ODESolution, solve_linear_ode
from looplab.engine.laplace.partial_fractions import (
    PartialFraction,
    PartialFractions,
    expand_rational,
    partial_fractions,
)
from looplab.engine.laplace.rational import Rational
from looplab.engine.laplace.theorems import LimitValue, final_value, initial_value

__all__ = [
    "LATEX",
    "TEXT",
    "ExponentialSum",
    "LaplaceInput",
    "LaplaceInputType",
    "LimitValue",
    "Mode",
    "ODESolution",
    "PartialFraction",
    "PartialFractions",
    "Rational",
    "SimulationCheck",
    "check_by_simulation",
    "expand_rational",
    "final_value",
    "fractions_sum",
    "initial_value",
    "inverse_transform",
    "partial_fractions",
    "solve_linear_ode",
    "suggested_horizon",
]
