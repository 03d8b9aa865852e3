"""Newton steps that bring approximate closed-loop poles onto the exact characteristic equation."""

from __future__ import annotations

import cmath
from math import isfinite

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.scalar import scalar_loop
from looplab.engine.systems.transfer_function import SMALL_ORDER, TransferFunction

ComplexArray = npt.NDArray[np.complex128]

# What one more step would leave of ln(-K L) is rounding.
NEGLIGIBLE = 1e-15
# After a step this small, relative to the root, the next one would be rounding.
FINAL = 1e-12
EPSILON = float(np.finfo(float).eps)


def _log_of_factors(away: ComplexArray, zeros: int) -> ComplexArray:
    """ln of prod(s - z)/prod(s - p) up to turns; one logarithm where the products stay in double precision."""
    if away.shape[0] <= SMALL_ORDER:
        return np.log(away[:zeros].prod(axis=0) / away[zeros:].prod(axis=0))
    logs = np.log(away)
    return np.asarray(logs[:zeros].sum(axis=0) - logs[zeros:].sum(axis=0))


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
    good : ndarray of bool
        True where the residual \|1 + K L\| ended below 1e-8 (or what rounding of s allows) near the guess.
    """
    s = guess.astype(complex)
    # Roots on the first axis: sums and products along a short last one are slow.
    roots = np.concatenate([L.zeros, L.poles]).reshape(-1, *(1,) * s.ndim)
    many, near = L.zeros.size, 0.3 * np.abs(guess) + 1e-6
    settled, size = False, np.zeros(())
    with np.errstate(all="ignore"):
        offset = np.log(np.asarray(gain, dtype=float) * L.gain + 0j) - 1j * np.pi
        for left in range(steps, -1, -1):
            away = s - roots
            miss = _log_of_factors(away, many) + (offset - L.theta * s)
            miss.imag -= 2.0 * np.pi * np.round(miss.imag / (2.0 * np.pi))
            np.reciprocal(away, out=away)
            slope = away[:many].sum(axis=0) - away[many:].sum(axis=0) - L.theta
            if not left or settled:
                break
            step = miss / slope
            step[~np.isfinite(step)] = 0.0
            s = s - step
            # Newton's misses shrink as their squares; steps of a few roundings of s lead nowhere, and a root that has
            # left the neighbourhood of its guess is none of ours.
            last, size = size, np.abs(miss)
            moving = (size**3 > NEGLIGIBLE * last**2) & (np.abs(step) > 4.0 * EPSILON * np.abs(s))
            settled = not (moving & (np.abs(s - guess) <= near)).any()
        # Next to an open-loop pole L cannot be known better than the rounding of s allows.
        knowable = 8.0 * EPSILON * np.abs(s * slope)
        good = np.abs(miss) < np.maximum(1e-8, np.minimum(knowable, 0.1))
        good &= np.abs(s - guess) <= near
    return s, good


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
