"""What an input does over time: a level, and signals that are added to it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.response.inputs import MAX_SAMPLES, InputSignal, held_samples, joined_samples
from looplab.engine.systems.polynomial import FloatArray

MAX_PARTS = 8
# Two breakpoints closer than this part of the time are one.
SAME_TIME = 1e-12


@dataclass(frozen=True)
class InputCourse:
    """u(t) = level + the sum of the parts.

    Attributes
    ----------
    level : float
        [input]
    parts : tuple of InputSignal
        Steps, pulses, ramps, sines, samples, noise: zero before they begin; no impulses.
    """

    level: float
    parts: tuple[InputSignal, ...] = ()

    def __post_init__(self) -> None:
        if len(self.parts) > MAX_PARTS:
            raise InvalidInput(f"an input is the sum of at most {MAX_PARTS} signals", field="add")
        if any(part.areas.any() for part in self.parts):
            raise InvalidInput(
                "an impulse has no meaning for a nonlinear model", field="add", hint="take a short pulse of that area"
            )

    def plus(self, *parts: InputSignal) -> InputCourse:
        """The same course with more signals added."""
        return InputCourse(self.level, (*self.parts, *parts))

    def breakpoints(self) -> FloatArray:
        """Times at which u or its slope jumps, sorted."""
        return np.unique(np.concatenate([np.zeros(0), *(part.times for part in self.parts)]))

    def values(self, t: npt.ArrayLike) -> FloatArray:
        """u at times t, same shape; the new value at a jump."""
        t = np.asarray(t, dtype=float)
        return self.level + sum((part.value(t) for part in self.parts), np.zeros(t.shape))

    def piece(self, start: float) -> float | Callable[[float], float]:
        """u from ``start`` to the next breakpoint: a number where it is constant, else a function of t."""
        at, slope, sines = self.level, 0.0, []
        for part in self.parts:
            index = int(np.searchsorted(part.times, start + SAME_TIME * abs(start), side="right")) - 1
            if index < 0:
                continue
            since = float(part.times[index])
            a, b = part.starts[index].tolist()
            if part.omega:
                sines.append((a, b, part.omega, since))
            else:
                at += a + b * (start - since)
                slope += b
        if not slope and not sines:
            return at

        def course(t: float) -> float:
            u = at + slope * (t - start)
            for a, b, omega, since in sines:
                angle = omega * (t - since)
                u += a * math.cos(angle) + b * math.sin(angle)
            return u

        return course


def table(times: Sequence[float], values: Sequence[float], hold: str = "zero") -> InputCourse:
    """u(t) as samples, held ("zero") or joined by lines ("linear"); the first also before, the last also after.

    Raises
    ------
    InvalidInput
    """
    if hold not in ("zero", "linear"):
        raise InvalidInput("hold must be zero or linear", field="hold")
    make = held_samples if hold == "zero" else joined_samples
    # Checked as they are, then shifted: the samples are what is added to the first of them.
    make(times, values)
    level = float(values[0])
    return InputCourse(level, (make(times, [value - level for value in values]),))


def noise(std: float, interval: float, horizon: float, seed: int = 0, start: float = 0.0) -> InputSignal:
    r"""Normal noise, held for ``interval`` each time; the same for the same seed.

    Its spectrum is flat to about half of 1/interval: the power has halved at omega = 2.78/interval [rad/time].

    Parameters
    ----------
    std : float
        Standard deviation [input].
    interval : float
        Time from sample to sample [time].
    horizon : float
        Until when [time].
    seed : int
    start : float
        [time]

    Returns
    -------
    InputSignal

    Raises
    ------
    InvalidInput
        The interval is too short for the horizon, or a number is out of range.
    """
    if not (math.isfinite(std) and std >= 0):
        raise InvalidInput("std must be zero or positive", field="std")
    if not (math.isfinite(interval) and interval > 0):
        raise InvalidInput("interval must be positive", field="interval")
    count = max(1, math.ceil((horizon - start) / interval)) if horizon - start < MAX_SAMPLES * interval else 0
    if not count:
        raise InvalidInput(
            f"the noise would take more than {MAX_SAMPLES} samples",
            field="interval",
            hint=f"an interval of {(horizon - start) / MAX_SAMPLES:.3g} or longer",
        )
    values = std * np.random.default_rng(seed).standard_normal(count)
    return held_samples(start + interval * np.arange(count), values)
