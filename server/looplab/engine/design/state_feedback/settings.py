"""What a state feedback is asked with."""

from __future__ import annotations

from dataclasses import dataclass

from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class ByPoles:
    """Poles that are asked for, one for each state (integrators included) [rad/time]."""

    poles: tuple[complex, ...]


@dataclass(frozen=True)
class ByWeights:
    """Weights of a regulator (integrators last), or intensities of a filter's noises of state and measurement."""

    Q: FloatArray
    R: FloatArray


@dataclass(frozen=True)
class Faster:
    """An observer with the poles of A - B K times ``speed``."""

    speed: float


@dataclass(frozen=True)
class DesignSettings:
    """Everything that makes a state feedback of a linear model.

    Attributes
    ----------
    gain : ByPoles or ByWeights
    observer : ByPoles, ByWeights, Faster or None
        None: the states themselves are measured.
    measured : tuple of int
        Outputs that the observer sees, counted from 0.
    controlled : tuple of int
        Outputs with a setpoint; may be empty.
    integral : bool
        Whether the errors of ``controlled`` are integrated; else a gain before the loop leads to the setpoint.
    """

    gain: ByPoles | ByWeights
    observer: ByPoles | ByWeights | Faster | None
    measured: tuple[int, ...]
    controlled: tuple[int, ...]
    integral: bool
