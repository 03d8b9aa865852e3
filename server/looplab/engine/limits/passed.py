"""What the loop lets through: the sensor's noise to y, the load to y."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.response import default_grid, log_magnitude
from looplab.engine.limits.bode_integral import log_sensitivity
from looplab.engine.limits.frequency_search import highest, widened
from looplab.engine.loop.feedback_loop import FeedbackLoop

FloatArray = npt.NDArray[np.float64]


def noise_passed(loop: FeedbackLoop, omega_n: float) -> float:
    r"""Largest part of the sensor's noise that reaches y from omega_n on.

    .. math:: \max_{\omega \ge \omega_n} |T(i\omega)|, \qquad Y = -T D_m

    Parameters
    ----------
    loop : FeedbackLoop
        Stable.
    omega_n : float
        > 0 [rad/time].

    Returns
    -------
    float
        [-]

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 8.3.
    """
    L = loop.open_loop
    grid = widened(default_grid(L))
    omega = np.concatenate([[omega_n], grid[grid > omega_n]])

    def size(omega: FloatArray) -> FloatArray:
        return log_magnitude(L, omega) + log_sensitivity(L, omega)

    if omega.size == 1:
        return float(np.exp(size(omega)[0]))
    return highest(size, omega)[0]


def load_left(loop: FeedbackLoop) -> tuple[float, float]:
    r"""Largest error that a unit of load leaves, and at which frequency.

    .. math:: \max_\omega |S(i\omega)\, G_d(i\omega)|

    Parameters
    ----------
    loop : FeedbackLoop
        Stable; without a disturbance model Gd is the plant.

    Returns
    -------
    value, omega : float
        [output/load], [rad/time]

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 8.4.
    """
    L, path = loop.open_loop, loop.load_path
    grid = np.unique(np.concatenate([default_grid(L), default_grid(path)]))
    return highest(lambda omega: log_magnitude(path, omega) + log_sensitivity(L, omega), widened(grid))
