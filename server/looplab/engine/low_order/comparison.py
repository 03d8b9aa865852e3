"""Low-order models of one plant beside each other, each with how far its step response strays from the true one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.identification import two_point
from looplab.engine.low_order import half_rule as half_rule_module
from looplab.engine.low_order import least_squares as least_squares_module
from looplab.engine.low_order import taylor as taylor_module
from looplab.engine.low_order.models import MODEL_TYPES, ModelType, require_settling
from looplab.engine.low_order.step_curve import StepCurve, model_step
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

MethodName = Literal["half_rule", "taylor", "two_point", "least_squares"]
Found = FOPDT | SOPDT
_SAMPLES = 4001


def _two_point(plant: TransferFunction, type: ModelType, curve: StepCurve) -> Found:
    if type != "FOPDT":
        raise RuleNotApplicable("two points give a first-order model only", field="plant")
    K = require_settling(plant)
    found = two_point(plant * (1.0 / K))
    return FOPDT(K, found.tau, found.theta)


@dataclass(frozen=True)
class Method:
    """One way to find a low-order model: its name, its source and its function."""

    name: str
    source: str
    find: Callable[[TransferFunction, ModelType, StepCurve], Found]


METHODS: dict[MethodName, Method] = {
    "half_rule": Method(
        half_rule_module.NAME, half_rule_module.SOURCE, lambda P, type, _: half_rule_module.half_rule(P, type)
    ),
    "taylor": Method(taylor_module.NAME, taylor_module.SOURCE, lambda P, type, _: taylor_module.taylor(P, type)),
    "two_point": Method(
        "two points of the step response (28.3 % and 63.2 %)",
        "C. A. Smith, A. B. Corripio, Principles and Practice of Automatic Process Control, 3rd ed., sec. 7-2",
        _two_point,
    ),
    "least_squares": Method(
        least_squares_module.NAME, least_squares_module.SOURCE, least_squares_module.least_squares_fit
    ),
}


@dataclass(frozen=True)
class Approximation:
    """One model, or None with the reason why the method refuses.

    Attributes
    ----------
    method, type : str
        Key of METHODS; "FOPDT" or "SOPDT".
    model : FOPDT or SOPDT or None
        What was found.
    max_deviation, t_max_deviation : float or None
        Largest distance between the step responses [output] and when [time].
    max_deviation_pct : float or None
        The same in percent of the steady-state gain [%].
    reason : str or None
        Why there is no model.
    """

    method: MethodName
    type: ModelType
    model: Found | None = None
    max_deviation: float | None = None
    t_max_deviation: float | None = None
    max_deviation_pct: float | None = None
    reason: str | None = None


@dataclass(frozen=True)
class Deviation:
    """Largest distance between two step responses, ``value`` [output], and when, ``t`` [time]."""

    value: float
    t: float


@dataclass(frozen=True)
class Comparison:
    """Every method with every type; ``curve`` is None, with the ``reason``, where the plant has no such models."""

    models: tuple[Approximation, ...]
    curve: StepCurve | None
    reason: str | None = None


def largest_deviation(curve: StepCurve, model: Found) -> Deviation:
    """Largest distance between a plant's and a model's unit step response.

    Sampled with the kinks at both dead times among the samples, then refined around the largest sample.

    Parameters
    ----------
    curve : StepCurve
        The plant's.
    model : FOPDT or SOPDT

    Returns
    -------
    Deviation
    """
    end = curve.theta + curve.horizon
    kinks = [v for v in (curve.theta, model.theta) if v <= end]
    t = np.unique(np.concatenate([np.linspace(0.0, end, _SAMPLES), kinks]))

    def distance(at: FloatArray) -> FloatArray:
        return np.abs(curve(at) - model_step(model, at))

    for _ in range(4):
        d = distance(t)
        i = int(np.argmax(d))
        best, when = float(d[i]), float(t[i])
        around = [t[max(i - 1, 0)], t[i], t[min(i + 1, t.size - 1)]]
        t = np.unique(np.concatenate([np.linspace(around[0], around[1], 41), np.linspace(around[1], around[2], 41)]))
    return Deviation(best, when)


def approximate(
    plant: TransferFunction,
    methods: Sequence[MethodName] = tuple(METHODS),
    types: Sequence[ModelType] = MODEL_TYPES,
) -> Comparison:
    """Find low-order models of a plant and compare them with its exact step response.

    Parameters
    ----------
    plant : TransferFunction
        Proper.
    methods, types : sequence of str
        Which methods and model types, in which order.

    Returns
    -------
    Comparison
        Refusals are in it with their reason: a rule that is for real poles, a plant that does not settle.

    Raises
    ------
    ImproperSystem
        More zeros than poles.
    """
    pairs = [(method, type) for method in methods for type in types]
    try:
        K = require_settling(plant)
    except RuleNotApplicable as error:
        return Comparison(tuple(Approximation(*pair, reason=error.message) for pair in pairs), None, error.message)
    curve = StepCurve(plant)
    out = []
    for method, type in pairs:
        try:
            model = METHODS[method].find(plant, type, curve)
        except RuleNotApplicable as error:
            out.append(Approximation(method, type, reason=error.message))
            continue
        found = largest_deviation(curve, model)
        out.append(Approximation(method, type, model, found.value, found.t, 100.0 * found.value / abs(K)))
    return Comparison(tuple(out), curve)
