"""Eigenvalues with the ones at the origin exact: an integrator must not become a pole at 1e-17 or 1e-8."""

from __future__ import annotations

import numpy as np
from scipy.linalg import matrix_balance

from looplab.engine.systems.polynomial import ComplexArray, FloatArray, pair_conjugates

EPS = float(np.finfo(float).eps)


def eigenvalues(A: FloatArray) -> ComplexArray:
    """Eigenvalues of a real matrix, reals first, then exact conjugate pairs.

    Parameters
    ----------
    A : ndarray, shape (n, n)

    Returns
    -------
    ndarray, shape (n,)
        The null space is deflated again and again before the rest is solved, so that also n integrators in a row,
        whose eigenvalues a plain solver scatters over a circle of radius eps^(1/n), are zeros exactly.
    """
    n = A.shape[0]
    if not n:
        return np.zeros(0, dtype=complex)
    A = matrix_balance(A, permute=False)[0]
    size = np.abs(A).max()
    while A.size:
        _, sigma, vt = np.linalg.svd(A)
        null = int(np.count_nonzero(sigma <= 8 * n * EPS * size))
        if not null:
            break
        rest = vt[: A.shape[0] - null]
        A = rest @ A @ rest.T
    found = np.linalg.eigvals(A) if A.size else np.zeros(0)
    return np.concatenate([np.zeros(n - found.size, dtype=complex), pair_conjugates(found)])
