"""The root locus, rational or with exact dead time, with everything that students construct by hand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import ceil, exp, inf, log, log10

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.stability.locus.construction import (
    LARGEST_LOG,
    Angle,
    Asymptotes,
    AxisCrossing,
    Breakaway,
    Window,
    arrival_angles,
    asymptotes,
    axis_crossings,
    breakaway_points,
    departure_angles,
    real_axis_segments,
    window,
)
from looplab.engine.stability.locus.dead_time import Rectangle, dead_time_branches
from looplab.engine.stability.locus.rational import rational_branches
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

# With dead time.
MOST_GAINS = 90
GAINS_PER_DECADE = 3


@dataclass(frozen=True)
class RootLocus:
    """Closed-loop poles over the gain.

    Attributes
    ----------
    gains : ndarray, shape (m,)
        Increasing from 0, closer where branches turn.
    branches : ndarray of complex, shape (n, m)
        One branch a row [rad/time]. Rational: row i starts at an open-loop pole. With dead time there are infinitely
        many; those of the surroundings of ``view`` are given, NaN where a branch is outside.
    open_loop_poles, open_loop_zeros : ndarray
    asymptotes : Asymptotes
    breakaways, imaginary_axis_crossings : tuple
    departure_angles, arrival_angles : tuple of Angle
    real_axis_segments : tuple of (left, right)
        None is an infinite end.
    view : ((float, float), (float, float))
        A window (re, im) that shows what matters [rad/time].
    complete : bool
        All branches are there; with dead time: all in the surroundings of ``view``, proved by the argument principle.
    """

    gains: FloatArray
    branches: ComplexArray
    open_loop_poles: ComplexArray
    open_loop_zeros: ComplexArray
    asymptotes: Asymptotes
    breakaways: tuple[Breakaway, ...]
    imaginary_axis_crossings: tuple[AxisCrossing, ...]
    departure_angles: tuple[Angle, ...]
    arrival_angles: tuple[Angle, ...]
    real_axis_segments: tuple[tuple[float | None, float | None], ...]
    view: Window
    complete: bool


@lru_cache(maxsize=16)
def root_locus(L: TransferFunction) -> RootLocus:
    r"""Closed-loop poles for a gain K from 0 upwards; give -L for negative gains.

    .. math:: 1 + K L(s) = 0

    Parameters
    ----------
    L : TransferFunction
        Proper open loop for K = 1, dead time exact.

    Returns
    -------
    RootLocus
        Each point satisfies the characteristic equation in factored form; break-away gains are on the grid, so that
        corners are sharp, and the grid is closer where a branch turns.

    Raises
    ------
    InvalidInput
        No pole could move: L is zero, or has neither poles nor dead time; or none moves at a gain that is a number.

    References
    ----------
    .. [1] W. R. Evans, Trans. AIEE 69 (1950) 66-69.
    .. [2] D. Breda, S. Maset, R. Vermiglio, SIAM J. Sci. Comput. 27 (2005) 482-495 (collocation of the dead time).
    """
    if (not L.order and not L.theta) or L.gain == 0.0:
        raise InvalidInput("the loop has no poles that could move", field="plant")
    breaks, crossed = breakaway_points(L), axis_crossings(L)
    view = window(L, breaks, crossed)
    (left, right), (_, top) = view
    size = max(right - left, top)
    marks = [b.K for b in breaks] + [c.K for c in crossed if c.K > 0]
    if L.theta:
        # Crossings without end: those of the picture count.
        marks = [b.K for b in breaks if abs(b.s) < 3 * size] + [c.K for c in crossed if c.omega < 2 * top and c.K > 0]
        inside = Rectangle(left - 0.5 * size, right + 0.7 * size, 1.5 * top)
        gains, branches, complete = dead_time_branches(L, _delay_gains(L, marks, inside), breaks, inside, size)
    else:
        gains, branches = rational_branches(L, _rational_gains(L, marks, size), breaks, size)
        complete = True
    return RootLocus(
        gains, branches, L.poles, L.zeros, asymptotes(L, 1.5 * top), breaks, crossed,
        departure_angles(L), arrival_angles(L), real_axis_segments(L), view, complete,
    )  # fmt: skip


def _rational_gains(L: TransferFunction, marks: list[float], size: float) -> FloatArray:
    """From where poles barely move to where the asymptotes have left the window; the meeting gains among them."""
    excess = max(L.relative_degree, 1)
    far = excess * log(1.5 * size) if L.relative_degree else log(10.0)
    if abs(far - log(abs(L.gain))) > LARGEST_LOG:
        raise InvalidInput(
            "the gains at which the poles move leave double precision",
            field="plant",
            hint="choose a time unit in which the roots are moderate",
        )
    leave = exp(far - log(abs(L.gain)))
    low = min([*marks, leave]) * 1e-3
    high = max([10.0 * m for m in marks] + [100.0 * leave])
    count = ceil(GAINS_PER_DECADE * log10(high / low))
    grid = [low * (high / low) ** (i / count) for i in range(count + 1)]
    if not L.relative_degree and L.gain < 0:
        # A branch passes through infinity, at a gain that must not be hit.
        grid = [K * 1.02 if abs(K * L.gain + 1.0) < 0.01 else K for K in grid]
    between = [(a * b) ** 0.5 for a, b in pairwise(sorted(marks))]
    return np.array(sorted({0.0, *grid, *marks, *between}))


def _delay_gains(L: TransferFunction, marks: list[float], inside: Rectangle) -> FloatArray:
    """Gains between which poles cross the rectangle: 1/|L| along its sides, and the meeting gains."""
    edge = 1j * np.linspace(0.0, inside.top, 12)
    # Branches leave a repeated pole fast: the first gain must not throw them far.
    start = L.poles[inside.contains(L.poles)] + 0.02 * inside.top
    with np.errstate(divide="ignore"):
        size = 1.0 / np.abs(L(np.concatenate([inside.left + edge, inside.right + edge, start])))
    every = size.tolist()
    around = [K for K in every[: 2 * edge.size] + marks if 0.0 < K < inf]
    low, high = 0.3 * min(around), max(around)
    if marks:
        low, high = max(low, min(marks) * 1e-6), min(high, max(marks) * 1e4)
    low = min([low, *(K for K in every[2 * edge.size :] if 0.0 < K < inf)])
    high = max(high, 2.0 * low)
    # Between two gains a pole of the dead time moves by a third of ln 10, or by part of the rectangle.
    step = min(log(10.0) / GAINS_PER_DECADE, 0.25 * L.theta * (inside.right - inside.left))
    count = min(ceil(log(high / low) / step), MOST_GAINS)
    grid = [low * (high / low) ** (i / count) for i in range(count + 1)]
    # Next to a meeting gain eigenvalues are not sharp.
    grid = [K for K in grid if all(abs(K - mark) > 1e-3 * mark for mark in marks)]
    between = [(a * b) ** 0.5 for a, b in pairwise(sorted(marks))]
    return np.array(sorted({0.0, *grid, *marks, *between}))
