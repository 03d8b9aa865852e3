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
        curvature = abs((1.0 / (b.s - L.poles) ** 2).sum() - (1.0 / (b.s - L.zeros) ** 2).sum())
        here = np.abs(poles - b.s) ** 2 * curvature <= 20.0 * RESIDUAL
        many = max(int(np.count_nonzero(here)), 2)
        poles = np.concatenate([poles[~here], np.full(many, b.s, dtype=complex)])
    return poles
