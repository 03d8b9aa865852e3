"""Zeros that cancel poles: modes that a transfer function does not show."""

from __future__ import annotations

import numpy as np

from looplab.engine.systems.polynomial import ComplexArray

# A zero and a pole closer than this fraction of their size are one number written twice.
CANCEL_TOLERANCE = 1e-9


def cancel(
    zeros: ComplexArray, poles: ComplexArray, tolerance: float = CANCEL_TOLERANCE
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Strike out pairs of a zero and a pole that are equal.

    Parameters
    ----------
    zeros, poles : ndarray of complex
        Closed under conjugation [rad/time].
    tolerance : float
        Largest distance of a pair, relative to its size [-].

    Returns
    -------
    zeros, poles, cancelled : ndarray of complex
        What is left of each, and the poles struck out.
    """
    left, kept, gone = list(zeros), [], []
    for p in poles:
        i = int(np.argmin(np.abs(np.array(left) - p))) if left else -1
        if left and abs(left[i] - p) <= tolerance * abs(p):
            gone.append(p)
            left.pop(i)
        else:
            kept.append(p)
    return tuple(np.array(r, dtype=complex) for r in (left, kept, gone))  # type: ignore[return-value]


def hidden_modes(zeros: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """The poles that equal a zero."""
    return cancel(zeros, poles)[2]
