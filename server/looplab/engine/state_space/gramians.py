"""Gramians of a stable model: how much energy reaches each direction of the state, and how much of it is seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_continuous_lyapunov

from looplab.engine.state_space.eigenvalues import EPS
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class Gramians:
    """Both Gramians, shape (n, n), and the Hankel singular values, largest first; None with the ``reason``."""

    controllability: FloatArray | None
    observability: FloatArray | None
    hankel_singular_values: FloatArray | None
    reason: str | None


def gramians(model: StateSpaceModel) -> Gramians:
    r"""Controllability and observability Gramians of a stable model.

    .. math:: W_c = \int_0^\infty e^{At}BB^Te^{A^Tt}\,dt, \quad A W_c + W_c A^T + B B^T = 0, \qquad
              A^T W_o + W_o A + C^T C = 0

    Parameters
    ----------
    model : StateSpaceModel

    Returns
    -------
    Gramians
        Without them, and with the reason, where a mode does not decay: the integral has no limit.

    References
    ----------
    .. [1] B. C. Moore, Principal component analysis in linear systems, IEEE Trans. Autom. Control 26 (1981) 17-32.
    """
    poles = model.poles
    lasting = poles[poles.real >= -1e-13 * np.maximum(np.abs(poles), 1e-300)]
    if lasting.size:
        worst = lasting[np.argmax(lasting.real)]
        at = f"{worst.real:.4g}" if worst.imag == 0 else f"{worst.real:.4g} ± {abs(worst.imag):.4g}j"
        return Gramians(
            None, None, None, f"the pole at {at} does not decay, so the integral that defines a Gramian has no limit"
        )
    if model.states and -2 * poles.real.max() <= 8 * EPS * model.states * np.linalg.norm(model.A):
        return Gramians(None, None, None, "the slowest mode is too slow beside the size of A to compute a Gramian")
    if not model.states:
        empty = np.zeros((0, 0))
        return Gramians(empty, empty, np.zeros(0), None)
    Wc = solve_continuous_lyapunov(model.A, -model.B @ model.B.T)
    Wo = solve_continuous_lyapunov(model.A.T, -model.C.T @ model.C)
    Wc, Wo = 0.5 * (Wc + Wc.T), 0.5 * (Wo + Wo.T)
    # sqrt(eig(Wc Wo)) through square roots: the small ones would drown in the product.
    left, right = (_root(W) for W in (Wc, Wo))
    hankel: FloatArray = np.linalg.svd(right.T @ left, compute_uv=False).astype(float)
    return Gramians(Wc, Wo, hankel, None)


def _root(W: FloatArray) -> FloatArray:
    """R with R R^T = W, for W positive semidefinite up to rounding."""
    values, vectors = np.linalg.eigh(W)
    return vectors * np.sqrt(np.maximum(values, 0.0))
