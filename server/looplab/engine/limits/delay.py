"""What a dead time leaves of the best possible loop."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]


def ideal_delay_loop(theta: float, omega: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    r"""S and T of the best loop around a dead time: y follows r exactly, theta later.

    .. math:: T = e^{-\theta s}, \qquad S = 1 - e^{-\theta s}, \qquad |S(i\omega)| = 2|\sin(\theta\omega/2)|

    Parameters
    ----------
    theta : float
        > 0 [time].
    omega : ndarray, shape (n,)
        [rad/time]

    Returns
    -------
    S, T : ndarray of complex, shape (n,)
        \|S\| reaches 1 at pi/(3 theta), a little above 1/theta; \|T\| is 1 everywhere.

    Raises
    ------
    InvalidInput
        theta is not positive.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 5.6.
    """
    if not theta > 0:
        raise InvalidInput("the dead time must be positive", field="theta")
    half = 0.5 * theta * omega
    # 1 - exp(-i x) without cancellation at small x
    return 2j * np.sin(half) * np.exp(-1j * half), np.exp(-2j * half)


def delay_bound(theta: float) -> float:
    r"""Highest useful crossover with a dead time.

    .. math:: \omega_c < 1/\theta

    Parameters
    ----------
    theta : float
        > 0 [time].

    Returns
    -------
    float
        [rad/time]

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 5.6.2.
    """
    return 1.0 / theta
