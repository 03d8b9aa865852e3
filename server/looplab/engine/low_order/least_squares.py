"""The model whose step response is closest to the plant's in the mean square."""

from __future__ import annotations

import numpy as np

from looplab.engine.low_order.models import ModelType, require_settling
from looplab.engine.low_order.step_curve import StepCurve, model_step
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

NAME = "least squares fit of the step response"
SOURCE = "definition: smallest integral of the squared deviation over the settling time, gain kept"
_POINTS = 800
_ZETA = (0.02, 20.0)


def least_squares_fit(plant: TransferFunction, type: ModelType, curve: StepCurve | None = None) -> FOPDT | SOPDT:
    r"""Fit tau, theta (and zeta) to the exact step response; the steady-state gain is the plant's.

    .. math:: \min_{\tau, \zeta, \theta} \int_0^{T} \bigl(y(t) - \hat y(t)\bigr)^2 dt

    Parameters
    ----------
    plant : TransferFunction
        Stable, with a steady-state gain.
    type : {"FOPDT", "SOPDT"}
    curve : StepCurve or None
        The plant's step response, where the caller has it already.

    Returns
    -------
    FOPDT or SOPDT
        The best of several starts (the problem has more than one minimum).

    Raises
    ------
    RuleNotApplicable
        The plant does not settle.

    References
    ----------
    .. [1] K. J. Astrom, T. Hagglund, Advanced PID Control, ISA 2006, sec. 2.7 (parametric methods).
    """
    # Half a second of import that only this fit needs.
    from scipy.optimize import least_squares

    K = require_settling(plant)
    curve = curve or StepCurve(plant)
    t = np.linspace(0.0, curve.theta + curve.horizon, _POINTS)
    y = curve(t)
    # Area over the response: dead time plus lags, as seen from t = 0.
    area = float(np.sum(1.0 - y / K) * t[1])
    slow = float((-1.0 / plant.poles.real).max())
    scale = max(area - curve.theta, 0.05 * slow)

    def model(v: FloatArray) -> FOPDT | SOPDT:
        # The bound at zero is approached, never reached: what is left of the dead time then is none.
        tau, theta = float(np.exp(v[0])), float(v[1]) if v[1] > 1e-12 * scale else 0.0
        return FOPDT(K, tau, theta) if type == "FOPDT" else SOPDT(K, tau, float(np.exp(v[2])), theta)

    def error(v: FloatArray) -> FloatArray:
        return (model_step(model(v), t) - y) / K

    split = [(part * scale, curve.theta + (1.0 - part) * scale) for part in (0.95, 0.6)]
    low, high = [np.log(1e-3 * scale), 0.0], [np.log(1e2 * (slow + scale)), curve.theta + curve.horizon]
    if type == "FOPDT":
        starts = [[np.log(lag), theta] for lag, theta in split]
    else:
        pair = plant.poles[np.argmax(plant.poles.real)]
        damping = float(np.clip(-pair.real / abs(pair), 0.05, 1.0))
        starts = [[np.log(0.5 * lag), theta, np.log(zeta)] for lag, theta in split for zeta in (0.5, 1.1)]
        starts.append([np.log(1.0 / abs(pair)), curve.theta, np.log(damping)])
        low, high = [*low, np.log(_ZETA[0])], [*high, np.log(_ZETA[1])]
    accuracy = {"xtol": 1e-12, "ftol": 1e-14, "gtol": 1e-14, "max_nfev": 80}
    fits = [least_squares(error, np.clip(start, low, high), bounds=(low, high), **accuracy) for start in starts]
    return model(min(fits, key=lambda fit: fit.cost).x)
