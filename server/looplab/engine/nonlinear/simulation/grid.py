"""Times at which a simulation stops, of which those that are the same to rounding are one."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.inputs import SAME_TIME, InputCourse
from looplab.engine.systems.polynomial import FloatArray

MAX_POINTS = 5_000
# Events are looked for at least this often, however few points are asked for.
LOOKS = 200
MAX_BREAKPOINTS = 4_000


def check_times(times: npt.ArrayLike) -> FloatArray:
    """Times as an array; raises InvalidInput where they are not strictly increasing numbers."""
    t = np.array(times, dtype=float)
    if t.ndim != 1 or not 2 <= t.size <= MAX_POINTS:
        raise InvalidInput(f"times must be a list of 2 to {MAX_POINTS} numbers", field="times")
    if not np.isfinite(t).all() or np.abs(t).max() > 1e9 or not (np.diff(t) > SAME_TIME * np.abs(t).max()).all():
        raise InvalidInput("times must be strictly increasing numbers up to 1e9", field="times")
    return t


def looks(times: FloatArray) -> FloatArray:
    """Times at which events are looked for."""
    return np.linspace(times[0], times[-1], LOOKS + 1) if times.size < LOOKS else times


def merged(stops: FloatArray, times: FloatArray) -> FloatArray:
    """Sorted; of those that are the same to rounding one is kept, the time that was asked for where there is one."""
    keep = np.unique(snapped(np.unique(stops), times))
    apart = np.diff(keep, prepend=-np.inf) > SAME_TIME * np.abs(keep)
    return keep[apart | np.isin(keep, times)]


def snapped(values: FloatArray, grid: FloatArray) -> FloatArray:
    """Each value, or the grid's own where they are the same to rounding."""
    if not grid.size:
        return values
    right = np.clip(np.searchsorted(grid, values), 1, grid.size - 1)
    nearest = np.where(values - grid[right - 1] < grid[right] - values, grid[right - 1], grid[right])
    return np.where(np.abs(nearest - values) <= SAME_TIME * np.abs(values), nearest, values)


def breakpoints(courses: Iterable[InputCourse], start: float, end: float) -> FloatArray:
    """Times between start and end at which an input or its slope jumps; raises InvalidInput where they are too many."""
    every = np.unique(np.concatenate([np.zeros(0), *(course.breakpoints() for course in courses)]))
    inside = every[(every > start) & (every < end)]
    if inside.size > MAX_BREAKPOINTS:
        raise InvalidInput(
            f"the inputs jump more than {MAX_BREAKPOINTS} times", field="inputs", hint="a shorter horizon has fewer"
        )
    return inside
