"""Where a magnitude passes a level, and where it is largest."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.bracketing import refine_brackets

FloatArray = npt.NDArray[np.float64]
LogSize = Callable[[FloatArray], FloatArray]

# Decades searched beyond each end of a grid.
BEYOND = 3
CLOSER = 64


def widened(grid: FloatArray) -> FloatArray:
    """A grid with three decades more on either side."""
    low = np.geomspace(grid[0] * 10.0**-BEYOND, grid[0], 40 * BEYOND)[:-1]
    high = np.geomspace(grid[-1], grid[-1] * 10.0**BEYOND, 40 * BEYOND)[1:]
    return np.concatenate([low, grid, high])


def last_fall(log_size: LogSize, omega: FloatArray, level: float) -> float | None:
    """The highest frequency at which a magnitude falls through exp(level); None where it does not."""
    above = log_size(omega) > level
    at = np.flatnonzero(above[:-1] & ~above[1:])[-1:]
    if not at.size:
        return None
    x = refine_brackets(lambda x: log_size(np.exp(x)) - level, np.log(omega[at]), np.log(omega[at + 1]))
    return float(np.exp(x[0]))


def first_rise(log_size: LogSize, omega: FloatArray, level: float) -> float | None:
    """The lowest frequency at which a magnitude rises through exp(level); None where it does not."""
    above = log_size(omega) > level
    at = np.flatnonzero(~above[:-1] & above[1:])[:1]
    if not at.size:
        return None
    x = refine_brackets(lambda x: log_size(np.exp(x)) - level, np.log(omega[at]), np.log(omega[at + 1]))
    return float(np.exp(x[0]))


def highest(log_size: LogSize, omega: FloatArray) -> tuple[float, float]:
    """Largest magnitude and where, the neighbourhood of the best point of a grid searched twice more closely."""
    for _ in range(3):
        values = log_size(omega)
        values[np.isnan(values)] = -np.inf
        best = int(values.argmax())
        value, where = float(values[best]), float(omega[best])
        omega = np.geomspace(omega[max(best - 1, 0)], omega[min(best + 1, omega.size - 1)], CLOSER)
    return float(np.exp(value)), where
