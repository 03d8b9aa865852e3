"""Ziegler-Nichols settings from the ultimate cycle."""

from __future__ import annotations

from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings
from looplab.engine.tuning.ultimate_point import UltimatePoint

# Kc/Ku, tau_I/Pu, tau_D/Pu
TABLE = {"P": (0.5, None, None), "PI": (0.45, 1 / 1.2, None), "PID": (0.6, 0.5, 0.125)}


def _apply(point: UltimatePoint, type: str, options: Options) -> Settings:
    RULE.kind(point, type)
    k, i, d = TABLE[type]
    return RULE.settings(point, type, Gains(k * point.Ku, i * point.Pu if i else None, d * point.Pu if d else 0.0))


RULE = Rule(
    id="ziegler_nichols",
    name="Ziegler–Nichols (ultimate cycle)",
    family="From the ultimate cycle",
    source="J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768",
    validity="any plant with an ultimate gain that is stable below it",
    formulas={
        "ultimate": {
            "P": r"K_c = 0.5\,K_u",
            "PI": r"K_c = 0.45\,K_u, \quad \tau_I = P_u/1.2",
            "PID": r"K_c = 0.6\,K_u, \quad \tau_I = P_u/2, \quad \tau_D = P_u/8",
        }
    },
    apply=_apply,
)


def ziegler_nichols_ultimate(Ku: float, Pu: float, type: str) -> Settings:
    r"""Settings for quarter-decay from the ultimate gain and period.

    .. math:: K_c = 0.6 K_u,\quad \tau_I = P_u/2,\quad \tau_D = P_u/8 \qquad\text{(PID)}

    Parameters
    ----------
    Ku : float
        Ultimate gain, not zero [input/output].
    Pu : float
        Ultimate period, > 0 [time].
    type : {"P", "PI", "PID"}

    Returns
    -------
    Settings
        For the ideal form.

    Raises
    ------
    InvalidInput
        Ku is zero or Pu not positive.
    RuleNotApplicable
        The rule has no such type.

    References
    ----------
    .. [1] J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768.
    """
    return _apply(UltimatePoint.of(Ku, Pu), type, DEFAULTS)
