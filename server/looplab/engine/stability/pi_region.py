"""The stable region of a PI controller on a plant, in the plane of Kc and tau_I."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.frequency.response import default_grid
from looplab.engine.loop.controllers import PID
from looplab.engine.stability.gain_ranges import GainRanges, gain_ranges
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

ROUNDING = 1e-14


@dataclass(frozen=True)
class PIBoundary:
    """Settings that put a pair of closed-loop poles at +-j omega.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        [rad/time]
    Kc, tau_I : ndarray, shape (n,)
        Ideal form [input/output, time]; NaN where no PI controller with tau_I > 0 does it.
    Ki : ndarray, shape (n,)
        Kc/tau_I, finite everywhere [input/output/time].
    """

    omega: FloatArray
    Kc: FloatArray
    tau_I: FloatArray
    Ki: FloatArray


@dataclass(frozen=True)
class PIRegion:
    """The boundary curve, and for each tau_I [time] the stable ranges of Kc."""

    boundary: PIBoundary
    tau_I: tuple[float, ...]
    ranges: tuple[GainRanges, ...]


def pi_boundary(plant: TransferFunction, omega: npt.ArrayLike | None = None) -> PIBoundary:
    r"""Solve 1 + C(j omega) P(j omega) = 0 for the settings of a PI controller.

    .. math::

        K_c(\omega) = -\Re\frac{1}{P(i\omega)}, \qquad K_i(\omega) = \omega\,\Im\frac{1}{P(i\omega)}, \qquad
        \tau_I = \frac{K_c}{K_i}

    Parameters
    ----------
    plant : TransferFunction
        Dead time exact.
    omega : array_like or None
        Positive frequencies [rad/time]; None takes an adaptive grid.

    Returns
    -------
    PIBoundary
        Beside this curve Kc = 0 and Ki = 0 (a pole at the origin) bound the region.

    Raises
    ------
    InvalidInput
        The plant is zero, or a frequency is not positive.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, Advanced PID Control, ISA 2006, sec. 6.
    """
    if plant.gain == 0.0:
        raise InvalidInput("the plant is zero: no controller acts on it", field="plant")
    w = default_grid(plant) if omega is None else np.atleast_1d(np.asarray(omega, dtype=float))
    if not (np.isfinite(w).all() and (w > 0).all()):
        raise InvalidInput("frequencies must be positive numbers", field="omega")
    with np.errstate(all="ignore"):
        inverse = 1.0 / plant.response(w)
        Kc, Ki = -inverse.real, w * inverse.imag
        # Where 1/P is real or imaginary but for rounding, the curve passes through Ki = 0 or Kc = 0.
        off_axes = np.minimum(np.abs(inverse.real), np.abs(inverse.imag)) > ROUNDING * np.abs(inverse)
        tau_I = np.where(off_axes & (Kc * Ki > 0), Kc / Ki, np.nan)
    finite = np.isfinite(Kc) & np.isfinite(Ki)
    w, Kc, Ki, tau_I = w[finite], Kc[finite], Ki[finite], tau_I[finite]
    return PIBoundary(w, np.where(np.isfinite(tau_I), Kc, np.nan), tau_I, Ki)


def pi_gain_ranges(plant: TransferFunction, tau_I: float, negative: bool = False) -> GainRanges:
    """Stable ranges of Kc of the ideal PI controller Kc (1 + 1/(tau_I s)) for one tau_I.

    Parameters
    ----------
    plant : TransferFunction
        Proper, dead time exact.
    tau_I : float
        Integral time, > 0 [time].
    negative : bool
        Look at negative gains too.

    Returns
    -------
    GainRanges

    Raises
    ------
    InvalidInput
        tau_I is not positive.
    ImproperSystem
        The plant has more zeros than poles.
    """
    return gain_ranges(PID(1.0, tau_I).to_transfer_function() * plant, negative)


def pi_region(plant: TransferFunction, tau_I: Sequence[float], negative: bool = False) -> PIRegion:
    """The stable region in (Kc, tau_I): its boundary curve, and its cut at each tau_I.

    Parameters
    ----------
    plant : TransferFunction
        Proper, dead time exact.
    tau_I : sequence of float
        Integral times, > 0 [time].
    negative : bool
        Look at negative gains too.

    Returns
    -------
    PIRegion

    Raises
    ------
    InvalidInput
        A tau_I is not positive, or the plant is zero.
    ImproperSystem
        The plant has more zeros than poles.
    """
    plant.require_proper("plant")
    ranges = tuple(pi_gain_ranges(plant, t, negative) for t in tau_I)
    return PIRegion(pi_boundary(plant), tuple(float(t) for t in tau_I), ranges)
