"""Chien-Hrones-Reswick settings: for a setpoint or a load step, without overshoot or with 20 % of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import Options, Rule, Settings, require_ratio

Aim = Literal["setpoint", "load"]
Overshoot = Literal[0, 20]
SMALLEST_RATIO, LARGEST_RATIO = 0.1, 1.0
SOURCE = (
    "K. L. Chien, J. A. Hrones, J. B. Reswick, Trans. ASME 74 (1952) 175-185; tables in K. J. Åström, "
    "T. Hägglund, PID Controllers, 2nd ed., ISA 1995, ch. 4"
)


@dataclass(frozen=True)
class _Row:
    """Kc K theta/tau, then tau_I and tau_D over ``unit`` and over theta."""

    gain: float
    integral: float | None = None
    derivative: float = 0.0
    unit: Literal["tau", "theta"] = "theta"


TABLE: dict[tuple[Aim, Overshoot], dict[str, _Row]] = {
    ("setpoint", 0): {"P": _Row(0.3), "PI": _Row(0.35, 1.2, unit="tau"), "PID": _Row(0.6, 1.0, 0.5, "tau")},
    ("setpoint", 20): {"P": _Row(0.7), "PI": _Row(0.6, 1.0, unit="tau"), "PID": _Row(0.95, 1.4, 0.47, "tau")},
    ("load", 0): {"P": _Row(0.3), "PI": _Row(0.6, 4.0), "PID": _Row(0.95, 2.4, 0.42)},
    ("load", 20): {"P": _Row(0.7), "PI": _Row(0.7, 2.3), "PID": _Row(1.2, 2.0, 0.42)},
}


def _latex(row: _Row) -> str:
    parts = [rf"K_c = {row.gain:g}\,\frac{{\tau}}{{K\theta}}"]
    if row.integral is not None:
        factor = "" if row.integral == 1 else rf"{row.integral:g}\,"
        parts.append(rf"\tau_I = {factor}\{row.unit}")
    if row.derivative:
        parts.append(rf"\tau_D = {row.derivative:g}\,\theta")
    return r", \quad ".join(parts)


def chien_hrones_reswick(model: FOPDT, type: str, aim: Aim, overshoot: Overshoot) -> Settings:
    r"""Settings for the quickest response with the given overshoot.

    .. math::

        K_c = a\,\frac{\tau}{K\theta}, \qquad \tau_I = b\,\tau \text{ (setpoint)},\ b\,\theta \text{ (load)}, \qquad
        \tau_D = c\,\theta

    Parameters
    ----------
    model : FOPDT
        0.1 <= theta/tau <= 1.
    type : {"P", "PI", "PID"}
    aim : {"setpoint", "load"}
    overshoot : {0, 20}
        [%]

    Returns
    -------
    Settings
        a, b and c are those of TABLE.

    Raises
    ------
    RuleNotApplicable
        theta/tau is outside its range, or the rule has no such type.

    References
    ----------
    .. [1] K. L. Chien, J. A. Hrones, J. B. Reswick, Trans. ASME 74 (1952) 175-185.
    .. [2] K. J. Åström, T. Hägglund, PID Controllers, 2nd ed., ISA 1995, ch. 4.
    """
    rule = next(r for r in RULES if r.id == f"chr_{aim}_{overshoot}")
    rule.kind(model, type)
    require_ratio(rule.name, model, SMALLEST_RATIO, LARGEST_RATIO)
    row = TABLE[aim, overshoot][type]
    unit = model.tau if row.unit == "tau" else model.theta
    tau_I = None if row.integral is None else row.integral * unit
    gain = row.gain * model.tau / (model.K * model.theta)
    return rule.settings(model, type, Gains(gain, tau_I, row.derivative * model.theta))


def _rule(aim: Aim, overshoot: Overshoot) -> Rule:
    def apply(model: FOPDT, type: str, options: Options) -> Settings:
        return chien_hrones_reswick(model, type, aim, overshoot)

    words = "no overshoot" if overshoot == 0 else "20 % overshoot"
    return Rule(
        id=f"chr_{aim}_{overshoot}",
        name=f"Chien–Hrones–Reswick ({aim}, {words})",
        family="From the reaction curve",
        source=SOURCE,
        validity=f"{SMALLEST_RATIO:g} <= theta/tau <= {LARGEST_RATIO:g}",
        formulas={"FOPDT": {type: _latex(row) for type, row in TABLE[aim, overshoot].items()}},
        apply=apply,
    )


RULES = tuple(_rule(aim, overshoot) for aim, overshoot in TABLE)
