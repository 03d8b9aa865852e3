"""Sampled curves with known slopes, as cubic Hermite polynomials between their samples."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]

# A piece is not split at its sign change where y is smaller than this fraction of its largest mean.
SETTLED = 1e-12

# From the coefficients of a cubic p: the integrals over [0, 1] of p and of x p, and four numbers whose squares add up
# to that of p^2 (the Cholesky factor of the Hilbert matrix).
_POWERS = 1.0 / (np.arange(1.0, 5.0) + np.arange(2.0)[:, None])
_TO_INTEGRALS = np.vstack([_POWERS, np.linalg.cholesky(1.0 / (np.arange(1.0, 5.0) + np.arange(4.0)[:, None])).T])


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


def _split_integrals(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Integrals of |p| and x |p| over [0, 1] for p = a + b x + c x^2 + d x^3, which changes sign there once."""
    x = _cubic_root(a, b, c, d)
    whole, moment = a + b / 2.0 + c / 3.0 + d / 4.0, a / 2.0 + b / 3.0 + c / 4.0 + d / 5.0
    before = x * (a + x * (b / 2.0 + x * (c / 3.0 + x * d / 4.0)))
    moment_before = x * x * (a / 2.0 + x * (b / 3.0 + x * (c / 4.0 + x * d / 5.0)))
    return abs(before) + abs(whole - before), abs(moment_before) + abs(moment - moment_before)


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
        # Coefficients of a + b x + c x^2 + d x^3 for x in [0, 1] in each piece; b is the slope at its start. Then come
        # the slope at its end and the chord.
        work = np.empty((6, y.shape[0], h.size))
        self.cubics = work[:4]
        a, m0, c, d, m1, chord = work
        a[...] = y[:, :-1]
        np.multiply(dy[:, :-1], h, out=m0)
        np.multiply(dy[:, 1:], h, out=m1)
        np.subtract(y[:, 1:], a, out=chord)
        np.subtract(chord, m0, out=c)
        np.subtract(m1, chord, out=d)
        d -= c
        c -= d
        self._chord = chord
        # The slope at the right end is the next sample's: at a kink it belongs to the next piece, so the cubic is
        # kept only where it agrees with the chord; elsewhere the parabola through both ends and the left slope.
        first, _, third, last, across = np.abs(work[1:])
        first += last
        np.maximum(first, across, out=first)
        third *= 2.0
        kink = third > first
        self._corner: npt.NDArray[np.bool_] | None = None
        if kink.any():
            m1[kink] = (2.0 * chord - m0)[kink]
            d[kink] = 0.0
            c[kink] = (chord - m0)[kink]
            self._corner = m1[:, :-1] * m0[:, 1:] < 0
        self._turning = m0 * m1 < 0

    @cached_property
    def _turns(self) -> tuple[Index, FloatArray, FloatArray, FloatArray]:
        """Pieces that turn inside, counted through the rows, where in the piece, the values there and at its start."""
        flat = self._turning.ravel().nonzero()[0]
        a, b, c, d = self.cubics.reshape(4, -1).take(flat, axis=1)
        with np.errstate(all="ignore"):
            x = _turning_points(b, c, d)
        return flat, x, a + x * (b + x * (c + x * d)), a

    def extrema(self, row: int) -> tuple[FloatArray, FloatArray]:
        """Times and values of a row's turning points, corners at samples included, increasing in time."""
        flat, x, values, _ = self._turns
        m = self.h.size
        first, stop = flat.searchsorted((row * m, (row + 1) * m)).tolist()
        piece = flat[first:stop] - row * m
        at, value = self.t[piece] + x[first:stop] * self.h[piece], values[first:stop]
        if self._corner is not None:
            corner = 1 + np.flatnonzero(self._corner[row])
            at, value = np.append(at, self.t[corner]), np.append(value, self.y[row, corner])
            order = at.argsort(kind="stable")
            at, value = at[order], value[order]
        return at, value

    def total_variation(self, first: int) -> list[float]:
        """Of each row from ``first`` on the sum of all ups and downs, turning points between the samples included."""
        flat, _, values, start = self._turns
        m = self.h.size
        begin = int(flat.searchsorted(first * m))
        flat, rise = flat[begin:], values[begin:] - start[begin:]
        chord = self._chord.take(flat)
        detour = np.abs(rise) + np.abs(chord - rise) - np.abs(chord)
        more = np.bincount(flat // m - first, weights=detour, minlength=self.y.shape[0] - first)
        total: list[float] = (np.abs(self._chord[first:]).sum(axis=1) + more).tolist()
        return total

    def absolute_integrals(self, count: int) -> list[tuple[float, float, float]]:
        """Of the first rows the integrals of |y|, y^2 and t|y| over the record.

        Pieces are split where y changes sign.
        """
        m = self.h.size
        cubics = self.cubics.reshape(4, -1)[:, : count * m]
        parts = _TO_INTEGRALS @ cubics
        whole = parts[:2]
        above = self.y[:count] > 0.0
        np.abs(whole, out=whole)
        flat = (above[:, 1:] != above[:, :-1]).ravel().nonzero()[0]
        if flat.size:
            # What is below rounding of the whole, as where a response has settled, may stay as it is.
            flat = flat[whole[0].take(flat) + np.abs(cubics[0].take(flat)) > SETTLED * whole[0].max()]
            split = [_split_integrals(*cubic) for cubic in cubics.take(flat, axis=1).T.tolist()]
            if split:
                whole[:, flat] = np.array(split).T
        np.square(parts[2:], out=parts[2:])
        parts = parts.reshape(6, count, m)
        ia, _, *squares = (parts @ self.h).tolist()
        ita = parts[0] @ (self.h * self.t[:-1]) + parts[1] @ (self.h * self.h)
        return list(zip(ia, map(sum, zip(*squares, strict=True)), ita.tolist(), strict=True))

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
