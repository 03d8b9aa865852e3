"""Cohen-Coon settings from a first-order model with dead time."""

from __future__ import annotations

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings, require_ratio

LARGEST_RATIO = 4.0
# From here on the derivative time of the PD controller is not positive.
LARGEST_PD_RATIO = 3.0


def cohen_coon(model: FOPDT, type: str, options: Options = DEFAULTS) -> Settings:
    r"""Settings for quarter-decay whose dependence on theta/tau is weakened.

    .. math::

        \text{PID:}\quad K_c = \frac{\tau}{K\theta}\left(\frac43 + \frac{\theta}{4\tau}\right),\quad
        \tau_I = \theta\frac{32\tau + 6\theta}{13\tau + 8\theta},\quad
        \tau_D = \frac{4\tau\theta}{11\tau + 2\theta}

    Parameters
    ----------
    model : FOPDT
        K [output/input], tau [time], theta > 0 [time].
    type : {"P", "PI", "PD", "PID"}
    options : Options
        None is used.

    Returns
    -------
    Settings
        For the ideal form.

    Raises
    ------
    RuleNotApplicable
        theta is 0 (the gain would be infinite) or exceeds 4 tau (3 tau for PD), or the rule has no such type.

    References
    ----------
    .. [1] G. H. Cohen, G. A. Coon, Trans. ASME 75 (1953) 827-834.
    .. [2] D. R. Coughanowr, Process Systems Analysis and Control, 2nd ed., McGraw-Hill 1991, ch. 19.
    """
    RULE.kind(model, type)
    require_ratio(RULE.name, model, 0.0, LARGEST_RATIO)
    K, tau, theta = model.K, model.tau, model.theta
    ratio = theta / tau
    base = tau / (K * theta)
    if type == "P":
        gains = Gains(base * (1.0 + ratio / 3.0))
    elif type == "PI":
        gains = Gains(base * (0.9 + ratio / 12.0), theta * (30 * tau + 3 * theta) / (9 * tau + 20 * theta))
    elif type == "PD":
        if ratio >= LARGEST_PD_RATIO:
            raise RuleNotApplicable(
                f"theta/tau = {ratio:.3g} is beyond {LARGEST_PD_RATIO:g}: the derivative time would not be positive",
                field="theta",
            )
        gains = Gains(base * (1.25 + ratio / 6.0), None, theta * (6 * tau - 2 * theta) / (22 * tau + 3 * theta))
    else:
        gains = Gains(
            base * (4.0 / 3.0 + ratio / 4.0),
            theta * (32 * tau + 6 * theta) / (13 * tau + 8 * theta),
            4 * tau * theta / (11 * tau + 2 * theta),
        )
    return RULE.settings(model, type, gains)


RULE = Rule(
    id="cohen_coon",
    name="Cohen–Coon (reaction curve)",
    family="From the reaction curve",
    source="G. H. Cohen, G. A. Coon, Trans. ASME 75 (1953) 827-834",
    validity="0 < theta/tau <= 4 (PD: below 3)",
    formulas={
        "FOPDT": {
            "P": r"K_c = \frac{\tau}{K\theta}\left(1 + \frac{\theta}{3\tau}\right)",
            "PI": r"K_c = \frac{\tau}{K\theta}\left(0.9 + \frac{\theta}{12\tau}\right), \quad "
            r"\tau_I = \theta\,\frac{30\tau + 3\theta}{9\tau + 20\theta}",
            "PD": r"K_c = \frac{\tau}{K\theta}\left(\frac{5}{4} + \frac{\theta}{6\tau}\right), \quad "
            r"\tau_D = \theta\,\frac{6\tau - 2\theta}{22\tau + 3\theta}",
            "PID": r"K_c = \frac{\tau}{K\theta}\left(\frac{4}{3} + \frac{\theta}{4\tau}\right), \quad "
            r"\tau_I = \theta\,\frac{32\tau + 6\theta}{13\tau + 8\theta}, \quad "
            r"\tau_D = \frac{4\tau\theta}{11\tau + 2\theta}",
        }
    },
    apply=cohen_coon,
)
