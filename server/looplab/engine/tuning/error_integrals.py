"""Settings that minimise an integral of the error, by correlations: IAE, ISE, ITAE, for a load or a setpoint step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import Options, Rule, Settings, require_ratio

Criterion = Literal["IAE", "ISE", "ITAE"]
Aim = Literal["load", "setpoint"]
SMALLEST_RATIO, LARGEST_RATIO = 0.1, 1.0
LOAD_SOURCE = (
    "A. M. Lopez, J. A. Miller, C. L. Smith, P. W. Murrill, Instrumentation Technology 14(11) (1967) 57-62; "
    "C. A. Smith, A. B. Corripio, Principles and Practice of Automatic Process Control, 3rd ed., Wiley 2006, ch. 7"
)
SETPOINT_SOURCE = (
    "A. A. Rovira, P. W. Murrill, C. L. Smith, Instruments and Control Systems 42(12) (1969) 67-69; "
    "C. A. Smith, A. B. Corripio, Principles and Practice of Automatic Process Control, 3rd ed., Wiley 2006, ch. 7"
)


@dataclass(frozen=True)
class _Row:
    """A and B of each part: K Kc = A r^B, tau/tau_I = A r^B (load) or A + B r (setpoint), tau_D/tau = A r^B."""

    gain: tuple[float, float]
    integral: tuple[float, float] | None = None
    derivative: tuple[float, float] | None = None


TABLE: dict[tuple[Aim, Criterion], dict[str, _Row]] = {
    ("load", "IAE"): {
        "P": _Row((0.902, -0.985)),
        "PI": _Row((0.984, -0.986), (0.608, -0.707)),
        "PID": _Row((1.435, -0.921), (0.878, -0.749), (0.482, 1.137)),
    },
    ("load", "ISE"): {
        "P": _Row((1.411, -0.917)),
        "PI": _Row((1.305, -0.959), (0.492, -0.739)),
        "PID": _Row((1.495, -0.945), (1.101, -0.771), (0.560, 1.006)),
    },
    ("load", "ITAE"): {
        "P": _Row((0.490, -1.084)),
        "PI": _Row((0.859, -0.977), (0.674, -0.680)),
        "PID": _Row((1.357, -0.947), (0.842, -0.738), (0.381, 0.995)),
    },
    ("setpoint", "IAE"): {
        "PI": _Row((0.758, -0.861), (1.02, -0.323)),
        "PID": _Row((1.086, -0.869), (0.740, -0.130), (0.348, 0.914)),
    },
    ("setpoint", "ITAE"): {
        "PI": _Row((0.586, -0.916), (1.03, -0.165)),
        "PID": _Row((0.965, -0.85), (0.796, -0.1465), (0.308, 0.929)),
    },
}


def _latex(row: _Row, aim: Aim) -> str:
    def power(a: float, b: float) -> str:
        return rf"{a:g}\,(\theta/\tau)^{{{b:g}}}"

    parts = [rf"K K_c = {power(*row.gain)}"]
    if row.integral:
        a, b = row.integral
        straight = rf"{a:g} - {-b:g}\,\theta/\tau"
        parts.append(rf"\tau/\tau_I = {power(a, b) if aim == 'load' else straight}")
    if row.derivative:
        parts.append(rf"\tau_D/\tau = {power(*row.derivative)}")
    return r", \quad ".join(parts)


def minimum_error(model: FOPDT, type: str, aim: Aim, criterion: Criterion) -> Settings:
    r"""Settings by the correlations for one criterion and one disturbance.

    .. math::

        K K_c = A\left(\frac\theta\tau\right)^B, \qquad
        \frac{\tau}{\tau_I} = A\left(\frac\theta\tau\right)^B \text{ (load)},\ A + B\,\frac\theta\tau
        \text{ (setpoint)}, \qquad \frac{\tau_D}{\tau} = A\left(\frac\theta\tau\right)^B

    Parameters
    ----------
    model : FOPDT
        0.1 <= theta/tau <= 1.
    type : {"P", "PI", "PID"}
        No P for a setpoint step.
    aim : {"load", "setpoint"}
    criterion : {"IAE", "ISE", "ITAE"}
        No ISE for a setpoint step.

    Returns
    -------
    Settings
        A and B are those of TABLE. The correlations were fitted to an ideal PID without a derivative filter.

    Raises
    ------
    RuleNotApplicable
        theta/tau is outside its range, or the rule has no such type.

    References
    ----------
    .. [1] A. M. Lopez et al., Instrumentation Technology 14(11) (1967) 57-62.
    .. [2] A. A. Rovira et al., Instruments and Control Systems 42(12) (1969) 67-69.
    .. [3] C. A. Smith, A. B. Corripio, Principles and Practice of Automatic Process Control, 3rd ed., Wiley 2006.
    .. [4] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, Table 12.3 (ITAE).
    """
    rule = next(r for r in RULES if r.id == f"{criterion.lower()}_{aim}")
    rule.kind(model, type)
    require_ratio(rule.name, model, SMALLEST_RATIO, LARGEST_RATIO)
    row, ratio, tau = TABLE[aim, criterion][type], model.theta / model.tau, model.tau
    gain = row.gain[0] * ratio ** row.gain[1] / model.K
    tau_I = None
    if row.integral:
        a, b = row.integral
        tau_I = tau / (a * ratio**b if aim == "load" else a + b * ratio)
    tau_D = tau * row.derivative[0] * ratio ** row.derivative[1] if row.derivative else 0.0
    return rule.settings(model, type, Gains(gain, tau_I, tau_D))


def _rule(aim: Aim, criterion: Criterion) -> Rule:
    def apply(model: FOPDT, type: str, options: Options) -> Settings:
        return minimum_error(model, type, aim, criterion)

    return Rule(
        id=f"{criterion.lower()}_{aim}",
        name=f"Minimum {criterion} ({aim})",
        family="Minimum error, by correlations",
        source=LOAD_SOURCE if aim == "load" else SETPOINT_SOURCE,
        validity=f"{SMALLEST_RATIO:g} <= theta/tau <= {LARGEST_RATIO:g}",
        formulas={"FOPDT": {type: _latex(row, aim) for type, row in TABLE[aim, criterion].items()}},
        apply=apply,
    )


RULES = tuple(_rule(aim, criterion) for aim, criterion in TABLE)
