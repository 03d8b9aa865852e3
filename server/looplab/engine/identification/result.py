"""What an identification gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from looplab.engine.identification.exact_response import LowOrder
from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class Fitted:
    """What a method found, before it is judged.

    Attributes
    ----------
    model : FOPDT, SOPDT or IPDT
    level : float
        y at rest with u_before [output].
    extra : ndarray, shape (n,) or ()
        What is added to the model's response and the level: drift, free response [output].
    intervals : dict or None
        95 % confidence interval of each parameter; None where the method has none.
    construction : dict
        Times, levels and lines to draw.
    notes : tuple of str
        Warnings of the method itself.
    estimated : dict
        Other estimated numbers, such as the drift.
    """

    model: LowOrder
    level: float
    extra: FloatArray = field(default_factory=lambda: np.zeros(()))
    intervals: Mapping[str, tuple[float, float]] | None = None
    construction: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    estimated: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Identified:
    """A model of recorded data, and how well it describes them.

    Attributes
    ----------
    method : str
    fitted : Fitted
    y_hat : ndarray, shape (n,)
        The model's output at the record's times [output].
    residuals : ndarray, shape (n,)
        y - y_hat, nan where y is missing [output].
    fit_pct : float or None
        None where y does not vary [%].
    warnings : tuple of str
    """

    method: str
    fitted: Fitted
    y_hat: FloatArray
    residuals: FloatArray
    fit_pct: float | None
    warnings: tuple[str, ...]
