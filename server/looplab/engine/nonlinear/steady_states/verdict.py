"""What kind of steady state it is, by the eigenvalues of the linearised model."""

from __future__ import annotations

import numpy as np
from scipy.linalg import matrix_balance

from looplab.engine.nonlinear.language import Values
from looplab.engine.stability.notions import StabilityNotion, matrix_stability
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.engine.systems.transfer_function import MAX_ORDER

_AXIS = 1e-10
UNDECIDED = "; the linear model alone does not decide about the nonlinear one"


def balanced(A: FloatArray) -> FloatArray:
    """A matrix similar to A whose entries do not depend on the units of the states."""
    return np.asarray(matrix_balance(A, permute=False)[0]) if A.size else A


def judge(A: FloatArray) -> tuple[ComplexArray, str, str]:
    """Eigenvalues, rightmost first, the verdict (stable, marginal or unstable) and its reason."""
    poles = eigenvalues(A)
    poles = poles[np.lexsort((-poles.imag, -np.round(poles.real, 12)))]
    if A.shape[0] > MAX_ORDER:
        right = float(poles[0].real)
        verdict = "stable" if right < 0 else "unstable"
        return poles, verdict, f"the rightmost of {poles.size} eigenvalues has the real part {right:.4g}"
    notion: StabilityNotion = matrix_stability(balanced(A))
    undecided = bool(notion.axis_modes) and not any(p.real > _AXIS * abs(p) for p in notion.poles)
    return poles, notion.verdict, notion.because + (UNDECIDED if undecided else "")


def unstable_count(parts: Values | FloatArray) -> int:
    """How many of the real parts, given largest first, are positive beyond rounding."""
    values = np.asarray(parts, dtype=float)
    return int(np.count_nonzero(values > _AXIS * np.abs(values).max(initial=0.0)))


def kind_of(poles: ComplexArray) -> str:
    """Node, focus, saddle or centre: the name of the picture that solutions make nearby.

    Parameters
    ----------
    poles : ndarray of complex
        Eigenvalues of the linearised model, rightmost first [rad/time].

    Returns
    -------
    str
        A centre is one of the linear model. Degenerate where an eigenvalue is zero.
    """
    size = float(np.abs(poles).max(initial=0.0))
    axis = np.abs(poles.real) <= _AXIS * size
    turning = np.abs(poles.imag) > _AXIS * size
    if (axis & ~turning).any():
        return "degenerate"
    if axis.any():
        return "centre" if axis.all() else "centre and others"
    right = poles.real > 0
    if right.any() and not right.all():
        return "saddle focus" if turning.any() else "saddle"
    return ("unstable" if right.all() else "stable") + (" focus" if turning.any() else " node")
