"""What the frequency and root-locus routes are asked about: an open loop, given as a system or as a loop."""

from __future__ import annotations

from typing import Any

from pydantic import Field, model_validator

from looplab.engine.frequency import nyquist_count, nyquist_curve
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
    """The curve for omega > 0, and the count with its verdict."""
    curve, count = nyquist_curve(L), nyquist_count(L)
    return {
        "omega": curve.omega,
        "re": curve.re,
        "im": curve.im,
        "N": count.N,
        "P": count.P,
        "Z": count.Z,
        "closed_loop_stable": closed_loop_stable,
        "explanation": nyquist_words(L),
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
