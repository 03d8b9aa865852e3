"""Branches of a locus between the gains at which they are known: a cubic each, and whether they look smooth."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
ComplexArray = npt.NDArray[np.complex128]
IntArray = npt.NDArray[np.intp]

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


def subdivided(cut: IntArray, count: IntArray) -> tuple[IntArray, FloatArray]:
    """So many evenly spaced places within each interval to be cut: the intervals' numbers and the places, 0 to 1."""
    at = np.repeat(cut, count)
    place = 1 + np.arange(at.size) - np.repeat(np.cumsum(count) - count, count)
    return at, place / np.repeat(count + 1, count)


def hermite(ends: Iterable[ComplexArray], slopes: Iterable[ComplexArray], x: FloatArray) -> ComplexArray:
    """Cubics with these two ends and slopes there, shape (places, n) each, at places x from 0 to 1, (places, 1)."""
    (start, end), (forward, backward) = ends, slopes
    rest = 1.0 - x
    straight = rest**2 * (1.0 + 2.0 * x) * start + x**2 * (1.0 + 2.0 * rest) * end
    return np.asarray(straight + x * rest * (rest * forward - x * backward))


class Sampled(NamedTuple):
    """Poles at some gains: ``rates`` are ds/d ln K, not finite where branches meet; ``meeting``: they do at this gain.

    Shapes (m,), (m, n), (m, n), (m,).
    """

    gains: FloatArray
    poles: ComplexArray
    rates: ComplexArray
    meeting: BoolArray

    def followed_by(self, more: Sampled) -> Sampled:
        """Both, where the other begins at a larger gain than this ends at."""
        return Sampled(*(np.concatenate(pair) for pair in zip(self, more, strict=True)))

    def merged(self, more: Sampled) -> Sampled:
        """Both, by increasing gain."""
        order = np.concatenate([self.gains, more.gains]).argsort(kind="stable")
        return Sampled(*(np.concatenate(pair)[order] for pair in zip(self, more, strict=True)))

    def joined(self, links: IntArray) -> Sampled:
        """One branch a column, given which pole of the next gain each pole becomes."""
        order = [list(range(self.poles.shape[1]))]
        for step in links.tolist():
            order.append(list(map(step.__getitem__, order[-1])))
        at = np.arange(len(order))[:, None], np.array(order)
        return self._replace(poles=self.poles[at], rates=self.rates[at])


def looks_smooth(found: Sampled, size: float) -> bool:
    """No branch in the picture jumps from one gain to the next, or turns, but where branches meet."""
    poles = found.poles
    chord, far = poles[1:] - poles[:-1], np.abs(poles)
    distance = np.minimum(far[1:], far[:-1])
    length = np.abs(chord) / np.maximum(distance, size) * (distance < FAR * size)
    if length.max() > LONGEST_STEP:
        return False
    turns = chord[1:] * chord[:-1].conj()
    sharp = np.abs(np.arctan2(turns.imag, turns.real)) > LARGEST_TURN
    sharp &= np.minimum(length[1:], length[:-1]) > TOO_SHORT
    return not sharp[~found.meeting[1:-1]].any()


@dataclass(frozen=True)
class Cubics:
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

    def gains(self, at: IntArray, x: FloatArray) -> FloatArray:
        """K at the places x of the intervals ``at``."""
        low, high, power = self.low[at], self.high[at], self.power[at]
        out = low ** (1.0 - x) * high**x
        bent = power.nonzero()[0]
        if bent.size:
            low, high, back = low[bent], high[bent], self.reversed[at[bent]]
            share = np.where(back, 1.0 - x[bent], x[bent]) ** power[bent] * (high - low)
            out[bent] = np.where(back, high - share, low + share)
        return np.asarray(out)

    def points(self, at: IntArray, x: FloatArray) -> ComplexArray:
        """Where the cubics are at those places, shape (places, n)."""
        return hermite((self.start[at], self.end[at]), self.slopes[:, at], x[:, None])

    def needed_parts(self, size: float) -> IntArray:
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


def cubics_between(found: Sampled, size: float) -> Cubics:
    """The cubics between neighbouring gains, from the poles and rates there.

    Parameters
    ----------
    found : Sampled
        One branch a column; the first gain is 0.
    size : float
        Size of the picture [rad/time]: a rate far beyond it is that of a meeting point.

    Returns
    -------
    Cubics
    """
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
    return Cubics(low, high, power, back, start, end, np.array([forward, backward]), directions)
