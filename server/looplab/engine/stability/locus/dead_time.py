"""Branches of a root locus with exact dead time: infinitely many poles, those in a window followed over the gain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.delay_line import chebyshev_differentiation
from looplab.engine.stability.locus.construction import Breakaway
from looplab.engine.stability.locus.count import count_in_rectangle
from looplab.engine.stability.locus.meeting import meet
from looplab.engine.stability.locus.near_roots import poles_near_roots
from looplab.engine.stability.locus.pairs import nearest_pairs
from looplab.engine.stability.polish import polish_closed_loop_poles
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

MAX_NODES = 110
MAX_GAINS = 400
CHECKS = 5
# A branch moves less than this from one gain to the next [size of the picture].
GATE = 0.3


@dataclass(frozen=True)
class Rectangle:
    """Part of the s-plane [rad/time]."""

    left: float
    right: float
    top: float

    def contains(self, s: ComplexArray) -> npt.NDArray[np.bool_]:
        """Which points lie inside; it is symmetric about the real axis."""
        return np.asarray((s.real > self.left) & (s.real < self.right) & (np.abs(s.imag) < self.top))


class Collocation:
    """The loop with its dead time as a delay line at Chebyshev points: M0 + K M1 has eigenvalues near the poles."""

    def __init__(self, L: TransferFunction, nodes: int, careful: bool = False) -> None:
        ss = realize(L)
        n = ss.B.size
        D = chebyshev_differentiation(nodes) / L.theta
        self.L = L
        self.careful = careful
        self.fixed = np.zeros((n + nodes, n + nodes))
        self.fixed[:n, :n] = ss.A
        self.fixed[n:, n:] = -D[1:, 1:]
        # The line carries y in units that make C of size 1: balancing alone does not undo a large gain.
        unit = float(np.linalg.norm(ss.C)) or 1.0
        self.fixed[n:, :n] = -np.outer(D[1:, 0], ss.C / unit)
        self.per_gain = np.zeros_like(self.fixed)
        self.per_gain[:n, -1] = -ss.B * unit
        self.per_gain[n:, -1] += D[1:, 0] * ss.D

    def poles(self, gains: FloatArray, inside: Rectangle) -> list[ComplexArray]:
        """Exact closed-loop poles in the rectangle, for each gain; where ``careful``, those near roots of L anew."""
        M = self.fixed + gains[:, None, None] * self.per_gain
        found = np.linalg.eigvals(M).astype(complex)
        near = np.abs(found) < 2.0 * (np.hypot(max(abs(inside.left), inside.right), inside.top))
        found = np.where(near, found, np.nan)
        polished, good = polish_closed_loop_poles(self.L, found, gains[:, None], steps=6)
        good &= inside.contains(polished)
        rows = [_distinct(row[ok]) for row, ok in zip(polished, good, strict=True)]
        for near in poles_near_roots(self.L, gains) if self.careful else ():
            for k in np.flatnonzero(np.isfinite(near.poles).all(axis=1)):
                new = near.poles[k][inside.contains(near.poles[k])]
                rows[k] = np.concatenate([rows[k][np.abs(rows[k] - near.root) > near.radius], new])
        return rows


def _distinct(poles: ComplexArray) -> ComplexArray:
    """Without the copies that Newton made of one root, and with exact conjugates."""
    real: list[complex] = []
    upper: list[complex] = []
    for s in poles.tolist():
        rounding = 1e-7 * abs(s)
        if s.imag > rounding:
            upper.append(s)
        elif s.imag >= -rounding:
            real.append(complex(s.real))
    kept: list[complex] = []
    for s in real + upper:
        if all(abs(s - other) > 1e-6 * max(abs(s), 1e-9) for other in kept):
            kept += [s] if s.imag == 0 else [s, s.conjugate()]
    return np.array(kept, dtype=complex)


def _links(L: TransferFunction, gains: FloatArray, poles: ComplexArray, gate: float) -> list[list[int]]:
    """Which pole of the next gain each pole becomes, -1 for none; poles of shape (m, n) with NaN where there are fewer.

    Each is followed along its tangent ds/dK = -L/(K L') to the nearest pole within ``gate``.
    """
    with np.errstate(all="ignore"):
        ahead = -np.log(gains[1:] / gains[:-1])[:, None] / L.log_derivative(poles[:-1])
        ahead[~(np.abs(ahead) < gate)] = 0.0
        gap = np.abs((poles[:-1] + ahead)[:, :, None] - poles[1:, None, :])
    gap[~(gap <= gate)] = np.inf
    nearest = gap.argmin(axis=2)
    reached = np.isfinite(gap.min(axis=2))
    mutual = np.take_along_axis(gap.argmin(axis=1), nearest, axis=1) == np.arange(poles.shape[1])
    links = np.where(reached & mutual, nearest, -1)
    # The nearest of some pole is nearer to another: the nearest pairs come first.
    for i in np.flatnonzero((reached & ~mutual).any(axis=1)).tolist():
        links[i] = -1
        for a, b in nearest_pairs(gap[i], gate):
            links[i, a] = b
    steps: list[list[int]] = links.tolist()
    return steps


def _join(L: TransferFunction, gains: FloatArray, rows: list[ComplexArray], gate: float) -> ComplexArray:
    """Branches as rows of an array with NaN where a branch is outside, shape (branches, gains)."""
    sizes = [row.size for row in rows]
    there = np.arange(max(sizes)) < np.array(sizes)[:, None]
    poles = np.full(there.shape, np.nan, dtype=complex)
    poles[there] = np.concatenate(rows)
    # Which branch each pole is on.
    on, count = [list(range(sizes[0]))], sizes[0]
    for step, size in zip(_links(L, gains, poles, gate), sizes[1:], strict=True):
        now = [-1] * size
        for branch, k in zip(on[-1], step, strict=False):
            if k >= 0:
                now[k] = branch
        for k in range(size):
            if now[k] < 0:
                now[k], count = count, count + 1
        on.append(now)
    branches = np.full((count, len(rows)), np.nan, dtype=complex)
    branches[np.concatenate(on).astype(int), np.nonzero(there)[0]] = poles[there]
    return branches[np.count_nonzero(np.isfinite(branches), axis=1) > 1]


def _coarse(branches: ComplexArray, size: float, corner: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Intervals of the gain in which some branch jumps, or turns but for a corner, shape (gains-1,)."""
    far: npt.NDArray[np.bool_]
    with np.errstate(all="ignore"):
        step = np.diff(branches, axis=1)
        length = np.abs(step)
        far = np.asarray((length > 0.05 * size).any(axis=0))
        turn = np.abs(np.angle(step[:, 1:] / step[:, :-1]))
        bend = ((turn > 0.2) & (np.minimum(length[:, 1:], length[:, :-1]) > 0.006 * size)).any(axis=0)
    bend &= ~corner[1:-1]
    far[:-1] |= bend
    far[1:] |= bend
    return far


def dead_time_branches(
    L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...], inside: Rectangle, size: float
) -> tuple[FloatArray, ComplexArray, bool]:
    """Branches inside a rectangle.

    Parameters
    ----------
    L : TransferFunction
        Open loop for K = 1 with dead time.
    gains : ndarray
        Increasing from 0; more are added where a branch jumps or turns.
    breaks : tuple of Breakaway
        Where branches meet.
    inside : Rectangle
        Where poles are followed.
    size : float
        Size of the picture [rad/time].

    Returns
    -------
    gains : ndarray, shape (m,)
    branches : ndarray of complex, shape (n, m)
        NaN where a branch is outside.
    proved : bool
        The argument principle found as many poles as were followed, at five gains.
    """
    L, hidden = split_hidden_modes(L)
    nodes = int(min(12 + np.ceil(L.theta * np.hypot(inside.top, inside.left)), MAX_NODES))
    positive = gains[gains > 0]
    line = Collocation(L, nodes)
    if not _proved(line, positive, inside):
        line = Collocation(L, min(2 * nodes, MAX_NODES), careful=True)
    meeting = np.array([b.K for b in breaks])
    fine, rows = _follow(line, positive, inside, size, meeting)
    proved = _proved(line, fine, inside)
    if not proved and not line.careful:
        careful = Collocation(L, min(2 * nodes, MAX_NODES), careful=True)
        fine, rows = _follow(careful, positive, inside, size, meeting)
        proved = _proved(careful, fine, inside)
    near = [b for b in breaks if inside.contains(np.array([b.s]))[0]]
    rows = [meet(L, K, row, near) for K, row in zip(fine.tolist(), rows, strict=True)]
    start = L.poles[inside.contains(L.poles)]
    gains = np.concatenate([[0.0], fine])
    branches = _join(L, gains, [start.astype(complex), *rows], GATE * size)
    stay = np.tile(hidden[inside.contains(hidden)][:, None], (1, gains.size))
    return gains, np.concatenate([branches, stay]), proved


def _follow(
    line: Collocation, gains: FloatArray, inside: Rectangle, size: float, meeting: FloatArray
) -> tuple[FloatArray, list[ComplexArray]]:
    """Gains, more of them where a branch jumps or turns (but at ``meeting`` gains), and the poles at each."""
    rows = line.poles(gains, inside)
    for _ in range(4):
        coarse = _coarse(_join(line.L, gains, rows, GATE * size), size, np.isin(gains, meeting))
        if not coarse.any() or gains.size > MAX_GAINS:
            break
        extra = np.sqrt(gains[:-1][coarse] * gains[1:][coarse])
        rows += line.poles(extra, inside)
        gains = np.concatenate([gains, extra])
        order = np.argsort(gains, kind="stable")
        gains, rows = gains[order], [rows[k] for k in order]
    return gains, rows


def _proved(line: Collocation, gains: FloatArray, inside: Rectangle) -> bool:
    # A little beside the gains of the grid, some of which have double poles.
    some = gains[np.linspace(0, gains.size - 1, CHECKS).astype(int)] * 1.0037
    for K, row in zip(some, line.poles(some, inside), strict=True):
        count = count_in_rectangle(line.L, float(K), inside.left, inside.right, -inside.top, inside.top)
        if count is not None and count != row.size:
            return False
    return True
