"""Halley's and Newton's steps that bring approximate closed-loop poles onto the exact characteristic equation."""

from __future__ import annotations

import cmath
from math import isfinite

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.scalar import scalar_loop
from looplab.engine.systems.transfer_function import SMALL_ORDER, TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

# What one more step would leave of ln(-K L) is rounding.
NEGLIGIBLE = 1e-15
# If fewer than one in so many still move, those alone go on.
FEW = 4
# After a step this small, relative to the root, the next one would be rounding.
FINAL = 1e-12
EPSILON = float(np.finfo(float).eps)


def _log_and_rates(
    L: TransferFunction, s: ComplexArray, factor: FloatArray
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """ln(factor prod(s - z)/prod(s - p) exp(-theta s)), imaginary part within half a turn, and two derivatives."""
    zeros, poles = L.zeros.size, L.order
    away = s - np.concatenate([L.zeros, L.poles])[:, None]
    to_zeros, to_poles = away[:zeros], away[zeros:]
    log = np.log(factor * (to_zeros[:SMALL_ORDER].prod(axis=0) / to_poles[:SMALL_ORDER].prod(axis=0)))
    # Products of more factors might leave double precision.
    for first in range(SMALL_ORDER, max(zeros, poles), SMALL_ORDER):
        some = slice(first, first + SMALL_ORDER)
        log += np.log(to_zeros[some].prod(axis=0) / to_poles[some].prod(axis=0))
    if L.theta:
        log -= L.theta * s
    if L.theta or max(zeros, poles) > SMALL_ORDER:
        log.imag -= 2.0 * np.pi * np.round(log.imag / (2.0 * np.pi))
    sense = np.ones(zeros + poles, dtype=complex)
    sense[zeros:] = -1.0
    np.reciprocal(away, out=away)
    slope = np.dot(sense, away)
    if L.theta:
        slope -= L.theta
    np.square(away, out=away)
    return log, slope, -np.dot(sense, away)


def polish_closed_loop_poles(
    L: TransferFunction, guess: ComplexArray, gain: npt.ArrayLike = 1.0, steps: int = 4
) -> tuple[ComplexArray, npt.NDArray[np.bool_]]:
    r"""Halley's method on :math:`\ln(-K L(s)) = 0` with the factored L, dead time exact.

    Parameters
    ----------
    L : TransferFunction
    guess : ndarray of complex
        Approximate roots of 1 + K L(s) = 0, any shape [rad/time].
    gain : array_like
        K, broadcast against guess.
    steps : int
        At most.

    Returns
    -------
    roots : ndarray, shape of guess
        Not a number where the steps lead nowhere.
    good : ndarray of bool
        True where the residual \|1 + K L\| ended below 1e-8 (or what rounding of s allows) near the guess.
    """
    return polish_with_slope(L, guess, gain, steps)[:2]


def polish_with_slope(
    L: TransferFunction, guess: ComplexArray, gain: npt.ArrayLike = 1.0, steps: int = 4
) -> tuple[ComplexArray, npt.NDArray[np.bool_], ComplexArray]:
    """The same, and L'/L before the last step, which is too short to matter where the root is good.

    References
    ----------
    .. [1] J. F. Traub, Iterative Methods for the Solution of Equations, Prentice-Hall 1964, sec. 5.2 (Halley).
    """
    start = guess.ravel()
    s, factor = start.astype(complex), np.full(guess.shape, -L.gain * np.asarray(gain, dtype=float)).ravel()
    near = 0.3 * np.abs(start) + 1e-6
    with np.errstate(all="ignore"):
        for left in range(steps, -1, -1):
            miss, slope, bend = _log_and_rates(L, s, factor)
            size = np.abs(miss)
            if not left:
                # Next to an open-loop pole L cannot be known better than the rounding of s allows.
                knowable = 8.0 * EPSILON * np.abs(s * slope)
                good = size < np.maximum(1e-8, np.minimum(knowable, 0.1))
                break
            step = miss / slope
            curved = 0.5 * step * bend / slope
            step /= 1.0 - curved
            s = s - step
            # A step leaves about the cube of the miss, more where poles meet; steps of a few roundings lead nowhere.
            good = size * np.square(size + np.abs(curved)) <= NEGLIGIBLE
            if np.count_nonzero(good) == good.size:
                break
            good |= (np.abs(step) <= 4.0 * EPSILON * np.abs(s)) & (size < 0.1)
            # A root that has left the neighbourhood of its guess is none of ours.
            moving = ~good & (np.abs(s - start) <= near)
            many = np.count_nonzero(moving)
            if not many:
                break
            if FEW * many < s.size:
                rest = factor[moving] / -L.gain
                s[moving], good[moving], slope[moving] = polish_with_slope(L, s[moving], rest, left - 1)
                break
        good &= np.abs(s - start) <= near
    return s.reshape(guess.shape), good.reshape(guess.shape), slope.reshape(guess.shape)


def polish_few(L: TransferFunction, guess: ComplexArray, steps: int = 2) -> ComplexArray:
    """The same for a handful of poles, on plain numbers; a pole whose Newton steps lead nowhere stays as guessed.

    Parameters
    ----------
    L : TransferFunction
    guess : ndarray of complex, shape (n,)
        Closed under conjugation [rad/time].
    steps : int

    Returns
    -------
    ndarray of complex, shape (n,)
    """
    loop, gain = scalar_loop(L.unit), abs(L.gain)
    done: dict[complex, complex] = {}
    for start in guess.tolist():
        if start.conjugate() in done:
            done[start] = done[start.conjugate()].conjugate()
            continue
        s, miss, rate = start, 1.0 + 0j, 0j
        for left in range(steps, -1, -1):
            value, rate = loop.value_and_rate(s, gain)
            if not (isfinite(abs(value)) and value and rate):
                break
            miss = cmath.log(-value)
            if left:
                # Rounding must not lead a real pole off the axis: it has no conjugate.
                step = miss / rate if start.imag else complex((miss / rate).real)
                s -= step
                if abs(step) <= FINAL * abs(s):
                    break
        # Next to an open-loop pole L cannot be known better than the rounding of s allows.
        knowable = 8.0 * EPSILON * abs(s * rate)
        good = abs(miss) < max(1e-8, min(knowable, 0.1)) and abs(s - start) <= 0.3 * abs(start) + 1e-6
        done[start] = s if good else start
    return np.array([done[start] for start in guess.tolist()], dtype=complex)
