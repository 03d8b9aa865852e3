"""Branches of a rational root locus: eigenvalues at a few gains, joined, and Newton's method between them."""

from __future__ import annotations

from dataclasses import dataclass

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
        gains, poles = _joined_eigenvalues(L, gains, breaks)
        gains, poles = _smooth(L, gains, poles, breaks, size)
    else:
        poles = np.zeros((gains.size, 0), dtype=complex)
    stay = np.broadcast_to(hidden, (gains.size, hidden.size))
    return gains, np.concatenate([poles, stay], axis=1).T


def _poles_at(L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...]) -> ComplexArray:
    """Closed-loop poles for each gain, unsorted, shape (m, n)."""
    ss = realize(L)
    effective = gains / (1.0 + gains * ss.D)
    found = np.linalg.eigvals(ss.A - effective[:, None, None] * (ss.B[:, None] * ss.C)).astype(complex)
    polished, good = polish_closed_loop_poles(L, found, gains[:, None], steps=2)
    # Near a break-away Newton may pull two roots into one: keep the eigenvalues there.
    good &= np.abs(polished - found) < 0.2 * _nearest_neighbour(found)
    out = np.where(good, polished, found)
    out.imag[found.imag == 0.0] = 0.0
    for i in _meeting(gains, breaks).nonzero()[0].tolist():
        row = meet(L, float(gains[i]), out[i], breaks)
        # As many as before: otherwise the double pole was not among them.
        if row.size == L.order:
            # The double pole comes last; the others are as good as they were.
            good[i] = [*np.isin(row[:-2], out[i][good[i]]), True, True]
            out[i] = row
    unsure = ~good.all(axis=1) & (gains > 0.0)
    if unsure.any():
        out[unsure] = _with_poles_near_roots(L, gains[unsure], out[unsure])
    out[gains == 0.0] = L.poles
    return out


def _meeting(gains: FloatArray, breaks: tuple[Breakaway, ...]) -> BoolArray:
    """At which of the gains branches meet."""
    return np.asarray((gains[:, None] == np.array([b.K for b in breaks])).any(axis=1))


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
    n = points.shape[-1]
    if n == 1:
        return np.full(points.shape, np.inf)
    gap = np.abs(points[:, :, None] - points[:, None, :])
    gap[:, np.arange(n), np.arange(n)] = np.inf
    return gap.min(axis=-1)


def _tangents(L: TransferFunction, poles: ComplexArray) -> ComplexArray:
    """ds/d ln K = -L/L' at each pole; 0 on a pole of L, huge or not a number where branches meet."""
    with np.errstate(all="ignore"):
        return -1.0 / L.log_derivative(poles)


def _joined_eigenvalues(
    L: TransferFunction, gains: FloatArray, breaks: tuple[Breakaway, ...]
) -> tuple[FloatArray, ComplexArray]:
    """Poles at the gains and at some between, so that it is sure which becomes which; one branch a column."""
    poles = _poles_at(L, gains, breaks)
    links, sure = _links(L, gains, poles, breaks)
    for _ in range(2):
        if sure.all():
            break
        at = np.flatnonzero(~sure)
        extra = np.sqrt(gains[at] * gains[at + 1])
        gains, poles = _merged(gains, poles, extra, _poles_at(L, extra, ()))
        links, sure = _links(L, gains, poles, breaks)
    return gains, _joined(poles, links)


def _merged(
    gains: FloatArray, poles: ComplexArray, extra: FloatArray, more: ComplexArray
) -> tuple[FloatArray, ComplexArray]:
    gains = np.concatenate([gains, extra])
    order = gains.argsort(kind="stable")
    return gains[order], np.concatenate([poles, more])[order]


def _links(
    L: TransferFunction, gains: FloatArray, poles: ComplexArray, breaks: tuple[Breakaway, ...]
) -> tuple[npt.NDArray[np.intp], BoolArray]:
    """Which pole of the next gain each pole becomes, shape (m-1, n), and in which intervals that is sure.

    Followed along their tangents to the middle of the interval, those that belong together meet there: it is sure
    where each is the other's nearest. Branches that meet at an end of the interval may be exchanged there.
    """
    tangents = _tangents(L, poles)
    room = _nearest_neighbour(poles)
    with np.errstate(all="ignore"):
        half = 0.5 * np.log(gains[1:] / gains[:-1])[:, None]
        ahead, back = tangents[:-1] * half, tangents[1:] * half
    # At a meeting point the tangent is lost; next to one it points too far.
    ahead[~(np.abs(ahead) < 0.5 * room[:-1])] = 0.0
    back[~(np.abs(back) < 0.5 * room[1:])] = 0.0
    start, end = poles[:-1] + ahead, poles[1:] - back
    gap = np.abs(start[:, :, None] - end[:, None, :])
    alone = ~_meeting(gains, breaks)
    alone[0] = False
    free = alone[1:] & alone[:-1]
    # Off the meeting points none leaves the real axis or crosses it.
    side = np.sign(poles.imag)
    gap[(side[:-1, :, None] != side[1:, None, :]) & free[:, None, None]] *= 10.0
    nearest = gap.argmin(axis=2)
    sure = (np.take_along_axis(gap.argmin(axis=1), nearest, axis=1) == np.arange(poles.shape[1])).all(axis=1)
    for i in (~sure).nonzero()[0].tolist():
        for a, b in nearest_pairs(gap[i]):
            nearest[i, a] = b
    return nearest, sure | ~free


def _joined(poles: ComplexArray, links: npt.NDArray[np.intp]) -> ComplexArray:
    """One branch a column, shape (m, n)."""
    order = [list(range(poles.shape[1]))]
    for step in links.tolist():
        order.append([step[j] for j in order[-1]])
    return poles[np.arange(len(order))[:, None], np.array(order)]


def _smooth(
    L: TransferFunction, gains: FloatArray, poles: ComplexArray, breaks: tuple[Breakaway, ...], size: float
) -> tuple[FloatArray, ComplexArray]:
    """Add gains where a branch jumps or turns, until it looks smooth in a window of the given size."""
    most = min(MAX_GAINS, MAX_POINTS // L.order)
    for _ in range(5):
        cubics = _cubics(L, gains, poles, breaks, size)
        parts = _needed_parts(cubics, size)
        cut = (parts > 1).nonzero()[0]
        if not cut.size or gains.size >= most:
            break
        count = parts[cut] - 1
        if count.sum() > most - gains.size:
            # What there is room for goes where it is needed most.
            keep = np.sort(np.argsort(-count, kind="stable")[: most - gains.size])
            cut = cut[keep]
            count = np.maximum(1, count[keep] * (most - gains.size) // max(int(count[keep].sum()), 1))
        at = np.repeat(cut, count)
        fraction = (1 + np.arange(at.size) - np.repeat(np.cumsum(count) - count, count)) / np.repeat(count + 1, count)
        extra, guess = cubics.gains(at, fraction), cubics.points(at, fraction)
        more, good = polish_closed_loop_poles(L, guess, extra[:, None], steps=6)
        lost = ~(good & (np.abs(more - guess) < 0.2 * _nearest_neighbour(guess))).all(axis=1)
        if lost.any():
            more[lost] = _poles_at(L, extra[lost], ())
        gains, poles = _merged(gains, poles, extra, more)
        if lost.any():
            poles = _joined(poles, _links(L, gains, poles, breaks)[0])
    return gains, poles


@dataclass(frozen=True)
class _Cubics:
    """Each branch between neighbouring gains as a cubic s(x), x from 0 to 1, shape (m-1, n).

    ``forward`` and ``backward`` are ds/dx at the two ends, ``leaves`` and ``arrives`` have the directions there. In an
    interval that begins or ends at a meeting point or at K = 0 the gain is a power of x, ``power``, since branches
    leave such points as a root of the gain does; it is counted from the other end where ``reversed``. Elsewhere
    ln K is linear in x, and the power 0.
    """

    low: FloatArray
    high: FloatArray
    power: FloatArray
    reversed: BoolArray
    start: ComplexArray
    end: ComplexArray
    forward: ComplexArray
    backward: ComplexArray
    leaves: ComplexArray
    arrives: ComplexArray

    def gains(self, at: npt.NDArray[np.intp], x: FloatArray) -> FloatArray:
        """K at the places x of the intervals ``at``."""
        low, high, power, back = self.low[at], self.high[at], self.power[at], self.reversed[at]
        share = np.where(back, x - 1.0, x)
        powers = np.where(back, high, low) + np.sign(share) * (high - low) * np.abs(share) ** power
        with np.errstate(divide="ignore"):
            return np.where(power == 0.0, low ** (1.0 - x) * high**x, powers)

    def points(self, at: npt.NDArray[np.intp], x: FloatArray) -> ComplexArray:
        """Where the cubics are at those places, shape (places, n)."""
        x = x[:, None]
        rest = 1.0 - x
        ends = rest**2 * (1.0 + 2.0 * x) * self.start[at] + x**2 * (1.0 + 2.0 * rest) * self.end[at]
        return np.asarray(ends + x * rest * (rest * self.forward[at] - x * self.backward[at]))


def _cubics(
    L: TransferFunction, gains: FloatArray, poles: ComplexArray, breaks: tuple[Breakaway, ...], size: float
) -> _Cubics:
    tangents = _tangents(L, poles)
    root = ~(np.abs(tangents) < AT_MEETING * size)
    repeated = (poles[0][:, None] == poles[0]).sum(axis=0)
    multiplicity = repeated.max()
    tangents[root] = tangents[0] = 0.0
    root[0] = repeated == multiplicity
    low, high, start, end = gains[:-1], gains[1:], poles[:-1], poles[1:]
    meeting = _meeting(gains, breaks)
    power = np.where(meeting[1:] | meeting[:-1], 2.0, 0.0)
    power[0] = multiplicity
    back = meeting[1:] & ~meeting[:-1]
    back[0] = False
    with np.errstate(divide="ignore", invalid="ignore"):
        # d ln K/dx at both ends; at the end where the power law begins it is 0.
        rise = np.where(power == 0.0, np.log(high / low), power * (high - low))
        begins = np.where(power == 0.0, rise, np.where(back, rise / low, 0.0))[:, None]
        ends = np.where(power == 0.0, rise, np.where(back, 0.0, rise / high))[:, None]
    forward, backward = begins * tangents[:-1], ends * tangents[1:]
    # A parabola says how fast a branch leaves a point that it leaves as a root of the gain does.
    first, last = root[:-1], root[1:]
    forward = np.where(first, 2.0 * (end - start) - backward, forward)
    backward = np.where(last, 2.0 * (end - start) - forward, backward)
    leaves, arrives = np.where(first, forward, tangents[:-1]), np.where(last, backward, tangents[1:])
    return _Cubics(low, high, power, back, start, end, forward, backward, leaves, arrives)


def _needed_parts(cubics: _Cubics, size: float) -> npt.NDArray[np.intp]:
    """Into how many parts each interval of the gain must be cut for the branches to look smooth, shape (m-1,)."""
    chord = cubics.end - cubics.start
    distance = np.minimum(np.abs(cubics.start), np.abs(cubics.end))
    # Farther out the picture is looked at from farther away.
    scale = np.maximum(distance, size)
    length = np.abs(chord) / scale
    inside = distance < FAR * size
    fastest = np.maximum(np.abs(cubics.forward), np.abs(cubics.backward)) / scale
    long = inside & (length > LONGEST_STEP)
    parts = np.where(long, np.maximum(length, fastest), 0.0) / AIMED_STEP
    turn = np.abs(np.angle(chord * cubics.leaves.conj())) + np.abs(np.angle(cubics.arrives * chord.conj()))
    bent = inside & (length > TOO_SHORT) & (turn > LARGEST_TURN)
    parts = np.maximum(parts, np.where(bent, turn, 0.0) / AIMED_TURN)
    return np.clip(np.ceil(parts.max(axis=1)), 1, MOST_PARTS).astype(np.intp)
