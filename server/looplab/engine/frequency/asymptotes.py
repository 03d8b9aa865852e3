"""Straight-line Bode asymptotes: how the diagram is sketched by hand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.response import frequency_range
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Corner:
    """A corner frequency [rad/time] and by how many times 20 dB/decade the slope changes there."""

    omega: float
    slope_change: int
    kind: str


@dataclass(frozen=True)
class BodeAsymptotes:
    """The polyline of the magnitude: omega [rad/time] and mag_dB [dB] at its vertices, and the corners."""

    omega: FloatArray
    mag_dB: FloatArray
    corners: tuple[Corner, ...]
    initial_slope: int


def bode_asymptotes(system: TransferFunction, low: float | None = None, high: float | None = None) -> BodeAsymptotes:
    r"""Straight-line approximation of the magnitude.

    .. math:: |G| \approx |k_0|\,\omega^{-m} \prod_{\omega_z < \omega} \frac{\omega}{\omega_z}
        \prod_{\omega_p < \omega} \frac{\omega_p}{\omega}

    Parameters
    ----------
    system : TransferFunction
        Dead time does not change the magnitude.
    low, high : float or None
        Ends of the polyline [rad/time]; None takes the decades that hold the corners.

    Returns
    -------
    BodeAsymptotes
        Exact far from the corners; a first-order corner is off by 3.01 dB, a resonance by 1/(2 zeta).

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, sec. 7-2.
    """
    auto_low, auto_high = frequency_range(system)
    low, high = low or auto_low, high or auto_high
    corners = [Corner(float(abs(r)), change, kind)
               for roots, change, kind in ((system.zeros, 1, "zero"), (system.poles, -1, "pole"))
               for r in roots if r != 0]  # fmt: skip
    corners.sort(key=lambda c: c.omega)
    slope = -system.origin_order
    start = np.log10(max(abs(system.origin_gain), 1e-300)) * 20 + slope * 20 * np.log10(low)
    # Corners left of the picture bend the line before it begins.
    for c in corners:
        if c.omega < low:
            start += 20 * c.slope_change * np.log10(low / c.omega)
    now = slope + sum(c.slope_change for c in corners if c.omega < low)
    omega, level = [low], [start]
    for c in [c for c in corners if low <= c.omega < high]:
        level.append(level[-1] + 20 * now * np.log10(c.omega / omega[-1]))
        omega.append(c.omega)
        now += c.slope_change
    level.append(level[-1] + 20 * now * np.log10(high / omega[-1]))
    omega.append(high)
    return BodeAsymptotes(np.array(omega), np.array(level), tuple(corners), slope)
