"""Modes that feedback cannot move: poles that cancel against zeros of the same open loop."""

from __future__ import annotations

import numpy as np

from looplab.engine.systems.polynomial import ComplexArray
from looplab.engine.systems.transfer_function import TransferFunction


def split_hidden_modes(L: TransferFunction) -> tuple[TransferFunction, ComplexArray]:
    """An open loop less its exactly cancelling pairs, and the poles of those pairs.

    Parameters
    ----------
    L : TransferFunction

    Returns
    -------
    reduced : TransferFunction
        L itself where nothing cancels.
    hidden : ndarray of complex, shape (k,)
        Poles that stay where they are for every gain [rad/time].
    """
    zeros, poles = L.zeros.tolist(), L.poles.tolist()
    hidden = []
    for z in L.zeros.tolist():
        if z in poles:
            zeros.remove(z)
            poles.remove(z)
            hidden.append(z)
    if not hidden:
        return L, np.zeros(0, dtype=complex)
    return TransferFunction(zeros, poles, L.gain, L.theta), np.array(hidden, dtype=complex)
