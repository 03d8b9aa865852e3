"""A sampled curve with known slopes, as the cubic Hermite polynomial between its samples."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

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
Cubic = tuple[float, float, float, float]


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


class HermiteCurve:
    """y(t) through samples y with slopes dy, shape (n,) each; slopes are right-hand limits."""

    def __init__(self, t: FloatArray, y: FloatArray, dy: FloatArray) -> None:
        (only,) = HermiteCurve.several(t, y[None], dy[None])
        self.__dict__.update(only.__dict__)

    @classmethod
    def several(cls, t: FloatArray, y: FloatArray, dy: FloatArray) -> list[HermiteCurve]:
        """One curve for each row of y and dy, shape (k, n), over the same t."""
        h = t[1:] - t[:-1]
        pieces = np.empty((4, y.shape[0], h.size))
        pieces[0], pieces[2] = y[:, :-1], y[:, 1:]
        np.multiply(dy[:, :-1], h, out=pieces[1])
        np.multiply(dy[:, 1:], h, out=pieces[3])
        _, m0, _, m1 = pieces
        # The slope at the right end is the next sample's: at a kink it belongs to the next piece, so the cubic is
        # kept only where it agrees with the chord; elsewhere the parabola through both ends and the left slope.
        chord = pieces[2] - pieces[0]
        d = np.abs(m0 + m1 - 2.0 * chord)
        kink = d > 0.5 * np.maximum(np.abs(m0) + np.abs(m1), np.abs(chord)) + 1e-300
        corner = None
        if kink.any():
            m1[kink] = (2.0 * chord - m0)[kink]
            corner = m1[:, :-1] * m0[:, 1:] < 0
        rows, turning = (m0 * m1 < 0).nonzero()
        a, b, a1, b1 = pieces[:, rows, turning]
        d = b + b1 - 2.0 * (a1 - a)
        c = a1 - a - b - d
        x = _turning_points(b, c, d)
        summits = a + x * (b + x * (c + x * d))
        # What a curve goes up and down beyond the straight way between the samples.
        detours = np.abs(summits - a) + np.abs(a1 - summits) - np.abs(a1 - a)
        times = t[turning] + x * h[turning]
        out = []
        for i in range(y.shape[0]):
            curve, mine = object.__new__(cls), rows == i
            curve.t, curve.y, curve._h, curve._pieces = t, y[i], h, pieces[:, i]
            curve._summits = times[mine], summits[mine]
            curve._detours = float(detours[mine].sum())
            curve._corners = np.zeros(0, dtype=int) if corner is None else 1 + np.flatnonzero(corner[i])
            out.append(curve)
        return out

    t: FloatArray
    y: FloatArray
    _h: FloatArray
    _pieces: FloatArray  # ends and slopes per piece, y0, m0, y1, m1 by rows
    _summits: tuple[FloatArray, FloatArray]  # times and values of the turning points inside pieces
    _corners: npt.NDArray[np.intp]  # samples at which a kink is a turning point
    _detours: float

    def _cubic(self, i: int) -> Cubic:
        """Coefficients of a + b x + c x^2 + d x^3 for x in [0, 1] in piece i."""
        y0, m0, y1, m1 = self._pieces[:, i].tolist()
        d = m0 + m1 - 2 * (y1 - y0)
        return y0, m0, y1 - y0 - m0 - d, d

    def _time(self, i: int, x: float) -> float:
        return float(self.t[i]) + x * float(self._h[i])

    def _pieces_across(self, level: float) -> list[int]:
        above = self.y > level
        return np.flatnonzero(above[1:] != above[:-1]).tolist()

    def _crossing(self, piece: int, level: float) -> float:
        a, b, c, d = self._cubic(piece)
        return float(self.t[piece]) + _cubic_root(a - level, b, c, d) * float(self._h[piece])

    def crossings(self, level: float) -> FloatArray:
        """Times at which the curve crosses a level, increasing."""
        return np.array([self._crossing(i, level) for i in self._pieces_across(level)])

    def first_crossing(self, level: float) -> float | None:
        """Time at which the curve first crosses a level."""
        above = self.y > level
        changed = above != above[0]
        i = int(changed.argmax())
        return self._crossing(i - 1, level) if changed[i] else None

    def last_outside(self, level: float, band: float) -> float | None:
        """When the curve comes within level +- band for the rest of the record; None where it ends outside."""
        outside = np.abs(self.y - level) > band
        if outside[-1]:
            return None
        i = outside.size - 1 - int(outside[::-1].argmax())
        if not outside[i]:
            return 0.0
        return self._crossing(i, level + band if self.y[i] > level else level - band)

    def extrema(self) -> tuple[list[float], list[float]]:
        """Times and values of the turning points, corners at samples included, increasing in time."""
        times, values = self._summits
        if self._corners.size:
            times, values = np.append(times, self.t[self._corners]), np.append(values, self.y[self._corners])
            order = times.argsort(kind="stable")
            times, values = times[order], values[order]
        return times.tolist(), values.tolist()

    def absolute_integrals(self, level: float) -> tuple[float, float, float]:
        """Integrals of |e|, e^2 and t|e| over the record, e = level - y; pieces are split where e changes sign."""
        h, start = self._h, self.t[:-1]
        error = _TO_NODES @ self._pieces - level
        whole, moment = _TO_MOMENTS @ np.abs(error)
        for i in self._pieces_across(level):
            a, b, c, d = self._cubic(i)
            a -= level
            x = _cubic_root(a, b, c, d)
            before = x * (a + x * (b / 2 + x * (c / 3 + x * d / 4)))
            after = a + b / 2 + c / 3 + d / 4 - before
            before_x = x * x * (a / 2 + x * (b / 3 + x * (c / 4 + x * d / 5)))
            after_x = a / 2 + b / 3 + c / 4 + d / 5 - before_x
            whole[i], moment[i] = abs(before) + abs(after), abs(before_x) + abs(after_x)
        whole *= h
        moment *= h * h
        ise = _WEIGHTS @ np.square(error, out=error) @ h
        return float(whole.sum()), float(ise), float(start @ whole + moment.sum())

    def total_variation(self) -> float:
        """Sum of all ups and downs, turning points between the samples included."""
        return float(np.abs(self.y[1:] - self.y[:-1]).sum()) + self._detours
