"""The Nyquist curve and its count: Z = N + P, exactly, from the crossings of the negative real axis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, exp, floor, log, pi

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.crossings import OFTEN, crossings, fastest_root
from looplab.engine.frequency.response import AXIS_GAP
from looplab.engine.frequency.sampled import UnitCurve, read_only
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

# Closer to -1 than this the curve passes through it.
ON_CURVE = 1e-9
# A loop with L(inf) this close to -1 is refused as having no solution.
ILL_POSED = 1e-12
# Beyond this, next to poles on the axis, the curve is not drawn.
LARGEST_DRAWN = 1e6
OUT_OF_PICTURE = 50.0
# Near the origin steps of this size are not seen.
SMALLEST_SEEN = 1e-3
# A step of the grid is cut into so many at most.
MOST_PARTS = 32
# The points of a curve are chosen anew for every fourth root of e that the gain moves by.
LEVELS = 4


@dataclass(frozen=True)
class NyquistCount:
    """Encirclements and poles.

    Attributes
    ----------
    N : int or None
        Clockwise encirclements of -1 by L along the Nyquist contour (indented to the right of poles on the axis);
        None when infinite or not defined.
    P : int
        Poles of L in the open right half-plane, cancelled ones included.
    Z : int or None
        Closed-loop poles in the open right half-plane, Z = N + P; None when N is.
    reason : str or None
        Why N is infinite, or that the curve passes through -1.
    through_minus_one : bool
        The curve passes through -1 (within 1e-9): a closed-loop pole lies on the imaginary axis.
    """

    N: int | None
    P: int
    Z: int | None
    reason: str | None = None
    through_minus_one: bool = False


def right_half_plane(roots: npt.NDArray[np.complex128]) -> int:
    """How many roots lie right of the imaginary axis (beyond 1e-9 of their size)."""
    return int(np.count_nonzero(roots.real > AXIS_GAP * np.abs(roots)))


def _start_turns(L: TransferFunction, phase: float) -> int:
    """Crossings of the ray (-inf, -1) from a small positive real s to where the curve first leaves the real axis.

    On the way lie the quarter circle around the origin and, where only even powers of s matter, a stretch along the
    axis. Weighted like the rest: 2 for a crossing that has a mirror image, 1 for the start itself; clockwise positive.
    """
    start = -pi if L.origin_gain < 0 else 0.0
    if not (L.origin_order > 0 or (L.origin_order == 0 and abs(L.origin_gain) > 1.0)):
        return 0
    turns = 0
    # On a positive real s the curve starts on the real axis, at phase 0 or -pi.
    if start == -pi:
        turns += 1 if phase < start else -1
    low, high = sorted((start, phase))
    # Odd multiples of pi strictly between.
    first, last = floor((low + 1e-12 + pi) / (2.0 * pi)) + 1, ceil((high - 1e-12 + pi) / (2.0 * pi)) - 1
    between = max(last - first + 1, 0)
    return turns + (2 * between if phase < start else -2 * between)


@lru_cache(maxsize=64)
def nyquist_count(L: TransferFunction) -> NyquistCount:
    r"""Count the closed-loop poles in the right half-plane by Nyquist's criterion, dead time exact.

    .. math:: Z = N + P

    N is the sum of signed crossings of the real axis left of -1: +1 where the phase falls through an odd multiple of
    pi, -1 where it rises, twice for each omega > 0 (the mirror image), with the indentation arcs at poles on the
    imaginary axis and the closing arc at infinity.

    Parameters
    ----------
    L : TransferFunction
        Proper open loop under unit negative feedback.

    Returns
    -------
    NyquistCount

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 10.2.
    """
    P = right_half_plane(L.poles)
    if L.theta == 0.0 and abs(L.high_frequency_gain + 1.0) < ILL_POSED:
        reason = "L tends to -1 at high frequencies: the loop has no solution there, and N is not defined"
        return NyquistCount(None, P, None, reason, True)
    if L.gain == 0.0 or (not L.order and not L.theta):
        return NyquistCount(0, P, P)
    found = crossings(L)
    end_gain = abs(L.high_frequency_gain)
    if L.theta > 0 and end_gain >= 1.0:
        return NyquistCount(
            None, P, None, f"|L| tends to {end_gain:.4g} >= 1 with dead time: the curve encircles -1 without end"
        )
    if found.overrun:
        return NyquistCount(None, P, None, f"the curve encircles -1 {OFTEN}: the loop is unstable")
    size, direction = found.phase_log_magnitude.tolist(), found.phase_direction.tolist()
    touching = any(abs(m) < ON_CURVE for m in size)
    touching |= any(abs(p % (2.0 * pi) - pi) < ON_CURVE for p in found.gain_phase.tolist())
    if L.origin_order == 0 and abs(L.origin_gain + 1.0) < ON_CURVE:
        touching = True
    N = int(-2 * sum(d for m, d in zip(size, direction, strict=True) if m > 0))
    if found.start_phase is not None:
        N += _start_turns(L, found.start_phase)
    if L.theta == 0 and L.relative_degree == 0 and L.gain < -1.0 and found.start_phase is not None:
        # The curve ends on the real axis left of -1; its mirror image takes over from there.
        last = float(found.grid.phase[-1])
        level = (2 * round((last - pi) / (2 * pi)) + 1) * pi
        if last != level:
            N += 1 if last > level else -1
    if touching:
        reason = "the curve passes through -1: a closed-loop pole lies on the imaginary axis and N is not defined"
        return NyquistCount(None, P, None, reason, True)
    return NyquistCount(N, P, N + P)


@dataclass(frozen=True)
class NyquistCurve:
    """L(j omega) for omega > 0 [rad/time]; the half for omega < 0 is its mirror image."""

    omega: FloatArray
    re: FloatArray
    im: FloatArray


def nyquist_curve(L: TransferFunction, step: float = 0.03) -> NyquistCurve:
    r"""The curve with its points as close as the eye needs, and no closer.

    .. math:: |\Delta L| \le 2 h \sqrt{|L|\,(1 + |L|)}

    A chord of that length leaves a circle of radius \|L\| around the origin by less than h^2/2 (1 + \|L\|).

    Parameters
    ----------
    L : TransferFunction
    step : float
        h [-]; where \|L\| > 50, out of the picture, ten times as much; by the twelfth turn of a dead time four times.

    Returns
    -------
    NyquistCurve
        Points where \|L\| > 1e6 (next to poles on the axis) are left out. A biproper L with dead time turns without
        end: its curve ends where it has become its last circle, at 30 times the fastest root.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 10.2.
    """
    grid = crossings(L).grid
    gain = abs(grid.gain)
    if not gain:
        return NyquistCurve(grid.omega, np.zeros(grid.omega.size), np.zeros(grid.omega.size))
    # Points that suit a gain a little above suit this one too, so that a moved gain mostly finds them chosen.
    omega, unit = _drawn(grid.curve, ceil(log(gain) * LEVELS), step, L.theta > 0 and L.relative_degree == 0)
    re, im = unit * gain
    return NyquistCurve(omega, re, im)


@lru_cache(maxsize=64)
def _drawn(curve: UnitCurve, level: int, step: float, turns_for_ever: bool) -> tuple[FloatArray, FloatArray]:
    """Points of the unit curve for gains up to exp(level/4): omega, shape (n,), and real and imaginary part, (2, n)."""
    gain, unit, omega = exp(level / LEVELS), curve.unit, curve.omega
    drawn = curve.size < LARGEST_DRAWN / gain
    if turns_for_ever:
        drawn &= omega <= max(30.0 * fastest_root(unit), 4.0 * pi / unit.theta)
    omega, value = omega[drawn], curve.value[drawn]
    if not omega.size:
        return omega, np.stack([value.real, value.imag])
    near, chord = _chords(value, curve.size[drawn], curve.phase[drawn], unit.theta)
    near *= gain
    length = chord * (gain / step)
    length /= np.sqrt((near + SMALLEST_SEEN) * (1.0 + near))
    length[near > OUT_OF_PICTURE] *= 0.1
    # Along the curve in units of the longest step, and points one such unit apart.
    along = np.zeros(omega.size)
    np.minimum(length, MOST_PARTS, out=length).cumsum(out=along[1:])
    count = max(ceil(along[-1]), 1)
    x = np.interp(np.arange(1, count) * (along[-1] / count), along, np.log(omega))
    omega = np.concatenate([omega[:1], np.exp(x), omega[-1:]])
    value = unit.response(omega)
    if not drawn.all():
        # Some may lie in the gap at a pole on the axis.
        inside = np.abs(value) < LARGEST_DRAWN / gain
        omega, value = omega[inside], value[inside]
    return read_only(omega), np.array([value.real, value.imag])


def _chords(value: ComplexArray, size: FloatArray, phase: FloatArray, theta: float) -> tuple[FloatArray, FloatArray]:
    """Of each step along a curve the smaller |L| of its ends and its length, less where the dead time has turned."""
    chord = np.abs(value[1:] - value[:-1])
    if theta:
        chord /= np.minimum(1.0 + np.abs(phase[1:] - phase[0]) / (8.0 * np.pi), 4.0)
    return np.minimum(size[1:], size[:-1]), chord
