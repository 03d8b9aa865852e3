"""Newton steps that bring approximate closed-loop poles onto the exact characteristic equation."""

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
# The miss that a guess is taken to come from: a first miss below 3e-9 is then the last.
AS_IF_BEFORE = 5e-6
# After a step this small, relative to the root, the next one would be rounding.
FINAL = 1e-12
EPSILON = float(np.finfo(float).eps)


def _log_and_slope(L: TransferFunction, s: ComplexArray, factor: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    """ln(factor prod(s - z)/prod(s - p) exp(-theta s)), imaginary part within half a turn, and its derivative."""
    # Roots on the first axis: sums and products along a short last one are slow.
    away = s - np.concatenate([L.zeros, L.poles]).reshape(-1, *(1,) * s.ndim)
    to_zeros, to_poles = away[: L.zeros.size], away[L.zeros.size :]
    log = np.log(factor * (to_zeros[:SMALL_ORDER].prod(axis=0) / to_poles[:SMALL_ORDER].prod(axis=0)))
    # Products of more factors might leave double precision.
    for first in range(SMALL_ORDER, max(L.zeros.size, L.order), SMALL_ORDER):
        some = slice(first, first + SMALL_ORDER)
        log += np.log(to_zeros[some].prod(axis=0) / to_poles[some].prod(axis=0))
    if L.theta:
        log -= L.theta * s
    if L.theta or max(L.zeros.size, L.order) > SMALL_ORDER:
        log.imag -= 2.0 * np.pi * np.round(log.imag / (2.0 * np.pi))
    np.reciprocal(away, out=away)
    slope = to_zeros.sum(axis=0) - to_poles.sum(axis=0)
    if L.theta:
        slope -= L.theta
    return log, slope


def polish_closed_loop_poles(
    L: TransferFunction, guess: ComplexArray, gain: npt.ArrayLike = 1.0, steps: int = 4
) -> tuple[ComplexArray, npt.NDArray[np.bool_]]:
    r"""Newton on :math:`\ln(-K L(s)) = 0` with the factored L, dead time exact.

    Parameters
    ----------
    L : TransferFunction
    guess : ndarray of complex
        Approximate roots of 1 + K L(s) = 0, any shape [rad/time].
    gain : array_like
        K, broadcast against guess.
    steps : int
        Newton steps at most.

    Returns
    -------
    roots : ndarray, shape of guess
        Not a number where Newton's steps lose themselves.
    good : ndarray of bool
        True where the residual \|1 + K L\| ended below 1e-8 (or what rounding of s allows) near the guess.
    """
    return polish_with_slope(L, guess, gain, steps)[:2]


def polish_with_slope(
    L: TransferFunction, guess: ComplexArray, gain: npt.ArrayLike = 1.0, steps: int = 4
) -> tuple[ComplexArray, npt.NDArray[np.bool_], ComplexArray]:
    """The same, and L'/L before the last step, which is too short to matter where the root is good."""
    s, near = guess.astype(complex), 0.3 * np.abs(guess) + 1e-6
    size: npt.ArrayLike = AS_IF_BEFORE
    with np.errstate(all="ignore"):
        factor = -L.gain * np.asarray(gain, dtype=float)
        for left in range(steps, -1, -1):
            miss, slope = _log_and_slope(L, s, factor)
            last, size = size, np.abs(miss)
            if not left:
                # Next to an open-loop pole L cannot be known better than the rounding of s allows.
                knowable = 8.0 * EPSILON * np.abs(s * slope)
                good = size < np.maximum(1e-8, np.minimum(knowable, 0.1))
                break
            step = miss / slope
            s = s - step
            # Newton's misses shrink as their squares; steps of a few roundings of s lead nowhere.
            good = (size**3 <= NEGLIGIBLE * np.square(last)) | (size <= FINAL) | (np.abs(step) <= 4.0 * EPSILON * np.abs(s))
            # A root that has left the neighbourhood of its guess is none of ours.
            if good.all() or not (~good & (np.abs(s - guess) <= near)).any():
                good &= size < 0.1
                break
        good &= np.abs(s - guess) <= near
    return s, good, slope


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
