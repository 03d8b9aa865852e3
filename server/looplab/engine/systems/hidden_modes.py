"""Modes that feedback cannot move: poles that cancel against zeros of the same open loop."""

from __future__ import annotations

from functools import lru_cache

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
    reduced, hidden = _split(L.unit)
    return L if reduced is None else reduced.with_gain(L.gain), hidden


@lru_cache(maxsize=64)
def _split(unit: TransferFunction) -> tuple[TransferFunction | None, ComplexArray]:
    """The same for a gain of 1 or -1; None where nothing cancels."""
    zeros, poles = unit.zeros.tolist(), unit.poles.tolist()
    found = []
    for z in unit.zeros.tolist():
        if z in poles:
            zeros.remove(z)
            poles.remove(z)
            found.append(z)
    hidden = np.array(found, dtype=complex)
    hidden.setflags(write=False)
    return TransferFunction(zeros, poles, unit.gain, unit.theta) if found else None, hidden
