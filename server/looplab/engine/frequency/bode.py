"""Bode data: magnitude in decibels and continuous phase in degrees."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.response import default_grid
from looplab.engine.frequency.sampled import sampled_at
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Bode:
    """omega [rad/time], mag_dB [dB] and phase_deg [deg] (anchored at omega -> 0), all of one shape."""

    omega: FloatArray
    mag_dB: FloatArray
    phase_deg: FloatArray


def bode(system: TransferFunction, omega: FloatArray | None = None) -> Bode:
    r"""Bode data with the dead time exact.

    .. math:: 20\log_{10}|G(i\omega)|, \qquad \arg G(i\omega) = \sum\arg - \omega\theta

    Parameters
    ----------
    system : TransferFunction
    omega : ndarray, shape (n,), or None
        Positive frequencies [rad/time]; None takes an adaptive grid.

    Returns
    -------
    Bode
        mag_dB is -inf where the response is zero.

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, ch. 14.
    """
    w = default_grid(system) if omega is None else np.asarray(omega, dtype=float)
    on_grid = sampled_at(system, w)
    return Bode(w, on_grid.mag_dB, on_grid.curve.phase_deg)
