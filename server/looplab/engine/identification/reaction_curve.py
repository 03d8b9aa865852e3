"""A first-order model with dead time from the exact step response of a plant (process reaction curve)."""

from __future__ import annotations

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.loop.hermite import HermiteCurves
from looplab.engine.loop.step_response import step_response
from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.systems.transfer_function import TransferFunction

_SLOWEST = 12.0


def two_point(plant: TransferFunction) -> FOPDT:
    r"""FOPDT through 28.3 % and 63.2 % of the step response.

    .. math:: \tau = 1.5\,(t_{63.2} - t_{28.3}), \qquad \theta = t_{63.2} - \tau

    Parameters
    ----------
    plant : TransferFunction
        Stable, proper, with a steady-state gain.

    Returns
    -------
    FOPDT
        Exact when the plant is a FOPDT itself; theta is never negative.

    Raises
    ------
    RuleNotApplicable
        The plant has no steady state to approach, starts in the wrong direction or overshoots: it has no
        reaction curve.

    References
    ----------
    .. [1] C. A. Smith, A. B. Corripio, Principles and Practice of Automatic Process Control, 3rd ed., Wiley 2006,
       sec. 7-2 (fit 3).
    """
    P = plant
    if P.poles.size and P.poles.real.max() >= 0:
        raise RuleNotApplicable(
            "the plant does not settle after a step, so it has no reaction curve",
            field="plant",
            hint="use the ultimate cycle instead",
        )
    K = P.dc_gain
    if not K or not P.order:
        raise RuleNotApplicable("the plant's step response does not end at a new value", field="plant")
    if P.order == 1 and not P.zeros.size:
        return FOPDT(K, float(-1.0 / P.poles[0].real), P.theta)
    slow = float((-1.0 / P.poles.real).max())
    horizon = P.theta + _SLOWEST * slow * max(1, int(np.count_nonzero(-1.0 / P.poles.real > 0.3 * slow)))
    response = step_response(P.without_dead_time(), horizon - P.theta, 2000)
    curve = HermiteCurves(response.t, response.y[None] / K, response.dy[None] / K)
    if curve.y.min() < -1e-3 or curve.y.max() > 1.1:
        raise RuleNotApplicable(
            "the step response overshoots or starts in the wrong direction: a first-order model does not describe it",
            field="plant",
            hint="use the ultimate cycle instead",
        )
    low, high = curve.crossings(0, 1 - np.exp(-1 / 3)), curve.crossings(0, 1 - np.exp(-1))
    if not low or not high:
        raise RuleNotApplicable(
            "the step response jumps past its 28.3 % point: a first-order model does not describe it", field="plant"
        )
    tau = 1.5 * (high[0] - low[0])
    return FOPDT(K, tau, P.theta + max(0.0, high[0] - tau))
