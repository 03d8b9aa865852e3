"""What a signal has been, as polynomials: a dead time of a continuous loop looks it up."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable

import numpy as np

from looplab.engine.systems.polynomial import FloatArray

_DEGREE = 12
# Chebyshev points of a panel, on [-1, 1], both ends included; values there to Chebyshev and to power coefficients.
_X = -np.cos(np.pi * np.arange(_DEGREE + 1) / _DEGREE)
_TO_CHEBYSHEV = np.linalg.inv(np.polynomial.chebyshev.chebvander(_X, _DEGREE))
_POWERS = np.zeros((_DEGREE + 1, _DEGREE + 1))
for _n in range(_DEGREE + 1):
    _POWERS[_n, : _n + 1] = np.polynomial.chebyshev.cheb2poly([0.0] * _n + [1.0])
_TO_POWERS = _POWERS.T @ _TO_CHEBYSHEV


def panel_times(begin: float, end: float) -> FloatArray:
    """Times at which a panel's values are wanted, shape (13,)."""
    t = 0.5 * (begin + end) + 0.5 * (end - begin) * _X
    t[0], t[-1] = begin, end
    return t


class History:
    """A signal up to now, delayed by a dead time: a course for an input of the loop's model.

    Parameters
    ----------
    theta : float
        Dead time [time].
    before : float
        The signal's value before the first panel.

    Attributes
    ----------
    error : float
        Largest error of the polynomials found, from the size of their last coefficients [signal].
    """

    def __init__(self, theta: float, before: float) -> None:
        self.theta, self.before = theta, before
        self.starts: list[float] = []
        self.panels: list[tuple[float, float, list[float]]] = []
        self.error = 0.0

    def tail(self, values: FloatArray) -> float:
        """Error to expect of a panel with these values, shape (13,)."""
        return float(np.abs(_TO_CHEBYSHEV[-2:] @ values).max())

    def append(self, begin: float, end: float, values: FloatArray) -> None:
        """One more panel, with its values at ``panel_times``."""
        self.starts.append(begin)
        # Highest power first, as it is evaluated.
        self.panels.append((0.5 * (begin + end), 2.0 / (end - begin), (_TO_POWERS @ values)[::-1].tolist()))
        self.error = max(self.error, self.tail(values))

    def value(self, t: float) -> float:
        """The signal at a time that is past."""
        index = bisect_right(self.starts, t) - 1
        if index < 0:
            return self.before
        middle, scale, powers = self.panels[index]
        # Beyond its last panel it would be a guess: a solver that looks ahead gets the last value.
        x = min((t - middle) * scale, 1.0)
        out = 0.0
        for power in powers:
            out = out * x + power
        return out

    def piece(self, start: float) -> float | Callable[[float], float]:
        """The delayed signal from ``start`` on."""
        del start
        theta = self.theta
        return lambda t: self.value(t - theta)
