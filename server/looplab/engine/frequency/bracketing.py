"""Vectorised root refinement between brackets (Chandrupatla's method)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def refine_brackets(
    f: Callable[[FloatArray], FloatArray], a: FloatArray, b: FloatArray, max_iterations: int = 60
) -> FloatArray:
    """Roots of f between a and b, all brackets at once, to rounding.

    Parameters
    ----------
    f : callable
        x, shape (m,) -> values, shape (m,); x[i] belongs to bracket i.
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
    x1, x2 = a.astype(float), b.astype(float)
    if not x1.size:
        return x1
    f1, f2 = f(x1), f(x2)
    part = np.full(a.size, 0.5)
    best = x1
    with np.errstate(all="ignore"):
        for _ in range(max_iterations):
            x = x1 + part * (x2 - x1)
            value = f(x)
            same = np.signbit(value) == np.signbit(f1)
            x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
            x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
            x1, f1 = x, value
            closer = np.abs(f2) < np.abs(f1)
            best = np.where(closer, x2, x1)
            width = np.abs(x2 - x1)
            tolerance = 4e-16 * np.abs(best) + 1e-300
            open_ = (width > 2 * tolerance) & (f1 != 0) & (f2 != 0)
            if not open_.any():
                break
            # Inverse quadratic interpolation where it is safe, else bisection.
            xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
            smooth = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
            step = f1 / (f2 - f1) * f3 / (f2 - f3) + f1 / (f3 - f1) * f2 / (f3 - f2) * ((x3 - x1) / (x2 - x1))
            least = np.minimum(tolerance / width, 0.5)
            part = np.where(smooth & np.isfinite(step), np.clip(step, least, 1.0 - least), 0.5)
            part = np.where(open_, part, 0.0)
    return best
