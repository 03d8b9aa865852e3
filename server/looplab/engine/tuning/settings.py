"""What a tuning rule is, and what it returns: settings with their formula and source, or a refusal with its reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.integrating import DIPDT, IPDT
from looplab.engine.tuning.forms import Gains, series_to_ideal
from looplab.engine.tuning.ultimate_point import UltimatePoint

TypeName = Literal["P", "PI", "PD", "PID"]
Kind = Literal["ultimate", "FOPDT", "SOPDT", "IPDT", "DIPDT"]
PlantData = UltimatePoint | FOPDT | SOPDT | IPDT | DIPDT
TYPES: tuple[TypeName, ...] = ("P", "PI", "PD", "PID")

KINDS: dict[type, Kind] = {UltimatePoint: "ultimate", FOPDT: "FOPDT", SOPDT: "SOPDT", IPDT: "IPDT", DIPDT: "DIPDT"}
KIND_NAMES: dict[Kind, str] = {
    "ultimate": "an ultimate gain and period",
    "FOPDT": "a first-order model with dead time",
    "SOPDT": "a second-order model with dead time",
    "IPDT": "an integrating process",
    "DIPDT": "a double integrating process",
}


@dataclass(frozen=True)
class Options:
    """What the user may choose in some rules.

    Attributes
    ----------
    tau_c : float or None
        Closed-loop time constant of IMC, lambda tuning and SIMC, >= 0; None takes each rule's default [time].
    PM_deg : float
        Phase margin that the Åström-Hägglund rule aims at, between 0 and 90 [deg].
    """

    tau_c: float | None = None
    PM_deg: float = 45.0


DEFAULTS = Options()


@dataclass(frozen=True)
class Settings:
    """Settings of an ideal-form controller by one rule.

    Attributes
    ----------
    rule, name : str
        Identifier and full name of the rule.
    type : str
        P, PI, PD or PID.
    Kc : float
        [input/output]
    tau_I, tau_D : float or None
        None where the type has no such action [time].
    formula : str
        LaTeX of the formulas used.
    source : str
        Where the rule was published.
    published : Gains or None
        The series settings of the source, where it is written for that form.
    note : str or None
        What the user should know of these settings.
    alpha : float
        Derivative filter time over tau_D [-].
    """

    rule: str
    name: str
    type: str
    Kc: float
    tau_I: float | None
    tau_D: float | None
    formula: str
    source: str
    published: Gains | None = None
    note: str | None = None
    alpha: float = 0.1


@dataclass(frozen=True)
class Rule:
    """A tuning rule.

    Attributes
    ----------
    id, name : str
        Identifier and full name.
    family : str
        The group it is listed in.
    source : str
        Publication, with edition and place.
    validity : str
        Range outside of which it refuses, in words.
    formulas : dict
        LaTeX of the settings by kind of plant data, then by controller type.
    apply : callable
        (plant data, type, Options) -> Settings; raises RuleNotApplicable outside its range.
    reduction : {"reaction_curve", "half_rule"}
        How a plant is reduced to a model for it (of no account for the ultimate point).
    form : {"ideal", "series"}
        The form that the source gives settings for; what comes out is always ideal.
    """

    id: str
    name: str
    family: str
    source: str
    validity: str
    formulas: dict[Kind, dict[str, str]]
    apply: Callable[[Any, str, Options], Settings]
    reduction: Literal["reaction_curve", "half_rule"] = "reaction_curve"
    form: Literal["ideal", "series"] = "ideal"

    @property
    def needs(self) -> Literal["ultimate", "model"]:
        """Whether it starts from the ultimate point or from a model."""
        return "ultimate" if "ultimate" in self.formulas else "model"

    @property
    def types(self) -> tuple[TypeName, ...]:
        """The controller types it has settings for."""
        return tuple(t for t in TYPES if any(t in by_type for by_type in self.formulas.values()))

    def formula(self, type: str) -> str | None:
        """The formula to show where no model is at hand: that of the simplest kind that has one."""
        return next((by_type[type] for by_type in self.formulas.values() if type in by_type), None)

    def kind(self, data: PlantData, type: str) -> Kind:
        """The kind of the data, when the rule has settings of this type for it.

        Raises
        ------
        RuleNotApplicable
            It has not.
        """
        kind = KINDS[data.__class__]
        if kind in self.formulas and type in self.formulas[kind]:
            return kind
        if type not in self.types:
            raise RuleNotApplicable(
                f"{self.name} has no settings for {type}", field="types", hint=", ".join(self.types)
            )
        known = kind in self.formulas
        offered = " or ".join(KIND_NAMES[k] for k, by_type in self.formulas.items() if type in by_type or not known)
        what = f"its {type} settings are" if known else "it is"
        raise RuleNotApplicable(f"{what} made for {offered}, not for {KIND_NAMES[kind]}", field="plant")

    def settings(self, data: PlantData, type: str, gains: Gains, note: str | None = None) -> Settings:
        """Settings from what the source's formulas gave, in the ideal form."""
        formula = self.formulas[KINDS[data.__class__]][type]
        ideal, published = gains, None
        if self.form == "series" and gains.tau_D:
            ideal, published = series_to_ideal(gains), gains
        tau_D = ideal.tau_D if "D" in type else None
        return Settings(self.id, self.name, type, ideal.Kc, ideal.tau_I, tau_D, formula, self.source, published, note)


def require_dead_time(name: str, theta: float) -> None:
    """Refuse a model without dead time.

    Raises
    ------
    RuleNotApplicable
    """
    if theta == 0:
        raise RuleNotApplicable(
            f"{name} needs dead time: without it the gain would be infinite",
            field="theta",
            hint="a first-order plant without dead time takes any gain",
        )


def require_ratio(name: str, model: FOPDT, low: float, high: float) -> None:
    """Refuse a ratio theta/tau outside the range a rule was made for.

    Raises
    ------
    RuleNotApplicable
    """
    require_dead_time(name, model.theta)
    ratio = model.theta / model.tau
    # The ends belong to the range, whatever their rounding.
    if not low * (1 - 1e-9) <= ratio <= high * (1 + 1e-9):
        side = f"beyond {high:g}" if ratio > high else f"below {low:g}"
        raise RuleNotApplicable(
            f"theta/tau = {ratio:.3g} is {side}, where {name} is not trusted",
            field="theta",
            hint="use a rule made for long dead times" if ratio > high else "use a rule for lag-dominant plants",
        )


def closed_loop_time(options: Options, default: float, theta: float, advice: str) -> float:
    """The tau_c that the user chose, or the rule's default [time].

    Raises
    ------
    RuleNotApplicable
        The default is zero, or tau_c + theta is: the gain would be infinite.
    """
    tau_c = default if options.tau_c is None else options.tau_c
    if not (tau_c >= 0 and tau_c + theta > 0) or (options.tau_c is None and tau_c == 0):
        raise RuleNotApplicable(
            f"without dead time there is no default for tau_c ({advice}): the gain would be infinite",
            field="tau_c",
            hint="choose tau_c, the closed-loop time constant you want",
        )
    return tau_c
