"""A few explicit steps on plain floats: from sample to sample, starting a solver is most of its work."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from looplab.engine.errors import NonFinite
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.simulation.solvers import Solver, Tolerances
from looplab.engine.systems.polynomial import FloatArray

Rates = Callable[[float, Sequence[float]], Values]

# Beyond this many steps to the next stop a solver that chooses its own steps is quicker.
_MOST_STEPS = 5
# A piece is tried again as long as tries succeed more often than they fail.
_PATIENCE = 5


class Patience:
    """Whether short steps are worth trying: a stiff model would refuse them again and again."""

    def __init__(self) -> None:
        self.left = _PATIENCE

    def tell(self, success: bool) -> None:
        """How the last try went."""
        self.left = min(_PATIENCE, self.left + 1) if success else self.left - 1


class ShortSteps:
    r"""Dormand and Prince's pair of orders 5 and 4, as many equal steps as the tolerance needs, then another solver.

    Parameters
    ----------
    rates : callable
        dx/dt as a tuple, of t and a sequence.
    t, x : float and ndarray, shape (n,)
        The start.
    tolerances : Tolerances
    patience : Patience
    otherwise : callable
        (t, x) -> the solver that goes on where short steps do not serve.

    References
    ----------
    .. [1] E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer 1993,
       sec. II.5, table 5.2.
    """

    def __init__(
        self,
        rates: Rates,
        t: float,
        x: FloatArray,
        tolerances: Tolerances,
        patience: Patience,
        otherwise: Callable[[float, FloatArray], Solver],
    ) -> None:
        self.rates, self.t, self.x, self.patience, self.otherwise = rates, t, x.tolist(), patience, otherwise
        self.rtol, self.atol = tolerances.rtol, tolerances.atol.tolist()
        self.slope: Values | None = None
        self.other: Solver | None = None

    def advance(self, t: float) -> FloatArray:
        """The state at a later time."""
        if self.other is None:
            if self.patience.left > 0:
                done = self._steps(t)
                self.patience.tell(done)
                if done:
                    return np.array(self.x)
            self.other = self.otherwise(self.t, np.array(self.x))
        return self.other.advance(t)

    def _steps(self, end: float) -> bool:
        start, x, slope = self.t, self.x, self.slope
        count = 1
        try:
            slope = slope or self.rates(start, x)
            first = slope
            while count <= _MOST_STEPS:
                h, at, worst = (end - start) / count, start, 0.0
                x, slope = self.x, first
                for _ in range(count):
                    x, slope, error = self._step(at, x, slope, h)
                    worst, at = max(worst, error), at + h
                    if worst > 1.0:
                        break
                else:
                    self.t, self.x, self.slope = end, x, slope
                    return True
                if not worst < 1e6:
                    return False
                count = max(count + 1, int(count * 1.1 * worst**0.2) + 1)
        except (NonFinite, OverflowError):
            # A trial step may lead where the equations end though the solution does not.
            return False
        return False

    def _step(self, t: float, x: list[float], k1: Values, h: float) -> tuple[list[float], Values, float]:
        """One step: the state and slope after it, and its error over the tolerance."""
        f = self.rates
        a = h / 5.0
        k2 = f(t + a, [v + a * p for v, p in zip(x, k1, strict=True)])
        a, b = 3.0 * h / 40.0, 9.0 * h / 40.0
        k3 = f(t + 0.3 * h, [v + a * p + b * q for v, p, q in zip(x, k1, k2, strict=True)])
        a, b, c = 44.0 * h / 45.0, -56.0 * h / 15.0, 32.0 * h / 9.0
        k4 = f(t + 0.8 * h, [v + a * p + b * q + c * r for v, p, q, r in zip(x, k1, k2, k3, strict=True)])
        a, b, c, d = 19372.0 * h / 6561.0, -25360.0 * h / 2187.0, 64448.0 * h / 6561.0, -212.0 * h / 729.0
        k5 = f(
            t + 8.0 * h / 9.0,
            [v + a * p + b * q + c * r + d * s for v, p, q, r, s in zip(x, k1, k2, k3, k4, strict=True)],
        )
        a, b, c, d, e = (
            9017.0 * h / 3168.0, -355.0 * h / 33.0, 46732.0 * h / 5247.0, 49.0 * h / 176.0, -5103.0 * h / 18656.0,
        )  # fmt: skip
        k6 = f(
            t + h,
            [v + a * p + b * q + c * r + d * s + e * w for v, p, q, r, s, w in zip(x, k1, k2, k3, k4, k5, strict=True)],
        )
        a, b, c, d, e = (
            35.0 * h / 384.0, 500.0 * h / 1113.0, 125.0 * h / 192.0, -2187.0 * h / 6784.0, 11.0 * h / 84.0,
        )  # fmt: skip
        new = [
            v + a * p + b * r + c * s + d * w + e * z for v, p, r, s, w, z in zip(x, k1, k3, k4, k5, k6, strict=True)
        ]
        k7 = f(t + h, new)
        a, b, c, d, e, g = (
            71.0 * h / 57600.0, -71.0 * h / 16695.0, 71.0 * h / 1920.0, -17253.0 * h / 339200.0, 22.0 * h / 525.0,
            -h / 40.0,
        )  # fmt: skip
        rtol = self.rtol
        error = max(
            abs(a * p + b * r + c * s + d * w + e * z + g * o) / (atol + rtol * max(abs(v), abs(n)))
            for p, r, s, w, z, o, v, n, atol in zip(k1, k3, k4, k5, k6, k7, x, new, self.atol, strict=True)
        )
        return new, k7, error
