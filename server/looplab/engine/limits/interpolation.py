"""What a loop must be at the right-half-plane zeros and poles of its plant, whatever the controller."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.response import AXIS_GAP
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.stability.closed_loop import closed_loop_poles
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

ComplexArray = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class Constraint:
    """One zero or pole of L in the right half-plane (the upper one of a pair).

    Attributes
    ----------
    root : complex
        [rad/time]
    kind : str
        "zero" or "pole".
    S, T : complex
        S and T of this loop there: 1 and 0 at a zero, 0 and 1 at a pole [-].
    peak_bound : float
        Least possible peak of \\|S\\| because of a zero, of \\|T\\| because of a pole [-].
    """

    root: complex
    kind: str
    S: complex
    T: complex
    peak_bound: float


def right_half_plane(roots: ComplexArray) -> ComplexArray:
    """Those to the right of the imaginary axis."""
    return roots[roots.real > AXIS_GAP * np.abs(roots)]


def blaschke(s: complex, roots: ComplexArray) -> float:
    r"""How far s lies from being one of the roots, seen from the right half-plane.

    .. math:: \prod_i \frac{|s + \bar r_i|}{|s - r_i|}

    Parameters
    ----------
    s : complex
        Re s > 0 [rad/time].
    roots : ndarray of complex, shape (n,)
        Closed under conjugation, Re > 0 [rad/time].

    Returns
    -------
    float
        At least 1; infinite at a root.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 5.3.
    """
    with np.errstate(divide="ignore"):
        return float(np.prod(np.abs(s + roots.conj()) / np.abs(s - roots)))


def peak_bounds(L: TransferFunction) -> tuple[float, float]:
    r"""Peaks of S and T that no controller can avoid, given the zeros and poles of L on the right.

    .. math:: \|S\|_\infty \ge \max_z \prod_i \frac{|z + \bar p_i|}{|z - p_i|}, \qquad
        \|T\|_\infty \ge \max_p e^{\theta\,\mathrm{Re}\,p} \prod_j \frac{|\bar z_j + p|}{|z_j - p|}

    Parameters
    ----------
    L : TransferFunction
        Open loop without hidden modes.

    Returns
    -------
    Ms, Mt : float
        At least 1 and 0; T has no bound without a pole [-].

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 5.3.
    """
    zeros, poles = right_half_plane(L.zeros), right_half_plane(L.poles)
    Ms = max((blaschke(complex(z), poles) for z in zeros), default=1.0)
    Mt = max((float(np.exp(L.theta * p.real)) * blaschke(complex(p), zeros) for p in poles), default=0.0)
    return Ms, Mt


def _sensitivity(loop: FeedbackLoop, L: TransferFunction, s: complex) -> tuple[complex, complex]:
    """S and T at s; without dead time from the closed-loop poles, which know nothing of s."""
    if loop.theta:
        value = L(s)
        return (0j, 1 + 0j) if np.isinf(value) else (complex(1.0 / (1.0 + value)), complex(value / (1.0 + value)))
    poles = closed_loop_poles(FeedbackLoop(L, TransferFunction([], [], 1.0))).poles
    scale = np.prod(s - poles) * (1.0 + L.high_frequency_gain)
    return complex(np.prod(s - L.poles) / scale), complex(L.gain * np.prod(s - L.zeros) / scale)


def interpolation_constraints(loop: FeedbackLoop) -> tuple[Constraint, ...]:
    r"""S and T at the zeros and poles of L in the right half-plane.

    .. math:: S(z) = 1, \quad T(z) = 0, \qquad S(p) = 0, \quad T(p) = 1

    Parameters
    ----------
    loop : FeedbackLoop
        Internally stable: otherwise S and T have poles of their own there.

    Returns
    -------
    tuple of Constraint
        Zeros first, each by its size; empty where L has neither.

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 8.6.
    .. [2] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 5.3.
    """
    L, _ = split_hidden_modes(loop.open_loop)
    out = []
    sides = {"zero": right_half_plane(L.zeros), "pole": right_half_plane(L.poles)}
    for kind, other in (("zero", "pole"), ("pole", "zero")):
        upper = sides[kind][sides[kind].imag >= 0]
        for root in sorted(set(upper.tolist()), key=abs):
            S, T = _sensitivity(loop, L, root)
            bound = blaschke(root, sides[other])
            if kind == "pole":
                bound *= float(np.exp(L.theta * root.real))
            out.append(Constraint(root, kind, S, T, bound))
    return tuple(out)
