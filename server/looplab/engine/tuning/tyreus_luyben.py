"""Tyreus-Luyben settings from the ultimate cycle: calmer than Ziegler-Nichols, made for lag-dominant plants."""

from __future__ import annotations

from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings
from looplab.engine.tuning.ultimate_point import UltimatePoint


def tyreus_luyben(point: UltimatePoint, type: str, options: Options = DEFAULTS) -> Settings:
    r"""Settings from the ultimate gain and period.

    .. math::

        \text{PI:}\quad K_c = \frac{K_u}{3.2},\ \tau_I = 2.2\,P_u \qquad
        \text{PID:}\quad K_c = \frac{K_u}{2.2},\ \tau_I = 2.2\,P_u,\ \tau_D = \frac{P_u}{6.3}

    Parameters
    ----------
    point : UltimatePoint
    type : {"PI", "PID"}
    options : Options
        None is used.

    Returns
    -------
    Settings

    Raises
    ------
    RuleNotApplicable
        The rule has no such type.

    References
    ----------
    .. [1] B. D. Tyreus, W. L. Luyben, Ind. Eng. Chem. Res. 31 (1992) 2625-2628 (PI).
    .. [2] W. L. Luyben, M. L. Luyben, Essentials of Process Control, McGraw-Hill 1997 (PID).
    """
    RULE.kind(point, type)
    Ku, Pu = point.Ku, point.Pu
    gains = Gains(Ku / 3.2, 2.2 * Pu) if type == "PI" else Gains(Ku / 2.2, 2.2 * Pu, Pu / 6.3)
    return RULE.settings(point, type, gains)


RULE = Rule(
    id="tyreus_luyben",
    name="Tyreus–Luyben",
    family="From the ultimate cycle",
    source="B. D. Tyreus, W. L. Luyben, Ind. Eng. Chem. Res. 31 (1992) 2625-2628; "
    "PID: W. L. Luyben, M. L. Luyben, Essentials of Process Control, McGraw-Hill 1997",
    validity="any plant with an ultimate gain that is stable below it; sluggish where dead time dominates",
    formulas={
        "ultimate": {
            "PI": r"K_c = K_u/3.2, \quad \tau_I = 2.2\,P_u",
            "PID": r"K_c = K_u/2.2, \quad \tau_I = 2.2\,P_u, \quad \tau_D = P_u/6.3",
        }
    },
    apply=tyreus_luyben,
)
