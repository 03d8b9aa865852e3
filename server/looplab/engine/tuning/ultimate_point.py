"""The ultimate gain and period of a plant under proportional control, from its exact frequency response."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.frequency.crossings import crossings
from looplab.engine.frequency.nyquist import nyquist_count
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class UltimatePoint:
    """Ku [input/output] (negative for a plant with negative gain), Pu [time] and omega_180 [rad/time]."""

    Ku: float
    Pu: float
    omega_180: float

    @classmethod
    def of(cls, Ku: float, Pu: float) -> UltimatePoint:
        """The point that an experiment gave.

        Raises
        ------
        InvalidInput
            Ku is zero or Pu not positive.
        """
        if Ku == 0 or not np.isfinite(Ku):
            raise InvalidInput("Ku must be a finite number other than zero", field="Ku")
        if not (Pu > 0 and np.isfinite(Pu)):
            raise InvalidInput("Pu must be positive", field="Pu")
        return cls(Ku, Pu, float(2 * np.pi / Pu))


def relay_point(amplitude: float, swing: float, Pu: float, hysteresis: float = 0.0) -> UltimatePoint:
    r"""Ultimate point from a relay experiment, by the relay's describing function.

    .. math:: K_u \approx \frac{4 d}{\pi\sqrt{a^2 - \varepsilon^2}}

    Parameters
    ----------
    amplitude : float
        d: the relay switches u between -d and +d around its mean, > 0 [input].
    swing : float
        a: y then oscillates between -a and +a around its mean, > hysteresis [output].
    Pu : float
        Period of that oscillation, > 0 [time].
    hysteresis : float
        epsilon: half the width of the relay's dead band, >= 0 [output].

    Returns
    -------
    UltimatePoint
        Approximate: the oscillation is taken for a sine.

    Raises
    ------
    InvalidInput
        A value is outside its range.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, Automatica 20 (1984) 645-651.
    """
    if not (np.isfinite(amplitude) and amplitude > 0):
        raise InvalidInput("the relay's amplitude must be positive", field="amplitude")
    if not (np.isfinite(hysteresis) and hysteresis >= 0):
        raise InvalidInput("the hysteresis must be zero or positive", field="hysteresis")
    if not (np.isfinite(swing) and swing > hysteresis):
        raise InvalidInput("the oscillation must be larger than the hysteresis", field="swing")
    height = np.sqrt(swing - hysteresis) * np.sqrt(swing + hysteresis)
    return UltimatePoint.of(float(4.0 * amplitude / (np.pi * height)), Pu)


def stabilising_sign(plant: TransferFunction) -> float:
    """Sign that a gain must have to stabilise a plant, 1.0 or -1.0.

    The constant coefficient of the closed loop's polynomial (with integral action) must have the sign of its leading
    one: each real pole in the right half-plane turns the sign of the plant's gain at low frequency.
    """
    right = np.count_nonzero((plant.poles.real > 0) & (plant.poles.imag == 0))
    return float(np.copysign(1.0, plant.origin_gain) * (-1.0) ** right)


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
    sign = stabilising_sign(plant)
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
