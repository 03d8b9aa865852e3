"""Which eigenvalues of a state-space system its inputs and outputs see, and the BIBO verdict they give."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.bibo import BIBO, bibo_from_poles
from looplab.engine.stability.notions import matrix_stability, state_matrix

FloatArray = npt.NDArray[np.float64]


def _reachable_basis(A: FloatArray, B: FloatArray, tolerance: float) -> FloatArray:
    """Orthonormal basis of the span of B, AB, A^2 B ..., shape (n, r)."""
    size = float(np.linalg.norm(A, 2)) or 1.0
    basis = np.zeros((A.shape[0], 0))
    block = B / (float(np.linalg.norm(B, 2)) or 1.0)
    while block.shape[1]:
        block = block - basis @ (basis.T @ block)
        block = block - basis @ (basis.T @ block)
        U, sigma, _ = np.linalg.svd(block, full_matrices=False)
        fresh = U[:, sigma > tolerance]
        basis = np.concatenate([basis, fresh], axis=1)
        block = A @ fresh / size
    return basis


def state_space_bibo(A: npt.ArrayLike, B: npt.ArrayLike, C: npt.ArrayLike, tolerance: float = 1e-9) -> BIBO:
    """Does every bounded input of x' = A x + B u, y = C x (+ D u) give a bounded output?

    Parameters
    ----------
    A : array_like, shape (n, n)
        [1/time]
    B : array_like, shape (n, m)
    C : array_like, shape (p, n)
    tolerance : float
        A direction whose singular value is below this (of blocks scaled by norm(A)) is not reached or not seen [-].

    Returns
    -------
    BIBO
        Decided by the eigenvalues that are both controllable and observable; the others are ``cancelled``.

    Raises
    ------
    InvalidInput
        Shapes do not fit.
    """
    M = state_matrix(A, "A")
    n = M.shape[0]
    whole = matrix_stability(M)
    b, c = state_matrix(B, "B", rows=n), state_matrix(C, "C", columns=n)
    reached = _reachable_basis(M, b, tolerance)
    inner = reached.T @ M @ reached
    seen = _reachable_basis(inner.T, (c @ reached).T, tolerance)
    core = seen.T @ inner @ seen
    poles = matrix_stability(core).poles if core.size else np.zeros(0, dtype=complex)
    rest = list(whole.poles)
    for p in poles:
        rest.pop(int(np.argmin(np.abs(np.array(rest) - p))))
    return bibo_from_poles(poles, np.array(rest, dtype=complex))
