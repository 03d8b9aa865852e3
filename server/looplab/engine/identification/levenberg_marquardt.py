"""Least squares within bounds, for a few parameters and a residual that costs little."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from looplab.engine.systems.polynomial import FloatArray

Residual = Callable[[FloatArray], FloatArray]
_STEP = 1e-6


def central_jacobian(residual: Residual, p: FloatArray) -> FloatArray:
    """Derivatives of the residual by central differences, shape (n, parameters); parameters are of the order of 1."""
    columns = []
    for k in range(p.size):
        h = np.zeros(p.size)
        h[k] = _STEP
        columns.append((residual(p + h) - residual(p - h)) / (2.0 * _STEP))
    return np.stack(columns, axis=1)


def levenberg_marquardt(
    residual: Residual, start: FloatArray, low: FloatArray, high: FloatArray, iterations: int = 60
) -> tuple[FloatArray, float]:
    r"""Parameters with the least sum of squares, from a start, and that sum.

    .. math:: (J^T J + \lambda\,\mathrm{diag}(J^T J))\,\delta = -J^T r

    Parameters
    ----------
    residual : callable, (n,) <- (parameters,)
        Also a little beyond the bounds, for its derivatives.
    start, low, high : ndarray, shape (parameters,)
        Parameters on a bound that they would leave are held there.
    iterations : int

    Returns
    -------
    p : ndarray, shape (parameters,)
    cost : float

    References
    ----------
    .. [1] J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed., Springer 2006, sec. 10.3.
    """
    p = np.clip(start, low, high)
    r = residual(p)
    cost, damping = float(r @ r), 1e-3
    for _ in range(iterations):
        J = central_jacobian(residual, p)
        g, H = J.T @ r, J.T @ J
        free = ~(((p <= low) & (g > 0)) | ((p >= high) & (g < 0))) & (np.diag(H) > 0)
        if not free.any():
            break
        better = False
        while damping < 1e12:
            A = H[np.ix_(free, free)]
            step = np.zeros(p.size)
            step[free] = -np.linalg.solve(A + damping * np.diag(np.diag(A)), g[free])
            new = np.clip(p + step, low, high)
            r_new = residual(new)
            cost_new = float(r_new @ r_new)
            if cost_new < cost:
                better = True
                break
            damping *= 5.0
        if not better:
            break
        moved, gained = float(np.abs(new - p).max()), cost - cost_new
        p, r, cost = new, r_new, cost_new
        damping = max(0.1 * damping, 1e-12)
        if moved < 1e-13 or gained <= 1e-11 * cost:
            break
    return p, cost
