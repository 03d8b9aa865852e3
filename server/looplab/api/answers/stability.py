"""The answers of POST /routh and POST /stability."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, ComplexPair, Numbers, Reasons


class RouthRowAnswer(Answer):
    """One row: its entries as numbers and as fractions; what it was before it was replaced, and why."""

    power: int
    label: str
    entries: list[float]
    texts: list[str]
    kind: Literal["given", "computed", "multiplied", "auxiliary"]
    computed: list[float] | None
    note: str | None


class AuxiliaryPolynomial(Answer):
    """The row above a row of zeros, as a polynomial that divides the given one."""

    degree: int
    coefficients: list[float]
    text: str


class GainRangeAnswer(Answer):
    """Stable for low < K < high; null where there is no limit, with the reason."""

    low: float | None
    high: float | None
    low_omega: Annotated[list[float], Field(description="Closed-loop poles at +-j omega there [rad/time].")]
    high_omega: list[float]
    low_reason: str
    high_reason: str


class GainNow(Answer):
    """The gain that the ranges speak of, and its present value."""

    name: str
    value: float
    in_range: bool


class PIBoundaryAnswer(Answer):
    """Settings with closed-loop poles at +-j omega."""

    omega: Numbers
    Kc: Numbers
    tau_I: Numbers


class PICut(Answer):
    """The stable ranges of Kc at one tau_I; none has a reason."""

    tau_I: float
    gain_ranges: list[GainRangeAnswer]
    reason: str | None


class PIRegionAnswer(Answer):
    """The stable region of a PI controller in (Kc, tau_I)."""

    boundary: PIBoundaryAnswer
    cuts: list[PICut]


class RouthAnswer(Answer):
    """The Routh array and what it proves; what does not exist is null with a reason."""

    polynomial: list[float] | None
    polynomial_text: str | None
    exact: Annotated[bool | None, Field(description="Computed with fractions.")]
    tolerance: Annotated[float | None, Field(description="Relative uncertainty of each coefficient, if not exact.")]
    array: list[RouthRowAnswer] | None
    auxiliary_polynomials: list[AuxiliaryPolynomial] | None
    sign_changes: int | None
    rhp_roots: int | None
    imaginary_axis_roots: int | None
    lhp_roots: int | None
    stable: bool
    because: str
    gain: GainNow | None
    gain_ranges: list[GainRangeAnswer] | None
    pi_region: PIRegionAnswer | None
    reasons: Reasons


class AxisMode(Answer):
    """An eigenvalue on the imaginary axis: as many eigenvectors as its multiplicity, or a Jordan block."""

    eigenvalue: ComplexPair
    algebraic: int
    geometric: int
    largest_block: int
    singular_values: Annotated[list[float], Field(description="Of A - eigenvalue I; empty for a transfer function.")]
    threshold: Annotated[float, Field(description="Singular values below it count as zero.")]


class BoundedInputAnswer(Answer):
    """A bounded input that gives an unbounded output."""

    name: str
    u: str
    output: str


class BIBOAnswer(Answer):
    """Bounded-input bounded-output stability, from the poles that input and output see."""

    stable: bool
    poles: list[ComplexPair]
    cancelled: list[ComplexPair]
    because: str
    unbounded: BoundedInputAnswer | None


class GangMemberAnswer(Answer):
    """One of the four closed-loop transfer functions."""

    poles: list[ComplexPair]
    complete: bool
    stable: bool
    because: str


class CancellationAnswer(Answer):
    """A zero that cancels a pole in the loop, and which of the four still show it."""

    root: ComplexPair
    zero_of: Literal["plant", "controller"]
    pole_of: Literal["plant", "controller"]
    multiplicity: int
    stable: bool
    seen_in: list[str]
    text: str


class InternalAnswer(Answer):
    """The gang of four after cancellation."""

    S: GangMemberAnswer
    PS: GangMemberAnswer
    CS: GangMemberAnswer
    T: GangMemberAnswer
    cancellations: list[CancellationAnswer]
    internally_stable: bool
    because: str


class StabilityAnswer(Answer):
    """Every notion of stability that applies; the others are null with a reason."""

    poles: list[ComplexPair]
    complete: bool
    verdict: Literal["stable", "marginal", "unstable"]
    because: str
    lyapunov_stable: bool
    asymptotically_stable: bool
    axis_modes: list[AxisMode] | None
    bibo: BIBOAnswer | None
    internal: InternalAnswer | None
    reasons: Reasons
