"""The ultimate gain and period of a plant under proportional control, from its exact frequency response."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.frequency.crossings import crossings
from looplab.engine.frequency.nyquist import nyquist_count
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class UltimatePoint:
    """Ku [input/output] (negative for a plant with negative gain), Pu [time] and omega_180 [rad/time]."""

    Ku: float
    Pu: float
    omega_180: float


def ultimate_point(plant: TransferFunction) -> UltimatePoint:
    r"""The gain at which proportional control loses stability, and the period it then oscillates with.

    .. math:: \arg P(i\omega_{180}) = -\pi, \quad K_u = 1/|P(i\omega_{180})|, \quad P_u = 2\pi/\omega_{180}

    Parameters
    ----------
    plant : TransferFunction
        Dead time exact.

    Returns
    -------
    UltimatePoint
        The largest gain of the stable range that the experiment reaches from below.

    Raises
    ------
    RuleNotApplicable
        No proportional gain makes the loop oscillate, or none stabilises it.

    References
    ----------
    .. [1] J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768.
    """
    sign = -1.0 if plant.origin_gain < 0 and nyquist_count(plant * 1e-9).Z == 0 else 1.0
    P = plant * sign
    found = crossings(P)
    usable = np.isfinite(found.phase_log_magnitude) & (found.phase_omega > 0)
    gains, omegas = np.exp(-found.phase_log_magnitude[usable]), found.phase_omega[usable]
    if not gains.size:
        raise RuleNotApplicable(
            "the plant has no ultimate gain: under proportional control its phase never reaches -180 deg",
            field="plant",
            hint="use a rule that needs no ultimate gain, or add the dead time the real plant has",
        )
    order = np.argsort(gains)
    for gain, omega in zip(gains[order], omegas[order], strict=True):
        if nyquist_count(P * float(gain * (1 - 1e-6))).Z == 0:
            return UltimatePoint(float(sign * gain), float(2 * np.pi / omega), float(omega))
    if any(nyquist_count(P * float(gain * (1 + 1e-6))).Z == 0 for gain in gains):
        raise RuleNotApplicable(
            f"the plant has no ultimate gain: it is stable for gains above {gains.min():.4g}, however large",
            field="plant",
            hint="use a rule that needs no ultimate gain, or add the dead time the real plant has",
        )
    raise RuleNotApplicable(
        "no proportional gain stabilises this plant, so it has no ultimate gain",
        field="plant",
        hint="stabilise it first, for example with derivative action",
    )
