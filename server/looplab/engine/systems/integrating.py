"""The low-order models of plants that do not settle: an integrator and a double integrator, each with dead time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class IPDT:
    r"""Integrator plus dead time, with a lag where there is one: :math:`K e^{-\theta s}/(s (\tau s + 1))`.

    K slope of the output per unit of input [output/input/time], theta >= 0 [time], tau >= 0 [time].
    """

    K: float
    theta: float = 0.0
    tau: float = 0.0

    def __post_init__(self) -> None:
        FOPDT(self.K, 1.0, self.theta)
        if not np.isfinite(self.tau) or self.tau < 0:
            raise InvalidInput("tau must be zero or positive", field="tau")

    def to_transfer_function(self) -> TransferFunction:
        """The same model as zeros, poles, gain and dead time."""
        if self.tau:
            return TransferFunction((), (0.0, -1.0 / self.tau), self.K / self.tau, self.theta)
        return TransferFunction((), (0.0,), self.K, self.theta)


@dataclass(frozen=True)
class DIPDT:
    r"""Double integrator plus dead time: :math:`K e^{-\theta s}/s^2`.

    K [output/input/time^2], theta >= 0 [time].
    """

    K: float
    theta: float = 0.0

    def __post_init__(self) -> None:
        FOPDT(self.K, 1.0, self.theta)

    def to_transfer_function(self) -> TransferFunction:
        """The same model as zeros, poles, gain and dead time."""
        return TransferFunction((), (0.0, 0.0), self.K, self.theta)
