"""The Padé approximation of a dead time, for designs that need a rational plant and say so."""

from __future__ import annotations

from math import comb, factorial

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.transfer_function import TransferFunction

LARGEST_ORDER = 8


def pade(theta: float, order: int) -> TransferFunction:
    r"""The diagonal Padé approximation of a dead time.

    .. math::

        e^{-\theta s} \approx \frac{\sum_k c_k (-\theta s)^k}{\sum_k c_k (\theta s)^k}, \qquad
        c_k = \binom{n}{k} \frac{(2n - k)!}{(2n)!}

    Parameters
    ----------
    theta : float
        Dead time, > 0 [time].
    order : int
        n, from 1 to 8.

    Returns
    -------
    TransferFunction
        All-pass, with n zeros in the right half-plane.

    Raises
    ------
    InvalidInput
        The order is outside its range.

    References
    ----------
    .. [1] G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., Johns Hopkins 2013, sec. 9.3.1.
    """
    if not 1 <= order <= LARGEST_ORDER:
        raise InvalidInput(f"the order must be from 1 to {LARGEST_ORDER}", field="pade_order")
    c = np.array([comb(order, k) * factorial(2 * order - k) / factorial(2 * order) for k in range(order, -1, -1)])
    powers = np.arange(order, -1, -1)
    return TransferFunction.from_polynomials(c * (-theta) ** powers, c * theta**powers)
