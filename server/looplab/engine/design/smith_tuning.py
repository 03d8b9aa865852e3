"""A Smith predictor tuned to a given peak of the sensitivity, so that it can be compared with PI and PID fairly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.loop import PID
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning import RULES, KnownPlant, Options
from looplab.engine.tuning.loop_family import time_scale

# Closed-loop time constants that are tried, over the model's time scale and dead time.
SLOWEST, FASTEST, STEPS = 100.0, 0.02, 60
ZOOMS, ZOOM_POINTS = 4, 41


@dataclass(frozen=True)
class SmithTuning:
    """The PI controller inside a predictor.

    Attributes
    ----------
    controller : PID
    tau_c : float
        Closed-loop time constant that gives it, by SIMC's formulas for the model without its dead time [time].
    Ms : float
        Of the loop whose model is right [-].
    on_limit : bool
        False where even the fastest one tried stays below the limit.
    """

    controller: PID
    tau_c: float
    Ms: float
    on_limit: bool


def nominal_peak(controller: PID, model: TransferFunction) -> float:
    r"""Ms of a Smith predictor whose model is right.

    .. math:: M_s = \max_\omega \left|1 - \frac{C G_0}{1 + C G_0}\, e^{-i\omega\theta}\right|

    Parameters
    ----------
    controller : PID
        C, for which C G_0 alone is a stable loop.
    model : TransferFunction
        G_0 with its dead time theta, > 0.

    Returns
    -------
    float

    References
    ----------
    .. [1] J. E. Normey-Rico, E. F. Camacho, Control of Dead-time Processes, Springer 2007, sec. 5.3.
    """
    C0 = controller.to_transfer_function() * model.without_dead_time()
    theta = model.theta

    def size(omega: FloatArray) -> FloatArray:
        L = C0.response(omega)
        return np.abs(1.0 - L / (1.0 + L) * np.exp(-1j * omega * theta))

    marks = np.abs(np.concatenate([model.poles, model.zeros, C0.zeros]))
    low = 1e-2 * min(float(marks[marks > 0].min(initial=1.0 / theta)), 1.0 / theta)
    omega = np.unique(np.concatenate([np.geomspace(low, 200.0 / theta, 800), np.arange(1, 1600) * np.pi / 24 / theta]))
    values = size(omega)
    i = int(np.argmax(values))
    a, b = omega[max(i - 1, 0)], omega[min(i + 1, omega.size - 1)]
    best = float(values[i])
    for _ in range(ZOOMS):
        fine = np.linspace(a, b, ZOOM_POINTS)
        values = size(fine)
        i = int(np.argmax(values))
        best = max(best, float(values[i]))
        a, b = fine[max(i - 1, 0)], fine[min(i + 1, ZOOM_POINTS - 1)]
    return best


def _primary(known: KnownPlant, tau_c: float) -> PID:
    found = known.tune(RULES["simc"], "PI", Options(tau_c=tau_c))
    return PID(found.Kc, found.tau_I)


@lru_cache(maxsize=32)
def smith_tuning(model: TransferFunction, Ms: float) -> SmithTuning:
    r"""The fastest SIMC controller for the model without its dead time that keeps the predictor's loop within Ms.

    .. math:: K_c = \frac{\tau}{K \tau_c}, \quad \tau_I = \min\{\tau, 4\tau_c\}, \qquad M_s(\tau_c) = M_s

    From slow to fast, tau_c is lowered until the peak of the sensitivity, the model being right, reaches the limit.

    Parameters
    ----------
    model : TransferFunction
        With a dead time; stable with real lags, or integrating.
    Ms : float
        Limit, > 1 [-].

    Returns
    -------
    SmithTuning

    Raises
    ------
    RuleNotApplicable
        The model has no dead time, or SIMC has no settings for it.

    References
    ----------
    .. [1] S. Skogestad, J. Process Control 13 (2003) 291-309, sec. 3.
    .. [2] J. E. Normey-Rico, E. F. Camacho, Control of Dead-time Processes, Springer 2007, ch. 5.
    """
    if not model.theta:
        raise RuleNotApplicable(
            "the model has no dead time: there is nothing to predict",
            field="model",
            hint="give it a dead time, as in exp(-4s)/(2s+1)",
        )
    known = KnownPlant.of(model.without_dead_time())
    size = model.theta + time_scale(model)
    times = size * np.geomspace(SLOWEST, FASTEST, STEPS)
    slower = float(times[0])
    for tau_c in times.tolist():
        if nominal_peak(_primary(known, tau_c), model) > Ms:
            break
        slower = tau_c
    else:
        C = _primary(known, slower)
        return SmithTuning(C, slower, nominal_peak(C, model), False)
    if tau_c == slower:
        raise RuleNotApplicable("no closed-loop time constant keeps the predictor within this Ms", field="Ms_limit")
    from scipy.optimize import brentq  # late: a server that does not need it is 26 MB smaller

    tau_c = float(brentq(lambda x: nominal_peak(_primary(known, x), model) - Ms, tau_c, slower, rtol=1e-10))
    C = _primary(known, tau_c)
    return SmithTuning(C, tau_c, nominal_peak(C, model), True)
