"""The answer of POST /tune."""

from __future__ import annotations

from typing import Literal

from looplab.api.answers.base import Answer


class Formula(Answer):
    """A formula as LaTeX and MathML."""

    latex: str
    mathml: str


class RuleSettings(Answer):
    """Settings of an ideal-form controller by one rule; all null where the rule refuses, with the reason."""

    rule: str
    name: str
    type: Literal["P", "PI", "PID"]
    Kc: float | None
    tau_I: float | None
    tau_D: float | None
    alpha: float
    valid: bool
    reason: str | None
    formula: Formula
    source: str


class Ultimate(Answer):
    """Ultimate gain and period; null with a reason where the plant has none."""

    Ku: float | None
    Pu: float | None
    omega_180: float | None
    reason: str | None


class ReactionModel(Answer):
    """The first-order model with dead time that was used, and how it was found."""

    K: float | None
    tau: float | None
    theta: float | None
    how: str


class TuneAnswer(Answer):
    """Settings by each rule and type, and the plant data they were computed from."""

    settings: list[RuleSettings]
    ultimate: Ultimate | None
    model: ReactionModel | None
