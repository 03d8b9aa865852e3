"""Is a controller a PID? Its settings where it is, and why not where it is none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.loop import PID
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class PIDForm:
    """The same controller as a P, PI, PD or PID of ideal form with filtered derivative; None with the reason."""

    controller: PID | None
    reason: str | None = None


def _settings(C: TransferFunction) -> PIDForm:
    """Of one integrator or none, and at most one further pole, which is the filter."""
    filters = [p for p in C.poles.tolist() if p != 0]
    # Normalised to C = q/(s^i (Tf s + 1)).
    Tf = -1.0 / filters[0].real if filters else 0.0
    q = np.zeros(3)
    numerator = C.num * (Tf or 1.0)
    q[3 - numerator.size :] = numerator
    if C.order > len(filters):
        Ki, Kp = q[2], q[1] - q[2] * Tf
        Kd = q[0] - Kp * Tf
    else:
        Ki, Kp = 0.0, q[2]
        Kd = q[1] - Kp * Tf
    if not Kp:
        return PIDForm(None, "its proportional part is zero, so that it has no times")
    tau_I, tau_D = Kp / Ki if Ki else None, Kd / Kp
    if tau_I is not None and tau_I < 0:
        return PIDForm(None, "its integral and its proportional part have different signs")
    if Tf and tau_D <= 0:
        return PIDForm(None, "its fast pole filters more than a derivative: tau_D would be negative")
    alpha = Tf / tau_D if Tf else 0.1
    return PIDForm(PID(Kp, tau_I, tau_D if Tf else None, alpha))


def pid_form(C: TransferFunction) -> PIDForm:
    r"""The settings of a controller that is a PID.

    .. math:: C(s) = K_c \left(1 + \frac{1}{\tau_I s} + \frac{\tau_D s}{\alpha \tau_D s + 1}\right)

    Parameters
    ----------
    C : TransferFunction
        Proper, without dead time.

    Returns
    -------
    PIDForm

    References
    ----------
    .. [1] K. J. Astrom, T. Hagglund, Advanced PID Control, ISA 2006, sec. 3.3.
    """
    if not C.gain:
        return PIDForm(None, "it is zero")
    integrators = int(np.count_nonzero(C.poles == 0))
    others = C.order - integrators
    if integrators > 1:
        return PIDForm(None, f"it has {integrators} integrators, a PID has one")
    if others > 1:
        return PIDForm(None, f"it has {others} poles beside the integrator, a PID has one, its filter")
    if others and (C.poles[C.poles != 0].real >= 0).any():
        return PIDForm(None, "its fast pole is not stable, so that it is no filter")
    if others and not integrators:
        # A lead is a PD only where its zero comes before its pole.
        found = _settings(C)
        return found if found.controller else PIDForm(None, "it is a lag or a filtered gain without integral action")
    return _settings(C)
