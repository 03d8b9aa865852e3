"""An open-loop step test as it is done on a plant: a valve with limits, noise and drift on the measurement."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.response import simulate
from looplab.engine.response.inputs import step
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class StepTest:
    """How the test is done.

    Attributes
    ----------
    size : float
        Wanted change of the input [input].
    start : float
        When it is made [time].
    horizon : float
        [time]
    points : int
    std : float
        Standard deviation of the measurement noise, independent from sample to sample [output].
    seed : int
    drift : float
        Slope that is added to the measurement [output/time].
    u_min, u_max : float or None
        Limits of the input [input].
    """

    size: float
    start: float
    horizon: float
    points: int = 200
    std: float = 0.0
    seed: int = 0
    drift: float = 0.0
    u_min: float | None = None
    u_max: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.size) and self.size):
            raise InvalidInput("the step must be a number other than zero", field="size")
        if not 0 <= self.start < self.horizon:
            raise InvalidInput("the step must be made within the horizon", field="start")
        if self.u_min is not None and self.u_max is not None and not self.u_min < self.u_max:
            raise InvalidInput("u_min must be below u_max", field="u_min")

    def applied(self, u0: float) -> float:
        """The change of the input that its limits leave [input].

        Raises
        ------
        InvalidInput
            The input already is at that limit, or beyond.
        """
        low = -math.inf if self.u_min is None else self.u_min
        high = math.inf if self.u_max is None else self.u_max
        if not low <= u0 <= high:
            raise InvalidInput("the input begins outside its limits", field="u_min")
        wanted = u0 + self.size
        # What no limit cuts short is the size itself, without the rounding of a sum and a difference.
        change = self.size if low <= wanted <= high else min(max(wanted, low), high) - u0
        if not change:
            raise InvalidInput("the input is at its limit: it cannot step that way", field="size")
        return change

    def times(self) -> FloatArray:
        """Times of the samples, shape (points,)."""
        return np.linspace(0.0, self.horizon, self.points)

    def inputs(self, t: FloatArray, u0: float) -> FloatArray:
        """The input at the samples; the new value from the first sample at or after the step."""
        return np.where(t >= self.made_at(), u0 + self.applied(u0), u0)

    def made_at(self) -> float:
        """The step is made at a sample, so that the record tells when."""
        t = self.times()
        return float(t[int(np.searchsorted(t, self.start * (1.0 - 1e-12)))])

    def measured(self, t: FloatArray, y: FloatArray) -> FloatArray:
        """The output as it is recorded, with noise and drift."""
        noise = self.std * np.random.default_rng(self.seed).standard_normal(t.size)
        return y + self.drift * t + noise


@dataclass(frozen=True)
class StepTestResult:
    """The record of a step test.

    Attributes
    ----------
    t, u, y, y_true : ndarray, shape (n,)
        y as measured, y_true without noise and drift [time, input, output].
    notes : tuple of str
    truncated_at, truncated_reason : float and str, or None
    """

    t: FloatArray
    u: FloatArray
    y: FloatArray
    y_true: FloatArray
    notes: tuple[str, ...]
    truncated_at: float | None
    truncated_reason: str | None


def linear_step_test(plant: TransferFunction, test: StepTest, u0: float = 0.0, y0: float = 0.0) -> StepTestResult:
    """A step test on a linear plant at rest, exact but for the noise that is asked for.

    Parameters
    ----------
    plant : TransferFunction
        Proper.
    test : StepTest
    u0, y0 : float
        Where it rests [input, output].

    Returns
    -------
    StepTestResult

    Raises
    ------
    ImproperSystem, InvalidInput
    """
    t = test.times()
    change = test.applied(u0)
    found = simulate(plant, step(change, test.made_at()), test.horizon, test.points)
    n = found.y.size
    y = y0 + found.y
    return StepTestResult(
        t[:n],
        test.inputs(t[:n], u0),
        test.measured(t[:n], y),
        y,
        limited_note(test, change),
        found.truncated_at,
        found.truncated_reason,
    )


def limited_note(test: StepTest, change: float) -> tuple[str, ...]:
    """What to say where the input's limits cut the step short."""
    if change == test.size:
        return ()
    return (f"the input is limited: it stepped by {change:.6g} instead of {test.size:.6g}",)
