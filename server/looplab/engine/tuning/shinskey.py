"""Shinskey's settings for the smallest IAE after a load step."""

from __future__ import annotations

from bisect import bisect_left

from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.systems.integrating import IPDT
from looplab.engine.tuning.forms import Gains
from looplab.engine.tuning.settings import DEFAULTS, Options, Rule, Settings, require_dead_time, require_ratio

# theta/tau, tau_I/theta, tau_D/theta, proportional band over K theta/tau [%]; noninteracting PID
TABLE = (
    (0.0, 1.90, 0.48, 78.0),
    (0.2, 1.77, 0.41, 76.0),
    (0.5, 1.43, 0.41, 74.0),
    (1.0, 1.17, 0.37, 67.0),
)
# The same for PI on a plant whose lag dominates.
PI_INTEGRAL, PI_BAND = 4.0, 105.0
LARGEST_PI_RATIO, LARGEST_RATIO = 0.2, 1.0


def _row(ratio: float) -> tuple[float, float, float]:
    """tau_I/theta, tau_D/theta and the band at a ratio, straight lines between the rows."""
    i = max(1, bisect_left([row[0] for row in TABLE], ratio * (1 - 1e-12)))
    (low, *a), (high, *b) = TABLE[i - 1], TABLE[min(i, len(TABLE) - 1)]
    x = (ratio - low) / (high - low)
    integral, derivative, band = (p + x * (q - p) for p, q in zip(a, b, strict=True))
    return integral, derivative, band


def shinskey(model: FOPDT | IPDT, type: str, options: Options = DEFAULTS) -> Settings:
    r"""Settings from Shinskey's table of proportional band, integral and derivative time.

    .. math::

        K_c = \frac{100}{\mathrm{PB}}\,\frac{\tau}{K\theta} \quad\left(\frac{1}{K\theta}\text{ for an integrating
        process}\right), \qquad \tau_I = i\,\theta, \qquad \tau_D = d\,\theta

    Parameters
    ----------
    model : FOPDT or IPDT
        theta > 0; theta/tau up to 1 for PID, up to 0.2 for PI.
    type : {"PI", "PID"}
    options : Options
        None is used.

    Returns
    -------
    Settings
        PB, i and d interpolated in TABLE.

    Raises
    ------
    RuleNotApplicable
        theta/tau is outside its range, or the rule has no such type.

    References
    ----------
    .. [1] F. G. Shinskey, Process Control Systems, 4th ed., McGraw-Hill 1996, Table 4.4 (PID).
    .. [2] F. G. Shinskey, Feedback Controllers for the Process Industries, McGraw-Hill 1994 (PI).
    """
    RULE.kind(model, type)
    theta, ratio = model.theta, 0.0
    if isinstance(model, FOPDT):
        require_ratio(RULE.name, model, 0.0, LARGEST_PI_RATIO if type == "PI" else LARGEST_RATIO)
        ratio, slope = theta / model.tau, model.K / model.tau
    else:
        require_dead_time(RULE.name, theta)
        slope = model.K
    if type == "PI":
        return RULE.settings(model, type, Gains(100.0 / (PI_BAND * slope * theta), PI_INTEGRAL * theta))
    integral, derivative, band = _row(ratio)
    return RULE.settings(model, type, Gains(100.0 / (band * slope * theta), integral * theta, derivative * theta))


_PID = r", \quad \tau_I = i\,\theta, \quad \tau_D = d\,\theta"
RULE = Rule(
    id="shinskey",
    name="Shinskey (load)",
    family="Minimum error, by correlations",
    source="F. G. Shinskey, Process Control Systems, 4th ed., McGraw-Hill 1996, Table 4.4; "
    "PI: Feedback Controllers for the Process Industries, McGraw-Hill 1994",
    validity="0 < theta/tau <= 1 (PI: 0.2, where the lag dominates), or an integrating process with dead time",
    formulas={
        "FOPDT": {
            "PI": r"K_c = \frac{\tau}{1.05\,K\theta}, \quad \tau_I = 4\,\theta",
            "PID": r"K_c = \frac{100}{\mathrm{PB}}\,\frac{\tau}{K\theta}" + _PID,
        },
        "IPDT": {
            "PI": r"K_c = \frac{1}{1.05\,K\theta}, \quad \tau_I = 4\,\theta",
            "PID": r"K_c = \frac{1}{0.78\,K\theta}, \quad \tau_I = 1.9\,\theta, \quad \tau_D = 0.48\,\theta",
        },
    },
    apply=shinskey,
)
