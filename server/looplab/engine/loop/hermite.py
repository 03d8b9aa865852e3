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
# y0, m0, y1, m1 (ends and slopes of a piece) to the values at the nodes, and those to integrals of y and x y.
_TO_NODES = np.array(
    [
        (1 + 2 * _NODES) * (1 - _NODES) ** 2,
        _NODES * (1 - _NODES) ** 2,
        _NODES**2 * (3 - 2 * _NODES),
        -(_NODES**2) * (1 - _NODES),
    ]
).T
_TO_MOMENTS = np.array([_WEIGHTS, _WEIGHTS * _NODES])
# Integrals over [0, 1] of the powers 1, x, x^2, x^3, and of x times them.
_INTEGRAL, _MOMENT = 1.0 / np.arange(1.0, 5.0), 1.0 / np.arange(2.0, 6.0)


def _split_moments(cubics: FloatArray) -> FloatArray:
    """Integrals of |p| and x |p| over [0, 1] of cubics p that change sign there once, shape (2, m)."""
    a, b, c, d = cubics
    end = a + b + c + d
    with np.errstate(all="ignore"):
        x = a / (a - end)
        for _ in range(2):
            x = x - (a + x * (b + x * (c + x * d))) / (b + x * (2.0 * c + x * 3.0 * d))
        # An error of x counts only by its square here; where two steps are not enough one careful root is found.
        left = np.abs(a + x * (b + x * (c + x * d)))
        lost = np.flatnonzero(~((left <= 1e-8 * np.maximum(np.abs(a), np.abs(end))) & (x >= 0.0) & (x <= 1.0)))
    for i in lost.tolist():
        x[i] = _cubic_root(*cubics[:, i].tolist())
    power = np.empty((5, x.size))
    power[0] = x
    for i in range(4):
        np.multiply(power[i], x, out=power[i + 1])
    before = np.stack([_INTEGRAL @ (cubics * power[:4]), _MOMENT @ (cubics * power[1:])])
    return np.abs(before) + np.abs(np.stack([_INTEGRAL @ cubics, _MOMENT @ cubics]) - before)


def _cubic_root(a: float, b: float, c: float, d: float) -> float:
    """Root in [0, 1] of a + b x + c x^2 + d x^3, which changes sign there: Newton, bisecting where it would leave."""
    low, high = 0.0, 1.0
    end = a + b + c + d
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
    with np.errstate(all="ignore"):
        q = -(c + np.copysign(np.sqrt(np.maximum(c * c - 3.0 * b * d, 0.0)), c))
        near, far = b / q, q / (3.0 * d)
    near[~((near >= 0.0) & (near <= 1.0))] = np.nan
    far[~((far >= 0.0) & (far <= 1.0))] = 0.5
    return np.where(np.isnan(near), far, near)


class HermiteCurves:
    """Curves y(t) through samples y with slopes dy, one a row, shape (k, n) each; slopes are right-hand limits."""

    def __init__(self, t: FloatArray, y: FloatArray, dy: FloatArray) -> None:
        self.t, self.y = t, y
        self.h = h = t[1:] - t[:-1]
        # Ends and slopes of each piece, y0, m0, y1, m1 by rows.
        self.pieces = pieces = np.empty((4, y.shape[0], h.size))
        pieces[0], pieces[2] = y[:, :-1], y[:, 1:]
        np.multiply(dy[:, :-1], h, out=pieces[1])
        np.multiply(dy[:, 1:], h, out=pieces[3])
        _, m0, _, m1 = pieces
        # The slope at the right end is the next sample's: at a kink it belongs to the next piece, so the cubic is
        # kept only where it agrees with the chord; elsewhere the parabola through both ends and the left slope.
        chord = pieces[2] - pieces[0]
        bent = np.abs(m0 + m1 - 2.0 * chord)
        kink = bent > 0.5 * np.maximum(np.abs(m0) + np.abs(m1), np.abs(chord)) + 1e-300
        self._corner: npt.NDArray[np.bool_] | None = None
        if kink.any():
            m1[kink] = (2.0 * chord - m0)[kink]
            self._corner = m1[:, :-1] * m0[:, 1:] < 0
        self._chord = chord

    def _cubics(self, flat: Index) -> FloatArray:
        """Coefficients of a + b x + c x^2 + d x^3 for x in [0, 1] in pieces counted through the rows, shape (4, m)."""
        a, b, a1, b1 = self.pieces.reshape(4, -1).take(flat, axis=1)
        chord = a1 - a
        d = b + b1 - 2.0 * chord
        return np.stack([a, b, chord - b - d, d])

    def _by_row(self, flat: Index) -> list[slice]:
        """Which of those pieces belong to each row."""
        ends = np.searchsorted(flat, self.h.size * np.arange(self.y.shape[0] + 1)).tolist()
        return [slice(*pair) for pair in pairwise(ends)]

    @cached_property
    def _turns(self) -> tuple[Index, FloatArray, FloatArray]:
        """Pieces with a turning point inside, counted through the rows, where in the piece and the value there."""
        flat = np.flatnonzero(self.pieces[1] * self.pieces[3] < 0)
        a, b, c, d = self._cubics(flat)
        x = _turning_points(b, c, d)
        return flat, x, a + x * (b + x * (c + x * d))

    @cached_property
    def extrema(self) -> list[tuple[list[float], list[float]]]:
        """Of each row times and values of the turning points, corners at samples included, increasing in time."""
        flat, x, values = self._turns
        piece = flat % self.h.size
        times = self.t[piece] + x * self.h[piece]
        out = []
        for i, mine in enumerate(self._by_row(flat)):
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
        flat, _, values = self._turns
        y0, y1 = self.pieces[::2].reshape(2, -1).take(flat, axis=1)
        detour = np.abs(values - y0) + np.abs(y1 - values) - np.abs(y1 - y0)
        straight = np.abs(self._chord).sum(axis=1).tolist()
        return [s + float(detour[mine].sum()) for s, mine in zip(straight, self._by_row(flat), strict=True)]

    def absolute_integrals(self, levels: Sequence[float]) -> list[tuple[float, float, float]]:
        """Of the first rows, one for each level, the integrals of |e|, e^2 and t|e| over the record, e = level - y.

        Pieces are split where e changes sign.
        """
        k, m = len(levels), self.h.size
        level = np.array(levels)[:, None]
        error = _TO_NODES @ self.pieces[:, :k].reshape(4, -1)
        error -= np.repeat(level, m)
        moments = _TO_MOMENTS @ np.abs(error)
        above = self.y[:k] > level
        flat = np.flatnonzero(above[:, 1:] != above[:, :-1])
        if flat.size:
            cubics = self._cubics(flat)
            cubics[0] -= level[flat // m, 0]
            moments[:, flat] = _split_moments(cubics)
        whole, moment = moments.reshape(2, k, m)
        whole *= self.h
        moment *= self.h * self.h
        ise = (_WEIGHTS @ np.square(error, out=error)).reshape(k, m) @ self.h
        iae, itae = whole.sum(axis=1), whole @ self.t[:-1] + moment.sum(axis=1)
        return list(zip(iae.tolist(), ise.tolist(), itae.tolist(), strict=True))

    def _crossing(self, row: int, piece: int, level: float) -> float:
        y0, m0, y1, m1 = self.pieces[:, row, piece].tolist()
        d = m0 + m1 - 2.0 * (y1 - y0)
        x = _cubic_root(y0 - level, m0, y1 - y0 - m0 - d, d)
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
