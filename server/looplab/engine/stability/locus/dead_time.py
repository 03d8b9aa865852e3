"""Branches of a root locus with exact dead time: infinitely many poles, those in a window followed over the gain."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, hypot

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.delay_line import chebyshev_differentiation
from looplab.engine.stability.locus.construction import Breakaway
from looplab.engine.stability.locus.continuation import join, smooth
from looplab.engine.stability.locus.count import count_on_both_sides
from looplab.engine.stability.locus.meeting import meet
from looplab.engine.stability.locus.near_roots import poles_near_roots
from looplab.engine.stability.polish import polish_closed_loop_poles
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
ComplexArray = npt.NDArray[np.complex128]

MAX_NODES = 110
# No more are added from so many gains on.
MAX_GAINS = 200
CHECKS = 5
# Eigenvalues are looked at again between gains, so often at most.
ROUNDS = 6
# So often gains are added where eigenvalues are taken at each, and so many gains there are to begin with.
REFINEMENTS = 4
MANY_GAINS = 90


@dataclass(frozen=True)
class Rectangle:
    """Part of the s-plane [rad/time]."""

    left: float
    right: float
    top: float

    def contains(self, s: ComplexArray) -> BoolArray:
        """Which points lie inside; it is symmetric about the real axis."""
        return np.asarray((s.real > self.left) & (s.real < self.right) & (np.abs(s.imag) < self.top))


class Collocation:
    """The loop with its dead time as a delay line at Chebyshev points: M0 + K M1 has eigenvalues near the poles."""

    def __init__(self, L: TransferFunction, nodes: int, careful: bool = False) -> None:
        ss = realize(L)
        n = ss.B.size
        D = chebyshev_differentiation(nodes)[1:] / L.theta
        self.L = L
        self.careful = careful
        self.fixed = np.zeros((n + nodes, n + nodes))
        self.fixed[:n, :n] = ss.A
        np.negative(D[:, 1:], out=self.fixed[n:, n:])
        # The line carries y in units that make C of size 1: balancing alone does not undo a large gain.
        unit = float(np.linalg.norm(ss.C)) or 1.0
        np.multiply(D[:, :1], ss.C / -unit, out=self.fixed[n:, :n])
        self.per_gain = np.zeros_like(self.fixed)
        self.per_gain[:n, -1] = -ss.B * unit
        self.per_gain[n:, -1] += D[:, 0] * ss.D

    def poles(self, gains: FloatArray, inside: Rectangle) -> list[ComplexArray]:
        """Exact closed-loop poles in the rectangle, for each gain; where ``careful``, those near roots of L anew."""
        found = np.linalg.eigvals(self.fixed + gains[:, None, None] * self.per_gain)
        # Those below the real axis are conjugates.
        reach = 2.0 * hypot(max(abs(inside.left), inside.right), inside.top)
        at, which = ((np.abs(found) < reach) & (found.imag >= 0.0)).nonzero()
        polished, good = polish_closed_loop_poles(self.L, found[at, which].astype(complex), gains[at], steps=6)
        good &= inside.contains(polished)
        ends = np.cumsum(np.bincount(at[good], minlength=gains.size))[:-1]
        rows = [_distinct(row, inside.top) for row in np.split(polished[good], ends)]
        for near in poles_near_roots(self.L, gains) if self.careful else ():
            for k in np.flatnonzero(np.isfinite(near.poles).all(axis=1)):
                new = near.poles[k][inside.contains(near.poles[k])]
                rows[k] = np.concatenate([rows[k][np.abs(rows[k] - near.root) > near.radius], new])
        return rows


def _distinct(poles: ComplexArray, size: float) -> ComplexArray:
    """Without the copies that Newton made of one root, and with exact conjugates, in a picture of some size."""
    # At the origin there is nothing but rounding.
    least = 1e-9 * size
    real: list[complex] = []
    upper: list[complex] = []
    for s in poles.tolist():
        rounding = 1e-7 * max(abs(s), least)
        if s.imag > rounding:
            upper.append(s)
        elif s.imag >= -rounding:
            real.append(complex(s.real))
    kept: list[complex] = []
    for s in real + upper:
        if all(abs(s - other) > 1e-6 * max(abs(s), least) for other in kept):
            kept += [s] if s.imag == 0 else [s, s.conjugate()]
    return np.array(kept, dtype=complex)


def _coarse(branches: ComplexArray, size: float, corner: BoolArray) -> BoolArray:
    """Intervals of the gain in which some branch jumps, or turns but for a corner, shape (gains-1,)."""
    far: BoolArray
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
    # A polynomial follows exp(x) over a length |x| with about |x|/2 terms, and a few more for digits.
    nodes = min(ceil(8.0 + 0.75 * L.theta * hypot(inside.top, inside.left)), MAX_NODES)
    near = tuple(b for b in breaks if inside.contains(np.array([b.s]))[0])
    for careful in (False, True):
        line = Collocation(L, min(2 * nodes, MAX_NODES) if careful else nodes, careful)
        found = _continued(line, gains, near, np.isin(gains, [b.K for b in breaks]), inside, size)
        if found is not None and _proved(L, *found, inside):
            gains, branches, proved = *found, True
            break
    else:
        gains, branches, proved = _followed(line, _denser(gains, [b.K for b in near]), near, inside, size)
    branches = branches[np.count_nonzero(np.isfinite(branches), axis=1) > 1]
    stay = np.tile(hidden[inside.contains(hidden)][:, None], (1, gains.size))
    return gains, np.concatenate([branches, stay]), proved


def _continued(
    line: Collocation,
    gains: FloatArray,
    near: tuple[Breakaway, ...],
    meeting: BoolArray,
    inside: Rectangle,
    size: float,
) -> tuple[FloatArray, ComplexArray] | None:
    """Gains and branches with eigenvalues at a few gains only; None where those between were not all found."""
    L, marks = line.L, gains[meeting].tolist()
    gains = gains[gains > 0]
    every = dict(zip(gains.tolist(), line.poles(gains, inside), strict=True))
    for K in marks:
        every[K] = meet(L, K, every[K], near)
    every[0.0] = L.poles[inside.contains(L.poles)].astype(complex)
    for _ in range(ROUNDS):
        gains = np.array(sorted(every))
        rows = [every[K] for K in gains.tolist()]
        known, unsure, at, missed = join(L, gains, rows, np.isin(gains, marks), inside.contains, size)
        extra = np.sqrt(gains[:-1] * gains[1:])[unsure]
        if not extra.size:
            known, extra = smooth(L, known, inside.contains, size)
            if not extra.size:
                return known.gains, known.poles.T
        elif at.size:
            poles, good = polish_closed_loop_poles(L, missed, gains[at], steps=6)
            good &= inside.contains(poles)
            for K, s in zip(gains[at[good]].tolist(), poles[good].tolist(), strict=True):
                more = _distinct(np.array([*every[K].tolist(), s, s.conjugate()]), inside.top)
                if more.size > every[K].size:
                    every[K], unsure[gains[1:] == K], unsure[gains[:-1] == K] = more, False, False
            extra = np.sqrt(gains[:-1] * gains[1:])[unsure]
        if extra.size:
            every.update(zip(extra.tolist(), line.poles(extra, inside), strict=True))
    return None


def _denser(gains: FloatArray, marks: list[float]) -> FloatArray:
    """As many gains as it takes where each is looked at for itself."""
    return np.unique(np.concatenate([np.geomspace(gains[1], gains[-1], MANY_GAINS), marks]))


def _followed(
    line: Collocation, gains: FloatArray, near: tuple[Breakaway, ...], inside: Rectangle, size: float
) -> tuple[FloatArray, ComplexArray, bool]:
    """Gains and branches with eigenvalues at every gain, more where a branch jumps or turns; and what was proved."""
    L, marks = line.L, [b.K for b in near]
    every = {0.0: L.poles[inside.contains(L.poles)].astype(complex)}
    extra = gains
    for left in range(REFINEMENTS, -1, -1):
        for K, row in zip(extra.tolist(), line.poles(extra, inside), strict=True):
            every[K] = meet(L, K, row, near)
        gains = np.array(sorted(every))
        meeting = np.isin(gains, marks)
        branches = join(L, gains, [every[K] for K in gains.tolist()], meeting, inside.contains, size).branches.poles.T
        coarse = _coarse(branches, size, meeting)
        # What K = 0 begins is left as it is.
        coarse[0] = False
        extra = np.sqrt(gains[:-1] * gains[1:])[coarse]
        if not extra.size or gains.size > MAX_GAINS or not left:
            break
    return gains, branches, _proved(L, gains, branches, inside)


def _proved(L: TransferFunction, gains: FloatArray, branches: ComplexArray, inside: Rectangle) -> bool:
    """Whether the argument principle finds as many poles at some of the gains."""
    open_ = np.linspace(1, gains.size - 1, CHECKS).astype(int)
    # Where a pole lies on the border there is no count: the next gain on either side is asked.
    for step in (0, 1, -1):
        at = np.clip(open_ + step, 1, gains.size - 1)
        there = np.count_nonzero(np.isfinite(branches[:, at]), axis=0).tolist()
        counted = count_on_both_sides(L, gains[at], inside.left, inside.right, inside.top)
        if any(count not in (None, many) for count, many in zip(counted, there, strict=True)):
            return False
        open_ = open_[[count is None for count in counted]]
        if not open_.size:
            return True
    return False
