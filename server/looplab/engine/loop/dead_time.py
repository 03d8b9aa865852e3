r"""Exact responses of a linear loop with one dead time.

Between two multiples of the dead time the loop is an ordinary linear system driven by its own past. With
x^m(s) = x(m theta + s) for 0 <= s <= theta and the shift operator z (z x^m = x^{m-1}) the loop reads
dx/ds = A(z) x, so that

.. math:: x^m(s) = \sum_j F_j(s)\, x^{m-j}(0), \qquad e^{s A(z)} = \sum_j F_j(s) z^j .

The F_j are read off exp(s A(z)) at roots of unity by an inverse FFT. Nothing is approximated but the tail of that
series, which is made smaller than rounding. A Pade fraction is nowhere.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import factorial

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import NoConvergence

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

TAIL = 1e-13
MAX_NODES = 2048
# 1/k! for k = 4 i + j
_TAYLOR = np.array([[1.0 / factorial(4 * i + j) for j in range(4)] for i in range(4)])
# z (k,) -> A(z) (k, n, n), C(z) (k, p, n)
Symbol = Callable[[ComplexArray], tuple[ComplexArray, ComplexArray]]


@dataclass(frozen=True)
class TimeGrid:
    """Output times k*h that fall on the breakpoints: theta = per_interval*h, or h = intervals_per_step*theta."""

    h: float
    count: int
    per_interval: int
    intervals_per_step: int

    @property
    def t(self) -> FloatArray:
        """The times, shape (count,) [time]."""
        return self.h * np.arange(self.count)


def delay_grid(theta: float, horizon: float, points: int) -> TimeGrid:
    """A grid close to ``points`` samples over ``horizon`` on which every multiple of theta is a sample, if it can be."""
    h0 = horizon / (points - 1)
    if theta >= h0:
        per_interval = int(np.ceil(theta / h0 - 1e-9))
        h = theta / per_interval
        return TimeGrid(h, int(np.floor(horizon / h + 1e-9)) + 1, per_interval, 1)
    per_step = max(1, int(np.floor(h0 / theta + 1e-9)))
    h = per_step * theta
    return TimeGrid(h, int(np.floor(horizon / h + 1e-9)) + 1, 1, per_step)


def expm_batch(matrices: ComplexArray) -> ComplexArray:
    """exp of a stack of matrices (k, n, n): scaling to norm 1/2, Taylor polynomial of degree 15, squaring.

    The polynomial is summed in powers of the fourth power (Paterson-Stockmeyer), six products in all; its remainder at
    norm 1/2 is below 1e-18.
    """
    norm = np.abs(matrices).sum(axis=-1).max(initial=0.0)
    squarings = max(0, int(np.ceil(np.log2(norm))) + 1) if norm > 0.5 else 0
    a1 = matrices / 2.0**squarings
    a2 = a1 @ a1
    a3 = a2 @ a1
    a4 = a2 @ a2
    powers = np.stack([np.broadcast_to(np.eye(a1.shape[-1]), a1.shape), a1, a2, a3])
    blocks = np.tensordot(_TAYLOR, powers, axes=1)
    out = blocks[3]
    for block in (blocks[2], blocks[1], blocks[0]):
        out = block + a4 @ out
    for _ in range(squarings):
        out = out @ out
    return out


def _power(base: ComplexArray, exponent: int) -> ComplexArray:
    out = None
    while exponent:
        if exponent & 1:
            out = base if out is None else out @ base
        base = base @ base
        exponent >>= 1
    assert out is not None
    return out


def _powers_of(step: ComplexArray, rows: ComplexArray, count: int) -> ComplexArray:
    """rows @ step^k for k = 0..count-1, shape (nodes, count, p, n), by doubling."""
    nodes, p, n = rows.shape
    out = np.empty((nodes, count * p, n), dtype=complex)
    out[:, :p] = rows
    done = 1
    while done < count:
        more = min(done, count - done)
        out[:, done * p : (done + more) * p] = out[:, : more * p] @ step
        step = step @ step
        done += more
    return out.reshape(nodes, count, p, n)


def _coefficients(
    symbol: Symbol, grid: TimeGrid, theta: float, intervals: int, radius: float
) -> tuple[FloatArray, FloatArray]:
    """F_j(theta) r^j, shape (J, n, n), and the output rows of F_j(k h) r^j, shape (J, q, p, n), r the radius."""
    nodes = 16
    while nodes <= MAX_NODES:
        A, C = symbol(radius * np.exp(-2j * np.pi * np.arange(nodes // 2 + 1) / nodes))
        step = expm_batch(A * grid.h)
        end = _power(step, grid.per_interval) if grid.intervals_per_step == 1 else expm_batch(A * theta)
        # With these nodes the forward transform is the series itself, so irfft returns its coefficients.
        F = np.fft.irfft(end, n=nodes, axis=0)
        size = np.abs(F).max(axis=(1, 2))
        if size[nodes * 3 // 4 :].max() <= TAIL * size.max():
            rows = _powers_of(step, C, grid.per_interval)
            H = np.fft.irfft(rows, n=nodes, axis=0)
            size = np.maximum(size, np.abs(H).max(axis=(1, 2, 3)))
            keep = np.flatnonzero(size[: intervals + 1] > 1e-17 * size.max())
            return F[: keep[-1] + 1], H[: keep[-1] + 1]
        nodes *= 2
    raise NoConvergence(
        "the dead-time series does not converge for these settings",
        field="theta",
        hint="the loop is close to (or past) |C(inf) P(inf)| = 1, where it has no finite bandwidth; lower the gain",
    )


def _march(F: FloatArray, x0: FloatArray, count: int) -> FloatArray:
    """States x^m(0) of every interval with its J-1 predecessors, newest first: (count, J, n, c)."""
    J, n = F.shape[0], F.shape[1]
    flat = F[::-1].transpose(1, 0, 2).reshape(n, J * n)  # newest interval last
    x = np.zeros((count + J - 1, n, x0.shape[1]))
    x[J - 1] = x0
    past = x.reshape(-1, x0.shape[1])
    for m in range(J, count + J - 1):
        x[m] = flat @ past[(m - J) * n : m * n]
    return np.stack([x[J - 1 - j : J - 1 - j + count] for j in range(J)], axis=1)


def _leap(F: FloatArray, x0: FloatArray, every: int, count: int) -> FloatArray:
    """States x^m(0) of every ``every``-th interval with its J-1 predecessors, newest first: (count, J, n, c)."""
    J, n = F.shape[0], F.shape[1]
    c = x0.shape[1]
    companion = np.zeros((J * n, J * n))
    companion[:n] = F.transpose(1, 0, 2).reshape(n, J * n)
    companion[n:, : (J - 1) * n] = np.eye((J - 1) * n)
    power = np.linalg.matrix_power(companion, every)
    out = np.zeros((J * n, count, c))
    out[:n, 0] = x0
    done = 1
    while done < count:
        more = min(done, count - done)
        out[:, done : done + more] = (power @ out[:, :more].reshape(J * n, -1)).reshape(J * n, more, c)
        done += more
        if done < count:
            power = power @ power
    return out.transpose(1, 0, 2).reshape(count, J, n, c)


def delayed_response(
    symbol: Symbol, x0: FloatArray, theta: float, grid: TimeGrid, neutral: float = 0.0
) -> FloatArray:
    """Outputs of dx/dt = A(z) x, y = C(z) x with z the shift by theta, zero before t = 0.

    Parameters
    ----------
    symbol : callable
        z, shape (k,) -> A(z), shape (k, n, n), and C(z), shape (k, p, n).
    x0 : ndarray, shape (n, c)
        c initial states, answered at once.
    theta : float
        Dead time, > 0 [time].
    grid : TimeGrid
        From delay_grid.
    neutral : float
        Size of the jump that comes back after one dead time, \\|Dc Dp\\| [-]. From 1 on such a loop is unstable at every
        high frequency; its response is computed as far as it stays below 1e14.

    Returns
    -------
    ndarray, shape (grid.count, p, c)
        Right-hand limits at the grid's times; NaN beyond the computed part of a growing neutral loop.

    Raises
    ------
    NoConvergence
        The series in z does not converge.
    """
    # Inside this circle the series converges; powers of the radius are undone interval by interval.
    radius = 1.0 if neutral < 0.8 else 0.8 / neutral
    if grid.intervals_per_step > 1:
        F, H = _coefficients(symbol, grid, theta, grid.count * grid.intervals_per_step, radius)
        if radius < 1.0:
            scale = radius ** -np.arange(F.shape[0])
            F, H = F * scale[:, None, None], H * scale[:, None, None, None]
        states = _leap(F, x0, grid.intervals_per_step, grid.count)
        return np.einsum("jpn,mjnc->mpc", H[:, 0], states)
    intervals = -(-grid.count // grid.per_interval)
    whole = intervals
    if neutral > 1.0:
        intervals = min(intervals, 2 + int(np.log(1e14) / np.log(neutral)))
    F, H = _coefficients(symbol, grid, theta, intervals, radius)
    if radius < 1.0:
        scale = radius ** -np.arange(F.shape[0])
        F, H = F * scale[:, None, None], H * scale[:, None, None, None]
    states = _march(F, x0, intervals)
    J, q, p, n = H.shape
    kernel = H.transpose(1, 2, 0, 3).reshape(q * p, J * n)
    out = kernel @ states.transpose(1, 2, 0, 3).reshape(J * n, -1)
    out = out.reshape(q, p, intervals, -1).transpose(2, 0, 1, 3).reshape(intervals * q, p, -1)
    if intervals < whole:
        out = np.concatenate([out, np.full(((whole - intervals) * q, *out.shape[1:]), np.nan)])
    return out[: grid.count]
