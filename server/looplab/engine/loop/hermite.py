"""Sampled curves with known slopes, as cubic Hermite polynomials between their samples."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]

# Gauss-Legendre nodes and weights on [0, 1]: exact to degree 7, the square of a cubic included.
_NODES, _WEIGHTS = (0.5 * v for v in np.polynomial.legendre.leggauss(4))
_NODES = _NODES + 0.5
# Coefficients of a cubic to its values at the nodes, and those to integrals of y and x y.
_TO_NODES = np.vander(_NODES, 4, increasing=True)
_TO_MOMENTS = np.array([_WEIGHTS, _WEIGHTS * _NODES])
# Integrals over [0, 1] of the powers 1, x, x^2, x^3, and of x times them, shape (4, 2, 1).
_POWERS = np.array([1.0 / np.arange(1.0, 5.0), 1.0 / np.arange(2.0, 6.0)]).T[:, :, None]


def _split_moments(cubics: FloatArray) -> FloatArray:
    """Integrals of |p| and x |p| over [0, 1] of cubics p that change sign there once, shape (2, m)."""
    a, b, c, d = cubics
    twice, thrice = 2.0 * c, 3.0 * d
    step = x = a / (a - (a + b + c + d))
    for _ in range(2):
        step = (a + x * (b + x * (c + x * d))) / (b + x * (twice + x * thrice))
        x = x - step
    # An error of x counts only by its square here; where two steps are not enough one careful root is found.
    for i in (~((np.abs(step) <= 1e-4) & (x >= 0.0) & (x <= 1.0))).nonzero()[0].tolist():
        x[i] = _cubic_root(*cubics[:, i].tolist())
    parts = _POWERS * cubics[:, None]
    a, b, c, d = parts
    before = x * (a + x * (b + x * (c + x * d)))
    before[1] *= x
    return np.abs(before) + np.abs(parts.sum(axis=0) - before)


def _cubic_root(a: float, b: float, c: float, d: float) -> float:
    """Root in [0, 1] of a + b x + c x^2 + d x^3, which changes sign there: Newton, bisecting where it would leave."""
    low, high = 0.0, 1.0
    end = a + b + c + d
    # A curve that leaves its level flat has a root of high order there, to which Newton is slow.
    if a == 0.0 or end == 0.0:
        return 0.0 if a == 0.0 else 1.0
    rising = end > a
    x = min(max(a / (a - end), 0.0), 1.0) if end != a else 0.5
    last = 1.0
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
        step = abs(new - x)
        # Newton's steps shrink as their squares: the next would be step^3 / last^2.
        if step < 1e-15 or step * step * step < 1e-16 * last * last:
            return new
        x, last = new, step
    return x


def _turning_points(b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    """Roots in [0, 1] of the slopes b + 2 c x + 3 d x^2, which change sign there."""
    # At the root the slope moves to the sign that b does not have; of its two forms the one without cancellation.
    root = np.copysign(np.sqrt(np.maximum(c * c - 3.0 * b * d, 0.0)), b)
    x = np.where(b * c > 0.0, (c + root) / (-3.0 * d), b / (root - c))
    return np.minimum(np.maximum(x, 0.0), 1.0)


class HermiteCurves:
    """Curves y(t) through samples y with slopes dy, one a row, shape (k, n) each; slopes are right-hand limits."""

    def __init__(self, t: FloatArray, y: FloatArray, dy: FloatArray) -> None:
        self.t, self.y = t, y
        self.h = h = t[1:] - t[:-1]
        # Coefficients of a + b x + c x^2 + d x^3 for x in [0, 1] in each piece.
        self.cubics = np.empty((4, y.shape[0], h.size))
        _, m0, c, d = self.cubics
        self.cubics[0] = y[:, :-1]
        np.multiply(dy[:, :-1], h, out=m0)
        m1 = dy[:, 1:] * h
        self._chord = chord = y[:, 1:] - y[:, :-1]
        np.add(m0, m1, out=d)
        d -= 2.0 * chord
        # The slope at the right end is the next sample's: at a kink it belongs to the next piece, so the cubic is
        # kept only where it agrees with the chord; elsewhere the parabola through both ends and the left slope.
        size = np.abs(m0)
        size += np.abs(m1)
        np.maximum(size, np.abs(chord), out=size)
        kink = np.abs(d) > 0.5 * size + 1e-300
        self._corner: npt.NDArray[np.bool_] | None = None
        if kink.any():
            m1[kink] = (2.0 * chord - m0)[kink]
            d[kink] = 0.0
            self._corner = m1[:, :-1] * m0[:, 1:] < 0
        np.subtract(chord, m0, out=c)
        c -= d
        self._turning = m0 * m1 < 0

    @cached_property
    def _turns(self) -> tuple[Index, FloatArray, FloatArray, FloatArray]:
        """Pieces that turn inside, counted through the rows, where in the piece, the values there and at its start."""
        flat = self._turning.ravel().nonzero()[0]
        a, b, c, d = self.cubics.reshape(4, -1).take(flat, axis=1)
        with np.errstate(all="ignore"):
            x = _turning_points(b, c, d)
        return flat, x, a + x * (b + x * (c + x * d)), a

    @cached_property
    def extrema(self) -> list[tuple[list[float], list[float]]]:
        """Of each row times and values of the turning points, corners at samples included, increasing in time."""
        flat, x, values, _ = self._turns
        row, piece = np.divmod(flat, self.h.size)
        times = self.t[piece] + x * self.h[piece]
        ends = row.searchsorted(np.arange(self.y.shape[0] + 1)).tolist()
        out = []
        for i, mine in enumerate(slice(*pair) for pair in pairwise(ends)):
            at, value = times[mine], values[mine]
            if self._corner is not None:
                corner = 1 + np.flatnonzero(self._corner[i])
                at, value = np.append(at, self.t[corner]), np.append(value, self.y[i, corner])
                order = at.argsort(kind="stable")
                at, value = at[order], value[order]
            out.append((at.tolist(), value.tolist()))
        return out

    @cached_property
    def total_variation(self) -> list[float]:
        """Of each row the sum of all ups and downs, turning points between the samples included."""
        flat, _, values, start = self._turns
        chord = self._chord.take(flat)
        rise = values - start
        detour = np.abs(rise) + np.abs(chord - rise) - np.abs(chord)
        more = np.bincount(flat // self.h.size, weights=detour, minlength=self.y.shape[0])
        total: list[float] = (np.abs(self._chord).sum(axis=1) + more).tolist()
        return total

    def absolute_integrals(self, levels: Sequence[float]) -> list[tuple[float, float, float]]:
        """Of the first rows, one for each level, the integrals of |e|, e^2 and t|e| over the record, e = level - y.

        Pieces are split where e changes sign.
        """
        k, m = len(levels), self.h.size
        level = np.array(levels)[:, None]
        cubics = self.cubics[:, :k].copy()
        cubics[0] -= level
        cubics = cubics.reshape(4, -1)
        error = _TO_NODES @ cubics
        moments = _TO_MOMENTS @ np.abs(error)
        above = self.y[:k] > level
        flat = (above[:, 1:] != above[:, :-1]).ravel().nonzero()[0]
        if flat.size:
            with np.errstate(all="ignore"):
                moments[:, flat] = _split_moments(cubics.take(flat, axis=1))
        whole, moment = moments.reshape(2, k, m)
        whole *= self.h
        ise = (_WEIGHTS @ np.square(error, out=error)).reshape(k, m) @ self.h
        iae, itae = whole.sum(axis=1), whole @ self.t[:-1] + moment @ (self.h * self.h)
        return list(zip(iae.tolist(), ise.tolist(), itae.tolist(), strict=True))

    def _crossing(self, row: int, piece: int, level: float) -> float:
        a, b, c, d = self.cubics[:, row, piece].tolist()
        x = _cubic_root(a - level, b, c, d)
        return float(self.t[piece]) + x * float(self.h[piece])

    def crossings(self, row: int, level: float) -> list[float]:
        """Times at which a curve crosses a level, increasing."""
        above = self.y[row] > level
        return [self._crossing(row, i, level) for i in np.flatnonzero(above[1:] != above[:-1]).tolist()]

    def first_crossing(self, row: int, level: float) -> float | None:
        """Time at which a curve first crosses a level."""
        above = self.y[row] > level
        changed = above != above[0]
        i = int(changed.argmax())
        return self._crossing(row, i - 1, level) if changed[i] else None

    def last_outside(self, row: int, level: float, band: float) -> float | None:
        """When a curve comes within level +- band for the rest of the record; None where it ends outside."""
        y = self.y[row]
        outside = np.abs(y - level) > band
        if outside[-1]:
            return None
        i = outside.size - 1 - int(outside[::-1].argmax())
        if not outside[i]:
            return 0.0
        return self._crossing(row, i, level + band if y[i] > level else level - band)
