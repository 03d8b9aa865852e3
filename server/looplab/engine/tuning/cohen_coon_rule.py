"""Cohen-Coon settings from a first-order model with dead time."""

from __future__ import annotations

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.tuning.settings import TYPES, Settings

RULE, NAME = "cohen_coon", "Cohen–Coon (process reaction curve)"
SOURCE = "G. H. Cohen, G. A. Coon, Trans. ASME 75 (1953) 827-834"
LARGEST_RATIO = 4.0
FORMULAS = {
    "P": r"K_c = \frac{\tau}{K\theta}\left(1 + \frac{\theta}{3\tau}\right)",
    "PI": r"K_c = \frac{\tau}{K\theta}\left(0.9 + \frac{\theta}{12\tau}\right), \quad "
    r"\tau_I = \theta\,\frac{30\tau + 3\theta}{9\tau + 20\theta}",
    "PID": r"K_c = \frac{\tau}{K\theta}\left(\frac{4}{3} + \frac{\theta}{4\tau}\right), \quad "
    r"\tau_I = \theta\,\frac{32\tau + 6\theta}{13\tau + 8\theta}, \quad \tau_D = \frac{4\tau\theta}{11\tau + 2\theta}",
}


def cohen_coon(model: FOPDT, type: str) -> Settings:
    r"""Settings for quarter-decay whose dependence on theta/tau is weakened.

    .. math::

        \text{PID:}\quad K_c = \frac{\tau}{K\theta}\left(\frac43 + \frac{\theta}{4\tau}\right),\quad
        \tau_I = \theta\frac{32\tau + 6\theta}{13\tau + 8\theta},\quad
        \tau_D = \frac{4\tau\theta}{11\tau + 2\theta}

    Parameters
    ----------
    model : FOPDT
        K [output/input], tau [time], theta > 0 [time].
    type : {"P", "PI", "PID"}

    Returns
    -------
    Settings
        For the ideal form.

    Raises
    ------
    RuleNotApplicable
        theta is 0 (the gain would be infinite) or exceeds 4 tau, or the rule has no such type.

    References
    ----------
    .. [1] G. H. Cohen, G. A. Coon, Trans. ASME 75 (1953) 827-834.
    """
    if type not in TYPES:
        raise RuleNotApplicable(f"Cohen-Coon has no settings for {type} here", field="types", hint="P, PI or PID")
    K, tau, theta = model.K, model.tau, model.theta
    if theta == 0:
        raise RuleNotApplicable(
            "Cohen-Coon needs dead time: without it the gain would be infinite",
            field="theta",
            hint="a first-order plant without dead time takes any gain",
        )
    if theta > LARGEST_RATIO * tau:
        raise RuleNotApplicable(
            f"theta/tau = {theta / tau:.3g} is beyond {LARGEST_RATIO:g}, where Cohen-Coon is not trusted",
            field="theta",
            hint="for long dead times use a rule made for them",
        )
    ratio = theta / tau
    Kc, tau_I, tau_D = 1.0 + ratio / 3.0, None, None
    if type == "PI":
        Kc, tau_I = 0.9 + ratio / 12.0, theta * (30 * tau + 3 * theta) / (9 * tau + 20 * theta)
    if type == "PID":
        Kc = 4.0 / 3.0 + ratio / 4.0
        tau_I = theta * (32 * tau + 6 * theta) / (13 * tau + 8 * theta)
        tau_D = 4 * tau * theta / (11 * tau + 2 * theta)
    return Settings(RULE, NAME, type, tau / (K * theta) * Kc, tau_I, tau_D, FORMULAS[type], SOURCE)
