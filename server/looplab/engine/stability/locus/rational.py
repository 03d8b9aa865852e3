"""Branches of a rational root locus: eigenvalues at a few gains, joined, and Newton's method between them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.locus.construction import Breakaway
from looplab.engine.stability.locus.meeting import at_meeting
from looplab.engine.stability.locus.near_roots import poles_near_roots
from looplab.engine.stability.locus.pairs import nearest_pairs
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
# Of a branch in the picture: the longest step, relative to its size, and the largest turn [rad] between gains. What
# exceeds them is cut finer than that, so that one cut is enough.
LONGEST_STEP, AIMED_STEP = 0.1, 0.07
LARGEST_TURN, AIMED_TURN = 0.15, 0.1
# Shorter steps, relative to the picture, may turn as they like.
TOO_SHORT = 0.004
# Out here [sizes of the picture] branches are not drawn closely.
FAR = 3.0
# Into so many parts an interval is cut at once.
MOST_PARTS = 24
# A pole that moves this far [sizes of the picture] per ln K is at a meeting point.
AT_MEETING = 1e4
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
    added begin on it. Newton's steps that move each by much less than the distance to its neighbours lead to n
    different roots of one equation of degree n, to all of them: where that fails eigenvalues are taken.
    """
    L, hidden = split_hidden_modes(L)
    if L.order:
        gains, poles, *_ = _smooth(L, _joined_eigenvalues(L, gains, breaks), size)
    else:
        poles = np.zeros((gains.size, 0), dtype=complex)
    if hidden.size:
        poles = np.concatenate([poles, np.broadcast_to(hidden, (gains.size, hidden.size))], axis=1)
    return gains, poles.T


class _Sampled(NamedTuple):
    """Poles at some gains: ``rates`` are ds/d ln K, not finite where branches meet; ``meeting``: they do at this gain.

    Shapes (m,), (m, n), (m, n), (m,).
    """

    gains: FloatArray
    poles: ComplexArray
    rates: ComplexArray
    meeting: BoolArray

    def merged(self, more: _Sampled) -> _Sampled:
        """Both, by increasing gain."""
        order = np.concatenate([self.gains, more.gains]).argsort(kind="stable")
        return _Sampled(*(np.concatenate(pair)[order] for pair in zip(self, more, strict=True)))

    def joined(self, links: npt.NDArray[np.intp]) -> _Sampled:
        """One branch a column, given which pole of the next gain each pole becomes."""
        order = [list(range(self.poles.shape[1]))]
        for step in links.tolist():
            order.append([step[j] for j in order[-1]])
        at = np.arange(len(order))[:, None], np.array(order)
        return self._replace(poles=self.poles[at], rates=self.rates[at])


def _poles_at(L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...]) -> _Sampled:
    """Closed-loop poles for each gain K > 0, unsorted."""
    ss = realize(L)
    effective = gains / (1.0 + gains * ss.D)
    found = np.linalg.eigvals(ss.A - effective[:, None, None] * (ss.B[:, None] * ss.C)).astype(complex)
    out, good, slope = polish_with_slope(L, found, gains[:, None], steps=2)
    # Near a break-away Newton may pull two roots into one: keep the eigenvalues there.
    good &= np.abs(out - found) < 0.2 * _nearest_neighbour(found)
    out = np.where(good, out, found)
    out.imag[found.imag == 0.0] = 0.0
    with np.errstate(all="ignore"):
        rates = -1.0 / slope
    meeting = np.zeros(gains.size, dtype=bool)
    increasing = gains.tolist()
    for b in breaks:
        for i in range(bisect_left(increasing, b.K * (1.0 - SAME)), bisect_right(increasing, b.K * (1.0 + SAME))):
            meeting[i] = True
            here = at_meeting(L, b.s, out[i])
            if np.count_nonzero(here) > 1:
                out[i, here], rates[i, here], good[i, here] = b.s, np.inf, True
    unsure = ~good.all(axis=1)
    if unsure.any():
        out[unsure] = _with_poles_near_roots(L, gains[unsure], out[unsure])
        with np.errstate(all="ignore"):
            rates[unsure] = -1.0 / L.log_derivative(out[unsure])
    return _Sampled(gains, out, rates, meeting)


def _with_poles_near_roots(L: TransferFunction, gains: FloatArray, poles: ComplexArray) -> ComplexArray:
    """Next to a root of L eigenvalues are not sharp enough for Newton to begin: those are replaced."""
    out = poles.copy()
    for near in poles_near_roots(L, gains):
        m = near.poles.shape[1]
        nearest = np.argsort(np.abs(out - near.root), axis=1)[:, :m]
        there = np.isfinite(near.poles).all(axis=1)
        out[np.flatnonzero(there)[:, None], nearest[there]] = near.poles[there]
    return out


def _nearest_neighbour(points: ComplexArray) -> FloatArray:
    m, n = points.shape
    gap = np.abs(points[:, :, None] - points[:, None, :])
    gap.reshape(m, n * n)[:, :: n + 1] = np.inf
    return gap.min(axis=1)


def _joined_eigenvalues(L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...]) -> _Sampled:
    """Poles at the gains and at some between, so that it is sure which becomes which; one branch a column."""
    begin = _Sampled(np.zeros(1), L.poles[None, :], np.zeros((1, L.order), dtype=complex), np.zeros(1, dtype=bool))
    found = begin.merged(_poles_at(L, gains[gains > 0.0], breaks))
    links, sure = _links(found)
    for _ in range(2):
        if sure.all():
            break
        at = np.flatnonzero(~sure)
        found = found.merged(_poles_at(L, np.sqrt(found.gains[at] * found.gains[at + 1]), ()))
        links, sure = _links(found)
    return found.joined(links)


def _links(found: _Sampled) -> tuple[npt.NDArray[np.intp], BoolArray]:
    """Which pole of the next gain each pole becomes, shape (m-1, n), and in which intervals that is sure.

    Followed along their tangents to the middle of the interval, those that belong together meet there: it is sure
    where each is the other's nearest. Branches that meet at an end of the interval may be exchanged there.
    """
    poles, n = found.poles, found.poles.shape[1]
    half = np.zeros((found.gains.size, 1))
    half[1:-1, 0] = 0.5 * np.log(found.gains[2:] / found.gains[1:-1])
    room = 0.5 * _nearest_neighbour(poles)
    with np.errstate(all="ignore"):
        ahead, back = found.rates[:-1] * half[:-1], found.rates[1:] * half[:-1]
        # At a meeting point the tangent is lost; next to one it points too far.
        start = poles[:-1] + np.where(np.abs(ahead) < room[:-1], ahead, 0.0)
        end = poles[1:] - np.where(np.abs(back) < room[1:], back, 0.0)
    gap = np.abs(start[:, :, None] - end[:, None, :])
    free = ~(found.meeting[1:] | found.meeting[:-1])
    free[0] = False
    # Off the meeting points none leaves the real axis or crosses it.
    side = np.sign(poles.imag)
    gap *= np.where((side[:-1, :, None] != side[1:, None, :]) & free[:, None, None], 10.0, 1.0)
    nearest = gap.argmin(axis=2)
    sure = (gap.argmin(axis=1)[np.arange(free.size)[:, None], nearest] == np.arange(n)).all(axis=1)
    for i in (~sure).nonzero()[0].tolist():
        for a, b in nearest_pairs(gap[i]):
            nearest[i, a] = b
    return nearest, sure | ~free


def _smooth(L: TransferFunction, found: _Sampled, size: float) -> _Sampled:
    """Add gains where a branch jumps or turns, until it looks smooth in a window of the given size."""
    most = min(MAX_GAINS, MAX_POINTS // L.order)
    for _ in range(5):
        cubics = _cubics(found, size)
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
        at = np.repeat(cut, count)
        fraction = (1 + np.arange(at.size) - np.repeat(np.cumsum(count) - count, count)) / np.repeat(count + 1, count)
        gains, guess = cubics.gains(at, fraction), cubics.points(at, fraction)
        poles, good, slope = polish_with_slope(L, guess, gains[:, None], steps=6)
        with np.errstate(all="ignore"):
            more = _Sampled(gains, poles, -1.0 / slope, np.zeros(gains.size, dtype=bool))
        if not good.all():
            # A pole that does not move from one end of the interval to the other is there: on a root of L, mostly.
            still = ~good & (np.abs(cubics.end[at] - cubics.start[at]) <= ROUNDINGS * np.abs(guess))
            poles[still], more.rates[still], good[still] = guess[still], 0.0, True
        lost = ~(good & (np.abs(poles - guess) < 0.4 * _nearest_neighbour(guess))).all(axis=1)
        if lost.any():
            again = _poles_at(L, gains[lost], ())
            more.poles[lost], more.rates[lost] = again.poles, again.rates
        found = found.merged(more)
        if lost.any():
            found = found.joined(_links(found)[0])
    return found


@dataclass(frozen=True)
class _Cubics:
    """Each branch between neighbouring gains as a cubic s(x), x from 0 to 1.

    ``start`` and ``end`` have shape (m-1, n); ``slopes`` are ds/dx at the two ends and ``directions`` those in which
    the branch passes them, shape (2, m-1, n). ln K is linear in x. But in an interval that begins or ends at a meeting
    point or at K = 0 the gain is a power of x, ``power``, since branches leave such points as a root of the gain does;
    it is counted from the other end where ``reversed``.
    """

    low: FloatArray
    high: FloatArray
    power: FloatArray
    reversed: BoolArray
    start: ComplexArray
    end: ComplexArray
    slopes: ComplexArray
    directions: ComplexArray

    def gains(self, at: npt.NDArray[np.intp], x: FloatArray) -> FloatArray:
        """K at the places x of the intervals ``at``."""
        low, high, power = self.low[at], self.high[at], self.power[at]
        out = low ** (1.0 - x) * high**x
        bent = power.nonzero()[0]
        if bent.size:
            low, high, back = low[bent], high[bent], self.reversed[at[bent]]
            share = np.where(back, 1.0 - x[bent], x[bent]) ** power[bent] * (high - low)
            out[bent] = np.where(back, high - share, low + share)
        return np.asarray(out)

    def points(self, at: npt.NDArray[np.intp], x: FloatArray) -> ComplexArray:
        """Where the cubics are at those places, shape (places, n)."""
        x = x[:, None]
        rest = 1.0 - x
        ends = rest**2 * (1.0 + 2.0 * x) * self.start[at] + x**2 * (1.0 + 2.0 * rest) * self.end[at]
        return np.asarray(ends + x * rest * (rest * self.slopes[0, at] - x * self.slopes[1, at]))

    def needed_parts(self, size: float) -> npt.NDArray[np.intp]:
        """Into how many parts each interval must be cut for the branches to look smooth, shape (m-1,)."""
        chord = self.end - self.start
        distance = np.minimum(np.abs(self.start), np.abs(self.end))
        # Farther out the picture is looked at from farther away.
        scale = np.maximum(distance, size)
        length, (leaves, arrives) = np.abs(chord) / scale, np.abs(self.slopes)
        longest = np.maximum(length, np.maximum(leaves, arrives) / scale)
        turns = self.directions * chord.conj()
        leaves, arrives = np.abs(np.arctan2(turns.imag, turns.real))
        turn = leaves + arrives
        bent = (length > TOO_SHORT) & (turn > LARGEST_TURN)
        parts = np.maximum((length > LONGEST_STEP) * longest / AIMED_STEP, bent * turn / AIMED_TURN)
        parts *= distance < FAR * size
        return np.ceil(np.minimum(parts.max(axis=1), MOST_PARTS)).astype(np.intp)


def _cubics(found: _Sampled, size: float) -> _Cubics:
    gains, poles, rates, meeting = found
    root = ~(np.abs(rates) < AT_MEETING * size)
    repeated = np.count_nonzero(poles[0][:, None] == poles[0], axis=0)
    multiplicity = int(repeated.max())
    root[0] = repeated == multiplicity
    rates = np.where(root, 0.0, rates)
    low, high, start, end = gains[:-1], gains[1:], poles[:-1], poles[1:]
    power, back = np.zeros(low.size), np.zeros(low.size, dtype=bool)
    # d ln K/dx at both ends; at the end where the power law begins it is 0.
    begins = np.zeros((low.size, 1))
    begins[1:, 0] = np.log(high[1:] / low[1:])
    ends = begins.copy()
    power[0], ends[0] = multiplicity, multiplicity
    for i in meeting.nonzero()[0].tolist():
        if i < low.size:
            power[i], back[i] = 2.0, False
            begins[i], ends[i] = 0.0, 2.0 * (1.0 - low[i] / high[i])
        if i > 1 and not meeting[i - 1]:
            power[i - 1], back[i - 1] = 2.0, True
            begins[i - 1], ends[i - 1] = 2.0 * (high[i - 1] / low[i - 1] - 1.0), 0.0
    # A parabola says how fast a branch leaves a point that it leaves as a root of the gain does.
    first, last, twice = root[:-1], root[1:], 2.0 * (end - start)
    backward = ends * rates[1:]
    forward = np.where(first, twice - backward, begins * rates[:-1])
    backward = np.where(last, twice - forward, backward)
    directions = np.array([np.where(first, forward, rates[:-1]), np.where(last, backward, rates[1:])])
    return _Cubics(low, high, power, back, start, end, np.array([forward, backward]), directions)
