"""A sampled curve with known slopes, as the cubic Hermite polynomial between its samples."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

# Gauss-Legendre nodes and weights on [0, 1]: exact to degree 7, the square of a cubic included.
_NODES, _WEIGHTS = (0.5 * v for v in np.polynomial.legendre.leggauss(4))
_NODES = _NODES + 0.5


class HermiteCurve:
    """y(t) through samples y with slopes dy, shape (n,) each; slopes are right-hand limits."""

    def __init__(self, t: FloatArray, y: FloatArray, dy: FloatArray) -> None:
        self.t, self.y, self.dy = t, y, dy

    @cached_property
    def _cubic(self) -> FloatArray:
        """Coefficients of y_i + b x + c x^2 + d x^3 for x in [0, 1], shape (4, n-1)."""
        h = np.diff(self.t)
        y0, y1 = self.y[:-1], self.y[1:]
        # The slope at the right end is the next sample's: at a kink it belongs to the next piece, so the cubic is
        # kept only where it agrees with the chord; elsewhere the parabola through both ends and the left slope.
        m0, m1, chord = self.dy[:-1] * h, self.dy[1:] * h, y1 - y0
        c, d = 3 * chord - 2 * m0 - m1, m0 + m1 - 2 * chord
        scale = np.maximum(np.abs(m0) + np.abs(m1), np.abs(chord)) + 1e-300
        kink = np.abs(d) > 0.5 * scale
        return np.stack([y0, m0, np.where(kink, chord - m0, c), np.where(kink, 0.0, d)])

    def _value(self, piece: npt.NDArray[np.intp], x: FloatArray) -> FloatArray:
        a, b, c, d = self._cubic[:, piece]
        return a + x * (b + x * (c + x * d))

    def _time(self, piece: npt.NDArray[np.intp], x: FloatArray) -> FloatArray:
        return self.t[piece] + x * (self.t[piece + 1] - self.t[piece])

    def crossings(self, level: float) -> FloatArray:
        """Times at which the curve crosses a level, increasing."""
        above = self.y > level
        piece = np.flatnonzero(above[1:] != above[:-1])
        if not piece.size:
            return np.zeros(0)
        y0, b, c, d = self._cubic[:, piece]
        low, high = np.zeros(piece.size), np.ones(piece.size)
        rising = above[piece + 1]
        x = (level - self.y[piece]) / (self.y[piece + 1] - self.y[piece])
        for _ in range(60):
            value = y0 + x * (b + x * (c + x * d)) - level
            past = (value > 0) == rising
            high, low = np.where(past, x, high), np.where(past, low, x)
            with np.errstate(all="ignore"):
                newton = x - value / (b + x * (2 * c + x * 3 * d))
            inside = (newton >= low) & (newton <= high)
            new = np.where(inside, newton, 0.5 * (low + high))
            step = np.abs(new - x).max()
            x = new
            if step < 1e-15:
                break
        return self._time(piece, x)

    def extrema(self) -> tuple[FloatArray, FloatArray]:
        """Times and values of the turning points, corners at samples included, increasing in time."""
        _, b, c, d = self._cubic
        with np.errstate(all="ignore"):
            root = np.sqrt(np.maximum(c * c - 3 * b * d, 0.0))
            q = -(c + np.copysign(root, c))
            candidates = np.stack([q / (3 * d), b / q])
        real = (c * c - 3 * b * d > 0) & np.isfinite(candidates) & (candidates > 0) & (candidates < 1)
        which, piece = np.nonzero(real)
        x = candidates[which, piece]
        times, values = self._time(piece, x), self._value(piece, x)
        corner = 1 + np.flatnonzero(
            (np.sign(self.y[1:-1] - self.y[:-2]) * np.sign(self.y[2:] - self.y[1:-1]) < 0)
            & (b[1:] * (b[:-1] + 2 * c[:-1] + 3 * d[:-1]) < 0)
        )
        times, values = np.append(times, self.t[corner]), np.append(values, self.y[corner])
        order = np.argsort(times)
        return times[order], values[order]

    def absolute_integrals(self) -> tuple[float, float, float]:
        """Integrals of |y|, y^2 and t|y| over the record; pieces are split where y changes sign."""
        zeros = self.crossings(0.0)
        edges = np.unique(np.concatenate([self.t, zeros]))
        h = np.diff(edges)
        t = edges[:-1, None] + h[:, None] * _NODES
        piece = np.clip(np.searchsorted(self.t, 0.5 * (edges[1:] + edges[:-1]), side="right") - 1, 0, self.t.size - 2)
        x = (t - self.t[piece, None]) / (self.t[piece + 1] - self.t[piece])[:, None]
        y = self._value(np.broadcast_to(piece[:, None], x.shape), x)
        weights = h[:, None] * _WEIGHTS
        return (
            float((weights * np.abs(y)).sum()),
            float((weights * y * y).sum()),
            float((weights * t * np.abs(y)).sum()),
        )

    def total_variation(self) -> float:
        """Sum of all ups and downs, turning points between the samples included."""
        times, values = self.extrema()
        t, y = np.append(self.t, times), np.append(self.y, values)
        return float(np.abs(np.diff(y[np.argsort(t, kind="stable")])).sum())
