"""Sampled curves with known slopes, as cubic Hermite polynomials between their samples."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]

# From the coefficients of a cubic p: the integrals over [0, 1] of p and of x p, and four numbers whose squares add up
# to that of p^2 (the Cholesky factor of the Hilbert matrix).
_POWERS = 1.0 / (np.arange(1.0, 5.0) + np.arange(2.0)[:, None])
_TO_INTEGRALS = np.vstack([_POWERS, np.linalg.cholesky(1.0 / (np.arange(1.0, 5.0) + np.arange(4.0)[:, None])).T])
# From the same: p(1); the coefficients of p and p' by powers of x; those of the integrals of p and x p up to x.
_AT_END = np.ones((1, 4))
_WITH_SLOPE = np.stack([np.eye(4), np.diag([1.0, 2.0, 3.0], 1)], axis=1).reshape(8, 4)
_UP_TO = np.stack([np.diag(row) for row in _POWERS], axis=1).reshape(8, 4)
_FOR_ROOTS = np.vstack([_AT_END, _WITH_SLOPE, _UP_TO])


def _before_root(cubics: FloatArray) -> FloatArray:
    """Integrals of p and x p from 0 to the root in [0, 1] of cubics p that change sign there once, shape (2, m)."""
    forms = _FOR_ROOTS.dot(cubics)
    start = cubics[0]
    x = start / (start - forms[0])
    a, b, c, d = forms[1:9].reshape(4, 2, -1)
    for _ in range(2):
        value, slope = a + x * (b + x * (c + x * d))
        step = value / slope
        x = x - step
    # An error of x counts only by its square here; where two steps are not enough one careful root is found.
    safe = np.abs(step) <= 1e-4
    safe &= np.abs(x - 0.5) <= 0.5
    if not safe.all():
        for i in (~safe).nonzero()[0].tolist():
            x[i] = _cubic_root(*cubics[:, i].tolist())
    a, b, c, d = forms[9:].reshape(4, 2, -1)
    before = x * (a + x * (b + x * (c + x * d)))
    before[1] *= x
    return np.asarray(before)


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
        self._climb = np.abs(chord)
        np.add(m0, m1, out=d)
        d -= chord
        d -= chord
        # The slope at the right end is the next sample's: at a kink it belongs to the next piece, so the cubic is
        # kept only where it agrees with the chord; elsewhere the parabola through both ends and the left slope.
        size = np.abs(m0)
        size += np.abs(m1)
        np.maximum(size, self._climb, out=size)
        size *= 0.5
        kink = np.abs(d) > size
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

    def extrema(self, row: int) -> tuple[FloatArray, FloatArray]:
        """Times and values of a row's turning points, corners at samples included, increasing in time."""
        flat, x, values, _ = self._turns
        m = self.h.size
        first, stop = flat.searchsorted((row * m, (row + 1) * m)).tolist()
        piece = flat[first:stop] - row * m
        at, value = self.t[piece] + x[first:stop] * self.h[piece], values[first:stop]
        corner = 1 + self._corner[row].nonzero()[0] if self._corner is not None else flat[:0]
        if corner.size:
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
        detour = np.abs(rise) + np.abs(chord - rise) - self._climb.take(flat)
        more = np.bincount(flat // m - first, weights=detour, minlength=self.y.shape[0] - first)
        total: list[float] = (self._climb[first:].sum(axis=1) + more).tolist()
        return total

    def absolute_integrals(self, count: int) -> list[tuple[float, float, float]]:
        """Of the first rows the integrals of |y|, y^2 and t|y| over the record.

        Pieces are split where y changes sign.
        """
        m = self.h.size
        cubics = self.cubics.reshape(4, -1)[:, : count * m]
        parts = _TO_INTEGRALS.dot(cubics)
        whole = parts[:2]
        above = self.y[:count] > 0.0
        flat = (above[:, 1:] != above[:, :-1]).ravel().nonzero()[0]
        if flat.size:
            with np.errstate(all="ignore"):
                before = _before_root(cubics.take(flat, axis=1))
            split = np.abs(before)
            split += np.abs(whole.take(flat, axis=1) - before)
        np.abs(whole, out=whole)
        if flat.size:
            whole[:, flat] = split
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
        y = self.y[row]
        beyond = y <= level if y[0] > level else y > level
        i = int(beyond.argmax())
        return self._crossing(row, i - 1, level) if i else None

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
