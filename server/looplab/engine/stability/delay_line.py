"""A loop's dead time as a transported wave at Chebyshev points: a matrix whose eigenvalues are near the poles."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from looplab.engine.loop.equations import LoopEquations

FloatArray = npt.NDArray[np.float64]


@lru_cache(maxsize=64)
def chebyshev_differentiation(nodes: int) -> FloatArray:
    """Differentiation matrix on x_i = (1 - cos(pi i/nodes))/2 in [0, 1], shape (nodes+1, nodes+1).

    References
    ----------
    .. [1] L. N. Trefethen, Spectral Methods in MATLAB, SIAM 2000, ch. 6.
    """
    i = np.arange(nodes + 1)
    x = 0.5 * (1.0 - np.cos(np.pi * i / nodes))
    c = np.where((i == 0) | (i == nodes), 2.0, 1.0) * (-1.0) ** i
    gap = x[:, None] - x[None, :] + np.eye(nodes + 1)
    D = np.outer(c, 1.0 / c) / gap
    return D - np.diag(D.sum(axis=1))


def delay_line_matrix(equations: LoopEquations, theta: float, nodes: int) -> FloatArray:
    """State matrix of [x_plant, x_controller, w_1 .. w_nodes] with w the plant output on its way through theta.

    The wave obeys dw/dt = -dw/dx / theta with w(x=0) the plant output before its dead time and w(x=1) the measured y.
    """
    n = equations.base.shape[0] - 2
    g, DpDc = equations.g[:n], equations.DpDc
    D = chebyshev_differentiation(nodes)[1:] / theta
    M = np.zeros((n + nodes, n + nodes))
    M[:n, :n] = equations.base[:n, :n]
    M[:n, -1] = equations.b_y[:n]
    np.negative(D[:, 1:], out=M[n:, n:])
    np.multiply(D[:, :1], -g, out=M[n:, :n])
    M[n:, -1] += D[:, 0] * DpDc
    return M
