"""The gang of six: what a loop with a weighted setpoint does to setpoint, load and noise, over frequency and time."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.response import log_magnitude, phase_rad
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.step_response import closed_loop_step
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

GANG = ("S", "PS", "CS", "T", "CFS", "TF")


@dataclass(frozen=True)
class GangOfSix:
    """ln of the magnitudes over omega [rad/time], shape (n,); -inf where a function is zero."""

    omega: FloatArray
    S: FloatArray
    PS: FloatArray
    CS: FloatArray
    T: FloatArray
    CFS: FloatArray
    TF: FloatArray


def _log(system: TransferFunction, omega: FloatArray) -> npt.NDArray[np.complex128]:
    return log_magnitude(system, omega) + 1j * phase_rad(system, omega)


def gang_of_six(loop: FeedbackLoop, omega: FloatArray) -> GangOfSix:
    r"""Magnitudes of the six transfer functions of a loop with two degrees of freedom, dead time exact.

    .. math:: S = \frac{1}{1 + L}, \quad PS, \quad CS, \quad T = LS, \qquad
        r \to u:\; C\mathcal F S, \quad r \to y:\; T\mathcal F, \qquad
        u = C(\mathcal F r - y), \quad \mathcal F = \frac{C + F}{C}

    The book's loop filters the setpoint by calF. Here u = C (r - y) + F r with F = Kc (beta - 1), which is the same
    with calF = 1 + F/C: the two functions more are (C + F) S and P (C + F) S. With beta = 1 they are CS and T.
    With actuator A and sensor H, L = C A P H, PS is the load's way to y (Gd S where the loop has a disturbance model),
    T leads to the measured y_m, and the last to y itself: A P (C + F) S.

    Parameters
    ----------
    loop : FeedbackLoop
    omega : ndarray, shape (n,)
        Frequencies, > 0 [rad/time].

    Returns
    -------
    GangOfSix

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 12.1.
    """
    C, path = _log(loop.C, omega), _log(loop.path, omega)
    load, forward = (log_magnitude(system, omega) for system in (loop.load_path, loop.forward))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        S = -np.log(np.abs(1.0 + np.exp(path + C)))
        CF = C.real if not loop.feedforward else np.log(np.abs(np.exp(C) + loop.feedforward))
        return GangOfSix(omega, S, S + load, S + C.real, S + path.real + C.real, S + CF, S + forward + CF)


@dataclass(frozen=True)
class GangSteps:
    """Unit-step responses of the six over t [time]; each ends where its loop's response was cut.

    Attributes
    ----------
    t : ndarray, shape (n,)
    S, PS, CS, T, CFS, TF : ndarray
        Shape (n,), or shorter where cut.
    truncated_reason : str or None
        Why they were cut.
    """

    t: FloatArray
    S: FloatArray
    PS: FloatArray
    CS: FloatArray
    T: FloatArray
    CFS: FloatArray
    TF: FloatArray
    truncated_reason: str | None


def gang_steps(loop: FeedbackLoop, horizon: float, points: int = 500) -> GangSteps:
    r"""Unit-step responses of the six transfer functions, as exact as the loop's step responses.

    .. math:: y_S(t) = 1 - y_T(t)

    T and CS are y (as measured) and u after a setpoint step with beta = 1, TF and CFS are y and u with the loop's beta,
    PS is y after a load step, and S is the error of T.

    Parameters
    ----------
    loop : FeedbackLoop
    horizon : float
        Length [time].
    points : int
        Number of samples.

    Returns
    -------
    GangSteps

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 12.1.
    """
    weighted = closed_loop_step(loop, horizon, points)
    plain = weighted if not loop.feedforward else closed_loop_step(replace(loop, controller=loop.C), horizon, points)
    T, filtered, load = plain.setpoint, weighted.setpoint, weighted.load
    measured = T.y if T.y_m is None else T.y_m
    reason = T.truncated_reason or filtered.truncated_reason or load.truncated_reason
    return GangSteps(weighted.t, 1.0 - measured, load.y, T.u, measured, filtered.u, filtered.y, reason)
