"""A system sampled over frequency, cached up to its gain: moving a gain only shifts the curves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.frequency.response import frequency_grid, log_magnitude, phase_rad
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]


MOST_EXTREMA = 200


@dataclass(frozen=True)
class Sampled:
    """ln|G| and phase [rad] over omega [rad/time], shape (n,), for the gain of the system they were asked of."""

    omega: FloatArray
    log_magnitude: FloatArray
    phase: FloatArray


@lru_cache(maxsize=128)
def _grid(unit: TransferFunction, low: float, high: float) -> FloatArray:
    """The adaptive grid with every extremum of magnitude and phase on it, so that no pair of crossings hides."""
    omega = frequency_grid(unit, low, high)

    def magnitude_slope(x: FloatArray) -> FloatArray:
        w = np.exp(x)
        return -unit.log_derivative((1j * w).astype(complex)).imag * w

    def phase_slope(x: FloatArray) -> FloatArray:
        w = np.exp(x)
        return unit.log_derivative((1j * w).astype(complex)).real * w

    x = np.log(omega)
    turning = []
    with np.errstate(all="ignore"):
        for slope in (magnitude_slope, phase_slope):
            rate = slope(x)
            at = np.flatnonzero(np.sign(rate[1:]) * np.sign(rate[:-1]) < 0)
            if at.size <= MOST_EXTREMA:
                turning.append(np.exp(refine_brackets(slope, x[at], x[at + 1])))
    return np.unique(np.concatenate([omega, *turning]))


@lru_cache(maxsize=256)
def _shape(unit: TransferFunction, grid_of: TransferFunction, low: float, high: float) -> tuple[FloatArray, FloatArray]:
    omega = _grid(grid_of, low, high)
    return log_magnitude(unit, omega), phase_rad(unit, omega)


def sampled(system: TransferFunction, low: float, high: float, grid_of: TransferFunction | None = None) -> Sampled:
    """A system between two frequencies [rad/time], on its own adaptive grid or on that of another system."""
    grid_of = (grid_of or system).unit
    magnitude, phase = _shape(system.unit, grid_of, low, high)
    if system.gain == 0.0:
        return Sampled(_grid(grid_of, low, high), np.full(magnitude.shape, -np.inf), phase)
    shift = np.log(abs(system.gain))
    return Sampled(_grid(grid_of, low, high), magnitude + shift, phase)
