"""The linear-quadratic regulator."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_continuous_are

from looplab.engine.design.state_feedback.hidden import pole_text, split_reachable
from looplab.engine.errors import InvalidInput, NoConvergence
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.systems.polynomial import ComplexArray, FloatArray


@dataclass(frozen=True)
class Regulator:
    """The gain of least cost.

    Attributes
    ----------
    K : ndarray, shape (m, n)
        u = -K x.
    P : ndarray, shape (n, n)
        x0' P x0 is the least cost from x0.
    poles : ndarray, shape (n,)
        Of A - B K [rad/time].
    residual : float
        Largest entry of the Riccati equation's left side, relative to its largest term.
    """

    K: FloatArray
    P: FloatArray
    poles: ComplexArray
    residual: float


def lqr(A: FloatArray, B: FloatArray, Q: FloatArray, R: FloatArray, dual: bool = False) -> Regulator:
    r"""State feedback that minimises a quadratic cost.

    .. math:: \min_u \int_0^\infty x^T Q x + u^T R u \; dt, \quad u = -R^{-1} B^T P x, \quad
              A^T P + P A - P B R^{-1} B^T P + Q = 0

    Parameters
    ----------
    A : ndarray, shape (n, n)
        [1/time]
    B : ndarray, shape (n, m)
    Q : ndarray, shape (n, n)
        Symmetric, no negative eigenvalue: what a state costs.
    R : ndarray, shape (m, m)
        Symmetric and positive definite: what an input costs.
    dual : bool
        Whether A and B are the transposes of an observer's A and C: with Q and R the intensities of the noises of state
        and measurement, K is then the transpose of the Kalman-Bucy filter's gain.

    Returns
    -------
    Regulator
        Without an observer, of one input: a phase margin of at least 60 deg, and |1 + L| >= 1 at every frequency.

    Raises
    ------
    InvalidInput
        A weight is not as it must be, a mode that does not decay cannot be moved, or one on the imaginary axis costs
        nothing.
    NoConvergence
        The Riccati equation is too badly conditioned.

    References
    ----------
    .. [1] B. D. O. Anderson, J. B. Moore, Optimal Control: Linear Quadratic Methods, Prentice Hall 1990, ch. 3 and 5.
    .. [2] R. E. Kalman, R. S. Bucy, New results in linear filtering and prediction theory, J. Basic Eng. 83 (1961)
       95-108.
    """
    n, m = B.shape
    Q, R = _weight(Q, n, "Q", definite=False), _weight(R, m, "R", definite=True)
    word = "unobservable" if dual else "uncontrollable"
    for mode in split_reachable(A, B)[3].tolist():
        if mode.real >= 0:
            raise InvalidInput(
                f"the mode at s = {pole_text(mode)} is {word} and does not decay",
                field="B" if not dual else "C",
                hint="choose other inputs" if not dual else "measure other outputs",
            )
    size = float(np.abs(A).max(initial=0.0)) or 1.0
    for mode in split_reachable(A.T, _root(Q).T)[3].tolist():
        if abs(mode.real) <= 1e-9 * size:
            raise InvalidInput(
                f"the mode at s = {pole_text(mode)} costs nothing, so nothing would bring it to rest",
                field="Q",
                hint="give a weight to a state in which it shows",
            )
    try:
        with np.errstate(all="ignore"):
            P = solve_continuous_are(A, B, Q, R)
            K = np.linalg.solve(R, B.T @ P)
    except (np.linalg.LinAlgError, ValueError):
        K = np.full((m, n), np.nan)
    with np.errstate(all="ignore"):
        poles = eigenvalues(A - B @ K) if np.isfinite(K).all() else np.full(n, np.nan)
    if not (poles.real < 0).all():
        raise NoConvergence(
            "the Riccati equation has no solution to working precision",
            field="Q",
            hint="weights that are closer together",
        )
    P = 0.5 * (P + P.T)
    terms = (A.T @ P + P @ A, K.T @ R @ K, Q)
    scale = max(float(np.abs(term).max(initial=0.0)) for term in terms) or 1.0
    residual = float(np.abs(terms[0] - terms[1] + terms[2]).max(initial=0.0)) / scale
    return Regulator(K, P, poles, residual)


def _weight(value: FloatArray, size: int, name: str, definite: bool) -> FloatArray:
    if value.shape != (size, size):
        raise InvalidInput(f"{name} must be {size} x {size}", field=name)
    if not np.abs(value - value.T).max(initial=0.0) <= 1e-12 * np.abs(value).max(initial=0.0):
        raise InvalidInput(f"{name} must be symmetric", field=name)
    least = float(np.linalg.eigvalsh(value).min(initial=np.inf))
    largest = float(np.abs(value).max(initial=0.0))
    if definite and not least > 1e-14 * largest:
        raise InvalidInput(f"{name} must be positive definite", field=name, hint="positive numbers on its diagonal")
    if least < -1e-12 * largest:
        raise InvalidInput(f"{name} must not have a negative eigenvalue", field=name)
    return 0.5 * (value + value.T)


def _root(Q: FloatArray) -> FloatArray:
    """H with H' H = Q."""
    values, vectors = np.linalg.eigh(Q)
    return np.asarray(np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T)
