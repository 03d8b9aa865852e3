"""A sampled curve with known slopes, as the cubic Hermite polynomial between its samples."""

from __future__ import annotations

from functools import cached_property
from math import copysign, sqrt

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

# Gauss-Legendre nodes and weights on [0, 1]: exact to degree 7, the square of a cubic included.
_NODES, _WEIGHTS = (0.5 * v for v in np.polynomial.legendre.leggauss(4))
_NODES = _NODES + 0.5
_POWERS = np.vander(_NODES, 4, increasing=True).T


def _cubic_root(a: float, b: float, c: float, d: float) -> float:
    """Root in [0, 1] of a + b x + c x^2 + d x^3, which changes sign there: Newton, bisecting where it would leave."""
    low, high = 0.0, 1.0
    end = a + b + c + d
    rising = end > a
    x = min(max(a / (a - end), 0.0), 1.0) if end != a else 0.5
    for _ in range(60):
        value = a + x * (b + x * (c + x * d))
        if value == 0.0:
            return x
        if (value > 0) == rising:
            high = x
        else:
            low = x
        slope = b + x * (2 * c + x * 3 * d)
        new = x - value / slope if slope else -1.0
        if not low <= new <= high:
            new = 0.5 * (low + high)
        if abs(new - x) < 1e-15:
            return new
        x = new
    return x


def _turning_point(b: float, c: float, d: float) -> float:
    """Root in [0, 1] of the slope b + 2 c x + 3 d x^2, which changes sign there."""
    q = -(c + copysign(sqrt(max(c * c - 3 * b * d, 0.0)), c))
    for x in (b / q if q else -1.0, q / (3 * d) if d else -1.0):
        if 0.0 <= x <= 1.0:
            return x
    return 0.5


class HermiteCurve:
    """y(t) through samples y with slopes dy, shape (n,) each; slopes are right-hand limits."""

    def __init__(self, t: FloatArray, y: FloatArray, dy: FloatArray) -> None:
        self.t, self.y, self.dy = t, y, dy

    @cached_property
    def _cubic(self) -> FloatArray:
        """Coefficients of a + b x + c x^2 + d x^3 for x in [0, 1], shape (4, n-1)."""
        h = self.t[1:] - self.t[:-1]
        y0 = self.y[:-1]
        # The slope at the right end is the next sample's: at a kink it belongs to the next piece, so the cubic is
        # kept only where it agrees with the chord; elsewhere the parabola through both ends and the left slope.
        m0, m1, chord = self.dy[:-1] * h, self.dy[1:] * h, self.y[1:] - y0
        d = m0 + m1 - 2 * chord
        kink = np.abs(d) > 0.5 * np.maximum(np.abs(m0) + np.abs(m1), np.abs(chord)) + 1e-300
        out = np.empty((4, h.size))
        out[0], out[1] = y0, m0
        out[2] = np.where(kink, chord - m0, chord - m0 - d)
        out[3] = np.where(kink, 0.0, d)
        return out

    def _times(self, pieces: list[int], x: list[float]) -> FloatArray:
        at = np.array(pieces, dtype=int)
        return self.t[at] + np.array(x) * (self.t[at + 1] - self.t[at])

    def crossings(self, level: float) -> FloatArray:
        """Times at which the curve crosses a level, increasing."""
        above = self.y > level
        pieces = np.flatnonzero(above[1:] != above[:-1])
        if not pieces.size:
            return np.zeros(0)
        x = [_cubic_root(a - level, b, c, d) for a, b, c, d in self._cubic[:, pieces].T.tolist()]
        return self._times(pieces.tolist(), x)

    @cached_property
    def _turns(self) -> tuple[list[int], list[float], list[float]]:
        """Pieces with a turning point inside, where in the piece, and the value there."""
        _, b, c, d = self._cubic
        pieces = np.flatnonzero(b * (b + 2 * c + 3 * d) < 0)
        where, values = [], []
        for a_, b_, c_, d_ in self._cubic[:, pieces].T.tolist():
            x = _turning_point(b_, c_, d_)
            where.append(x)
            values.append(a_ + x * (b_ + x * (c_ + x * d_)))
        return pieces.tolist(), where, values

    def extrema(self) -> tuple[FloatArray, FloatArray]:
        """Times and values of the turning points, corners at samples included, increasing in time."""
        _, b, c, d = self._cubic
        pieces, where, values = self._turns
        corner = 1 + np.flatnonzero((b + 2 * c + 3 * d)[:-1] * b[1:] < 0)
        times = np.append(self._times(pieces, where), self.t[corner])
        found = np.append(np.array(values), self.y[corner])
        order = np.argsort(times)
        return times[order], found[order]

    def absolute_integrals(self, level: float) -> tuple[float, float, float]:
        """Integrals of |e|, e^2 and t|e| over the record, e = level - y; pieces are split where e changes sign."""
        h, start = self.t[1:] - self.t[:-1], self.t[:-1]
        error = level - (self._cubic.T @ _POWERS)  # at the Gauss nodes of each piece
        size = np.abs(error)
        by_piece = size @ _WEIGHTS
        moment = (size * _NODES) @ _WEIGHTS
        iae = h * by_piece
        itae = h * (start * by_piece + h * moment)
        ise = float(h @ (error * error @ _WEIGHTS))
        above = self.y > level
        for i in np.flatnonzero(above[1:] != above[:-1]).tolist():
            a, b, c, d = self._cubic[:, i].tolist()
            x = _cubic_root(a - level, b, c, d)
            iae[i] = itae[i] = 0.0
            for low, high in ((0.0, x), (x, 1.0)):
                nodes = low + (high - low) * _NODES
                part = np.abs(level - (a + nodes * (b + nodes * (c + nodes * d)))) * _WEIGHTS * (high - low) * h[i]
                iae[i] += part.sum()
                itae[i] += (part * (start[i] + nodes * h[i])).sum()
        return float(iae.sum()), ise, float(itae.sum())

    def total_variation(self) -> float:
        """Sum of all ups and downs, turning points between the samples included."""
        total = float(np.abs(np.diff(self.y)).sum())
        for i, value in zip(self._turns[0], self._turns[2], strict=True):
            y0, y1 = float(self.y[i]), float(self.y[i + 1])
            total += abs(value - y0) + abs(y1 - value) - abs(y1 - y0)
        return total
