"""Taylor approximation: the slowest lags are kept, every other factor becomes dead time."""

from __future__ import annotations

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.low_order.models import ModelType, require_settling, second_order
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.transfer_function import TransferFunction

NAME = "Taylor (neglected lags become dead time)"
SOURCE = "D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, sec. 6.3"


def taylor(plant: TransferFunction, type: ModelType) -> FOPDT | SOPDT:
    r"""Keep the slowest poles and replace the rest to first order in s.

    .. math:: \frac{1}{\tau s + 1} \approx e^{-\tau s}, \qquad T s + 1 \approx e^{T s}

    Both sides have the same slope at s = 0, so that the area between the step response and its final value,
    K (theta + sum of the lags), is the plant's.

    Parameters
    ----------
    plant : TransferFunction
        Stable; complex poles are kept where they are the slowest and the model is of second order.
    type : {"FOPDT", "SOPDT"}

    Returns
    -------
    FOPDT or SOPDT

    Raises
    ------
    RuleNotApplicable
        The plant does not settle, its slowest poles do not fit the model, or the dead time would be negative.

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, sec. 6.3.
    """
    K = require_settling(plant)
    poles = plant.poles[np.lexsort((-plant.poles.imag, -plant.poles.real))]
    kept = 1 if type == "FOPDT" else 2
    if poles.size < kept:
        raise RuleNotApplicable("the plant has fewer lags than the model", field="plant")
    slow, rest = poles[:kept], poles[kept:]
    if abs(slow.imag.sum()) > 0:
        raise RuleNotApplicable(
            "the slowest poles are complex: they do not fit the model",
            field="plant",
            hint="use a second-order model, or the fit of the step response",
        )
    theta = plant.theta + float((-1.0 / rest).real.sum() + (1.0 / plant.zeros).real.sum())
    if theta < 0:
        raise RuleNotApplicable(
            "the zeros lead by more than the neglected lags: the dead time would be negative", field="plant"
        )
    if type == "FOPDT":
        return FOPDT(K, float(-1.0 / slow[0].real), theta)
    if slow[0].imag:
        omega_n = float(abs(slow[0]))
        return SOPDT(K, 1.0 / omega_n, float(-slow[0].real) / omega_n, theta)
    return second_order(K, float(-1.0 / slow[0].real), float(-1.0 / slow[1].real), theta)
