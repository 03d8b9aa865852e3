"""Closed-loop poles at a gain where branches meet: a double root, of which Newton sees half the digits."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.locus.construction import Breakaway
from looplab.engine.systems.transfer_function import TransferFunction

ComplexArray = npt.NDArray[np.complex128]

# What a polished pole may leave of 1 + K L.
RESIDUAL = 1e-8


def at_meeting(L: TransferFunction, s: complex, poles: ComplexArray) -> npt.NDArray[np.bool_]:
    """Which poles at the gain of a meeting point s cannot be told from it, given what is left of 1 + K L at each."""
    curvature = abs(sum((s - p) ** -2 for p in L.poles.tolist()) - sum((s - z) ** -2 for z in L.zeros.tolist()))
    return np.asarray(np.abs(poles - s) ** 2 * curvature <= 20.0 * RESIDUAL)


def meet(L: TransferFunction, K: float, poles: ComplexArray, breaks: Iterable[Breakaway]) -> ComplexArray:
    """The poles at gain K with those of a meeting point put on it, two at least.

    Parameters
    ----------
    L : TransferFunction
        Open loop for K = 1.
    K : float
    poles : ndarray of complex
        Approximate closed-loop poles at this gain, in which the copies of a double one may be missing [rad/time].
    breaks : iterable of Breakaway

    Returns
    -------
    ndarray of complex
        Unchanged where no branches meet at this gain.
    """
    for b in breaks:
        if abs(K - b.K) > 1e-12 * b.K:
            continue
        here = at_meeting(L, b.s, poles)
        many = max(int(np.count_nonzero(here)), 2)
        poles = np.concatenate([poles[~here], np.full(many, b.s, dtype=complex)])
    return poles
