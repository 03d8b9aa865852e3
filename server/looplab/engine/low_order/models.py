"""A low-order model with dead time, and what every way to find one starts from."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

ModelType = Literal["FOPDT", "SOPDT"]
SMALLEST_GAIN, LARGEST_GAIN = 1e-100, 1e100
MODEL_TYPES: tuple[ModelType, ...] = ("FOPDT", "SOPDT")


@dataclass(frozen=True)
class Lags:
    """A stable plant with real poles as K prod(T s + 1)/prod(tau s + 1) e^{-theta s}.

    Attributes
    ----------
    K : float
        Steady-state gain [output/input].
    lags : tuple of float
        Time constants of the poles, longest first [time].
    leads : tuple of float
        Time constants of the left half-plane zeros, longest first [time].
    inverse : tuple of float
        Time constants of the right half-plane zeros, positive, longest first [time].
    theta : float
        Dead time [time].
    """

    K: float
    lags: tuple[float, ...]
    leads: tuple[float, ...]
    inverse: tuple[float, ...]
    theta: float


def steady_gain(plant: TransferFunction) -> float:
    """G(0), infinite for an integrator; of a size that can be squared.

    Raises
    ------
    InvalidInput
        The gain is outside 1e-100 ... 1e100.
    """
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        K = plant.dc_gain if plant.gain else 0.0
    if K and not plant.origin_order > 0 and not SMALLEST_GAIN <= abs(K) <= LARGEST_GAIN:
        raise InvalidInput(
            f"the steady-state gain {K:.3g} is outside {SMALLEST_GAIN:g} ... {LARGEST_GAIN:g}",
            field="plant",
            hint="choose units in which it is moderate",
        )
    return K


def require_settling(plant: TransferFunction) -> float:
    """Steady-state gain of a plant whose step response settles at a new value.

    Raises
    ------
    ImproperSystem
        More zeros than poles.
    InvalidInput
        The gain is too large or too small to compute with.
    RuleNotApplicable
        The step response does not settle, or settles where it began, or there are no poles.
    """
    plant.require_proper("plant")
    if not plant.order:
        raise RuleNotApplicable("the plant has no poles: there is nothing to approximate", field="plant")
    if plant.poles.real.max() >= 0:
        raise RuleNotApplicable(
            "the plant does not settle after a step: these models are for stable plants", field="plant"
        )
    K = steady_gain(plant)
    if K == 0:
        raise RuleNotApplicable("the step response ends where it began", field="plant")
    return K


def time_constants(plant: TransferFunction) -> Lags:
    """Time constants of a stable plant with real poles and zeros.

    Raises
    ------
    RuleNotApplicable
        A pole or zero is complex, or the plant does not settle.
    """
    K = require_settling(plant)
    if plant.poles.imag.any() or plant.zeros.imag.any():
        raise RuleNotApplicable(
            "this rule is for real poles and zeros",
            field="plant",
            hint="for an oscillating plant use the fit of the step response",
        )
    lags = -1.0 / plant.poles.real
    times: FloatArray = -1.0 / plant.zeros.real

    def ordered(values: FloatArray) -> tuple[float, ...]:
        return tuple(float(v) for v in np.sort(values)[::-1])

    return Lags(K, ordered(lags), ordered(times[times > 0]), ordered(-times[times < 0]), plant.theta)


def second_order(K: float, tau_1: float, tau_2: float, theta: float) -> SOPDT:
    """The SOPDT with two real lags."""
    tau = math.sqrt(tau_1) * math.sqrt(tau_2)
    return SOPDT(K, tau, (tau_1 + tau_2) / (2.0 * tau), theta)


def real_lags(model: FOPDT | SOPDT) -> tuple[float, float] | None:
    """Slow and fast lag of an overdamped or critically damped second-order model [time]."""
    if isinstance(model, FOPDT) or model.zeta < 1.0:
        return None
    root = math.sqrt((model.zeta - 1.0) * (model.zeta + 1.0))
    slow = model.tau * (model.zeta + root)
    return slow, model.tau**2 / slow
