"""The Nyquist curve and its count: Z = N + P, exactly, from the crossings of the negative real axis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.crossings import OFTEN, crossings
from looplab.engine.frequency.response import AXIS_GAP, phase_rad
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]


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


def _start_turns(L: TransferFunction, omega_low: float) -> int:
    """Crossings of the ray (-inf, -1) from the indentation at the origin (or omega = 0) up to the first grid point.

    Weighted like the rest: 2 for a crossing that has a mirror image, 1 for one at omega = 0 itself; clockwise positive.
    """
    phase_low = float(phase_rad(L, np.array([omega_low]))[0])
    start = -np.pi if L.origin_gain < 0 else 0.0
    big = L.origin_order > 0 or (L.origin_order == 0 and abs(L.origin_gain) > 1.0)
    if not big:
        return 0
    turns = 0
    # On a positive real s the curve starts on the real axis, at phase 0 or -pi.
    if start == -np.pi and abs(phase_low - start) < 1e-12:
        # It runs along the ray (only even powers of s) until a pole on the axis turns it off, clockwise: that crossing,
        # counted twice later, is its own mirror image.
        return -1
    if start == -np.pi:
        turns += 1 if phase_low < start else -1
    low, high = sorted((start, phase_low))
    levels = np.arange(np.floor((low + np.pi) / (2 * np.pi)) + 1, np.floor((high + np.pi) / (2 * np.pi)) + 1)
    levels = levels * 2 * np.pi - np.pi
    between = int(np.count_nonzero((levels > low + 1e-12) & (levels < high - 1e-12)))
    return turns + (2 * between if phase_low < start else -2 * between)


@lru_cache(maxsize=256)
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
    touching = bool(np.any(np.abs(found.phase_log_magnitude) < 1e-9))
    touching |= bool(np.any(np.abs(np.mod(found.gain_phase, 2 * np.pi) - np.pi) < 1e-9))
    if L.origin_order == 0 and abs(L.origin_gain + 1.0) < 1e-9:
        touching = True
    outside = found.phase_log_magnitude > 0
    N = int(-2 * found.phase_direction[outside].sum()) + _start_turns(L, found.omega[0])
    if L.theta == 0 and L.relative_degree == 0 and L.gain < -1.0:
        # The curve ends on the real axis left of -1; its mirror image takes over from there.
        last = float(phase_rad(L, found.omega[-1:])[0])
        level = (2 * np.round((last - np.pi) / (2 * np.pi)) + 1) * np.pi
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


def nyquist_curve(L: TransferFunction, max_turn: float = 0.06) -> NyquistCurve:
    """The curve with a point wherever it turns: neighbours differ by at most ``max_turn`` where it is near -1.

    Parameters
    ----------
    L : TransferFunction
    max_turn : float
        Largest step, relative to 1 + \\|L\\| [-].

    Returns
    -------
    NyquistCurve
        Points where \\|L\\| > 1e6 (next to poles on the axis) are left out.
    """
    omega = crossings(L).omega
    for _ in range(4):
        value = L.response(omega)
        step = np.abs(np.diff(value)) / (1.0 + np.minimum(np.abs(value[1:]), np.abs(value[:-1])))
        # Next to a pole on the axis the steps cannot shrink: there the curve is out of the picture.
        coarse = (step > max_turn) & (np.minimum(np.abs(value[1:]), np.abs(value[:-1])) < 50.0)
        if not coarse.any() or omega.size > 6000:
            break
        middle = np.sqrt(omega[:-1][coarse] * omega[1:][coarse])
        omega = np.unique(np.concatenate([omega, middle]))
    value = L.response(omega)
    keep = np.isfinite(value) & (np.abs(value) < 1e6)
    return NyquistCurve(omega[keep], value.real[keep], value.imag[keep])
