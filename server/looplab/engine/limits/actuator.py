"""What the loop asks of its actuator."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.bandwidth import Bandwidth, bandwidth, closed_loop_bandwidth
from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.frequency.response import default_grid, log_magnitude
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Peak:
    """Largest magnitude [-] and where [rad/time]; ``omega`` is None where it is approached at ever higher omega."""

    value: float
    omega: float | None


@dataclass(frozen=True)
class ActuatorDemand:
    """What u does after a unit step of the setpoint or of a disturbance at the output, and over frequency.

    Attributes
    ----------
    initial, final : float or None
        u at once and in the end, per unit of r; after a disturbance at the output the same with the other sign. None
        where it has no final value [input/output].
    ratio : float or None
        \\|initial/final\\|; None where either is zero or undefined [-].
    peak : Peak
        Of \\|Su\\| [input/output].
    plant, loop : Bandwidth
        Of the plant and of T [rad/time].
    """

    initial: float
    final: float | None
    ratio: float | None
    peak: Peak
    plant: Bandwidth
    loop: Bandwidth


def _log_size(loop: FeedbackLoop, omega: FloatArray) -> FloatArray:
    """ln|C/(1 + L)|."""
    L = loop.open_loop.response(omega)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # Where L has a pole |C/(1 + L)| is that of 1/(A P H).
        direct = log_magnitude(loop.C, omega) - np.log(np.abs(1.0 + L))
        inverse = -log_magnitude(loop.path, omega) - np.log(np.abs(1.0 + 1.0 / L))
    return np.where(np.abs(L) < 1.0, direct, inverse)


def _slope(loop: FeedbackLoop, omega: FloatArray) -> FloatArray:
    """Its slope over ln omega."""
    s = (1j * omega).astype(complex)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        L = loop.open_loop.response(omega)
        T = np.where(np.isfinite(L), L / (1.0 + L), 1.0)
        return np.asarray((s * (loop.C.log_derivative(s) - T * loop.open_loop.log_derivative(s))).real)


def demand_peak(loop: FeedbackLoop) -> Peak:
    r"""Largest magnitude of the input sensitivity.

    .. math:: S_u = \frac{C}{1 + L} = \frac{T}{G}

    Parameters
    ----------
    loop : FeedbackLoop
        Stable; dead time exact. With actuator and sensor G is A P H.

    Returns
    -------
    Peak
        [input/output]

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 8.4.
    """
    grid = default_grid(loop.open_loop)
    omega = np.unique(np.concatenate([grid, default_grid(loop.C)]))
    size, slope = _log_size(loop, omega), _slope(loop, omega)
    at = np.flatnonzero((slope[:-1] > 0) & (slope[1:] <= 0))
    summit = np.exp(refine_brackets(lambda x: _slope(loop, np.exp(x)), np.log(omega[at]), np.log(omega[at + 1])))
    where, value = np.concatenate([omega, summit]), np.concatenate([size, _log_size(loop, summit)])
    value[~np.isfinite(value)] = -np.inf
    best = int(value.argmax())
    C, product = loop.C.high_frequency_gain, loop.open_loop.high_frequency_gain
    ripple = abs(product) if loop.theta else -product
    last = abs(C) / abs(1.0 - ripple) if ripple != 1.0 else np.inf
    if last >= np.exp(value[best]) * (1.0 - 1e-9):
        return Peak(float(last), None)
    return Peak(float(np.exp(value[best])), float(where[best]))


def actuator_demand(loop: FeedbackLoop) -> ActuatorDemand:
    r"""What a unit step asks of the actuator: at once, in the end and at worst over frequency.

    .. math:: u(0^+) = \lim_{s\to\infty} S_u(s), \qquad u(\infty) = \lim_{s\to 0} S_u(s)

    Parameters
    ----------
    loop : FeedbackLoop
        Stable; the setpoint weight is left out.

    Returns
    -------
    ActuatorDemand

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 8.4.
    """
    L, _ = split_hidden_modes(loop.open_loop)
    C, path = loop.C, loop.path
    initial = C.high_frequency_gain / (1.0 if loop.theta else 1.0 + L.high_frequency_gain)
    final = _at_rest(C, path, L)
    ratio = abs(initial / final) if final and initial else None
    return ActuatorDemand(initial, final, ratio, demand_peak(loop), bandwidth(path), closed_loop_bandwidth(L))


def _at_rest(C: TransferFunction, path: TransferFunction, L: TransferFunction) -> float | None:
    """C/(1 + L) for s to 0."""
    if L.origin_order > 0:
        # C/L = 1/(A P H)
        return 0.0 if path.origin_order > 0 else 1.0 / path.dc_gain if path.dc_gain else None
    return C.dc_gain / (1.0 + L.dc_gain) if np.isfinite(C.dc_gain) and L.dc_gain != -1.0 else None
