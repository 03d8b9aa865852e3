"""Two points of a recorded step response."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.identification.result import Fitted
from looplab.engine.identification.step_data import StepData
from looplab.engine.systems.first_second_order import FOPDT


@dataclass(frozen=True)
class TwoPoints:
    """tau = stretch (t2 - t1), theta = weights . (t1, t2), times from the step on."""

    fractions: tuple[float, float]
    stretch: float
    weights: tuple[float, float]


SMITH = TwoPoints((1 - float(np.exp(-1 / 3)), 1 - float(np.exp(-1))), 1.5, (1.5, -0.5))
SUNDARESAN_KRISHNASWAMY = TwoPoints((0.353, 0.853), 0.67, (1.3, -0.29))


def two_points(data: StepData, rule: TwoPoints = SMITH) -> Fitted:
    r"""FOPDT through two points of the curve.

    .. math::

        \tau = 1.5\,(t_{63.2} - t_{28.3}), \quad \theta = t_{63.2} - \tau \qquad\text{(Smith)}

        \tau = 0.67\,(t_{85.3} - t_{35.3}), \quad \theta = 1.3\,t_{35.3} - 0.29\,t_{85.3}
        \qquad\text{(Sundaresan, Krishnaswamy)}

    Parameters
    ----------
    data : StepData
    rule : TwoPoints
        Smith's is exact for a FOPDT, the other within 1 %.

    Returns
    -------
    Fitted
        With t0, t1, t2 (of the two points), y1, y2, y0 and y_final as its construction.

    Raises
    ------
    RuleNotApplicable
        The curve does not pass both points.

    References
    ----------
    .. [1] C. A. Smith, A. B. Corripio, Principles and Practice of Automatic Process Control, 3rd ed., Wiley 2006,
       sec. 7-2 (fit 3).
    .. [2] K. R. Sundaresan, P. R. Krishnaswamy, Can. J. Chem. Eng. 56 (1978) 257-262.
    """
    t1, t2 = (data.crossing(fraction) for fraction in rule.fractions)
    tau = rule.stretch * (t2 - t1)
    if not tau > 0:
        raise RuleNotApplicable("the curve jumps past both points at once", field="y", hint="sample faster")
    theta = rule.weights[0] * t1 + rule.weights[1] * t2
    notes = data.notes
    if theta < -1e-6 * tau:
        notes = (*notes, "the two points give a dead time below zero: theta is taken as 0")
    change = data.y_final - data.y0
    construction = {
        "t0": data.t_step,
        "t1": data.t_step + t1,
        "t2": data.t_step + t2,
        "y1": data.y0 + rule.fractions[0] * change,
        "y2": data.y0 + rule.fractions[1] * change,
        "y0": data.y0,
        "y_final": data.y_final,
        "window": data.window,
    }
    return Fitted(FOPDT(data.K, tau, max(0.0, theta)), data.y0, construction=construction, notes=notes)
