"""Confidence intervals of estimated parameters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from looplab.engine.systems.polynomial import FloatArray

LEVEL = 0.95
ASSUMPTIONS = (
    "linearised about the estimate, for independent normal noise of one size and a model structure that is the plant's"
)


def confidence_intervals(
    estimate: FloatArray, scale: FloatArray, jacobian: FloatArray, which: Sequence[int], residual: FloatArray
) -> list[tuple[float, float]]:
    r"""95 % intervals by linearisation.

    .. math:: \hat p_i \pm t_{0.975,\,n-p}\; \sqrt{s^2\,\bigl[(J^T J)^{-1}\bigr]_{ii}}, \quad
        s^2 = \frac{\sum r_j^2}{n - p}

    Parameters
    ----------
    estimate : ndarray, shape (k,)
        The parameters that are wanted.
    scale : ndarray, shape (k,)
        Their change with the column's parameter (tau for a column after ln tau).
    jacobian : ndarray, shape (n, p)
        Of the output after all parameters.
    which : sequence of int
        Their columns.
    residual : ndarray, shape (n,)

    Returns
    -------
    list of (low, high)
        Those of a dead time are cut at zero by the caller, where that matters.

    References
    ----------
    .. [1] G. A. F. Seber, C. J. Wild, Nonlinear Regression, Wiley 1989, sec. 5.1.
    """
    # Only this needs the distribution.
    from scipy.special import stdtrit

    n, p = jacobian.shape
    size = np.maximum(np.linalg.norm(jacobian, axis=0), 1e-300)
    _, s, Vt = np.linalg.svd(jacobian / size, full_matrices=False)
    # A direction that the data do not see has no end: its width overflows to a very wide interval.
    with np.errstate(over="ignore"):
        spread = np.linalg.norm(Vt.T / np.maximum(s, 1e-15), axis=1) / size
    sigma = float(np.sqrt(residual @ residual / (n - p)))
    factor = float(stdtrit(n - p, 0.5 + 0.5 * LEVEL)) * sigma
    half = [factor * float(spread[i]) * abs(float(m)) for i, m in zip(which, scale, strict=True)]
    return [(float(e) - h, float(e) + h) for e, h in zip(estimate, half, strict=True)]
