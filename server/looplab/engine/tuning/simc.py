"""Skogestad's SIMC settings: tau_c is the only choice, and the dead time is the tight one."""

from __future__ import annotations

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.low_order.models import real_lags
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.integrating import DIPDT, IPDT
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings, closed_loop_time


def simc(model: FOPDT | SOPDT | IPDT | DIPDT, type: str, options: Options = DEFAULTS) -> Settings:
    r"""Settings of the series form from a model by the half rule.

    .. math::

        K_c = \frac{\tau_1}{K(\tau_c + \theta)}, \qquad \tau_I = \min\{\tau_1,\ 4(\tau_c + \theta)\}, \qquad
        \tau_D = \tau_2

    Parameters
    ----------
    model : FOPDT, SOPDT, IPDT or DIPDT
        For PI a first-order (or integrating) one, for PID a second-order one with real lags, an integrating one with
        a lag, or a double integrating one.
    type : {"PI", "PID"}
    options : Options
        tau_c; by default theta ("tight" control).

    Returns
    -------
    Settings
        PID converted from the series form of the source.

    Raises
    ------
    RuleNotApplicable
        The model is not the one that the type needs, or there is no default for tau_c.

    References
    ----------
    .. [1] S. Skogestad, J. Process Control 13 (2003) 291-309, eqs. 23-25 and Table 1.
    """
    RULE.kind(model, type)
    K, theta = model.K, model.theta
    tau_c = closed_loop_time(options, theta, theta, "theta")
    slow = 4.0 * (tau_c + theta)
    if isinstance(model, DIPDT):
        gains = Gains(1.0 / (K * slow * (tau_c + theta)), slow, slow)
    elif isinstance(model, IPDT):
        if type == "PID" and not model.tau:
            raise RuleNotApplicable(
                f"{RULE.name} gives derivative action only where there is a second lag to counteract",
                field="plant",
                hint="use its PI settings",
            )
        gains = Gains(1.0 / (K * (tau_c + theta)), slow, model.tau if type == "PID" else 0.0)
    elif isinstance(model, SOPDT):
        lags = real_lags(model)
        if lags is None:
            raise RuleNotApplicable(f"{RULE.name} is for two real lags: this model oscillates", field="zeta")
        gains = Gains(lags[0] / (K * (tau_c + theta)), min(lags[0], slow), lags[1])
    else:
        gains = Gains(model.tau / (K * (tau_c + theta)), min(model.tau, slow))
    return RULE.settings(model, type, gains, f"with tau_c = {tau_c:.4g}")


RULE = Rule(
    id="simc",
    name="SIMC (Skogestad)",
    family="From a model, with a closed-loop time constant",
    source="S. Skogestad, J. Process Control 13 (2003) 291-309, eqs. 23-25 and Table 1",
    validity="stable plants with real lags and integrating plants, by the half rule; tau_c = theta unless chosen",
    formulas={
        "FOPDT": {
            "PI": r"K_c = \frac{\tau_1}{K(\tau_c + \theta)}, \quad \tau_I = \min\{\tau_1, 4(\tau_c + \theta)\}",
        },
        "SOPDT": {
            "PID": r"K_c' = \frac{\tau_1}{K(\tau_c + \theta)}, \quad \tau_I' = \min\{\tau_1, 4(\tau_c + \theta)\}, "
            r"\quad \tau_D' = \tau_2",
        },
        "IPDT": {
            "PI": r"K_c = \frac{1}{K(\tau_c + \theta)}, \quad \tau_I = 4(\tau_c + \theta)",
            "PID": r"K_c' = \frac{1}{K(\tau_c + \theta)}, \quad \tau_I' = 4(\tau_c + \theta), \quad \tau_D' = \tau_2",
        },
        "DIPDT": {
            "PID": r"K_c' = \frac{1}{4K(\tau_c + \theta)^2}, \quad \tau_I' = \tau_D' = 4(\tau_c + \theta)",
        },
    },
    apply=simc,
    reduction="half_rule",
    form="series",
)
