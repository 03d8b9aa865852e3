"""The answers of POST /limits and POST /bode-integral."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, ComplexPair, Numbers, Reasons
from looplab.api.answers.frequency import BandwidthAnswer


class LimitAnswer(Answer):
    """One limit of the bandwidth; null where there is none, and because says why."""

    id: Literal["pole", "load", "zero", "dead_time", "actuator", "mismatch", "noise"]
    side: Annotated[Literal["lower", "upper"], Field(description="omega_c must lie above or below it.")]
    omega: Annotated[float | None, Field(description="[rad/time]")]
    binding: Annotated[bool, Field(description="The tightest on its side.")]
    met: Annotated[bool | None, Field(description="Whether the present omega_c keeps to it.")]
    because: str


class WindowAnswer(Answer):
    """What is left between the limits [rad/time]; null is no limit on that side."""

    low: float | None
    high: float | None
    open: bool
    because: str


class PeakAnswer(Answer):
    """A largest value and where; omega is null where it is approached at ever higher frequencies."""

    value: float
    omega: float | None


class ActuatorAnswer(Answer):
    """u after a unit step of r, and Su = T/G over frequency."""

    initial: float
    final: float | None
    ratio: float | None
    peak: PeakAnswer
    plant_bandwidth: BandwidthAnswer
    loop_bandwidth: BandwidthAnswer


class MismatchAnswer(Answer):
    """Whether the loop is stable on every plant within the spread."""

    peak: Annotated[float, Field(description="Largest |T| times the relative model error; below 1 is safe.")]
    omega_peak: float
    robustly_stable: bool
    worst_S: Annotated[float | None, Field(description="By how much the error may grow: bound on |1/(1 + T G_Delta)|.")]


class ConstraintAnswer(Answer):
    """S and T of this loop at a zero or pole of L in the right half-plane."""

    root: ComplexPair
    kind: Literal["zero", "pole"]
    S: ComplexPair
    T: ComplexPair
    peak_bound: Annotated[float, Field(description="Least peak of |S| (zero) or |T| (pole).")]


class LemmaAnswer(Answer):
    """The integral of signal e^{-root t} over this loop's own response, and what it must be."""

    root: float
    kind: Literal["zero", "pole"]
    signal: Literal["y", "e"]
    step: Literal["setpoint", "load"]
    value: float
    theorem: float


class ZeroEffectAnswer(Answer):
    """The least undershoot or overshoot because of one real zero."""

    c: float
    effect: Literal["undershoot", "overshoot"]
    bound_pct: float


class StepShapeAnswer(Answer):
    """A step response, over its final value, beside what its zeros ask for."""

    t_settle: float | None
    undershoot_pct: float | None
    overshoot_pct: float | None
    t_undershoot: float | None
    starts_up: bool | None
    effects: list[ZeroEffectAnswer]


class PeaksAnswer(Answer):
    """Peaks of S and T, and the least that zeros and poles on the right allow."""

    Ms: float | None
    Mt: float | None
    Ms_bound: float
    Mt_bound: float


class LimitCurves(Answer):
    """|S|, |T| and the relative model error over frequency, and |S| of the best loop with this dead time [-].

    Cut at 1e9.
    """

    omega: Numbers
    S: Numbers
    T: Numbers
    model_error: Numbers
    ideal_S: Numbers | None


class LimitsAnswer(Answer):
    """The limits of a loop; what only a stable loop has is null for another, with the reason."""

    closed_loop_stable: bool
    omega_c: float | None
    bandwidth: BandwidthAnswer
    window: WindowAnswer
    limits: list[LimitAnswer]
    actuator: ActuatorAnswer | None
    noise_passed: Annotated[float | None, Field(description="Largest |T| from noise_omega on.")]
    load_left: PeakAnswer | None
    mismatch: MismatchAnswer | None
    peaks: PeaksAnswer
    constraints: list[ConstraintAnswer] | None
    integrals: list[LemmaAnswer] | None
    step: Annotated[StepShapeAnswer | None, Field(description="y after a setpoint step.")]
    plant_step: Annotated[StepShapeAnswer, Field(description="y after a step of u, without feedback.")]
    curves: LimitCurves
    reasons: Reasons


class BodePiece(Answer):
    """A part of the frequency axis and the integral over it; the last one has no end."""

    name: Literal["origin", "middle", "tail"]
    omega_from: float
    omega_to: float | None
    value: float
    how: str


class BodeIntegralAnswer(Answer):
    """The integral of ln|S| in its pieces, the theorem's value beside it, and the curve; null with the reason."""

    value: float | None
    theorem: float | None
    difference: float | None
    error: float | None
    pieces: list[BodePiece] | None
    area_below: float | None
    area_above: float | None
    limit_sL: Annotated[float | None, Field(description="The limit of s L(s), dead time left out; null: infinite.")]
    theta: float
    unstable_poles: list[ComplexPair]
    closed_loop_stable: bool
    omega: Numbers
    ln_S: Numbers
    reasons: Reasons
