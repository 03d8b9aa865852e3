"""AMIGO settings: approximations of the fastest PI and PID with Ms about 1.4."""

from __future__ import annotations

from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.systems.integrating import IPDT
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings, require_dead_time


def amigo(model: FOPDT | IPDT, type: str, options: Options = DEFAULTS) -> Settings:
    r"""Settings for load disturbances with a robustness of about Ms = Mt = 1.4.

    .. math::

        \text{PI:}\quad K_c = \frac{0.15}{K} + \left(0.35 - \frac{\theta\tau}{(\theta + \tau)^2}\right)
        \frac{\tau}{K\theta},\quad
        \tau_I = 0.35\,\theta + \frac{13\,\theta\tau^2}{\tau^2 + 12\,\theta\tau + 7\,\theta^2}

        \text{PID:}\quad K_c = \frac1K\left(0.2 + 0.45\,\frac\tau\theta\right),\quad
        \tau_I = \frac{0.4\,\theta + 0.8\,\tau}{\theta + 0.1\,\tau}\,\theta,\quad
        \tau_D = \frac{0.5\,\theta\tau}{0.3\,\theta + \tau}

    Parameters
    ----------
    model : FOPDT or IPDT
        theta > 0.
    type : {"PI", "PID"}
    options : Options
        None is used.

    Returns
    -------
    Settings

    Raises
    ------
    RuleNotApplicable
        theta is 0, or the rule has no such type.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, J. Process Control 14 (2004) 635-650.
    .. [2] K. J. Åström, T. Hägglund, Advanced PID Control, ISA 2006, p. 229 (PI) and eq. 7.7, p. 233 (PID).
    """
    RULE.kind(model, type)
    require_dead_time(RULE.name, model.theta)
    K, theta = model.K, model.theta
    if isinstance(model, IPDT):
        gains = Gains(0.35 / (K * theta), 13.4 * theta)
        if type == "PID":
            gains = Gains(0.45 / (K * theta), 8.0 * theta, 0.5 * theta)
        return RULE.settings(model, type, gains)
    tau = model.tau
    if type == "PI":
        gain = 0.15 + (0.35 - theta * tau / (theta + tau) ** 2) * tau / theta
        integral = 0.35 * theta + 13.0 * theta * tau**2 / (tau**2 + 12.0 * theta * tau + 7.0 * theta**2)
        return RULE.settings(model, type, Gains(gain / K, integral))
    integral = (0.4 * theta + 0.8 * tau) / (theta + 0.1 * tau) * theta
    gains = Gains((0.2 + 0.45 * tau / theta) / K, integral, 0.5 * theta * tau / (0.3 * theta + tau))
    return RULE.settings(model, type, gains)


RULE = Rule(
    id="amigo",
    name="AMIGO (Åström–Hägglund)",
    family="From the reaction curve",
    source="K. J. Åström, T. Hägglund, J. Process Control 14 (2004) 635-650; "
    "Advanced PID Control, ISA 2006, p. 229 (PI) and eq. 7.7, p. 233 (PID)",
    validity="any first-order or integrating model with dead time (its PID is conservative for theta/tau < 0.4)",
    formulas={
        "FOPDT": {
            "PI": r"K_c = \frac{0.15}{K} + \left(0.35 - \frac{\theta\tau}{(\theta+\tau)^2}\right)"
            r"\frac{\tau}{K\theta}, \quad \tau_I = 0.35\,\theta + "
            r"\frac{13\,\theta\tau^2}{\tau^2 + 12\,\theta\tau + 7\,\theta^2}",
            "PID": r"K_c = \frac{1}{K}\left(0.2 + 0.45\,\frac{\tau}{\theta}\right), \quad "
            r"\tau_I = \frac{0.4\,\theta + 0.8\,\tau}{\theta + 0.1\,\tau}\,\theta, \quad "
            r"\tau_D = \frac{0.5\,\theta\tau}{0.3\,\theta + \tau}",
        },
        "IPDT": {
            "PI": r"K_c = \frac{0.35}{K\theta}, \quad \tau_I = 13.4\,\theta",
            "PID": r"K_c = \frac{0.45}{K\theta}, \quad \tau_I = 8\,\theta, \quad \tau_D = 0.5\,\theta",
        },
    },
    apply=amigo,
)
