"""The answer of POST /connect."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, ComplexPair, Numbers, Reasons
from looplab.api.answers.loop import MarginsAnswer, SystemText
from looplab.api.answers.state_space import RemovedModes


class SystemVerdict(Answer):
    """Stable, marginal or unstable; rhp_poles is null when there are infinitely many."""

    verdict: Literal["stable", "marginal", "unstable"]
    stable: bool
    because: str
    rhp_poles: int | None


class SystemStep(Answer):
    """y after a unit step, shorter than t where it was cut; breakpoints are the times of jumps and kinks inside."""

    horizon: float
    t: Numbers
    y: Numbers
    final_value: float | None
    breakpoints: Annotated[list[float], Field(description="The first 200 of them [time].")]
    truncated_at: float | None
    truncated_reason: str | None


class SystemFrequency(Answer):
    """Frequency response [dB, deg] over omega [rad/time]; the phase is anchored at low frequency."""

    omega: Numbers
    mag_dB: Numbers
    phase_deg: Numbers


class SystemNyquist(Answer):
    """The curve for omega > 0, and Z = N + P under unit negative feedback; null where infinite or not defined."""

    omega: Numbers
    re: Numbers
    im: Numbers
    N: int | None
    P: int
    Z: int | None
    reason: str | None


class MinimalAnswer(RemovedModes):
    """The diagram without hidden modes and without delays that nothing reaches or shows."""

    delays: list[float]
    removed_delays: list[float]


class ConnectAnswer(Answer):
    """The connected system; what is null has its reason."""

    time_unit: str
    order: Annotated[int, Field(description="States of the rational part.")]
    delays: Annotated[list[float], Field(description="Dead times inside [time].")]
    transfer_function: Annotated[SystemText | None, Field(description="Where it is one, with one dead time.")]
    verdict: SystemVerdict | None
    poles: Annotated[list[ComplexPair], Field(description="Rightmost first.")]
    complete: Annotated[bool, Field(description="false where a dead time in a loop makes infinitely many poles.")]
    step: SystemStep | None
    frequency: SystemFrequency | None
    margins: MarginsAnswer | None
    nyquist: SystemNyquist | None
    minimal: MinimalAnswer | None
    reasons: Reasons
