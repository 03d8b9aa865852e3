"""Inputs whose transform is rational, and linear ODEs, as JSON."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.engine.laplace import LaplaceInput
from looplab.schemas.base import Coefficients, Model


class StepTransform(Model):
    """A step, amplitude/s."""

    type: Literal["step"]
    amplitude: float = 1.0

    def to_engine(self) -> LaplaceInput:
        """The input for the engine."""
        return LaplaceInput("step", self.amplitude)


class ImpulseTransform(Model):
    """An impulse of ``area``."""

    type: Literal["impulse"]
    area: Annotated[float, Field(description="[input*time]")] = 1.0

    def to_engine(self) -> LaplaceInput:
        """The input for the engine."""
        return LaplaceInput("impulse", self.area)


class RampTransform(Model):
    """A ramp, slope/s^2."""

    type: Literal["ramp"]
    slope: Annotated[float, Field(description="[input/time]")] = 1.0

    def to_engine(self) -> LaplaceInput:
        """The input for the engine."""
        return LaplaceInput("ramp", self.slope)


class SineTransform(Model):
    """amplitude sin(omega t)."""

    type: Literal["sine"]
    amplitude: float = 1.0
    omega: Annotated[float, Field(gt=0, description="[rad/time]")] = 1.0

    def to_engine(self) -> LaplaceInput:
        """The input for the engine."""
        return LaplaceInput("sine", self.amplitude, omega=self.omega)


class ExponentialTransform(Model):
    """amplitude e^(rate t)."""

    type: Literal["exponential"]
    amplitude: float = 1.0
    rate: Annotated[float, Field(description="[1/time]")] = -1.0

    def to_engine(self) -> LaplaceInput:
        """The input for the engine."""
        return LaplaceInput("exponential", self.amplitude, rate=self.rate)


TransformInput = Annotated[
    StepTransform | ImpulseTransform | RampTransform | SineTransform | ExponentialTransform,
    Field(discriminator="type"),
]


class LinearODE(Model):
    """a_n y^(n) + ... + a_0 y = b_m u^(m) + ... + b_0 u, coefficients from the highest derivative down."""

    a: Coefficients
    b: Coefficients = Field(default=[1.0])
    initial: Annotated[
        list[float], Field(max_length=50, description="y(0), y'(0), ... before the input acts; empty means zero.")
    ] = Field(default=[])
