"""Exact step responses as curves: of a plant of any order, and of a low-order model in closed form."""

from __future__ import annotations

import math

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.step_response import step_response
from looplab.engine.low_order.models import require_settling
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

_SAMPLES = 4000
_SETTLED = 12.0
_PERIODS = 40.0


def settling_horizon(plant: TransferFunction) -> float:
    """A time after the dead time by which a stable plant has settled [time]; light damping is cut at 40 periods."""
    slow = 0.0
    for p in plant.poles:
        decay = _SETTLED / -p.real
        slow = max(slow, min(decay, _PERIODS * 2.0 * math.pi / abs(p.imag)) if p.imag else decay)
    real = -1.0 / plant.poles.real
    # Lags in series settle one after the other.
    return slow * max(1, int(np.count_nonzero(real > 0.3 * real.max()))) ** 0.5


class StepCurve:
    """Unit step response of a stable plant at any time: exact samples and slopes, cubic between them.

    Between the samples within 5e-6 of its largest value, for the lightest damping (far closer otherwise). Raises
    InvalidInput where the response dwarfs its final value.
    """

    def __init__(self, plant: TransferFunction) -> None:
        self.theta, self.horizon = plant.theta, settling_horizon(plant)
        K = require_settling(plant)
        # Of unit gain, so that it is not cut for its unit's sake.
        response = step_response(plant.without_dead_time() * (1.0 / K), self.horizon, _SAMPLES)
        if response.truncated_at is not None:
            raise InvalidInput(
                "the step response grows to a billion times its final value: no low-order model describes it",
                field="plant",
            )
        self._h = self.horizon / (_SAMPLES - 1)
        self._y, self._slope = K * response.y, K * response.dy * self._h
        self.size = float(np.abs(response.y).max())

    def __call__(self, t: FloatArray) -> FloatArray:
        """y(t), shape of t, within the horizon after the dead time [time]."""
        x = np.clip((t - self.theta) / self._h, 0.0, self._y.size - 1.0)
        piece = np.minimum(x.astype(int), self._y.size - 2)
        x = x - piece
        y0, y1, m0, m1 = self._y[piece], self._y[piece + 1], self._slope[piece], self._slope[piece + 1]
        c, d = 3.0 * (y1 - y0) - 2.0 * m0 - m1, m0 + m1 - 2.0 * (y1 - y0)
        return np.where(t >= self.theta, y0 + x * (m0 + x * (c + x * d)), 0.0)


def model_step(model: FOPDT | SOPDT, t: FloatArray) -> FloatArray:
    """Unit step response of a model in closed form, shape of t; smooth through critical damping."""
    x = np.maximum(t - model.theta, 0.0)
    if isinstance(model, FOPDT):
        return -model.K * np.expm1(-x / model.tau)
    beta = np.sqrt(complex(model.zeta**2 - 1.0)) / model.tau
    slow = np.exp((-model.zeta / model.tau + beta) * x)
    # (1 - e^{-2 beta x})/(2 beta): x where beta vanishes.
    wave = -np.expm1(-2.0 * beta * x) / (2.0 * beta) if abs(beta) * model.tau > 1e-9 else x.astype(complex)
    cosine = slow * 0.5 * (1.0 + np.exp(-2.0 * beta * x))
    y: FloatArray = model.K * (1.0 - (cosine + model.zeta / model.tau * slow * wave).real)
    return y
