"""Branches of a rational root locus: eigenvalues, polished on the exact equation and joined right."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.locus.construction import Breakaway
from looplab.engine.stability.locus.meeting import meet
from looplab.engine.stability.locus.near_roots import poles_near_roots
from looplab.engine.stability.polish import polish_closed_loop_poles
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

MAX_GAINS = 700


def _poles_at(L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...]) -> ComplexArray:
    """Closed-loop poles for each gain, unsorted, shape (m, n)."""
    ss = realize(L)
    effective = gains / (1.0 + gains * ss.D)
    found = np.linalg.eigvals(ss.A - effective[:, None, None] * np.outer(ss.B, ss.C)).astype(complex)
    polished, good = polish_closed_loop_poles(L, found, gains[:, None], steps=3)
    # Near a break-away Newton may pull two roots into one: keep the eigenvalues there.
    good &= np.abs(polished - found) < 0.2 * _nearest_neighbour(found)
    out = np.where(good, polished, found)
    unsure = ~good.all(axis=1) & (gains > 0.0)
    if unsure.any():
        out[unsure] = _with_poles_near_roots(L, gains[unsure], out[unsure])
    out[gains == 0.0] = L.poles
    for i in np.flatnonzero(np.isin(gains, [b.K for b in breaks])):
        row = meet(L, float(gains[i]), out[i], breaks)
        # As many as before: otherwise the double pole was not among them.
        if row.size == L.order:
            out[i] = row
    return out


def _with_poles_near_roots(L: TransferFunction, gains: FloatArray, poles: ComplexArray) -> ComplexArray:
    """Next to a root of L eigenvalues are not sharp enough for Newton to begin: those are replaced."""
    out = poles.copy()
    for near in poles_near_roots(split_hidden_modes(L)[0], gains):
        m = near.poles.shape[1]
        nearest = np.argsort(np.abs(out - near.root), axis=1)[:, :m]
        there = np.isfinite(near.poles).all(axis=1)
        out[np.flatnonzero(there)[:, None], nearest[there]] = near.poles[there]
    return out


def _nearest_neighbour(points: ComplexArray) -> FloatArray:
    n = points.shape[-1]
    if n == 1:
        return np.full(points.shape, np.inf)
    gap = np.abs(points[:, :, None] - points[:, None, :])
    gap[:, np.arange(n), np.arange(n)] = np.inf
    return gap.min(axis=-1)


def _join(L: TransferFunction, gains: FloatArray, poles: ComplexArray) -> ComplexArray:
    """Order each row so that columns are continuous branches: nearest to the predicted pole, assigned where unclear."""
    out = poles.copy()
    for i in range(1, len(gains)):
        guess = out[i - 1]
        if i > 1 and gains[i - 1] > gains[i - 2]:
            guess = guess + (out[i - 1] - out[i - 2]) * _ratio(gains[i - 2 : i + 1])
        gap = np.abs(guess[:, None] - out[i][None, :])
        nearest = gap.argmin(axis=1)
        if np.unique(nearest).size != nearest.size:
            from scipy.optimize import linear_sum_assignment

            nearest = linear_sum_assignment(np.abs(out[i - 1][:, None] - out[i][None, :]) ** 2)[1]
        out[i] = out[i][nearest]
    return out.T


def _ratio(g: FloatArray) -> float:
    if g[0] <= 0:
        return 0.0
    return float(min(np.log(g[2] / g[1]) / np.log(g[1] / g[0]), 2.0))


def rational_branches(
    L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...], size: float
) -> tuple[FloatArray, ComplexArray]:
    """Add gains where a branch jumps or turns, until it looks smooth in a window of the given size."""
    poles = _poles_at(L, gains, breaks)
    coarse: npt.NDArray[np.bool_]
    for _ in range(5):
        branches = _join(L, gains, poles)
        step = np.abs(np.diff(branches, axis=1))
        inside = np.minimum(np.abs(branches[:, 1:]), np.abs(branches[:, :-1])) < 3.0 * size
        coarse = np.asarray(((step > 0.04 * size) & inside).any(axis=0))
        middle = branches[:, 1:-1]
        a, b = middle - branches[:, :-2], branches[:, 2:] - middle
        with np.errstate(all="ignore"):
            turn = np.abs(np.angle(b / a))
        # A right-angled break-away is a true corner; elsewhere a turn wants more points.
        bend = (turn > 0.15) & (np.minimum(np.abs(a), np.abs(b)) > 0.004 * size) & inside[:, 1:]
        coarse[:-1] |= bend.any(axis=0)
        coarse[1:] |= bend.any(axis=0)
        if not coarse.any() or gains.size > MAX_GAINS:
            break
        low, high = gains[:-1][coarse], gains[1:][coarse]
        extra = np.where(low > 0, np.sqrt(low * high), high / 4.0)
        new = _poles_at(L, extra, ())
        gains = np.concatenate([gains, extra])
        poles = np.concatenate([poles, new])
        order = np.argsort(gains, kind="stable")
        gains, poles = gains[order], poles[order]
    return gains, _join(L, gains, poles)
