"""Sums of sines, sampled: what is seen of them, and the slower sines that give the same samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.frequency.spectrum import alias

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Sine:
    """amplitude sin(2 pi frequency t + phase) [signal], [cycles/time], [rad]."""

    amplitude: float
    frequency: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        if not (np.isfinite(self.frequency) and 0.0 <= self.frequency <= 1e9):
            raise InvalidInput("the frequency must be from 0 to 1e9", field="frequency")

    def __call__(self, t: FloatArray) -> FloatArray:
        """Its values at t, shape of t."""
        return self.amplitude * np.sin(2.0 * np.pi * self.frequency * t + self.phase)

    def aliased(self, rate: float) -> Sine:
        r"""The slowest sine with the same samples.

        .. math:: f_a = |f - k f_s|, \quad \sin(2\pi (f - k f_s) t + \varphi) = \sin(2\pi f t + \varphi)
            \;\text{ at }\; t = n/f_s

        Parameters
        ----------
        rate : float
            f_s [samples/time].

        Returns
        -------
        Sine

        References
        ----------
        .. [1] K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 3rd ed., Prentice Hall 1997, sec. 7.4.
        """
        seen, k = alias(self.frequency, rate)
        if self.frequency - k * rate >= 0:
            return Sine(self.amplitude, seen, self.phase)
        # sin(-x + phase) = sin(x + pi - phase)
        return Sine(self.amplitude, seen, np.pi - self.phase)


def sum_of_sines(sines: Sequence[Sine], t: FloatArray, offset: float = 0.0) -> FloatArray:
    """Values of offset plus all sines at t, shape of t."""
    out = np.full(t.shape, float(offset))
    for sine in sines:
        out += sine(t)
    return out
