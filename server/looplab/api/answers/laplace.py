"""The answers of POST /laplace and POST /approximate."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, ComplexPair, Numbers, Reasons


class Formula(Answer):
    """A formula three ways; mathml is null where the formula is too long to typeset."""

    text: str
    latex: str
    mathml: str | None


class Fraction(Answer):
    """coefficient/(s - pole)^power."""

    pole: ComplexPair
    power: int
    coefficient: ComplexPair


class LimitFormulas(Answer):
    """What the limits of s Y(s) give, also where the theorem does not hold; null where they are infinite."""

    initial_value: float | None
    final_value: float | None


class Accuracy(Answer):
    """How exact the expansion is."""

    cluster_tolerance: Annotated[float, Field(description="Relative distance up to which poles were taken as one.")]
    moved: Annotated[float, Field(description="Largest relative distance a pole was moved by that.")]
    cancelled: Annotated[list[ComplexPair], Field(description="Poles that zeros hide.")]
    residual: Annotated[float, Field(description="Fractions against the factored Y(s), relative.")]
    simulation_difference: Annotated[float | None, Field(description="y(t) against the simulation, relative.")]
    simulation_reason: str | None


class TimeFunction(Answer):
    """Samples of y(t), without the impulse; cut where |y| leaves 1e9."""

    t: Numbers
    y: Numbers
    truncated_at: float | None
    truncated_reason: str | None
    simulated_t: Annotated[Numbers, Field(description="Times of the simulation beside it; empty where it has none.")]
    simulated_y: Numbers


class CharacterAnswer(Answer):
    """A first- or second-order system in the terms of its step response."""

    order: int
    classification: str
    theta: float
    K: float | None
    tau: float | None
    tau_1: float | None
    tau_2: float | None
    zeta: float | None
    omega_n: float | None
    omega_d: float | None
    period: float | None
    t_63: float | None
    t_peak: float | None
    overshoot_pct: float | None
    decay_ratio: float | None
    initial_slope: float | None
    reasons: Reasons


class LaplaceAnswer(Answer):
    """Y(s), its partial fractions and y(t)."""

    time_unit: str
    transform: Annotated[Formula, Field(description="Y(s) in factors.")]
    partial_fractions: list[Fraction]
    direct: Annotated[float, Field(description="Polynomial part of Y(s): the weight of an impulse in y(t).")]
    theta: float
    expansion: Annotated[Formula, Field(description="Y(s) as a sum, conjugate pairs joined.")]
    text: Annotated[str, Field(description="y(t).")]
    latex: str
    mathml: str | None
    initial_value: float | None
    final_value: float | None
    reasons: Reasons
    formula: LimitFormulas
    forced: Annotated[Formula | None, Field(description="Of an ODE: what the input does from rest.")]
    free: Annotated[Formula | None, Field(description="Of an ODE: what the initial values do without input.")]
    accuracy: Accuracy
    horizon: float
    response: TimeFunction
    character: Annotated[CharacterAnswer | None, Field(description="Of a first- or second-order system.")]


class LowOrderModel(Answer):
    """One model; all null where the method refuses, with the reason."""

    method: str
    name: str
    source: str
    type: Literal["FOPDT", "SOPDT"]
    valid: bool
    reason: str | None
    K: float | None
    tau: float | None
    zeta: float | None
    tau_1: Annotated[float | None, Field(description="Slow lag of a second-order model with real poles.")]
    tau_2: float | None
    theta: float | None
    latex: str | None
    mathml: str | None
    max_deviation: Annotated[float | None, Field(description="Largest distance from the true step response.")]
    max_deviation_pct: float | None
    t_max_deviation: float | None
    y: Numbers | None


class PlantAnswer(Answer):
    """The plant as it was read."""

    text: str
    latex: str
    mathml: str | None
    order: int


class ApproximateAnswer(Answer):
    """The plant's step response beside that of its models, over one time axis."""

    time_unit: str
    plant: PlantAnswer
    character: CharacterAnswer | None
    reason: Annotated[str | None, Field(description="Why the plant has no such models.")]
    t: Numbers | None
    y: Numbers | None
    models: list[LowOrderModel]
