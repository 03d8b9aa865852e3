"""Ziegler-Nichols settings from the process reaction curve."""

from __future__ import annotations

from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.systems.integrating import IPDT
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings, require_dead_time, require_ratio

LARGEST_RATIO = 1.0
# Kc R theta, tau_I/theta, tau_D/theta, with R the slope of the reaction curve
TABLE = {"P": (1.0, None, None), "PI": (0.9, 1 / 0.3, None), "PID": (1.2, 2.0, 0.5)}


def ziegler_nichols_reaction(model: FOPDT | IPDT, type: str, options: Options = DEFAULTS) -> Settings:
    r"""Settings for quarter-decay from the slope R and the dead time of the reaction curve.

    .. math::

        \text{PID:}\quad K_c = \frac{1.2}{R\,\theta},\quad \tau_I = 2\,\theta,\quad \tau_D = 0.5\,\theta, \qquad
        R = \frac{K}{\tau} \text{ (FOPDT)},\ K \text{ (integrating)}

    Parameters
    ----------
    model : FOPDT or IPDT
        theta > 0.
    type : {"P", "PI", "PID"}
    options : Options
        None is used.

    Returns
    -------
    Settings

    Raises
    ------
    RuleNotApplicable
        theta is 0 or exceeds tau, or the rule has no such type.

    References
    ----------
    .. [1] J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768.
    .. [2] A. O'Dwyer, Handbook of PI and PID Controller Tuning Rules, 3rd ed., Imperial College Press 2009 (range).
    """
    RULE.kind(model, type)
    if isinstance(model, FOPDT):
        require_ratio(RULE.name, model, 0.0, LARGEST_RATIO)
        slope = model.K / model.tau
    else:
        require_dead_time(RULE.name, model.theta)
        slope = model.K
    k, i, d = TABLE[type]
    theta = model.theta
    return RULE.settings(model, type, Gains(k / (slope * theta), i * theta if i else None, d * theta if d else 0.0))


RULE = Rule(
    id="ziegler_nichols_reaction",
    name="Ziegler–Nichols (reaction curve)",
    family="From the reaction curve",
    source="J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768",
    validity="0 < theta/tau <= 1, or an integrating process with dead time",
    formulas={
        "FOPDT": {
            "P": r"K_c = \frac{\tau}{K\theta}",
            "PI": r"K_c = \frac{0.9\,\tau}{K\theta}, \quad \tau_I = \theta/0.3",
            "PID": r"K_c = \frac{1.2\,\tau}{K\theta}, \quad \tau_I = 2\,\theta, \quad \tau_D = 0.5\,\theta",
        },
        "IPDT": {
            "P": r"K_c = \frac{1}{K\theta}",
            "PI": r"K_c = \frac{0.9}{K\theta}, \quad \tau_I = \theta/0.3",
            "PID": r"K_c = \frac{1.2}{K\theta}, \quad \tau_I = 2\,\theta, \quad \tau_D = 0.5\,\theta",
        },
    },
    apply=ziegler_nichols_reaction,
)
