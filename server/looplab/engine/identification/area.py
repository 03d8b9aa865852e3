"""The area method, which sums the response up instead of reading points of it."""

from __future__ import annotations

import math

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.identification.result import Fitted
from looplab.engine.identification.step_data import StepData
from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.systems.polynomial import FloatArray


def _integral(t: FloatArray, y: FloatArray, end: float) -> float:
    """Of the straight lines through the samples, from the first to ``end``."""
    inside = t < end
    times = np.append(t[inside], end)
    values = np.append(y[inside], np.interp(end, t, y))
    return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(times)))


def area(data: StepData) -> Fitted:
    r"""FOPDT from two areas: over the whole curve, and under its beginning. No smoothing is needed.

    .. math::

        T_{ar} = \int_0^\infty \Bigl(1 - \frac{y - y_0}{y_\infty - y_0}\Bigr) dt = \theta + \tau, \qquad
        \tau = e \int_0^{T_{ar}} \frac{y - y_0}{y_\infty - y_0}\, dt

    Parameters
    ----------
    data : StepData
        Its raw samples are joined by straight lines.

    Returns
    -------
    Fitted
        With t0, t_ar, y0 and y_final as its construction.

    Raises
    ------
    RuleNotApplicable
        An area is not positive, as where the output overshoots much.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, PID Controllers: Theory, Design, and Tuning, 2nd ed., ISA 1995, sec. 2.4.
    """
    t = data.t - data.t_step
    z = (data.raw - data.y0) / (data.y_final - data.y0)
    if t[0] > 0:
        t, z = np.append(0.0, t), np.append(0.0, z)
    residence = _integral(t, 1.0 - z, float(t[-1]))
    if not 0 < residence < t[-1]:
        raise RuleNotApplicable("the area between the curve and its final value is not positive", field="y")
    tau = math.e * _integral(t, z, residence)
    if not tau > 0:
        raise RuleNotApplicable("the area under the beginning of the curve is not positive", field="y")
    theta, notes = residence - tau, data.notes
    if theta < -1e-6 * tau:
        notes = (*notes, "the areas give a dead time below zero: theta is taken as 0")
    construction = {"t0": data.t_step, "t_ar": data.t_step + residence, "y0": data.y0, "y_final": data.y_final}
    return Fitted(FOPDT(data.K, tau, max(0.0, theta)), data.y0, construction=construction, notes=notes)
