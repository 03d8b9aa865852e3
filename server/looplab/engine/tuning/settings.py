"""What every tuning rule returns: settings with their formula and source, or a refusal with its reason."""

from __future__ import annotations

from dataclasses import dataclass

TYPES = ("P", "PI", "PID")


@dataclass(frozen=True)
class Settings:
    """Settings of an ideal-form controller by one rule.

    Attributes
    ----------
    rule, name : str
        Identifier and full name of the rule.
    type : str
        P, PI or PID.
    Kc : float
        [input/output]
    tau_I, tau_D : float or None
        None where the type has no such action [time].
    alpha : float
        Derivative filter time over tau_D [-].
    formula : str
        LaTeX of the formulas used.
    source : str
        Where the rule was published.
    """

    rule: str
    name: str
    type: str
    Kc: float
    tau_I: float | None
    tau_D: float | None
    formula: str
    source: str
    alpha: float = 0.1
