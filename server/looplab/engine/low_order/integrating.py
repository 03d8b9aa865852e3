"""Integrating plants as an integrator with dead time: by the half rule, or by the asymptote of the step response."""

from __future__ import annotations

from typing import Literal

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.low_order.half_rule import effective_lags
from looplab.engine.low_order.models import Lags
from looplab.engine.systems.integrating import DIPDT, IPDT
from looplab.engine.systems.transfer_function import TransferFunction


def _require_integrators(plant: TransferFunction, most: int) -> None:
    plant.require_proper("plant")
    order = plant.origin_order
    if plant.gain == 0.0 or not 1 <= order <= most:
        wanted = "one integrator" if most == 1 else "one integrator or two"
        raise RuleNotApplicable(f"the plant does not have {wanted}", field="plant")
    rest = plant.poles[plant.poles != 0]
    if rest.size and rest.real.max() >= 0:
        raise RuleNotApplicable("beside its integrators the plant is not stable", field="plant")


def integrating_half_rule(plant: TransferFunction, lags: Literal[0, 1]) -> IPDT | DIPDT:
    r"""Integrator (or double integrator) with dead time by Skogestad's half rule.

    .. math::

        \theta = \theta_0 + \tfrac12\tau_{10} + \sum_{i\ge2}\tau_{i0} + \sum_j T_j^{inv}
        \quad\text{or}\quad \tau = \tau_{10} + \tfrac12\tau_{20}

    Parameters
    ----------
    plant : TransferFunction
        One or two integrators, all other poles and zeros real and not in the right half-plane (zeros may be).
    lags : {0, 1}
        Lags to keep beside one integrator; none beside two.

    Returns
    -------
    IPDT or DIPDT

    Raises
    ------
    RuleNotApplicable
        The plant is not of this kind, or has a zero slower than all its lags.

    References
    ----------
    .. [1] S. Skogestad, J. Process Control 13 (2003) 291-309, sec. 2 and sec. 3.3.
    """
    _require_integrators(plant, most=2)
    poles, zeros = plant.poles[plant.poles != 0], plant.zeros[plant.zeros != 0]
    if poles.imag.any() or zeros.imag.any():
        raise RuleNotApplicable("the half rule is for real poles and zeros", field="plant")
    times = np.sort(-1.0 / zeros.real)[::-1]
    constants = np.sort(-1.0 / poles.real)[::-1]
    leads = tuple(float(T) for T in times[times > 0])
    if leads and (len(leads) > constants.size or leads[0] > constants[0]):
        raise RuleNotApplicable(
            "a zero is slower than every lag: beside an integrator the half rule cannot match it", field="plant"
        )
    inverse = tuple(float(-T) for T in times[times < 0])
    data = Lags(plant.origin_gain, tuple(float(v) for v in constants), leads, inverse, plant.theta)
    double = plant.origin_order == 2
    found = effective_lags(data, 0 if double or not poles.size else lags)
    return DIPDT(found.K, found.theta) if double else IPDT(found.K, found.theta, *found.lags)


def ramp_asymptote(plant: TransferFunction) -> IPDT:
    r"""Integrator with dead time from the straight line that the step response of an integrating plant ends on.

    .. math:: y(t) \to K (t - \theta), \qquad \theta = \theta_0 + \sum_i \tau_i - \sum_j T_j

    Parameters
    ----------
    plant : TransferFunction
        One integrator, all other poles stable.

    Returns
    -------
    IPDT

    Raises
    ------
    RuleNotApplicable
        The plant is not of this kind, or the line starts before t = 0.

    References
    ----------
    .. [1] J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768 (reaction rate and lag).
    """
    _require_integrators(plant, most=1)
    poles, zeros = plant.poles[plant.poles != 0], plant.zeros[plant.zeros != 0]
    theta = plant.theta + float((-1.0 / poles).real.sum() + (1.0 / zeros).real.sum())
    if theta < 0:
        raise RuleNotApplicable("the zeros lead by more than the lags: there is no dead time to read", field="plant")
    return IPDT(plant.origin_gain, theta)
