"""Ziegler-Nichols settings from the ultimate cycle."""

from __future__ import annotations

from math import isfinite

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.tuning.settings import TYPES, Settings

RULE, NAME = "ziegler_nichols", "Ziegler–Nichols (ultimate cycle)"
SOURCE = "J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768"
# Kc/Ku, tau_I/Pu, tau_D/Pu
TABLE = {"P": (0.5, None, None), "PI": (0.45, 1 / 1.2, None), "PID": (0.6, 0.5, 0.125)}
FORMULAS = {
    "P": r"K_c = 0.5\,K_u",
    "PI": r"K_c = 0.45\,K_u, \quad \tau_I = P_u/1.2",
    "PID": r"K_c = 0.6\,K_u, \quad \tau_I = P_u/2, \quad \tau_D = P_u/8",
}


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
    if type not in TYPES:
        raise RuleNotApplicable(f"Ziegler-Nichols has no settings for {type}", field="types", hint="P, PI or PID")
    if Ku == 0 or not isfinite(Ku):
        raise InvalidInput("Ku must be a finite number other than zero", field="Ku")
    if not (Pu > 0 and isfinite(Pu)):
        raise InvalidInput("Pu must be positive", field="Pu")
    k, i, d = TABLE[type]
    return Settings(RULE, NAME, type, k * Ku, i * Pu if i else None, d * Pu if d else None, FORMULAS[type], SOURCE)
