"""Lambda tuning: PI and PID whose closed loop has the time constant lambda (here tau_c), by default a robust one."""

from __future__ import annotations

from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.systems.integrating import IPDT
from looplab.engine.tuning.imc import FIRST_ORDER_FORMULAS, INTEGRATING_PI, first_order_gains, integrating_gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings, closed_loop_time

# Three times the open-loop time constant is the robust choice, the time constant itself the aggressive one.
PER_LAG = 3.0
PER_DEAD_TIME = 3.0


def lambda_tuning(model: FOPDT | IPDT, type: str, options: Options = DEFAULTS) -> Settings:
    r"""Settings that cancel the lag and place the closed-loop pole at -1/tau_c.

    .. math::

        \text{PI:}\ K_c = \frac{\tau}{K(\tau_c + \theta)},\ \tau_I = \tau \qquad
        \text{PID:}\ K_c = \frac{\tau + \theta/2}{K(\tau_c + \theta/2)},\ \tau_I = \tau + \frac\theta2,\
        \tau_D = \frac{\tau\theta}{2\tau + \theta}

    Parameters
    ----------
    model : FOPDT or IPDT
    type : {"PI", "PID"}
        PI only for an integrating process.
    options : Options
        tau_c = lambda; by default 3 tau, for an integrating process 3 theta.

    Returns
    -------
    Settings

    Raises
    ------
    RuleNotApplicable
        The rule has no such type for the model, or there is no default for tau_c.

    References
    ----------
    .. [1] E. B. Dahlin, Instruments and Control Systems 41(6) (1968) 77-83.
    .. [2] K. J. Åström, T. Hägglund, Advanced PID Control, ISA 2006, ch. 6.
    """
    RULE.kind(model, type)
    if isinstance(model, IPDT):
        tau_c = closed_loop_time(options, PER_DEAD_TIME * model.theta, model.theta, "3 theta")
        gains = integrating_gains(model, type, tau_c)
    else:
        tau_c = closed_loop_time(options, PER_LAG * model.tau, model.theta, "3 tau")
        gains = first_order_gains(model, type, tau_c)
    return RULE.settings(model, type, gains, f"with lambda = {tau_c:.4g}")


RULE = Rule(
    id="lambda_tuning",
    name="Lambda tuning",
    family="From a model, with a closed-loop time constant",
    source="E. B. Dahlin, Instruments and Control Systems 41(6) (1968) 77-83; "
    "K. J. Åström, T. Hägglund, Advanced PID Control, ISA 2006, ch. 6",
    validity="any first-order or integrating model; lambda (tau_c) is 3 tau unless chosen (integrating: 3 theta)",
    formulas={"FOPDT": FIRST_ORDER_FORMULAS, "IPDT": {"PI": INTEGRATING_PI}},
    apply=lambda_tuning,
)
