"""What the frequency and root-locus routes are asked about: an open loop, given as a system or as a loop."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from pydantic import Field, model_validator

from looplab.engine.frequency import nyquist_count, nyquist_curve
from looplab.engine.frequency.bode_criterion import BodeCriterion, bode_criterion
from looplab.engine.frequency.indentation import indentation_arcs
from looplab.engine.frequency.sketch import bode_sketch
from looplab.engine.loop import FeedbackLoop
from looplab.engine.systems import TransferFunction
from looplab.schemas import Loop, Model, System, located


class OpenLoopRequest(Model):
    """The open loop L: a system of its own, or that of a loop."""

    system: System | None = Field(default=None, description="L(s) itself, proper.")
    loop: Loop | None = Field(default=None, description="A loop; L = C A P H.")

    @model_validator(mode="after")
    def _one(self) -> OpenLoopRequest:
        if (self.system is None) == (self.loop is None):
            raise ValueError("give either system or loop")
        return self

    def feedback_loop(self) -> FeedbackLoop | None:
        """The loop, where one was given."""
        if self.loop is None:
            return None
        with located("loop"):
            return self.loop.to_engine()

    def open_loop(self) -> TransferFunction:
        """L for the engine."""
        loop = self.feedback_loop()
        if loop is not None:
            return loop.open_loop
        assert self.system is not None
        with located("system"):
            return self.system.to_engine().require_proper()


def nyquist_words(L: TransferFunction) -> str:
    """Z = N + P written out, or why it is not defined."""
    count = nyquist_count(L)
    if count.N is None or count.Z is None:
        return str(count.reason)
    times = {0: "does not turn around -1", 1: "turns around -1 once"}.get(
        abs(count.N), f"turns around -1 {abs(count.N)} times"
    )
    way = "" if count.N == 0 else " clockwise" if count.N > 0 else " counter-clockwise"
    poles = {0: "no pole", 1: "one pole"}.get(count.P, f"{count.P} poles")
    return (
        f"Z = N + P = {count.N} + {count.P} = {count.Z}: the curve {times}{way}, L has {poles} in the right half-plane"
    )


def nyquist_answer(L: TransferFunction, closed_loop_stable: bool) -> dict[str, Any]:
    """The curve for omega > 0, the arcs that close it, the count with its verdict, and Bode's criterion beside it."""
    curve, count, criterion = nyquist_curve(L), nyquist_count(L), bode_criterion(L)
    return {
        "omega": curve.omega,
        "re": curve.re,
        "im": curve.im,
        "N": count.N,
        "P": count.P,
        "Z": count.Z,
        "closed_loop_stable": closed_loop_stable,
        "explanation": nyquist_words(L),
        "arcs": [asdict(arc) | {"turn_deg": arc.turn_deg} for arc in indentation_arcs(L)],
        "bode_criterion": {**asdict(criterion), "explanation": bode_words(criterion)},
    }


def bode_words(criterion: BodeCriterion) -> str:
    """What Bode's criterion says, what Nyquist's says, and why they differ where they do."""
    c = criterion
    says = {True: "stable", False: "unstable", None: "on the limit of stability"}
    if c.magnitude is not None and c.omega_180 is not None:
        size = "1" if c.stable is None else f"{c.magnitude:.4g} {'<' if c.stable else '>'} 1"
        where = f"|L| = {size} at omega_180 = {c.omega_180:.4g}"
    elif c.stable:
        where = "the phase never crosses -180 deg"
    else:
        where = "the phase crossovers cannot be listed"
    if c.stable is None and c.magnitude is None:
        return f"Bode: no verdict, {where}. Nyquist: {says[c.nyquist_stable]}."
    text = f"Bode: {says[c.stable]}, for {where}. Nyquist: {says[c.nyquist_stable]}."
    why = "; ".join(c.unmet)
    if c.applies:
        return f"{text} The conditions of Bode's criterion are met, and the two agree."
    if c.agrees is False:
        return f"{text} They disagree, and Nyquist is right: Bode's criterion does not hold here, because {why}."
    return f"{text} Bode's criterion proves nothing here, because {why}."


def asymptotes_answer(L: TransferFunction, low: float, high: float) -> dict[str, Any]:
    """The straight lines of L, and what each corner is; none where L is zero."""
    if L.gain == 0.0:
        lines = ("omega", "mag_dB", "phase_omega", "phase_deg", "corners")
        return {name: [] for name in lines} | {"initial_slope": 0, "initial_phase_deg": 0.0}
    sketch = bode_sketch(L, low, high)
    return {
        "omega": sketch.omega.tolist(),
        "mag_dB": sketch.mag_dB.tolist(),
        "phase_omega": sketch.phase_omega.tolist(),
        "phase_deg": sketch.phase_deg.tolist(),
        "corners": [asdict(c) | {"s": [c.s.real, c.s.imag]} for c in sketch.corners],
        "initial_slope": sketch.initial_slope,
        "initial_phase_deg": sketch.initial_phase_deg,
    }


LOOP_EXAMPLE: dict[str, Any] = {
    "loop": {
        "plant": {"type": "fopdt", "K": 1, "tau": 0.5, "theta": 0.1},
        "controller": {"type": "pid", "Kc": 4.781},
    }
}
EXAMPLES: dict[str, Any] = {
    "a loop": {"value": LOOP_EXAMPLE},
    "an open loop": {"value": {"system": {"type": "expr", "text": "4.781 exp(-0.1s)/(0.5s+1)"}}},
}
