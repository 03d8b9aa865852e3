"""Vectorised root refinement between brackets (Chandrupatla's method)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def refine_brackets(
    f: Callable[[FloatArray, npt.NDArray[np.intp]], FloatArray], a: FloatArray, b: FloatArray, max_iterations: int = 60
) -> FloatArray:
    """Roots of f between a and b, all brackets at once, to rounding.

    Parameters
    ----------
    f : callable
        (x, which) -> values; ``which`` are the indices of the brackets that x belongs to.
    a, b : ndarray, shape (m,)
        f changes sign between a and b.
    max_iterations : int
        Bound on the iterations; bisection guarantees progress in each.

    Returns
    -------
    ndarray, shape (m,)

    References
    ----------
    .. [1] T. R. Chandrupatla, Adv. Eng. Software 28 (1997) 145-149.
    """
    every = np.arange(a.size)
    x1, x2 = a.astype(float).copy(), b.astype(float).copy()
    if not every.size:
        return x1
    f1, f2 = f(x1, every), f(x2, every)
    x3, f3 = x1.copy(), f1.copy()
    best = np.where(np.abs(f1) < np.abs(f2), x1, x2)
    part = np.full(a.size, 0.5)
    live = every
    for _ in range(max_iterations):
        x = x1[live] + part[live] * (x2[live] - x1[live])
        value = f(x, live)
        same = np.sign(value) == np.sign(f1[live])
        x3[live] = np.where(same, x1[live], x2[live])
        f3[live] = np.where(same, f1[live], f2[live])
        x2[live] = np.where(same, x2[live], x1[live])
        f2[live] = np.where(same, f2[live], f1[live])
        x1[live], f1[live] = x, value
        closer = np.abs(f2[live]) < np.abs(f1[live])
        best[live] = np.where(closer, x2[live], x1[live])
        width = np.abs(x2[live] - x1[live])
        tolerance = 2e-16 * np.abs(best[live]) + 1e-300
        done = (width <= 4 * tolerance) | (np.where(closer, f2[live], f1[live]) == 0.0)
        live = live[~done]
        if not live.size:
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            xi = (x1[live] - x2[live]) / (x3[live] - x2[live])
            phi = (f1[live] - f2[live]) / (f3[live] - f2[live])
            inverse_quadratic = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
            al = (x3[live] - x1[live]) / (x2[live] - x1[live])
            iqi = f1[live] / (f2[live] - f1[live]) * f3[live] / (f2[live] - f3[live]) + f1[live] / (
                f3[live] - f1[live]
            ) * f2[live] / (f3[live] - f2[live]) * al
        step = np.where(inverse_quadratic & np.isfinite(iqi), iqi, 0.5)
        least = np.minimum(tolerance[~done] / np.maximum(width[~done], 1e-300), 0.5)
        part[live] = np.clip(step, least, 1.0 - least)
    return best
