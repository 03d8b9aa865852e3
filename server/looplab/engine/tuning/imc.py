"""Internal model control (IMC) settings: the closed loop is given a time constant tau_c."""

from __future__ import annotations

from math import sqrt

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.integrating import IPDT
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings, closed_loop_time

# Rivera et al.: tau_c > 0.8 theta and tau_c > 0.1 tau.
PER_DEAD_TIME, PER_LAG = 0.8, 0.1
# Chien and Fruehauf, for integrating processes.
PER_DEAD_TIME_INTEGRATING = sqrt(10.0)


def imc(model: FOPDT | SOPDT | IPDT, type: str, options: Options = DEFAULTS) -> Settings:
    r"""Settings that make the setpoint response a lag tau_c behind the dead time.

    .. math::

        \text{PI:}\ K_c = \frac{\tau}{K(\tau_c + \theta)},\ \tau_I = \tau \qquad
        \text{PID:}\ K_c = \frac{\tau + \theta/2}{K(\tau_c + \theta/2)},\ \tau_I = \tau + \theta/2,\
        \tau_D = \frac{\tau\theta}{2\tau + \theta}

    Parameters
    ----------
    model : FOPDT, SOPDT or IPDT
        An integrating process without a lag.
    type : {"PI", "PID"}
    options : Options
        tau_c; by default the larger of 0.8 theta and 0.1 tau, for an integrating process sqrt(10) theta.

    Returns
    -------
    Settings

    Raises
    ------
    RuleNotApplicable
        The rule has no such type for the model, or there is no default for tau_c.

    References
    ----------
    .. [1] D. E. Rivera, M. Morari, S. Skogestad, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 252-265.
    .. [2] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, Table 12.1 (cases G to N).
    .. [3] I.-L. Chien, P. S. Fruehauf, Chem. Eng. Prog. 86(10) (1990) 33-41.
    """
    RULE.kind(model, type)
    K, theta = model.K, model.theta
    if isinstance(model, IPDT):
        tau_c = closed_loop_time(options, PER_DEAD_TIME_INTEGRATING * theta, theta, "sqrt(10) theta")
        gains = integrating_gains(model, type, tau_c)
    else:
        tau_c = closed_loop_time(options, max(PER_DEAD_TIME * theta, PER_LAG * model.tau), theta, "0.1 tau")
        if isinstance(model, SOPDT):
            if model.zeta <= 0:
                raise RuleNotApplicable(f"{RULE.name} is for a damped model, zeta > 0", field="zeta")
            lead = 2.0 * model.zeta * model.tau
            gains = Gains(lead / (K * (tau_c + theta)), lead, model.tau / (2.0 * model.zeta))
        else:
            gains = first_order_gains(model, type, tau_c)
    return RULE.settings(model, type, gains, f"with tau_c = {tau_c:.4g}")


def first_order_gains(model: FOPDT, type: str, tau_c: float) -> Gains:
    """PI or PID that cancels the lag and leaves a loop with the time constant tau_c."""
    K, tau, theta = model.K, model.tau, model.theta
    if type == "PI":
        return Gains(tau / (K * (tau_c + theta)), tau)
    lead = tau + 0.5 * theta
    return Gains(lead / (K * (tau_c + 0.5 * theta)), lead, tau * theta / (2.0 * tau + theta))


def integrating_gains(model: IPDT, type: str, tau_c: float) -> Gains:
    """PI or PID of an integrating process, with or without a lag."""
    K, theta = model.K, model.theta
    if model.tau and type == "PID":
        lead = 2.0 * tau_c + model.tau + theta
        return Gains(lead / (K * (tau_c + theta) ** 2), lead, (2.0 * tau_c + theta) * model.tau / lead)
    lead = 2.0 * tau_c + theta
    if type == "PI":
        return Gains(lead / (K * (tau_c + theta) ** 2), lead)
    return Gains(lead / (K * (tau_c + 0.5 * theta) ** 2), lead, (tau_c * theta + 0.25 * theta**2) / lead)


FIRST_ORDER_FORMULAS = {
    "PI": r"K_c = \frac{\tau}{K(\tau_c + \theta)}, \quad \tau_I = \tau",
    "PID": r"K_c = \frac{\tau + \theta/2}{K(\tau_c + \theta/2)}, \quad \tau_I = \tau + \theta/2, \quad "
    r"\tau_D = \frac{\tau\theta}{2\tau + \theta}",
}
INTEGRATING_PI = r"K_c = \frac{2\tau_c + \theta}{K(\tau_c + \theta)^2}, \quad \tau_I = 2\tau_c + \theta"
RULE = Rule(
    id="imc",
    name="IMC (internal model control)",
    family="From a model, with a closed-loop time constant",
    source="D. E. Rivera, M. Morari, S. Skogestad, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 252-265; "
    "D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, Table 12.1",
    validity="any first- or second-order or integrating model; tau_c is the larger of 0.8 theta and 0.1 tau unless "
    "chosen (integrating: sqrt(10) theta)",
    formulas={
        "FOPDT": FIRST_ORDER_FORMULAS,
        "SOPDT": {
            "PID": r"K_c = \frac{2\zeta\tau}{K(\tau_c + \theta)}, \quad \tau_I = 2\zeta\tau, \quad "
            r"\tau_D = \frac{\tau}{2\zeta}",
        },
        "IPDT": {
            "PI": INTEGRATING_PI,
            "PID": r"K_c = \frac{2\tau_c + \theta}{K(\tau_c + \theta/2)^2}, \quad \tau_I = 2\tau_c + \theta, \quad "
            r"\tau_D = \frac{\tau_c\theta + \theta^2/4}{2\tau_c + \theta}",
        },
    },
    apply=imc,
)
