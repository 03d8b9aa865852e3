"""Polynomials at Chebyshev points: differentiation, interpolation, coefficients, and linear equations on one piece."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import schur
from scipy.linalg.lapack import ztrsyl

from looplab.engine.systems.polynomial import FloatArray

DEGREE = 24

_index = np.arange(DEGREE + 1)


def points(degree: int) -> FloatArray:
    """Chebyshev points from -1 to 1, shape (degree + 1,)."""
    return np.asarray(-np.cos(np.pi * np.arange(degree + 1) / degree))


def differentiation(degree: int) -> FloatArray:
    """Values at the points -> slopes there, shape (degree + 1, degree + 1)."""
    index, x = np.arange(degree + 1), points(degree)
    c = np.where((index == 0) | (index == degree), 2.0, 1.0) * (-1.0) ** index
    D = np.outer(c, 1.0 / c) / (x[:, None] - x[None, :] + np.eye(degree + 1))
    return np.asarray(D - np.diag(D.sum(axis=1)))


def _to_coefficients() -> FloatArray:
    T = np.cos(np.outer(_index, np.pi * _index / DEGREE)) * 2.0 / DEGREE
    T[:, [0, -1]] *= 0.5
    T[[0, -1]] *= 0.5
    return np.asarray(T * (-1.0) ** _index[:, None])


NODES = points(DEGREE)
DIFFERENTIATE = differentiation(DEGREE)
# Values at the nodes -> Chebyshev coefficients.
TO_COEFFICIENTS = _to_coefficients()
_R, _V = schur(DIFFERENTIATE[1:, 1:].T.astype(complex), output="complex")


def interpolation(x: FloatArray, degree: int = DEGREE) -> FloatArray:
    """Rows that map values at the points to values at x in [-1, 1], shape (x.size, degree + 1)."""
    weights = (-1.0) ** np.arange(degree + 1)
    weights[[0, -1]] *= 0.5
    gap = x[:, None] - points(degree)
    hit = gap == 0
    gap[hit] = 1.0
    rows = weights / gap
    rows /= rows.sum(axis=1, keepdims=True)
    on_node = hit.any(axis=1)
    rows[on_node] = hit[on_node]
    return np.asarray(rows)


def polynomials(x: FloatArray) -> FloatArray:
    """T_0 .. T_DEGREE at x in [-1, 1], shape (x.size, DEGREE + 1)."""
    return np.asarray(np.cos(np.outer(np.arccos(np.clip(x, -1.0, 1.0)), _index)))


class LinearPiece:
    """Solves x' = A x + f on a piece of any length, f known at the nodes, by collocation.

    In the Schur bases of A and of the differentiation matrix the collocation equations are triangular, whatever the
    length of the piece.

    References
    ----------
    .. [1] L. N. Trefethen, Spectral Methods in MATLAB, SIAM 2000, ch. 6.
    .. [2] R. H. Bartels, G. W. Stewart, Solution of the matrix equation AX + XB = C, Comm. ACM 15 (1972) 820-826.
    """

    def __init__(self, A: FloatArray) -> None:
        self.n = A.shape[0]
        if self.n:
            self.T, self.U = schur(A.astype(complex), output="complex")

    def solve(self, h: float, x0: FloatArray, f: FloatArray) -> FloatArray:
        """x at the nodes of a piece of length h, shape (n, DEGREE + 1, m), for x0 (n, m) and f (n, DEGREE + 1, m)."""
        out: FloatArray = np.empty_like(f)
        if not self.n:
            return out
        out[:, 0] = x0
        rate = 2.0 / h
        known = f[:, 1:] - rate * DIFFERENTIATE[1:, 0][None, :, None] * x0[:, None, :]
        for j in range(f.shape[2]):
            right: npt.NDArray[np.complex128] = self.U.conj().T @ known[:, :, j] @ _V
            y, scale, _ = ztrsyl(self.T, rate * _R, -right, isgn=-1)
            out[:, 1:, j] = (self.U @ (y / scale) @ _V.conj().T).real
        return out
