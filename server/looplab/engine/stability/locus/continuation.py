"""Branches of which some come and go: poles at a few gains, joined, and Newton's method between them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.locus.cubics import (
    AIMED_TURN,
    AT_MEETING,
    LARGEST_TURN,
    MOST_PARTS,
    TOO_SHORT,
    hermite,
    subdivided,
)
from looplab.engine.stability.locus.pairs import nearest_neighbour, nearest_pairs
from looplab.engine.stability.polish import EPSILON, polish_closed_loop_poles
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
IntArray = npt.NDArray[np.intp]
ComplexArray = npt.NDArray[np.complex128]
# Which points are in the part of the plane where poles are followed.
Inside = Callable[[ComplexArray], BoolArray]

MAX_GAINS = 400
ROUNDS = 4
# Of a branch the longest step between gains [sizes of the picture], and what longer ones are cut to.
LONGEST_STEP, AIMED_STEP = 0.04, 0.03
# Followed from both sides, one branch misses itself by less than this [sizes of the picture].
GATE = 0.3
# A branch without a partner must be outside this many times farther on.
BEYOND = 1.5


class Branches(NamedTuple):
    """Poles over the gain, one branch a column, NaN where it is outside; ``meeting``: branches meet at this gain.

    Shapes (m,), (m, n) and (m,).
    """

    gains: FloatArray
    poles: ComplexArray
    meeting: BoolArray


class Joined(NamedTuple):
    """Branches; in which intervals of the gain it is not sure which pole becomes which, shape (m-1,); and where
    partners of those that seem to have none would be: the gains' numbers, shape (k,), and points, shape (k,).
    """

    branches: Branches
    unsure: BoolArray
    at: IntArray
    missed: ComplexArray


def join(
    L: TransferFunction, gains: FloatArray, rows: list[ComplexArray], meeting: BoolArray, inside: Inside, size: float
) -> Joined:
    """Poles of each gain as branches.

    Followed along their tangents to the middle of the interval, those that belong together meet there. ``gains`` may
    begin with 0: there the open-loop poles are.
    """
    sizes = np.array([row.size for row in rows])
    there = np.arange(max(int(sizes.max()), 1)) < sizes[:, None]
    poles = np.full(there.shape, np.nan, dtype=complex)
    poles[there] = np.concatenate(rows)
    links, unsure, at, missed = _links(L, gains, poles, meeting, inside, size)
    count = int(sizes[0])
    on = [list(range(count))]
    for step, many in zip(links.tolist(), sizes[1:].tolist(), strict=True):
        now = [-1] * many
        for branch, k in zip(on[-1], step, strict=False):
            if k >= 0:
                now[k] = branch
        for k in range(many):
            if now[k] < 0:
                now[k], count = count, count + 1
        on.append(now)
    out = np.full((gains.size, max(count, 1)), np.nan, dtype=complex)
    out[there.nonzero()[0], np.concatenate(on).astype(int)] = poles[there]
    return Joined(Branches(gains, out, meeting), unsure, at, missed)


def _links(
    L: TransferFunction, gains: FloatArray, poles: ComplexArray, meeting: BoolArray, inside: Inside, size: float
) -> tuple[IntArray, BoolArray, IntArray, ComplexArray]:
    """Which pole of the next gain each pole becomes, -1 for none, shape (m-1, n), and the rest as in Joined."""
    half, first = np.zeros((gains.size - 1, 1)), int(gains[0] == 0.0)
    half[first:, 0] = 0.5 * np.log(gains[first + 1 :] / gains[first:-1])
    room = 0.5 * nearest_neighbour(poles)
    with np.errstate(all="ignore"):
        rates = -1.0 / L.log_derivative(poles)
        ahead, back = rates[:-1] * half, rates[1:] * half
        # At a meeting point the tangent is lost; next to one it points too far.
        ahead[~(np.abs(ahead) < room[:-1])] = 0.0
        back[~(np.abs(back) < room[1:])] = 0.0
        gap = np.abs((poles[:-1] + ahead)[:, :, None] - (poles[1:] - back)[:, None, :])
    free = ~(meeting[1:] | meeting[:-1])
    free[:first] = False
    # Off the meeting points none leaves the real axis or crosses it.
    side = np.sign(poles.imag)
    gap[(side[:-1, :, None] != side[1:, None, :]) & free[:, None, None]] *= 10.0
    gap[~(gap <= GATE * size)] = np.inf
    links = gap.argmin(axis=2)
    reached = np.isfinite(gap.min(axis=2))
    mutual = gap.argmin(axis=1)[np.arange(free.size)[:, None], links] == np.arange(poles.shape[1])
    links[~reached] = -1
    torn = (reached & ~mutual).any(axis=1)
    for i in torn.nonzero()[0].tolist():
        links[i] = -1
        for a, b in nearest_pairs(gap[i], GATE * size):
            links[i, a] = b
    taken = np.zeros(poles.shape, dtype=bool)
    at, which = (links >= 0).nonzero()
    taken[at + 1, links[at, which]] = True
    lost = (links < 0) & inside(poles[:-1] + 2.0 * BEYOND * ahead) & free[:, None]
    found = ~taken[1:] & inside(poles[1:] - 2.0 * BEYOND * back) & free[:, None]
    at = np.concatenate([lost.nonzero()[0] + 1, found.nonzero()[0]])
    missed = np.concatenate([(poles[:-1] + 2.0 * ahead)[lost], (poles[1:] - 2.0 * back)[found]])
    return links, (lost | found).any(axis=1), at, missed


def smooth(L: TransferFunction, known: Branches, inside: Inside, size: float) -> tuple[Branches, FloatArray]:
    """Gains added where a branch jumps or turns, until it looks smooth; and gains at which some pole was not found.

    Between two gains a branch is nearly the cubic with its end points and its tangents there. Newton's steps that move
    each pole by much less than the distance to its neighbours lead to different poles.
    """
    for _ in range(ROUNDS):
        low, high, power, back, cubic, parts = _cubics(L, known, size)
        cut = (parts > 1).nonzero()[0]
        if not cut.size or known.gains.size >= MAX_GAINS:
            break
        count = parts[cut] - 1
        at, x = subdivided(cut, count)
        share = np.where(back[at], 1.0 - (1.0 - x) ** 2, x**2)
        gains = np.where(power[at], low[at] + share * (high - low)[at], low[at] * (high / low)[at] ** x)
        guess = hermite(cubic[:2, at], cubic[2:, at], x[:, None])
        poles, good = polish_closed_loop_poles(L, guess, gains[:, None], steps=6)
        poles.imag[guess.imag == 0.0] = 0.0
        # Next to a root of L a pole may move by less than rounding.
        still = np.abs(cubic[1, at] - cubic[0, at]) <= 16.0 * EPSILON * np.abs(guess)
        poles[still] = guess[still]
        good &= np.abs(poles - guess) < 0.2 * nearest_neighbour(guess)
        missing = ~(good | still)
        lost = (missing & inside(guess)).any(axis=1)
        if lost.any():
            return known, gains[lost]
        poles[missing | ~inside(poles)] = np.nan
        gains = np.concatenate([known.gains, gains])
        order = gains.argsort(kind="stable")
        meeting = np.concatenate([known.meeting, np.zeros(at.size, dtype=bool)])
        known = Branches(gains[order], np.concatenate([known.poles, poles])[order], meeting[order])
    return known, np.zeros(0)


def _cubics(
    L: TransferFunction, known: Branches, size: float
) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray, ComplexArray, IntArray]:
    """Each branch between neighbouring gains as a cubic of x from 0 to 1.

    Returns
    -------
    low, high : ndarray, shape (m-1,)
        Gains at the ends, > 0: what begins at K = 0 is left as it is.
    power, back : ndarray of bool
        ln K is linear in x; where a meeting point begins or ends the interval (``power``) K is quadratic, since
        branches leave such points as a root of the gain does; counted from the end where ``back``.
    cubic : ndarray, shape (4, m-1, n)
        Ends and slopes there.
    parts : ndarray of int
        Into how many parts each interval must be cut.
    """
    gains, poles, meeting = known
    with np.errstate(all="ignore"):
        rates = -1.0 / L.log_derivative(poles)
    root = np.abs(rates) >= AT_MEETING * size
    root[~np.isfinite(rates) & np.isfinite(poles)] = True
    rates[root] = 0.0
    low, high = np.maximum(gains[:-1], 1e-300), gains[1:]
    power, back = meeting[1:] | meeting[:-1], meeting[1:] & ~meeting[:-1]
    # d ln K/dx at both ends; at the end where the power law begins it is 0.
    rise, wide = np.log(high / low), 2.0 * (high - low)
    begins = np.where(power, np.where(back, wide / low, 0.0), rise)[:, None]
    ends = np.where(power, np.where(back, 0.0, wide / high), rise)[:, None]
    start, end = poles[:-1], poles[1:]
    forward, backward = begins * rates[:-1], ends * rates[1:]
    # A parabola says how fast a branch leaves a point that it leaves as a root of the gain does.
    first, last = root[:-1], root[1:]
    forward = np.where(first, 2.0 * (end - start) - backward, forward)
    backward = np.where(last, 2.0 * (end - start) - forward, backward)
    directions = np.array([np.where(first, forward, rates[:-1]), np.where(last, backward, rates[1:])])
    outside = np.isnan(poles)
    if outside.any():
        # One that comes or goes within the interval goes straight on over ln K.
        comes, goes = outside[:-1] & ~last, outside[1:] & ~first
        on, straight = np.where(comes, rates[1:], rates[:-1]), comes | goes
        far = rise[:, None] * on
        start, end = np.where(comes, end - far, start), np.where(goes, start + far, end)
        forward, backward = np.where(straight, begins * on, forward), np.where(straight, ends * on, backward)
    cubic = np.array([start, end, forward, backward])
    chord = end - start
    length = np.abs(chord) / size
    turns = directions * chord.conj()
    turn = np.abs(np.arctan2(turns.imag, turns.real)).sum(axis=0)
    with np.errstate(invalid="ignore"):
        parts = np.maximum(
            np.where(length > LONGEST_STEP, np.maximum(length, np.abs(cubic[2:]).max(axis=0) / size), 0.0) / AIMED_STEP,
            np.where((length > TOO_SHORT) & (turn > LARGEST_TURN), turn, 0.0) / AIMED_TURN,
        )
    count = np.clip(np.ceil(parts.max(axis=1)), 1, MOST_PARTS).astype(np.intp)
    count[gains[:-1] == 0.0] = 1
    return low, high, power, back, cubic, count
