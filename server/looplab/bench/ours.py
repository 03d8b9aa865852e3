"""One gain move by looplab: all that the workbench shows for one slider position."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from looplab.bench.scenarios import POINTS, Scenario


class Ours:
    """The engine at work on one scenario; ``stretch`` scales the plant's poles, so that nothing is remembered."""

    def __init__(self, scenario: Scenario, stretch: float = 1.0) -> None:
        from looplab.engine.systems import TransferFunction

        self.scenario, self.omega = scenario, scenario.omega()
        poles = stretch * np.array(scenario.poles)
        self.plant = TransferFunction((), poles, scenario.num[0] * stretch**poles.size, scenario.theta)

    def loop(self, Kc: float) -> Any:
        """The feedback loop at one gain."""
        from looplab.engine.loop import PID, FeedbackLoop

        s = self.scenario
        return FeedbackLoop(self.plant, PID(Kc, s.tau_I, s.tau_D, s.alpha))

    def move(self, Kc: float, locus: bool) -> dict[str, Any]:
        """Verdict, poles, y and u for setpoint and load, metrics, Bode of L, P, C, sensitivities, Nyquist, margins."""
        from looplab.engine.frequency import bode, margins, nyquist_count, nyquist_curve
        from looplab.engine.frequency.sampled import sampled_at
        from looplab.engine.loop import closed_loop_step, loop_metrics
        from looplab.engine.stability import closed_loop_poles, closed_loop_verdict, root_locus

        loop = self.loop(Kc)
        L = loop.open_loop
        verdict = closed_loop_verdict(loop)
        step = closed_loop_step(loop, self.scenario.horizon, POINTS)
        L_at, P_at, C_at = (sampled_at(system, self.omega).value for system in (L, self.plant, loop.C))
        S = 1.0 / (1.0 + L_at)
        out: dict[str, Any] = {
            "verdict": verdict,
            "poles": closed_loop_poles(loop),
            "step": step,
            "metrics": loop_metrics(step, stable=verdict.closed_loop_stable),
            "bode": [bode(system, self.omega) for system in (L, self.plant, loop.C)],
            "sensitivity": (S, L_at * S, P_at * S, C_at * S),
            "nyquist": (nyquist_curve(L), nyquist_count(L)),
            "margins": margins(L),
        }
        if locus:
            # The locus does not depend on the gain: for a moved gain it is the one at hand.
            out["root_locus"] = root_locus(loop.locus_system)
        return out


def gain_move(scenario: Scenario, locus: bool) -> Callable[[float], Any]:
    """A function of Kc that does one move, plant unchanged."""
    work = Ours(scenario)
    return lambda Kc: work.move(Kc, locus)


def full_recompute(scenario: Scenario, locus: bool) -> Callable[[float], Any]:
    """A function of Kc that does the same for a plant never seen before."""
    seen = [0]

    def move(Kc: float) -> Any:
        seen[0] += 1
        return Ours(scenario, 1.0 + 1e-7 * seen[0]).move(Kc, locus)

    return move
