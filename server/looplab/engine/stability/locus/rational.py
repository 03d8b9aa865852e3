"""Branches of a rational root locus: eigenvalues, polished on the exact equation and joined right."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.locus.construction import Breakaway
from looplab.engine.stability.locus.meeting import meet
from looplab.engine.stability.locus.near_roots import poles_near_roots
from looplab.engine.stability.locus.pairs import nearest_pairs
from looplab.engine.stability.polish import polish_closed_loop_poles
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

MAX_GAINS = 700
# Of a branch in the picture: the longest step, relative to its size, and the largest turn [rad] between gains.
LONGEST_STEP = 0.04
LARGEST_TURN = 0.15
# Into so many parts an interval is cut at once.
MOST_PARTS = 8


def _poles_at(L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...]) -> ComplexArray:
    """Closed-loop poles for each gain, unsorted, shape (m, n)."""
    ss = realize(L)
    effective = gains / (1.0 + gains * ss.D)
    found = np.linalg.eigvals(ss.A - effective[:, None, None] * (ss.B[:, None] * ss.C)).astype(complex)
    polished, good = polish_closed_loop_poles(L, found, gains[:, None], steps=2)
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


def _links(L: TransferFunction, gains: FloatArray, poles: ComplexArray) -> npt.NDArray[np.intp]:
    """Which pole of the next gain each pole becomes, shape (m-1, n).

    Each is followed along its tangent ds/dK = -L/(K L') to the nearest pole there; of two that want the same one the
    nearer gets it.
    """
    with np.errstate(all="ignore"):
        ahead = -np.log(gains[1:] / gains[:-1])[:, None] / L.log_derivative(poles[:-1])
    # At a meeting point the tangent is lost; next to one it points too far.
    ahead[~(np.abs(ahead) < 0.5 * _nearest_neighbour(poles[:-1]))] = 0.0
    gap = np.abs((poles[:-1] + ahead)[:, :, None] - poles[1:, None, :])
    nearest = gap.argmin(axis=2)
    for i in np.flatnonzero((np.sort(nearest, axis=1) != np.arange(poles.shape[1])).any(axis=1)).tolist():
        for a, b in nearest_pairs(poles[i] + ahead[i], poles[i + 1]):
            nearest[i, a] = b
    return nearest


def _joined(poles: ComplexArray, links: npt.NDArray[np.intp]) -> ComplexArray:
    """Branches as rows, shape (n, m)."""
    order = [list(range(poles.shape[1]))]
    for step in links.tolist():
        order.append([step[j] for j in order[-1]])
    return np.take_along_axis(poles, np.array(order).reshape(poles.shape), axis=1).T


def _needed_parts(poles: ComplexArray, links: npt.NDArray[np.intp], size: float) -> npt.NDArray[np.intp]:
    """Into how many parts each interval of the gain must be cut for the branches to look smooth, shape (m-1,)."""
    step = np.take_along_axis(poles[1:], links, axis=1) - poles[:-1]
    length, near = np.abs(step), np.abs(poles) < 3.0 * size
    inside = near[:-1] | np.take_along_axis(near[1:], links, axis=1)
    parts = np.where(inside, length, 0.0).max(axis=1, initial=0.0) / (LONGEST_STEP * size)
    with np.errstate(all="ignore"):
        turn = np.abs(np.angle(np.take_along_axis(step[1:], links[:-1], axis=1) / step[:-1]))
    # A right-angled break-away is a true corner; elsewhere a turn wants more points.
    after = np.take_along_axis(length[1:], links[:-1], axis=1)
    seen = (np.minimum(after, length[:-1]) > 0.004 * size) & inside[:-1]
    bend = np.where(seen, turn, 0.0).max(axis=1, initial=0.0) / LARGEST_TURN
    np.maximum(parts[:-1], bend, out=parts[:-1])
    np.maximum(parts[1:], bend, out=parts[1:])
    return np.clip(np.ceil(parts), 1, MOST_PARTS).astype(np.intp)


def rational_branches(
    L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...], size: float
) -> tuple[FloatArray, ComplexArray]:
    """Add gains where a branch jumps or turns, until it looks smooth in a window of the given size."""
    poles = _poles_at(L, gains, breaks)
    for _ in range(5):
        links = _links(L, gains, poles)
        parts = _needed_parts(poles, links, size)
        cut = np.flatnonzero(parts > 1)
        if not cut.size or gains.size > MAX_GAINS:
            return gains, _joined(poles, links)
        count = parts[cut] - 1
        left = np.repeat(cut, count)
        part = (1 + np.arange(left.size) - np.repeat(np.cumsum(count) - count, count)) / np.repeat(parts[cut], count)
        low, high = gains[left], gains[left + 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            extra = np.where(low > 0, low * (high / low) ** part, high * part**2)
        gains, poles = np.concatenate([gains, extra]), np.concatenate([poles, _poles_at(L, extra, ())])
        order = np.argsort(gains, kind="stable")
        gains, poles = gains[order], poles[order]
    return gains, _joined(poles, _links(L, gains, poles))
