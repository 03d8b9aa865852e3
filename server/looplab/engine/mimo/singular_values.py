"""Singular values and condition numbers: in which direction a process answers strongly, and in which weakly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.mimo.relative_gain import relative_gain_array
from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class SingularValues:
    """Singular values, largest first, shape (N, n), and their quotients, shape (N,).

    ``condition_number`` depends on the units of inputs and outputs; ``minimized`` is its least value over all units,
    known in closed form for two loops, None for more. Infinite where the matrix is singular.
    """

    values: FloatArray
    condition_number: FloatArray
    minimized: FloatArray | None


def singular_values(G: npt.NDArray) -> SingularValues:
    r"""Singular values and condition numbers of matrices.

    .. math:: \gamma = \frac{\bar\sigma}{\underline\sigma}, \qquad
        \min_{D_1, D_2} \gamma(D_1 G D_2) = m + \sqrt{m^2 - 1}, \quad m = |\lambda_{11}| + |\lambda_{12}| \ (n = 2)

    For two loops :math:`\gamma + 1/\gamma = \|G\|_F^2/|\det G|`, and scaling with a fixed determinant makes the norm
    least at :math:`2(|g_{11} g_{22}| + |g_{12} g_{21}|)`.

    Parameters
    ----------
    G : ndarray, shape (N, n, n)

    Returns
    -------
    SingularValues

    References
    ----------
    .. [1] P. Grosdidier, M. Morari, B. R. Holt, Ind. Eng. Chem. Fundam. 24 (1985) 221-235.
    .. [2] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 3.4.
    """
    values = np.linalg.svd(G, compute_uv=False)
    with np.errstate(divide="ignore", invalid="ignore"):
        number = np.where(values[:, -1] > 0, values[:, 0] / values[:, -1], np.inf)
    if G.shape[-1] != 2:
        return SingularValues(values, number, None)
    m = np.full(G.shape[0], np.inf)
    for at, matrix in enumerate(G):
        try:
            m[at] = np.abs(relative_gain_array(matrix)[0]).sum()
        except InvalidInput:
            continue
    with np.errstate(invalid="ignore"):
        least = np.where(np.isfinite(m), m + np.sqrt(np.maximum(m * m - 1.0, 0.0)), np.inf)
    return SingularValues(values, number, least)
