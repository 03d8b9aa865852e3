"""Input signals as JSON."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.engine.response import (
    InputSignal,
    held_samples,
    impulse,
    joined_samples,
    pulse,
    ramp,
    sine,
    step,
)
from looplab.engine.response.inputs import MAX_SAMPLES
from looplab.schemas.base import Model

Start = Annotated[float, Field(ge=0, le=1e9, description="When it begins; zero before [time].")]
Samples = Annotated[list[float], Field(min_length=1, max_length=MAX_SAMPLES)]


class StepInput(Model):
    """A step of ``amplitude`` at ``start``."""

    type: Literal["step"]
    amplitude: float = 1.0
    start: Start = 0.0

    def to_engine(self) -> InputSignal:
        """The signal for the engine; raises EngineError naming the field."""
        return step(self.amplitude, self.start)


class ImpulseInput(Model):
    """An impulse of ``area`` at ``start``."""

    type: Literal["impulse"]
    area: Annotated[float, Field(description="[input*time]")] = 1.0
    start: Start = 0.0

    def to_engine(self) -> InputSignal:
        """The signal for the engine; raises EngineError naming the field."""
        return impulse(self.area, self.start)


class RampInput(Model):
    """A ramp of ``slope`` from ``start`` on."""

    type: Literal["ramp"]
    slope: Annotated[float, Field(description="[input/time]")] = 1.0
    start: Start = 0.0

    def to_engine(self) -> InputSignal:
        """The signal for the engine; raises EngineError naming the field."""
        return ramp(self.slope, self.start)


class SineInput(Model):
    """amplitude sin(omega (t - start) + phase) from ``start`` on."""

    type: Literal["sine"]
    amplitude: float = 1.0
    omega: Annotated[float, Field(gt=0, description="[rad/time]")]
    phase_deg: float = 0.0
    start: Start = 0.0

    def to_engine(self) -> InputSignal:
        """The signal for the engine; raises EngineError naming the field."""
        return sine(self.amplitude, self.omega, self.phase_deg, self.start)


class PulseInput(Model):
    """A rectangle of ``amplitude`` that lasts ``width`` from ``start``."""

    type: Literal["pulse"]
    amplitude: float = 1.0
    width: Annotated[float, Field(gt=0, description="[time]")]
    start: Start = 0.0

    def to_engine(self) -> InputSignal:
        """The signal for the engine; raises EngineError naming the field."""
        return pulse(self.amplitude, self.width, self.start)


class SampledInput(Model):
    """Samples held until the next one ("zero") or joined by straight lines ("linear"); the last one lasts."""

    type: Literal["sampled"]
    times: Samples
    values: Samples
    hold: Literal["zero", "linear"] = "zero"

    def to_engine(self) -> InputSignal:
        """The signal for the engine; raises EngineError naming the field."""
        make = held_samples if self.hold == "zero" else joined_samples
        return make(self.times, self.values)


InputShape = Annotated[
    StepInput | ImpulseInput | RampInput | SineInput | PulseInput | SampledInput, Field(discriminator="type")
]
