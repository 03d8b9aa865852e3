"""The loops that are timed, and the gains a slider moves through."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

POINTS = 500
PADE_ORDER = 5


@dataclass(frozen=True)
class Scenario:
    """num/den exp(-theta s) under a PID: coefficients highest power first, times in one unit.

    gains are the Kc that the slider passes through; every one is used once, so that no answer is remembered.
    """

    name: str
    num: tuple[float, ...]
    poles: tuple[float, ...]
    theta: float
    Kc: float
    tau_I: float
    tau_D: float
    alpha: float
    horizon: float

    def gains(self, count: int, series: int = 0) -> list[float]:
        """``count`` different gains between half and the whole of Kc; no two series share one."""
        return [float(k) * (1.0 - 1e-5 * series) for k in np.linspace(0.5 * self.Kc, self.Kc, count)]

    def omega(self) -> np.ndarray:
        """The frequencies of the Bode plots, the same for both [rad/time]."""
        return np.logspace(-2, 2, 400) / self.tau_D / 10.0


DELAY_FREE = Scenario("1/(s+1)^3, PID", (1.0,), (-1.0, -1.0, -1.0), 0.0, 4.8, 1.8138, 0.45345, 0.1, 30.0)
DEAD_TIME = Scenario("exp(-0.5 s)/(s+1)^3, PID", (1.0,), (-1.0, -1.0, -1.0), 0.5, 2.0, 2.0, 0.5, 0.1, 30.0)
