"""The answers of the tuning routes."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, Reasons
from looplab.engine.tuning import Aim, Criterion, TypeName
from looplab.engine.tuning.settings import Kind


class Formula(Answer):
    """A formula as LaTeX and MathML."""

    latex: str
    mathml: str


class TimeConstantGains(Answer):
    """Settings in ideal or series form; null for an action that is off."""

    Kc: float
    tau_I: float | None
    tau_D: float | None


class PublishedGains(TimeConstantGains):
    """The settings in the form that the source gives them for."""

    form: Literal["ideal", "series"]


class ParallelForm(Answer):
    """The same controller in parallel form."""

    Kp: float
    Ki: float
    Kd: float


class Forms(Answer):
    """An ideal controller in the other forms; no series form, with the reason, where its zeros are complex."""

    series: TimeConstantGains | None
    series_reason: str | None
    parallel: ParallelForm | None


class Basis(Answer):
    """What a rule started from: the ultimate point or a model, its numbers, and how they were come by."""

    kind: Kind
    values: dict[str, float]
    how: str


class RuleSettings(Forms):
    """Settings of an ideal-form controller by one rule; all null where the rule refuses, with the reason."""

    rule: str
    name: str
    family: str
    type: TypeName
    Kc: float | None
    tau_I: float | None
    tau_D: float | None
    alpha: float
    valid: bool
    reason: str | None
    formula: Annotated[Formula | None, Field(description="Null where the rule has no such type.")]
    source: str
    validity: Annotated[str, Field(description="Range outside of which the rule refuses.")]
    published: Annotated[PublishedGains | None, Field(description="The series settings, where the source gives those.")]
    note: str | None
    basis: Basis | None


class Ultimate(Answer):
    """Ultimate gain and period; null with a reason where the plant has none."""

    Ku: float | None
    Pu: float | None
    omega_180: float | None
    reason: str | None


class ReactionModel(Answer):
    """The first-order model with dead time of the reaction curve, and how it was found."""

    K: float | None
    tau: float | None
    theta: float | None
    how: str


class TuneAnswer(Answer):
    """Settings by each rule and type, and the plant data they were computed from."""

    settings: list[RuleSettings]
    ultimate: Ultimate | None
    model: ReactionModel | None


class RuleFormula(Formula):
    """The settings of one type of controller from one kind of plant data."""

    kind: Kind
    type: TypeName


class RuleEntry(Answer):
    """One rule as the list has it."""

    id: str
    name: str
    family: str
    source: str
    validity: str
    needs: Literal["ultimate", "model"]
    form: Annotated[Literal["ideal", "series"], Field(description="The form that the source gives settings for.")]
    types: list[TypeName]
    formulas: list[RuleFormula]


class RuleList(Answer):
    """Every rule, in the order in which they are shown."""

    rules: list[RuleEntry]


class PIDSettings(TimeConstantGains):
    """A controller as the requests take it."""

    type: Literal["pid"]
    form: Literal["ideal", "series"]
    alpha: float


class Optimum(Answer):
    """The best settings within the limits; `value` is the criterion, of the exact response."""

    type: TypeName
    criterion: Criterion
    aim: Aim
    controller: PIDSettings
    value: float | None
    Ms: float
    Mt: float
    active: Annotated[list[str], Field(description="The limits that the loop lies on.")]
    edges: Annotated[list[str], Field(description="Settings that ended on the edge of what was searched.")]
    reasons: Reasons


class OptimalAnswer(Forms, Optimum):
    """The best settings within the limits, in all forms."""


class TradeOffPoint(Answer):
    """The best that can be had for one limit of Ms."""

    Ms_limit: float
    optimum: Optimum | None
    reason: str | None


class TradeOffAnswer(Answer):
    """The price of robustness, in increasing order of the limit."""

    points: list[TradeOffPoint]


class FormsAnswer(Forms):
    """One controller in ideal, series and parallel form, with its proportional band."""

    ideal: TimeConstantGains
    Tf: Annotated[float, Field(description="Filter time of the derivative, the same in all forms [time].")]
    proportional_band_pct: Annotated[
        float | None, Field(description="100/|Kc|, for a gain in percent of span per percent of span [%].")
    ]
    reasons: Reasons
