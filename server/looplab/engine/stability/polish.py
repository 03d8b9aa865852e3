"""Newton steps that bring approximate closed-loop poles onto the exact characteristic equation."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.systems.transfer_function import TransferFunction

ComplexArray = npt.NDArray[np.complex128]


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
        Newton steps.

    Returns
    -------
    roots : ndarray, shape of guess
    good : ndarray of bool
        True where the residual \|1 + K L\| ended below 1e-8 (or what rounding of s allows) near the guess.
    """
    s = guess.astype(complex)
    K = np.asarray(gain, dtype=float)
    with np.errstate(all="ignore"):
        for _ in range(steps):
            step = np.log(-K * L(s)) / L.log_derivative(s)
            s = s - np.where(np.isfinite(step), step, 0.0)
        value = K * L(s)
        # Next to an open-loop pole L cannot be known better than the rounding of s allows.
        knowable = 8.0 * np.finfo(float).eps * np.abs(s) * np.abs(L.log_derivative(s))
        good = np.isfinite(value) & (np.abs(1.0 + value) < np.maximum(1e-8, np.minimum(knowable, 0.1)))
        good &= np.abs(s - guess) <= 0.3 * np.abs(guess) + 1e-6
    return s, good
