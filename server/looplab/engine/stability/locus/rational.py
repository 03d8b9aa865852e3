"""Branches of a rational root locus: eigenvalues at a few gains, joined, and Halley's method between them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.locus.construction import Breakaway
from looplab.engine.stability.locus.cubics import Sampled, cubics_between, looks_smooth, subdivided
from looplab.engine.stability.locus.meeting import at_meeting
from looplab.engine.stability.locus.near_roots import poles_near_roots
from looplab.engine.stability.locus.pairs import nearest_neighbour, nearest_pairs
from looplab.engine.stability.polish import polish_with_slope
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
ComplexArray = npt.NDArray[np.complex128]

# Most gains, and fewer for many branches: so many points in all.
MAX_GAINS = 700
MAX_POINTS = 20_000
# Two numbers this close, relative to them, cannot be told apart.
ROUNDINGS = 4e-15
# Gains this close, relative to them, are one.
SAME = 1e-12


def rational_branches(
    L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...], size: float
) -> tuple[FloatArray, ComplexArray]:
    r"""Branches over the gain, with gains added until they look smooth.

    Parameters
    ----------
    L : TransferFunction
        Open loop for K = 1 without dead time.
    gains : ndarray
        Increasing from 0, those of ``breaks`` among them; more are added where a branch jumps or turns.
    breaks : tuple of Breakaway
        Where branches meet.
    size : float
        Size of the picture [rad/time].

    Returns
    -------
    gains : ndarray, shape (m,)
    branches : ndarray of complex, shape (n, m)

    Notes
    -----
    Between two gains a branch is nearly the cubic with its end points and its tangents ds/dK there. The points to be
    added begin on it. Halley's steps that move each by much less than the distance to its neighbours lead to n
    different roots of one equation of degree n, to all of them: where that fails eigenvalues are taken.
    """
    L, hidden = split_hidden_modes(L)
    if L.order:
        # Rates are infinite where branches meet, and L is on its roots.
        with np.errstate(all="ignore"):
            gains, poles, *_ = _smooth(L, _joined_eigenvalues(L, gains, breaks), size)
    else:
        poles = np.zeros((gains.size, 0), dtype=complex)
    if hidden.size:
        poles = np.concatenate([poles, np.broadcast_to(hidden, (gains.size, hidden.size))], axis=1)
    return gains, poles.T


def _poles_at(L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...]) -> Sampled:
    """Closed-loop poles for each gain K > 0, unsorted."""
    ss = realize(L)
    effective = gains / (1.0 + gains * ss.D)
    found = np.linalg.eigvals(ss.A - effective[:, None, None] * (ss.B[:, None] * ss.C)).astype(complex)
    out, good, slope = polish_with_slope(L, found, gains[:, None], steps=2)
    # Near a break-away Halley's method may pull two roots into one: keep the eigenvalues there.
    good &= np.abs(out - found) < 0.2 * nearest_neighbour(found)
    if np.count_nonzero(good) < good.size:
        out = np.where(good, out, found)
    out.imag[found.imag == 0.0] = 0.0
    rates = -1.0 / slope
    meeting = np.zeros(gains.size, dtype=bool)
    increasing = gains.tolist()
    for b in breaks:
        for i in range(bisect_left(increasing, b.K * (1.0 - SAME)), bisect_right(increasing, b.K * (1.0 + SAME))):
            meeting[i] = True
            here = at_meeting(L, b.s, out[i])
            if np.count_nonzero(here) > 1:
                out[i, here], rates[i, here], good[i, here] = b.s, np.inf, True
    if np.count_nonzero(good) < good.size:
        unsure = ~good.all(axis=1)
        out[unsure] = _with_poles_near_roots(L, gains[unsure], out[unsure])
        rates[unsure] = -1.0 / L.log_derivative(out[unsure])
    return Sampled(gains, out, rates, meeting)


def _with_poles_near_roots(L: TransferFunction, gains: FloatArray, poles: ComplexArray) -> ComplexArray:
    """Next to a root of L eigenvalues are not sharp enough for Halley's method to begin: those are replaced."""
    out = poles.copy()
    for near in poles_near_roots(L, gains):
        m = near.poles.shape[1]
        nearest = np.argsort(np.abs(out - near.root), axis=1)[:, :m]
        there = np.isfinite(near.poles).all(axis=1)
        out[np.flatnonzero(there)[:, None], nearest[there]] = near.poles[there]
    return out


def _joined_eigenvalues(L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...]) -> Sampled:
    """Poles at the gains and at some between, so that it is sure which becomes which; one branch a column."""
    begin = Sampled(np.zeros(1), L.poles[None, :], np.zeros((1, L.order), dtype=complex), np.zeros(1, dtype=bool))
    found = begin.followed_by(_poles_at(L, gains[gains > 0.0], breaks))
    links, sure = _links(found)
    for _ in range(2):
        if sure.all():
            break
        at = np.flatnonzero(~sure)
        found = found.merged(_poles_at(L, np.sqrt(found.gains[at] * found.gains[at + 1]), ()))
        links, sure = _links(found)
    return found.joined(links)


def _links(found: Sampled) -> tuple[npt.NDArray[np.intp], BoolArray]:
    """Which pole of the next gain each pole becomes, shape (m-1, n), and in which intervals that is sure.

    Followed along their tangents to the middle of the interval, those that belong together meet there: it is sure
    where each is the other's nearest. Branches that meet at an end of the interval may be exchanged there.
    """
    gains, poles, rates, meeting = found
    half = np.zeros((gains.size - 1, 1))
    half[1:, 0] = 0.5 * np.log(gains[2:] / gains[1:-1])
    ahead, back = rates[:-1] * half, rates[1:] * half
    # At a meeting point the tangent is lost; next to one it points too far.
    room = 0.5 * nearest_neighbour(poles)
    start = poles[:-1] + np.where(np.abs(ahead) < room[:-1], ahead, 0.0)
    end = poles[1:] - np.where(np.abs(back) < room[1:], back, 0.0)
    gap = np.abs(start[:, :, None] - end[:, None, :])
    free = ~(meeting[1:] | meeting[:-1])
    free[0] = False
    # Off the meeting points none leaves the real axis or crosses it.
    side = np.sign(poles.imag)
    gap[(side[:-1, :, None] != side[1:, None, :]) & free[:, None, None]] *= 10.0
    nearest = gap.argmin(axis=2)
    row = np.arange(free.size)[:, None]
    sure = (gap.argmin(axis=1)[row, nearest] == np.arange(poles.shape[1])).all(axis=1)
    for i in (~sure).nonzero()[0].tolist():
        for a, b in nearest_pairs(gap[i]):
            nearest[i, a] = b
    return nearest, sure | ~free


def _smooth(L: TransferFunction, found: Sampled, size: float) -> Sampled:
    """Add gains where a branch jumps or turns, until it looks smooth in a window of the given size."""
    most = min(MAX_GAINS, MAX_POINTS // L.order)
    for round_ in range(5):
        if round_ and looks_smooth(found, size):
            break
        cubics = cubics_between(found, size)
        parts = cubics.needed_parts(size)
        cut = (parts > 1).nonzero()[0]
        room = most - found.gains.size
        if not cut.size or room <= 0:
            break
        count = parts[cut] - 1
        if count.sum() > room:
            # What there is room for goes where it is needed most.
            keep = np.sort(np.argsort(-count, kind="stable")[:room])
            cut = cut[keep]
            count = np.maximum(1, count[keep] * room // max(int(count[keep].sum()), 1))
        at, fraction = subdivided(cut, count)
        gains, guess = cubics.gains(at, fraction), cubics.points(at, fraction)
        poles, good, slope = polish_with_slope(L, guess, gains[:, None], steps=6)
        more = Sampled(gains, poles, -1.0 / slope, np.zeros(gains.size, dtype=bool))
        if np.count_nonzero(good) < good.size:
            # A pole that does not move from one end of the interval to the other is there: on a root of L, mostly.
            still = ~good & (np.abs(cubics.end[at] - cubics.start[at]) <= ROUNDINGS * np.abs(guess))
            poles[still], more.rates[still], good[still] = guess[still], 0.0, True
        good &= np.abs(poles - guess) < 0.4 * nearest_neighbour(guess)
        if np.count_nonzero(good) == good.size:
            found = found.merged(more)
            continue
        lost = ~good.all(axis=1)
        again = _poles_at(L, gains[lost], ())
        more.poles[lost], more.rates[lost] = again.poles, again.rates
        found = found.merged(more)
        found = found.joined(_links(found)[0])
    return found
