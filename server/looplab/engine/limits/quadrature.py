"""Integrals over many panels at once, halved until two orders of Gauss's rule agree."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import NoConvergence

FloatArray = npt.NDArray[np.float64]

ORDER = 16
MAX_PANELS = 60_000
MAX_HALVINGS = 60
_LOW = np.polynomial.legendre.leggauss(ORDER // 2)
_HIGH = np.polynomial.legendre.leggauss(ORDER)


def integrate_panels(
    f: Callable[[FloatArray], FloatArray], edges: FloatArray, tolerance: float
) -> tuple[FloatArray, float]:
    r"""Integral of f over each of the panels between neighbouring edges.

    .. math:: \int_a^b f \approx \tfrac{b-a}{2} \sum_i w_i\, f\big(\tfrac{a+b}{2} + \tfrac{b-a}{2} x_i\big)

    A panel on which 8 and 16 Gauss points differ is halved. Ends are never evaluated, so that f may have a logarithmic
    singularity at an edge.

    Parameters
    ----------
    f : callable
        x, shape (m,) -> values, shape (m,).
    edges : ndarray, shape (n + 1,)
        Increasing.
    tolerance : float
        Difference that is left on one panel [units of the integral].

    Returns
    -------
    integrals : ndarray, shape (n,)
    error : float
        Sum of the differences that are left: far above the true error of the finer rule.

    Raises
    ------
    NoConvergence
        More panels than 60 000 would be needed.

    References
    ----------
    .. [1] P. J. Davis, P. Rabinowitz, Methods of Numerical Integration, 2nd ed., Academic Press 1984, sec. 6.2.
    """
    out = np.zeros(edges.size - 1)
    owner = np.arange(edges.size - 1)
    a, b = edges[:-1], edges[1:]
    error = 0.0
    for _ in range(MAX_HALVINGS):
        half, middle = 0.5 * (b - a), 0.5 * (a + b)
        low, high = (
            half * (f((middle[:, None] + half[:, None] * x).ravel()).reshape(middle.size, -1) @ w)
            for x, w in (_LOW, _HIGH)
        )
        miss = np.abs(high - low)
        # Halving a panel at rounding of its place gains nothing.
        done = (miss <= tolerance) | (half <= 4e-16 * np.abs(middle))
        np.add.at(out, owner[done], high[done])
        error += float(miss[done].sum())
        if done.all():
            return out, error
        rest = ~done
        if 2 * int(rest.sum()) > MAX_PANELS:
            break
        a, b = (
            np.concatenate([a[rest], middle[rest]]),
            np.concatenate([middle[rest], b[rest]]),
        )
        owner = np.concatenate([owner[rest], owner[rest]])
    raise NoConvergence("the integral does not settle", hint="the dead time turns too often within the loop's corners")
