"""Bandwidth: up to which frequency a system passes a signal unattenuated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.frequency.response import default_grid, log_magnitude
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Bandwidth:
    """The first frequency at which the gain has fallen to 1/sqrt(2) of its steady-state value [rad/time].

    ``omega`` is None where there is none, with the ``reason``.
    """

    omega: float | None
    reason: str | None = None


def _first_fall(size: Callable[[FloatArray], FloatArray], omega: FloatArray, level: float) -> float | None:
    """First omega at which ln|G| falls through ``level``."""
    values = size(omega)
    at = np.flatnonzero((values[:-1] > level) & (values[1:] <= level))[:1]
    if not at.size:
        return None
    x = refine_brackets(lambda x: size(np.exp(x)) - level, np.log(omega[at]), np.log(omega[at + 1]))
    return float(np.exp(x[0]))


def bandwidth(system: TransferFunction) -> Bandwidth:
    r"""Bandwidth of a system.

    .. math:: |G(i\omega_B)| = |G(0)|/\sqrt{2}

    Parameters
    ----------
    system : TransferFunction

    Returns
    -------
    Bandwidth
        None with a reason for an integrator (infinite gain at rest), a differentiator, or a gain that never falls.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 9.4.
    """
    return _bandwidth(system.dc_gain, lambda w: log_magnitude(system, w), default_grid(system))


def closed_loop_bandwidth(L: TransferFunction) -> Bandwidth:
    r"""Bandwidth of the complementary sensitivity T = L/(1 + L).

    .. math:: |T(i\omega_B)| = |T(0)|/\sqrt{2}

    Parameters
    ----------
    L : TransferFunction
        Open loop, dead time exact.

    Returns
    -------
    Bandwidth

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 2.4.5.
    """

    def size(omega: FloatArray) -> FloatArray:
        with np.errstate(divide="ignore", invalid="ignore"):
            value = L.response(omega)
            return np.log(np.abs(value / (1.0 + value)))

    dc = 1.0 if L.origin_order > 0 else L.dc_gain / (1.0 + L.dc_gain) if L.dc_gain != -1.0 else np.inf
    return _bandwidth(dc, size, default_grid(L))


def _bandwidth(dc: float, size: Callable[[FloatArray], FloatArray], grid: FloatArray) -> Bandwidth:
    if not np.isfinite(dc):
        return Bandwidth(None, "undefined: the steady-state gain is infinite")
    if dc == 0.0:
        return Bandwidth(None, "undefined: the steady-state gain is zero")
    level = np.log(abs(dc)) - 0.5 * np.log(2.0)
    wide = np.concatenate(
        [np.geomspace(grid[0] * 1e-3, grid[0], 60)[:-1], grid, np.geomspace(grid[-1], grid[-1] * 1e3, 60)[1:]]
    )
    omega = _first_fall(size, wide, float(level))
    return Bandwidth(
        omega, None if omega is not None else "infinite: the gain never falls to 1/sqrt(2) of its value at rest"
    )
