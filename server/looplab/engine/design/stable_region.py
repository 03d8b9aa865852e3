r"""Where in a plane of plants a loop is stable, its boundary exact.

On the boundary :math:`K e^{-i\omega\theta} = -M/(C P_0)`: the size of the right side gives the gain, its angle the dead
time. Along a line of plants roots change sides at these crossings alone, and the slope there tells which way: one count
of Nyquist's on each line gives the number of unstable poles everywhere on it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
import numpy.typing as npt

from looplab.engine.design.mismatch import Axis, MismatchLoop, batches
from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

Plane = Literal["theta_K", "theta_tau", "K_tau"]
Interval = tuple[float, float]
# Factors of the plant over the model that a plane shows.
RANGES: dict[Axis, Interval] = {"K": (0.05, 3.0), "tau": (0.2, 3.0), "theta": (0.0, 3.0)}
# Axis of the intervals, axis of the rows, and what is held.
AXES: dict[Plane, tuple[Axis, Axis, Axis]] = {
    "theta_K": ("theta", "K", "tau"),
    "theta_tau": ("theta", "tau", "K"),
    "K_tau": ("K", "tau", "theta"),
}
# Stretches shorter than this share of the axis are not looked at.
SHORTEST = 1e-7
# Where a gain axis has a crossing at rest, roots on both sides of it are counted.
UNKNOWN = 0


@dataclass(frozen=True)
class Region:
    """Stable plants of a plane, row by row; factors are those of plant over model.

    Attributes
    ----------
    along, across : str
        The axis of the intervals, and that of the rows.
    rows : ndarray, shape (m,)
        Factors of the second axis.
    intervals : tuple of tuple of (low, high)
        For each row the stable stretches of the first axis, within its range.
    """

    along: Axis
    across: Axis
    rows: FloatArray
    intervals: tuple[tuple[Interval, ...], ...]


@dataclass(frozen=True)
class Crossings:
    """Points of a line at which roots cross the imaginary axis, ascending.

    Attributes
    ----------
    at : ndarray, shape (k,)
        Factors of what varies [-].
    change : ndarray of int, shape (k,)
        Roots gained on the right: 2, -2, or 0 where that is not known.
    """

    at: FloatArray
    change: npt.NDArray[np.int_]

    @classmethod
    def of(cls, at: FloatArray, change: npt.NDArray[np.int_]) -> Crossings:
        """Sorted."""
        order = np.argsort(at, kind="stable")
        return cls(at[order], change[order])


def _columns(grid: FloatArray, first: FloatArray, second: FloatArray) -> list[FloatArray]:
    """Frequency and two factors of each plant (row) at each frequency (column), in one line each."""
    shape = (first.size, grid.size)
    return [np.broadcast_to(v, shape).ravel() for v in (grid, first[:, None], second[:, None])]


def gain_crossings(loop: MismatchLoop, tau: FloatArray, theta: FloatArray, highest: float) -> list[Crossings]:
    r"""Gain factors at which roots cross the imaginary axis, for each of some plants.

    .. math::

        K = r(\omega), \quad \operatorname{Im} r(\omega) = 0, \qquad
        r = -\frac{M(i\omega)}{C P_0(i\omega)}\,e^{i\omega\theta}

    and as K grows a pair crosses to the right where the angle of r rises.

    Parameters
    ----------
    loop : MismatchLoop
    tau, theta : ndarray, shape (m,)
        Factors of time constants and dead time [-].
    highest : float
        Largest gain factor of interest [-].

    Returns
    -------
    list of Crossings
        One a plant.

    References
    ----------
    .. [1] W. Michiels, S.-I. Niculescu, Stability and Stabilization of Time-Delay Systems, SIAM 2007, ch. 4.
    """
    grid = loop.grid(highest, (float(tau.min()), float(tau.max())), float(theta.max()))

    def gain(omega: FloatArray, tau: FloatArray, theta: FloatArray) -> ComplexArray:
        out: ComplexArray = -loop.ahead(omega) / loop.rational(omega, tau)
        return out * np.exp(1j * omega * loop.plant.theta * theta)

    found = []
    for part in batches(tau.size, grid.size):
        value = gain(*_columns(grid, tau[part], theta[part])).reshape(-1, grid.size)
        rises = np.signbit(value.imag).astype(int)
        near = np.minimum(value.real[:, 1:], value.real[:, :-1]) < 2.0 * highest
        row, at = np.nonzero((rises[:, 1:] != rises[:, :-1]) & near)
        found.append((row + part.start, at, 2 * (rises[row, at] - rises[row, at + 1])))
    row, at, change = (np.concatenate(parts) for parts in zip(*found, strict=True))
    omega = refine_brackets(lambda w: gain(w, tau[row], theta[row]).imag, grid[at], grid[at + 1])
    K = gain(omega, tau[row], theta[row]).real
    used = (K > 0) & (highest >= K)
    at_rest = np.zeros(0) if loop.origin else np.array([-1.0 / (loop.C * loop.plant).dc_gain])
    at_rest = at_rest[(at_rest > 0) & (at_rest <= highest)]
    unknown = np.full(at_rest.size, UNKNOWN)
    each = [used & (row == i) for i in range(tau.size)]
    return [Crossings.of(np.append(K[mine], at_rest), np.append(change[mine], unknown)) for mine in each]


def dead_time_crossings(loop: MismatchLoop, K: FloatArray, tau: FloatArray, highest: float) -> list[Crossings]:
    r"""Dead-time factors at which roots cross the imaginary axis, for each of some plants.

    .. math:: K\,|C P_0(i\omega)| = |M(i\omega)|, \qquad \theta = \left(\arg\frac{-K C P_0}{M} + 2\pi k\right)/\omega

    and as the dead time grows a pair crosses to the right where the ratio of the sizes falls.

    Parameters
    ----------
    loop : MismatchLoop
    K, tau : ndarray, shape (m,)
        Factors of gain and time constants [-].
    highest : float
        Largest dead-time factor of interest [-].

    Returns
    -------
    list of Crossings
        One a plant.

    References
    ----------
    .. [1] K. L. Cooke, P. van den Driessche, Funkcialaj Ekvacioj 29 (1986) 77-90 (direction of the crossings).
    .. [2] W. Michiels, S.-I. Niculescu, Stability and Stabilization of Time-Delay Systems, SIAM 2007, ch. 4.
    """
    longest = highest * loop.plant.theta
    if not longest:
        return [Crossings(np.zeros(0), np.zeros(0, dtype=int)) for _ in K]
    grid = loop.grid(float(K.max()), (float(tau.min()), float(tau.max())), highest)

    def log_ratio(omega: FloatArray, K: FloatArray, tau: FloatArray) -> FloatArray:
        with np.errstate(divide="ignore"):
            out: FloatArray = np.log(K * np.abs(loop.rational(omega, tau)) / np.abs(loop.ahead(omega)))
            return out

    found = []
    for part in batches(K.size, grid.size):
        size = log_ratio(*_columns(grid, K[part], tau[part])).reshape(-1, grid.size)
        below = np.signbit(size).astype(int)
        row, at = np.nonzero(below[:, 1:] != below[:, :-1])
        found.append((row + part.start, at, 2 * (below[row, at + 1] - below[row, at])))
    row, at, change = (np.concatenate(parts) for parts in zip(*found, strict=True))
    omega = refine_brackets(lambda w: log_ratio(w, K[row], tau[row]), grid[at], grid[at + 1])
    angle = np.mod(np.angle(-K[row] * loop.rational(omega, tau[row]) / loop.ahead(omega)), 2.0 * np.pi)
    out = []
    for i in range(K.size):
        mine = np.flatnonzero(row == i)
        times = [np.arange(angle[j] / omega[j], longest, 2.0 * np.pi / omega[j]) for j in mine]
        changes = [np.full(t.size, change[j]) for t, j in zip(times, mine, strict=True)]
        none = np.zeros(0, dtype=int)
        out.append(Crossings.of(np.concatenate([none, *times]) / loop.plant.theta, np.concatenate([none, *changes])))
    return out


def stable_intervals(
    loop: MismatchLoop, along: Axis, at: dict[Axis, FloatArray], limits: Interval
) -> tuple[tuple[Interval, ...], ...]:
    """Stable stretches along one axis for each of some plants, exact at both ends.

    Parameters
    ----------
    loop : MismatchLoop
    along : {"K", "theta"}
        What varies.
    at : dict of ndarray, shape (m,)
        Factors of the other two [-].
    limits : tuple of float
        Ends of the axis [-].

    Returns
    -------
    tuple of tuple of (low, high)
    """
    low, high = limits
    if along == "K":
        lines = gain_crossings(loop, at["tau"], at["theta"], high)
    else:
        lines = dead_time_crossings(loop, at["K"], at["tau"], high)

    def count(row: list[int], where: list[float]) -> list[int]:
        point = {name: values[row] for name, values in at.items()} | {along: np.array(where)}
        return loop.roots_right(point["K"], point["tau"], point["theta"]).tolist()

    marks = [[low, *line.at[(line.at > low) & (line.at < high)].tolist(), high] for line in lines]
    # Counted where the line is farthest from its crossings.
    widest = [int(np.argmax(np.diff(m))) for m in marks]
    rows = list(range(len(lines)))
    known = count(rows, [0.5 * (m[j] + m[j + 1]) for m, j in zip(marks, widest, strict=True)])
    out = []
    for i, (line, ends, start) in enumerate(zip(lines, marks, widest, strict=True)):
        change = line.change[(line.at > low) & (line.at < high)]
        steps = np.concatenate([[0], np.cumsum(change)])
        roots = known[i] + steps - steps[start]
        if (change == UNKNOWN).any() or known[i] < 0 or roots.min() < 0:
            roots = np.array(count([i] * (len(ends) - 1), [0.5 * (a + b) for a, b in pairwise(ends)]))
        out.append(_joined([p for p, r in zip(pairwise(ends), roots, strict=True) if r == 0], SHORTEST * high))
    return tuple(out)


def _joined(pieces: list[Interval], gap: float) -> tuple[Interval, ...]:
    """Neighbours as one, and without what is too short to be seen."""
    out: list[Interval] = []
    for a, b in pieces:
        if out and a - out[-1][1] <= gap:
            out[-1] = (out[-1][0], b)
        else:
            out.append((a, b))
    return tuple((a, b) for a, b in out if b - a > gap)


def stable_region(loop: MismatchLoop, plane: Plane, at: dict[Axis, float], rows: int = 41) -> Region:
    """Stable plants of a plane through the present one.

    Parameters
    ----------
    loop : MismatchLoop
    plane : {"theta_K", "theta_tau", "K_tau"}
        Axis of the intervals, axis of the rows.
    at : dict
        The present factors; that of the third axis is the one used [-].
    rows : int
        How many, evenly over the range of the second axis.

    Returns
    -------
    Region
    """
    along, across, third = AXES[plane]
    levels = np.linspace(*RANGES[across], rows)
    held = {across: levels, third: np.full(rows, at[third])}
    return Region(along, across, levels, stable_intervals(loop, along, held, RANGES[along]))
