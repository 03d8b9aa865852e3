"""The tangent at the inflection of a step response (process reaction curve)."""

from __future__ import annotations

import numpy as np

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.identification.result import Fitted
from looplab.engine.identification.step_data import Choices, StepData
from looplab.engine.systems.first_second_order import FOPDT


def tangent(data: StepData, choices: Choices | None = None, to_63: bool = False) -> Fitted:
    r"""FOPDT by the steepest tangent: t1 where it meets y0, t2 where it meets y_final.

    .. math:: K = \frac{y_\infty - y_0}{\Delta u}, \quad \theta = t_1 - t_0, \quad \tau = t_2 - t_1
        \quad\text{or}\quad \tau = t_{63.2} - t_1

    Parameters
    ----------
    data : StepData
        Smoothed; the inflection is the sample with the steepest slope on the way to 63.2 %.
    choices : Choices or None
        A tangent drawn by hand: where it touches and its slope, each taken from the curve where left out.
    to_63 : bool
        tau from 63.2 % of the change instead of from the tangent's end.

    Returns
    -------
    Fitted
        With t0, t1, t2, t_inflection, y_inflection, slope, y0 and y_final as its construction.

    Raises
    ------
    InvalidInput
        The tangent drawn by hand goes the other way than the output.
    RuleNotApplicable
        The tangent gives no positive time constant.

    References
    ----------
    .. [1] J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768.
    .. [2] C. A. Smith, A. B. Corripio, Principles and Practice of Automatic Process Control, 3rd ed., Wiley 2006,
       sec. 7-2 (fits 1 and 2).
    """
    choices = choices or Choices()
    way = float(np.sign(data.y_final - data.y0))
    t = choices.t_inflection
    if t is None:
        t = data.steepest()
    on_curve, slope_there = data.at(t)
    y = on_curve if choices.y_inflection is None else choices.y_inflection
    slope = slope_there if choices.slope is None else choices.slope
    if not way * slope > 0:
        raise InvalidInput(
            "the tangent must go the way that the output goes",
            field="slope",
            hint=f"a slope {'above' if way > 0 else 'below'} zero",
        )
    t1, t2 = t + (data.y0 - y) / slope, t + (data.y_final - y) / slope
    tau = data.crossing(1 - np.exp(-1.0)) + data.t_step - t1 if to_63 else t2 - t1
    if not tau > 0:
        raise RuleNotApplicable("the tangent meets y0 after the curve has passed 63.2 % of its change", field="y")
    notes = data.notes
    if t1 < data.t_step - 1e-6 * tau:
        notes = (*notes, "the tangent meets y0 before the step: theta is taken as 0")
    construction = {
        "t0": data.t_step,
        "t1": t1,
        "t2": t1 + tau,
        "t_inflection": t,
        "y_inflection": y,
        "slope": slope,
        "y0": data.y0,
        "y_final": data.y_final,
        "window": data.window,
    }
    return Fitted(FOPDT(data.K, tau, max(0.0, t1 - data.t_step)), data.y0, construction=construction, notes=notes)
