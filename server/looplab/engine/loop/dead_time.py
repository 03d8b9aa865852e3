r"""Exact responses of a linear loop with one dead time.

Between two multiples of the dead time the loop is an ordinary linear system driven by its own past. With the shift
operator z, (z x)(t) = x(t - theta), the loop reads dx/dt = A(z) x. Cut the dead time into Q pieces of length
theta/Q and call x_k(s) the state at time s after the start of piece k: then z x_k = x_{k-Q}, so that

.. math:: x_k(s) = \sum_j F_j(s)\, x_{k - jQ}(0), \qquad e^{s A(z)} = \sum_j F_j(s) z^j .

Nothing is approximated but the tail of that series, which is made smaller than rounding. A Pade fraction is nowhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import as_strided

from looplab.engine.errors import NoConvergence
from looplab.engine.loop.shift_series import (
    LARGEST_EXPONENTIAL,
    Symbol,
    circle_radius,
    pieces_of_dead_time,
    shift_series,
)

FloatArray = npt.NDArray[np.float64]

MAX_PIECES = 60_000
LARGEST_STATE = 1e14
# States that marching finds at once, few and many of them: the more, the longer it takes to get ready.
FEW_PIECES, MANY_PIECES, LONG = 4, 8, 200
# Above this size marching is cheaper than powers of the companion matrix.
LARGEST_COMPANION = 250


@dataclass(frozen=True)
class TimeGrid:
    """Output times k*h: theta is a whole number of steps, or a step is a whole number of dead times."""

    h: float
    count: int

    @property
    def t(self) -> FloatArray:
        """The times, shape (count,) [time]."""
        return self.h * np.arange(self.count, dtype=float)


@dataclass(frozen=True)
class DelayGrid(TimeGrid):
    """A grid whose breakpoints are samples.

    Attributes
    ----------
    pieces : int
        Q, pieces that the dead time is cut into.
    samples : int
        Output samples per piece (1 where a step is one piece or longer).
    pieces_per_step : int
        Pieces per output step (1 where a piece is one step or longer).
    """

    pieces: int = 1
    samples: int = 1
    pieces_per_step: int = 1


def delay_grid(theta: float, horizon: float, points: int, pieces: int = 1) -> DelayGrid:
    """A grid close to ``points`` samples over ``horizon`` on which every multiple of theta is a sample, if it can be.

    Parameters
    ----------
    theta, horizon : float
        Dead time and length [time].
    points : int
        Samples wanted.
    pieces : int
        Pieces that the dead time must be cut into at least.
    """
    h0 = horizon / (points - 1)
    per_dead_time = theta / h0
    if per_dead_time < 1.0:
        step = max(1, int(np.floor(h0 / theta + 1e-9)))
        h = step * theta
        return DelayGrid(h, int(np.floor(horizon / h + 1e-9)) + 1, pieces, 1, step * pieces)
    if pieces <= per_dead_time:
        samples = int(np.ceil(per_dead_time / pieces - 1e-9))
        h = theta / (pieces * samples)
        return DelayGrid(h, int(np.floor(horizon / h + 1e-9)) + 1, pieces, samples, 1)
    steps = int(np.ceil(per_dead_time - 1e-9))
    per_step = -(-pieces // steps)
    h = theta / steps
    return DelayGrid(h, int(np.floor(horizon / h + 1e-9)) + 1, steps * per_step, 1, per_step)


def _march(F: FloatArray, x0: FloatArray, lag: int, count: int) -> FloatArray:
    """States x_k(0) of every piece, after (J-1) lag rows of zeros for the past, shape (count + (J-1) lag, n, c)."""
    J, n = F.shape[0], F.shape[1]
    before = (J - 1) * lag
    x = np.zeros((count + before, n, x0.shape[1]))
    x[before] = x0
    flat = np.ascontiguousarray(F[::-1].transpose(1, 0, 2).reshape(n, J * n))  # oldest first
    if lag == 1:
        several = _several_pieces(flat, min(FEW_PIECES if count < LONG else MANY_PIECES, J, count))
        states, stop = x.reshape(-1, x0.shape[1]), (count + before) * n
        for k in range((before + 1) * n, stop, several.shape[0]):
            rows = min(several.shape[0], stop - k)
            np.dot(several[:rows], states[k - J * n : k], out=states[k : k + rows])
    else:
        for k in range(before + 1, count + before):
            x[k] = flat @ x[k - 1 - before : k : lag].reshape(J * n, -1)
    return x


def _several_pieces(flat: FloatArray, most: int) -> FloatArray:
    """The next ``count`` states from the past, shape (count*n, J*n), where ``flat`` (n, J*n) gives the next one.

    The count is the largest power of two up to ``most`` <= J: each doubling lets the states found so far be the past.
    """
    width = flat.shape[1]
    out = flat
    while 2 * out.shape[0] <= most * flat.shape[0]:
        known = out.shape[0]
        more = np.zeros((2 * known, width))
        more[:known] = out
        np.matmul(out[:, width - known :], out, out=more[known:])
        more[known:, known:] += out[:, : width - known]
        out = more
    return out


def _leap(F: FloatArray, x0: FloatArray, every: int, count: int) -> FloatArray:
    """For pieces of one dead time: states of every ``every``-th piece with its past, newest first: (count, J, n, c)."""
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


def _states(F: FloatArray, x0: FloatArray, grid: DelayGrid, count: int) -> FloatArray:
    """State at the start of each needed piece with its past in steps of the dead time: (count, J, n, c)."""
    every = grid.pieces_per_step
    if grid.pieces == 1 and every > 1 and F.shape[0] * F.shape[1] <= LARGEST_COMPANION:
        return _leap(F, x0, every, count)
    total = (count - 1) * every + 1
    if total > MAX_PIECES:
        raise NoConvergence(
            "this loop changes too much within one dead time for so long a horizon",
            field="horizon",
            hint="shorten the horizon or lower the gain",
        )
    x = _march(F, x0, grid.pieces, total)
    J, (_, n, c) = F.shape[0], x.shape
    first, piece, row, column = (J - 1) * grid.pieces, *x.strides
    return as_strided(x[first:], (count, J, n, c), (every * piece, -grid.pieces * piece, row, column), writeable=False)


def delayed_response(
    symbol: Symbol,
    x0: FloatArray,
    theta: float,
    horizon: float,
    points: int,
    neutral: float = 0.0,
    on: DelayGrid | None = None,
) -> tuple[DelayGrid, FloatArray]:
    r"""Outputs of dx/dt = A(z) x, y = C(z) x with z the shift by theta, zero before t = 0.

    Parameters
    ----------
    symbol : callable
        z, shape (k,) -> A(z), shape (k, n, n), and C(z), shape (k, p, n).
    x0 : ndarray, shape (n, c)
        c initial states, answered at once.
    theta, horizon : float
        Dead time > 0 and length of the response [time].
    points : int
        Samples wanted.
    neutral : float
        Relative size of the jump that comes back after one dead time, \|Dc Dp\| [-]. From 1 on such a loop is unstable
        at every high frequency; its response is computed as far as jumps stay below 1e14.
    on : DelayGrid or None
        The grid, of a caller that has chosen it: horizon and points do not matter then. None chooses one.

    Returns
    -------
    grid : DelayGrid
    out : ndarray, shape (grid.count, p, c)
        Right-hand limits at the grid's times; NaN beyond the computed part of a growing neutral loop. A view of an
        array in which each output's samples follow one another.

    Raises
    ------
    NoConvergence
        The dead time is too long for the speed of the loop and the horizon.
    """

    def series(grid: DelayGrid, largest: float = np.inf) -> tuple[FloatArray, FloatArray] | None:
        h, terms = grid.h / grid.pieces_per_step, int(grid.count * grid.h / theta) + 2
        return shift_series(symbol, h, grid.samples, terms, neutral, largest)

    # Mostly the dead time is short enough for one piece.
    grid = delay_grid(theta, horizon, points) if on is None else on
    found = series(grid, LARGEST_EXPONENTIAL if on is None else np.inf)
    if found is None:
        grid = delay_grid(theta, horizon, points, pieces_of_dead_time(symbol, theta, circle_radius(neutral)))
        found = series(grid)
    assert found is not None
    F, H = found
    steps = -(-grid.count // grid.samples)
    whole = steps
    if neutral > 1.0:
        steps_per_dead_time = grid.pieces / grid.pieces_per_step
        steps = min(steps, int((2 + np.log(LARGEST_STATE) / np.log(neutral)) * steps_per_dead_time) + 1)
    states = _states(F, x0, grid, steps)
    J, q, p, n = H.shape
    kernel = H.transpose(0, 3, 2, 1).reshape(J * n, p * q)
    out = states.transpose(3, 0, 1, 2).reshape(-1, J * n) @ kernel
    out = out.reshape(-1, steps, p, q).transpose(0, 2, 1, 3).reshape(-1, p, steps * q)
    if steps < whole:
        out = np.concatenate([out, np.full((*out.shape[:2], (whole - steps) * q), np.nan)], axis=2)
    return grid, out[:, :, : grid.count].transpose(2, 1, 0)
