"""The inputs whose transform is rational: impulse, step, ramp, sine and exponential."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.transfer_function import TransferFunction

LaplaceInputType = Literal["impulse", "step", "ramp", "sine", "exponential"]


@dataclass(frozen=True)
class LaplaceInput:
    r"""An input that starts at t = 0.

    .. math::

        \mathcal{L}\{\delta\} = 1,\quad \mathcal{L}\{1\} = \frac{1}{s},\quad \mathcal{L}\{t\} = \frac{1}{s^2},\quad
        \mathcal{L}\{\sin\omega t\} = \frac{\omega}{s^2 + \omega^2},\quad \mathcal{L}\{e^{a t}\} = \frac{1}{s - a}

    Attributes
    ----------
    type : {"impulse", "step", "ramp", "sine", "exponential"}
    amplitude : float
        Factor in front of the signal [input].
    omega : float
        Frequency of the sine, > 0 [rad/time].
    rate : float
        a of the exponential [1/time].
    """

    type: LaplaceInputType = "step"
    amplitude: float = 1.0
    omega: float = 1.0
    rate: float = -1.0

    def __post_init__(self) -> None:
        if self.type not in get_args(LaplaceInputType):
            raise InvalidInput(f"unknown input {self.type!r}", field="type", hint=", ".join(get_args(LaplaceInputType)))
        for name in ("amplitude", "omega", "rate"):
            if not np.isfinite(getattr(self, name)):
                raise InvalidInput(f"{name} must be a finite number", field=name)
        if self.type == "sine" and self.omega <= 0:
            raise InvalidInput(
                "the frequency of a sine must be positive", field="omega", hint="for a constant, use step"
            )

    def transform(self) -> TransferFunction:
        """U(s), with all its poles kept."""
        match self.type:
            case "impulse":
                return TransferFunction((), (), self.amplitude)
            case "step":
                return TransferFunction((), (0.0,), self.amplitude)
            case "ramp":
                return TransferFunction((), (0.0, 0.0), self.amplitude)
            case "sine":
                return TransferFunction((), (1j * self.omega, -1j * self.omega), self.amplitude * self.omega)
        return TransferFunction((), (self.rate,), self.amplitude)
