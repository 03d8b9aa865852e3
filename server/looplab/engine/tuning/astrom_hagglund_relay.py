"""Åström-Hägglund settings from a relay experiment: the ultimate point is moved to a chosen phase margin."""

from __future__ import annotations

from math import cos, radians, sqrt, tan

from looplab.engine.errors import InvalidInput
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings
from looplab.engine.tuning.ultimate_point import UltimatePoint

# tau_I/tau_D
RATIO = 4.0


def astrom_hagglund_relay(point: UltimatePoint, type: str, options: Options = DEFAULTS) -> Settings:
    r"""PID settings that put L(i omega_180) on the unit circle at the chosen phase margin.

    .. math::

        K_c = K_u\cos\phi_m, \qquad
        \tau_D = \frac{\tan\phi_m + \sqrt{1 + \tan^2\phi_m}}{2\,\omega_{180}}, \qquad \tau_I = 4\,\tau_D

    so that C(i omega_180) = Ku e^{i phi_m} before the derivative is filtered.

    Parameters
    ----------
    point : UltimatePoint
        From a relay (see relay_point) or of the plant itself.
    type : {"PID"}
    options : Options
        PM_deg is used.

    Returns
    -------
    Settings

    Raises
    ------
    InvalidInput
        The phase margin is not between 0 and 90 deg.
    RuleNotApplicable
        The rule has no such type.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, Automatica 20 (1984) 645-651.
    """
    RULE.kind(point, type)
    if not 0 < options.PM_deg < 90:
        raise InvalidInput("the phase margin must be between 0 and 90 deg", field="PM_deg", hint="45 is usual")
    slope = tan(radians(options.PM_deg))
    tau_D = (slope + sqrt(4.0 / RATIO + slope**2)) / (2.0 * point.omega_180)
    gains = Gains(point.Ku * cos(radians(options.PM_deg)), RATIO * tau_D, tau_D)
    return RULE.settings(point, type, gains, f"for a phase margin of {options.PM_deg:g}° before the derivative filter")


RULE = Rule(
    id="astrom_hagglund_relay",
    name="Åström–Hägglund (relay, phase margin)",
    family="From the ultimate cycle",
    source="K. J. Åström, T. Hägglund, Automatica 20 (1984) 645-651",
    validity="any plant with an ultimate gain that is stable below it; phase margin 0 to 90°, 45° unless chosen",
    formulas={
        "ultimate": {
            "PID": r"K_c = K_u \cos\phi_m, \quad "
            r"\tau_D = \frac{\tan\phi_m + \sqrt{1 + \tan^2\phi_m}}{2\,\omega_{180}}, \quad \tau_I = 4\,\tau_D",
        }
    },
    apply=astrom_hagglund_relay,
)
