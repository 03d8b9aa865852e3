"""The same gain move by python-control, by the fastest of its own ways, and the way its examples go.

Fastest, measured and chosen: state space instead of polynomials for the closed loop (2 inputs r, d and 2 outputs y, u
in one step_response, 2.5 times faster than four polynomial ones), values of the transfer functions by calling them
(three times faster than frequency_response), one stability_margins for all margins. Dead time is a Pade fraction: the
package has no other. ``control`` is imported here, inside the functions.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from looplab.bench.scenarios import PADE_ORDER, POINTS, Scenario


class Peer:
    """python-control at work on one scenario."""

    def __init__(
        self, scenario: Scenario, stretch: float = 1.0, order: int = PADE_ORDER, polynomials: bool = False
    ) -> None:
        import control

        self.scenario, self.omega, self.polynomials = scenario, scenario.omega(), polynomials
        poles = stretch * np.array(scenario.poles)
        self.P = control.tf([scenario.num[0] * stretch**poles.size], np.poly(poles))
        if scenario.theta:
            self.P = self.P * control.tf(*control.pade(scenario.theta, order))
        self.P_ss = control.ss(self.P)
        # Its count is right only when the contour begins at zero; its own default grid takes twice as long.
        self.closed_omega = np.append(0.0, self.omega)
        self.t = np.linspace(0.0, scenario.horizon, POINTS)

    def controller(self, Kc: float) -> Any:
        """Kc (1 + 1/(tau_I s) + tau_D s/(alpha tau_D s + 1)) as one fraction."""
        import control

        s = self.scenario
        filtered, integral = [s.alpha * s.tau_D, 1.0], [s.tau_I, 0.0]
        den = np.polymul(integral, filtered)
        num = np.polyadd(np.polymul([s.tau_I, 1.0], filtered), np.polymul([s.tau_D, 0.0], integral))
        return control.tf(Kc * num, den)

    def closed_loop(self, C: Any) -> Any:
        """From (r, d) to (u, y) in state space: C and P side by side, closed around."""
        import control

        side_by_side = control.append(control.ss(C), self.P_ss)
        return control.feedback(side_by_side, control.ss([], [], [], [[0.0, 1.0], [-1.0, 0.0]]))

    def by_states(self, C: Any) -> tuple[Any, Any, Any]:
        """y and u, each for r and d, and the closed-loop poles: one state space, one step_response."""
        import control

        closed = self.closed_loop(C)
        step = control.step_response(closed, T=self.t)
        return step.outputs[1], step.outputs[0], closed.poles()

    def by_polynomials(self, C: Any, L: Any) -> tuple[Any, Any, Any]:
        """The same from four transfer functions."""
        import control

        T, PS, CS = control.feedback(L, 1), control.feedback(self.P, C), control.feedback(C, self.P)
        y_r, y_d, u_r, u_d = (control.step_response(G, T=self.t).outputs for G in (T, PS, CS, -T))
        return (y_r, y_d), (u_r, u_d), T.poles()

    def move(self, Kc: float, locus: bool) -> dict[str, Any]:
        """Poles, y and u for setpoint and load, metrics, values of L, P, C, sensitivities, Nyquist, margins."""
        import control

        C = self.controller(Kc)
        L = self.P * C
        y, u, poles = self.by_polynomials(C, L) if self.polynomials else self.by_states(C)
        s = 1j * self.omega
        value, P, CC = L(s), self.P(s), C(s)
        S = 1.0 / (1.0 + value)
        metrics = []
        for side, (r, final) in enumerate(((1.0, 1.0), (0.0, 0.0))):
            e = np.abs(r - y[side])
            integrals = [np.trapezoid(f, self.t) for f in (e, e * e, self.t * e)]
            info = control.step_info(y[side], T=self.t, final_output=final or float(y[side][-1]))
            metrics.append((info, integrals, np.abs(np.diff(u[side])).sum()))
        out: dict[str, Any] = {
            "poles": poles,
            "step": (y, u),
            "metrics": metrics,
            "bode": [(20.0 * np.log10(np.abs(v)), np.degrees(np.unwrap(np.angle(v)))) for v in (value, P, CC)],
            "sensitivity": (S, value * S, P * S, CC * S),
            "nyquist": control.nyquist_response(L, self.closed_omega),
            "margins": (control.stability_margins(L, returnall=True), np.abs(S).max(), np.abs(value * S).max()),
        }
        if locus:
            out["root_locus"] = control.root_locus_map(L)
        return out


def _quiet(work: Callable[[float], Any]) -> Callable[[float], Any]:
    def quiet(Kc: float) -> Any:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return work(Kc)

    return quiet


def gain_move(scenario: Scenario, locus: bool, polynomials: bool = False) -> Callable[[float], Any]:
    """A function of Kc that does one move, plant unchanged."""
    work = Peer(scenario, polynomials=polynomials)
    return _quiet(lambda Kc: work.move(Kc, locus))


def full_recompute(scenario: Scenario, locus: bool, polynomials: bool = False) -> Callable[[float], Any]:
    """A function of Kc that does the same for a new plant."""
    seen = [0]

    def move(Kc: float) -> Any:
        seen[0] += 1
        return Peer(scenario, 1.0 + 1e-7 * seen[0], polynomials=polynomials).move(Kc, locus)

    return _quiet(move)
