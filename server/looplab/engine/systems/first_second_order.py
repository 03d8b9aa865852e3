"""The low-order models that process control lives on: FOPDT and SOPDT."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.polynomial import roots
from looplab.engine.systems.transfer_function import TransferFunction


def _positive(name: str, value: float) -> None:
    if not (np.isfinite(value) and value > 0):
        raise InvalidInput(f"{name} must be positive", field=name, hint="a time constant is a time: give a value > 0")


@dataclass(frozen=True)
class FOPDT:
    r"""First order plus dead time (also written FOPTD): :math:`K e^{-\theta s}/(\tau s + 1)`.

    K [output/input], tau > 0 [time], theta >= 0 [time]. Raises InvalidInput otherwise.
    """

    K: float
    tau: float
    theta: float = 0.0

    def __post_init__(self) -> None:
        _positive("tau", self.tau)
        if not np.isfinite(self.K) or self.K == 0:
            raise InvalidInput("K must be a finite number other than zero", field="K")
        if not np.isfinite(self.theta) or self.theta < 0:
            raise InvalidInput("theta must be zero or positive", field="theta")

    def to_transfer_function(self) -> TransferFunction:
        """The same model as zeros, poles, gain and dead time."""
        return TransferFunction((), (-1.0 / self.tau,), self.K / self.tau, self.theta)


@dataclass(frozen=True)
class SOPDT:
    r"""Second order plus dead time: :math:`K e^{-\theta s}/(\tau^2 s^2 + 2 \zeta \tau s + 1)`.

    K [output/input], tau = 1/omega_n > 0 [time], zeta the damping ratio [-], theta >= 0 [time].
    """

    K: float
    tau: float
    zeta: float
    theta: float = 0.0

    def __post_init__(self) -> None:
        FOPDT(self.K, self.tau, self.theta)
        if not np.isfinite(self.zeta):
            raise InvalidInput("zeta must be a finite number", field="zeta")

    def to_transfer_function(self) -> TransferFunction:
        """The same model as zeros, poles, gain and dead time."""
        poles = roots(np.array([self.tau**2, 2.0 * self.zeta * self.tau, 1.0]))
        return TransferFunction((), poles, self.K / self.tau**2, self.theta)
