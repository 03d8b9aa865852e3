"""A distillation column of 44 states, 500 points: beside scipy's LSODA and python-control on equations in numpy."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from looplab.bench.timing import WARM_UP, interleave

HORIZON, POINTS = 100.0, 500
RTOL = 1e-8
FEED_TRAY, R_0 = 10, 128.01
# A PI controller of the distillate by the reflux, for the second pair of rows.
KC, TAU_I, SETPOINT = 100.0, 20.0, 0.985
NOTE = "all with LSODA and rtol 1e-8; looplab by its formulas and exact Jacobian, the others by equations in numpy"


def _equations(x: Any, R: float, V: float = 178.01, F: float = 100.0, z: float = 0.5) -> Any:
    """dx/dt of M_B, M_1, ..., M_D, x_B, ..., x_D, as one writes it for speed."""
    M, X = x[:22], x[22:44]
    Y = 2.0 * X / (1.0 + X)
    liquid = np.empty(22)
    liquid[1:21] = 11.45 * np.maximum(M[1:21] - 5.0, 0.0) ** 1.5
    liquid[0], liquid[21] = max(M[0] - 50.0, 0.0), R
    D = max(M[21] - 50.0, 0.0)
    out = np.empty(44)
    dM, dX = out[:22], out[22:]
    dM[:21] = liquid[1:] - liquid[:21]
    dM[0] -= V
    dM[21] = V - R - D
    dM[FEED_TRAY] += F
    dX[:21] = liquid[1:] * (X[1:] - X[:21])
    dX[21] = V * (Y[20] - X[21])
    dX[0] -= V * (Y[0] - X[0])
    dX[1:21] += V * (Y[:20] - Y[1:21])
    dX[FEED_TRAY] += F * (z - X[FEED_TRAY])
    dX /= M
    return out


def _controlled(x: Any, setpoint: float) -> Any:
    """The same and the integral of the error, under PI control of x_D."""
    error = setpoint - x[43]
    return np.append(_equations(x[:44], R_0 + KC * (error + x[44] / TAU_I)), error)


class Column:
    """One run, with ``value`` the new reflux or the new setpoint from t = 0 on."""

    def __init__(self, controlled: bool) -> None:
        from looplab.plants import load_plant

        self.controlled = controlled
        self.model = load_plant("distillation")
        self.near = self.model.document.operating_points[0].near
        self.t = np.linspace(0.0, HORIZON, POINTS)
        x0 = self.model.states(self.near, self.model.x0)
        self.x0 = np.array([*x0, 0.0] if controlled else x0)
        self.f = _controlled if controlled else _equations

    def ours(self, value: float) -> Any:
        """States (count, 44) by looplab."""
        if self.controlled:
            from looplab.engine.loop import PID
            from looplab.engine.nonlinear.control_loop import ControlLoop
            from looplab.engine.nonlinear.control_loop.simulation import simulate_control
            from looplab.engine.nonlinear.inputs import InputCourse

            loop = ControlLoop("x_D", "R", InputCourse(value), PID(KC, TAU_I))
            return simulate_control(self.model, self.t, [loop], initial=self.near, rtol=RTOL).x[:, :44]
        from looplab.engine.nonlinear.simulation import simulate_open_loop

        return simulate_open_loop(self.model, self.t, {"R": value}, initial=self.near, rtol=RTOL).x

    def scipy(self, value: float) -> Any:
        """States by solve_ivp."""
        from scipy.integrate import solve_ivp

        found = solve_ivp(lambda t, x: self.f(x, value), (0.0, HORIZON), self.x0, "LSODA", self.t, rtol=RTOL, atol=RTOL)
        return found.y[:44].T

    def control(self, value: float) -> Any:
        """States by python-control's input_output_response."""
        import control

        system = control.nlsys(lambda t, x, u, params: self.f(x, u[0]), None, inputs=1, states=self.x0.size)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = control.input_output_response(
                system,
                self.t,
                np.full((1, POINTS), value),
                self.x0,
                solve_ivp_method="LSODA",
                solve_ivp_kwargs={"rtol": RTOL, "atol": RTOL},
            )
        return found.states[:44].T


ROWS = tuple(
    (what, controlled, peer)
    for what, controlled in (("step of the reflux", False), ("setpoint step under PI", True))
    for peer in ("scipy", "control")
)
PEERS = {"scipy": "solve_ivp", "control": "input_output_response"}


def measure(rounds: int, tick: Callable[[], None]) -> list[dict[str, Any]]:
    """Time every pair; rows as those of the moves."""
    rows = []
    for what, controlled, peer in ROWS:
        column = Column(controlled)
        start, size = (SETPOINT, 1e-4) if controlled else (R_0, 0.05)
        values = [start + size * (i + 1) for i in range(rounds + WARM_UP)]
        timed = interleave(column.ours, getattr(column, peer), values, tick)
        name = f"{what}, {PEERS[peer]}"
        rows.append({"loop": "column", "what": name, "goal": None, "note": "", "pade_order": None, **timed})
    return rows
