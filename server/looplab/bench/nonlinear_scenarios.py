"""Two unstable plants under PID, as looplab reads them and by hand, as one writes them for a solver."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

Rates = Callable[[Sequence[float], float], list[float]]


@dataclass(frozen=True)
class ControlScenario:
    """A plant with one PID loop.

    Attributes
    ----------
    name : str
    document : dict
        The model.
    rates : callable
        dx/dt by hand, of the state and u.
    x0 : tuple of float
    output : int
        Which state is measured.
    u0, u_min, u_max, setpoint : float
    Kc, tau_I, tau_D : float
        Direct action: Kc acts on y - r.
    h, samples : float and int
        Sampling time and how many samples.
    """

    name: str
    document: dict[str, Any]
    rates: Rates
    x0: tuple[float, ...]
    output: int
    u0: float
    u_min: float
    u_max: float
    setpoint: float
    Kc: float
    tau_I: float
    tau_D: float
    h: float
    samples: int
    alpha: float = 0.1

    def gains(self, count: int) -> list[float]:
        """A new gain for each repetition."""
        return [self.Kc * (1.0 + 0.2 * i / count) for i in range(count)]


def _reactor(x: Sequence[float], u: float) -> list[float]:
    cA, T = x
    rate = 7.2e10 * math.exp(-1e4 / T) * cA
    return [1.0 - cA - rate, 350.0 - T + 200.0 * rate - u / 1e5]


def _pendulum(x: Sequence[float], u: float) -> list[float]:
    _, v, phi, omega = x
    M, m, length, J = 0.5, 0.2, 0.3, 0.024
    s, c = math.sin(phi), math.cos(phi)
    push, turn = u - 0.1 * v + m * length * omega * omega * s, 9.8 * m * length * s - 0.01 * omega
    D = (M + m) * J - (m * length * c) ** 2
    return [v, (J * push - m * length * c * turn) / D, omega, ((M + m) * turn - m * length * c * push) / D]


REACTOR = ControlScenario(
    "reactor",
    {
        "id": "reactor",
        "title": "Stirred tank reactor",
        "time_unit": "min",
        "inputs": [{"name": "Q", "value": 2e6}],
        "variables": [{"name": "rate", "expression": "7.2e10*exp(-10000/T)*cA"}],
        "states": [
            {"name": "cA", "initial": 0.72, "equation": "1 - cA - rate"},
            {"name": "T", "initial": 386, "equation": "350 - T + 200*rate - Q/1e5"},
        ],
    },
    _reactor, (0.72, 386.0), 1, 2e6, 0.0, 2e7, 390.0, 1e6, 0.5, 0.02, 0.02, 500,
)  # fmt: skip
PENDULUM = ControlScenario(
    "pendulum on a cart",
    {
        "id": "pendulum",
        "title": "Pendulum on a cart",
        "parameters": [{"name": "m", "value": 0.2}, {"name": "l", "value": 0.3}, {"name": "J", "value": 0.024}],
        "inputs": [{"name": "F", "value": 0}],
        "variables": [
            {"name": "push", "expression": "F - 0.1*v + m*l*omega^2*sin(phi)"},
            {"name": "turn", "expression": "9.8*m*l*sin(phi) - 0.01*omega"},
            {"name": "D", "expression": "0.7*J - (m*l*cos(phi))^2"},
        ],
        "states": [
            {"name": "x", "initial": 0, "equation": "v"},
            {"name": "v", "initial": 0, "equation": "(J*push - m*l*cos(phi)*turn)/D"},
            {"name": "phi", "initial": 0.1, "equation": "omega"},
            {"name": "omega", "initial": 0, "equation": "(0.7*turn - m*l*cos(phi)*push)/D"},
        ],
    },
    _pendulum, (0.0, 0.0, 0.1, 0.0), 2, 0.0, -20.0, 20.0, 0.0, 40.0, 1.0, 0.15, 0.01, 500,
)  # fmt: skip
SCENARIOS = (REACTOR, PENDULUM)
