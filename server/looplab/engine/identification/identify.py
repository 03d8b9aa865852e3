"""All methods by name, and one way to ask any of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from looplab.engine.identification.area import area
from looplab.engine.identification.exact_response import model_response
from looplab.engine.identification.judgement import fit_percent, warnings
from looplab.engine.identification.least_squares import Unknowns, least_squares
from looplab.engine.identification.record import Record
from looplab.engine.identification.result import Fitted, Identified
from looplab.engine.identification.step_data import Choices, step_data
from looplab.engine.identification.tangent import tangent
from looplab.engine.identification.two_points import SUNDARESAN_KRISHNASWAMY, two_points

MethodName = Literal[
    "tangent",
    "tangent_63",
    "two_point",
    "sundaresan_krishnaswamy",
    "area",
    "least_squares",
    "least_squares_sopdt",
    "least_squares_ipdt",
]


@dataclass(frozen=True)
class Method:
    """A method of identification.

    Attributes
    ----------
    name : str
    source : str
    needs_step : bool
        Whether it reads a step response; otherwise it takes any input.
    apply : callable
        (record, choices, unknowns) -> Fitted
    """

    name: str
    source: str
    needs_step: bool
    apply: Callable[[Record, Choices, Unknowns], Fitted]


_SMITH = "C. A. Smith, A. B. Corripio, Principles and Practice of Automatic Process Control, 3rd ed., 2006, sec. 7-2"
_LEAST_SQUARES = "smallest sum of squared residuals by variable projection (Golub, Pereyra, 1973), dead time exact"
METHODS: dict[MethodName, Method] = {
    "tangent": Method(
        "tangent at the inflection",
        "J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768",
        True,
        lambda record, choices, _: tangent(step_data(record, choices), choices),
    ),
    "tangent_63": Method(
        "tangent and 63.2 %",
        f"{_SMITH} (fit 2)",
        True,
        lambda record, choices, _: tangent(step_data(record, choices), choices, to_63=True),
    ),
    "two_point": Method(
        "two points, 28.3 % and 63.2 %",
        f"{_SMITH} (fit 3)",
        True,
        lambda record, choices, _: two_points(step_data(record, choices)),
    ),
    "sundaresan_krishnaswamy": Method(
        "two points, 35.3 % and 85.3 %",
        "K. R. Sundaresan, P. R. Krishnaswamy, Can. J. Chem. Eng. 56 (1978) 257-262",
        True,
        lambda record, choices, _: two_points(step_data(record, choices), SUNDARESAN_KRISHNASWAMY),
    ),
    "area": Method(
        "two areas",
        "K. J. Åström, T. Hägglund, PID Controllers, 2nd ed., 1995, sec. 2.4",
        True,
        lambda record, choices, _: area(step_data(record, choices)),
    ),
    "least_squares": Method(
        "least squares, first order with dead time",
        _LEAST_SQUARES,
        False,
        lambda record, _, unknowns: least_squares(record, "FOPDT", unknowns),
    ),
    "least_squares_sopdt": Method(
        "least squares, second order with dead time",
        _LEAST_SQUARES,
        False,
        lambda record, _, unknowns: least_squares(record, "SOPDT", unknowns),
    ),
    "least_squares_ipdt": Method(
        "least squares, integrator with dead time",
        _LEAST_SQUARES,
        False,
        lambda record, _, unknowns: least_squares(record, "IPDT", unknowns),
    ),
}


def identify(
    record: Record, method: MethodName, choices: Choices | None = None, unknowns: Unknowns | None = None
) -> Identified:
    """A model of a record by one method, with its output, its fit and what speaks against it.

    Parameters
    ----------
    record : Record
    method : str
        One of METHODS.
    choices : Choices or None
        For the methods that read a step response.
    unknowns : Unknowns or None
        For least squares.

    Returns
    -------
    Identified

    Raises
    ------
    RuleNotApplicable, InvalidInput
        The data are not what the method needs, with the reason.
    """
    fitted = METHODS[method].apply(record, choices or Choices(), unknowns or Unknowns())
    y_hat = fitted.level + fitted.extra + model_response(fitted.model, record)
    residuals = record.y - y_hat
    if fitted.intervals is not None and fitted.intervals["theta"][0] < 0:
        low_end = (0.0, fitted.intervals["theta"][1])
        fitted = replace(fitted, intervals={**fitted.intervals, "theta": low_end})
    seen = record.seen
    return Identified(
        method,
        fitted,
        np.asarray(y_hat),
        residuals,
        fit_percent(record.y[seen], y_hat[seen]),
        warnings(record, fitted, residuals),
    )
