"""Laplace transforms: partial fractions, y(t), limits; and low-order models of a plant."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.responses import Response

from looplab.api.answers.laplace import ApproximateAnswer, LaplaceAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import complex_pairs, json_response
from looplab.api.strict import StrictRoute
from looplab.engine import laplace as lap
from looplab.engine import low_order
from looplab.engine.errors import InvalidInput
from looplab.engine.systems import FOPDT, SOPDT, TransferFunction
from looplab.engine.systems.polynomial import roots
from looplab.labs.text import render_math
from looplab.schemas import FOPDTSystem, Model, SOPDTSystem, System, located
from looplab.schemas.laplace import LinearODE, StepTransform, TransformInput

router = APIRouter(tags=["laplace"], route_class=StrictRoute)

LARGEST_VALUE = 1e9
Method = Literal["half_rule", "taylor", "two_point", "least_squares"]
ModelTypeName = Literal["FOPDT", "SOPDT"]


class LaplaceRequest(Model):
    """A system at rest or a linear ODE with initial values, and its input."""

    system: System | None = None
    ode: LinearODE | None = None
    input: TransformInput | None = Field(
        default=StepTransform(type="step"), description="null: a system's own transform G(s); an ODE without input."
    )
    horizon: Annotated[float, Field(ge=1e-9, le=1e9)] | None = None
    points: Annotated[int, Field(ge=20, le=5000)] = 300
    arrays: Literal["list", "f4"] = "list"

    @model_validator(mode="after")
    def _one_source(self) -> LaplaceRequest:
        if (self.system is None) == (self.ode is None):
            raise ValueError("give either a system or an ode")
        return self


class ApproximateRequest(Model):
    """A plant, and which models of it are wanted."""

    plant: System
    methods: Annotated[list[Method], Field(min_length=1, max_length=8)] = Field(
        default=["half_rule", "taylor", "two_point", "least_squares"]
    )
    types: Annotated[list[ModelTypeName], Field(min_length=1, max_length=4)] = Field(default=["FOPDT", "SOPDT"])
    points: Annotated[int, Field(ge=20, le=5000)] = 300
    arrays: Literal["list", "f4"] = "list"


def _mathml(latex: str) -> str | None:
    try:
        return render_math(latex)
    except InvalidInput:
        # A sum of fifty terms has no place on a line.
        return None


def _formula(text: str, latex: str) -> dict[str, Any]:
    return {"text": text, "latex": latex, "mathml": _mathml(latex)}


def _time_formula(y: lap.ExponentialSum) -> dict[str, Any]:
    return _formula(y.to_text(), y.to_latex())


def _character(system: TransferFunction | None) -> dict[str, Any] | None:
    if system is None or not 1 <= system.order <= 2 or not system.gain:
        return None
    try:
        return asdict(low_order.characterize(system))
    except InvalidInput:
        # Numbers too large to read anything from; the transform itself has been answered.
        return None


def _samples(y: lap.ExponentialSum, horizon: float, points: int) -> dict[str, Any]:
    t = np.linspace(0.0, horizon, points)
    values = y(t)
    with np.errstate(invalid="ignore"):
        bad = ~(np.abs(values) < LARGEST_VALUE)
    stop = int(np.argmax(bad)) if bad.any() else t.size
    cut = stop < t.size
    return {
        "t": t[:stop],
        "y": values[:stop],
        "truncated_at": float(t[stop]) if cut else None,
        "truncated_reason": f"y grows beyond {LARGEST_VALUE:g}" if cut else None,
    }


def _simulated(check: lap.SimulationCheck) -> dict[str, Any]:
    shown = (check.t <= check.horizon) & (np.abs(check.y) < LARGEST_VALUE)
    return {"simulated_t": check.t[shown], "simulated_y": check.y[shown]}


def _limits(fractions: lap.PartialFractions) -> dict[str, Any]:
    found = {"initial_value": lap.initial_value(fractions), "final_value": lap.final_value(fractions)}
    return {
        **{name: limit.value for name, limit in found.items()},
        "reasons": {name: limit.reason for name, limit in found.items() if limit.reason},
        "formula": {name: limit.formula for name, limit in found.items()},
    }


def _transform(rational: lap.Rational) -> TransferFunction:
    zeros = np.concatenate([rational.zeros, roots(rational.coefficients)])
    return TransferFunction(zeros, rational.poles, float(rational.coefficients[0]), rational.theta)


LAPLACE_EXAMPLES: dict[str, Any] = {
    "a step on a double lag": {"value": {"system": {"type": "expr", "text": "exp(-0.5 s)/(s+1)^2"}}},
    "y'' + y = 1": {"value": {"ode": {"a": [1, 0, 1], "b": [1], "initial": [0, 0]}, "input": {"type": "step"}}},
    "initial values alone": {"value": {"ode": {"a": [1, 3, 2], "initial": [1, 0]}, "input": None}},
}


@router.post("/laplace", summary="Partial fractions and y(t)", responses={200: {"model": LaplaceAnswer}, **ERRORS})
def laplace(request: Annotated[LaplaceRequest, Body(openapi_examples=LAPLACE_EXAMPLES)]) -> Response:
    """Partial fractions of Y(s), y(t) as an expression checked against the simulation, initial and final value.

    Repeated and complex poles are expanded from the factors, dead time becomes a shifted step. Where a limit theorem
    does not hold its value is null, with the pole that forbids it.
    """
    signal = None
    if request.input is not None:
        with located("input"):
            signal = request.input.to_engine()
    system, forced, free = None, None, None
    if request.system is not None:
        with located("system"):
            system = request.system.to_engine().require_proper()
            rational = lap.Rational.of(system if signal is None else system * signal.transform())
            fractions = lap.expand_rational(rational)
        y = lap.inverse_transform(fractions)
    else:
        assert request.ode is not None
        with located("ode"):
            solution = lap.solve_linear_ode(request.ode.a, request.ode.b, request.ode.initial, signal)
        rational, fractions, y = solution.transform, solution.fractions, solution.y
        forced, free = _time_formula(solution.forced), _time_formula(solution.free)
    horizon = request.horizon or lap.suggested_horizon(y)
    check = lap.check_by_simulation(rational, y, horizon, request.points)
    transform = _transform(rational)
    answer = {
        "time_unit": "s",
        "transform": _formula(transform.to_text(), transform.to_latex()),
        "partial_fractions": [
            {
                "pole": [f.pole.real, f.pole.imag],
                "power": f.power,
                "coefficient": [f.coefficient.real, f.coefficient.imag],
            }
            for f in fractions.terms
        ],
        "direct": fractions.direct,
        "theta": fractions.theta,
        "expansion": _formula(lap.fractions_sum(fractions, lap.TEXT, 6), lap.fractions_sum(fractions, lap.LATEX, 4)),
        **_time_formula(y),
        **_limits(fractions),
        "forced": forced,
        "free": free,
        "accuracy": {
            "cluster_tolerance": fractions.cluster_tolerance,
            "moved": fractions.moved,
            "cancelled": complex_pairs(np.array(fractions.cancelled, dtype=complex)),
            "residual": fractions.residual,
            "simulation_difference": check.difference,
            "simulation_reason": check.reason,
        },
        "horizon": horizon,
        "response": _samples(y, horizon, request.points) | _simulated(check),
        "character": _character(system),
    }
    return json_response(answer, request.arrays)


def _model_latex(model: FOPDT | SOPDT) -> str:
    """The model in its own parameters."""
    if isinstance(model, FOPDT):
        return FOPDTSystem(type="fopdt", K=model.K, tau=model.tau, theta=model.theta).to_latex()
    return SOPDTSystem(type="sopdt", K=model.K, tau=model.tau, zeta=model.zeta, theta=model.theta).to_latex()


def _model(found: low_order.Approximation, t: np.ndarray | None) -> dict[str, Any]:
    method = low_order.METHODS[found.method]
    out: dict[str, Any] = {
        "method": found.method,
        "name": method.name,
        "source": method.source,
        "type": found.type,
        "valid": found.model is not None,
        "reason": found.reason,
        **dict.fromkeys(("K", "tau", "zeta", "tau_1", "tau_2", "theta", "latex", "mathml", "y")),
        "max_deviation": found.max_deviation,
        "max_deviation_pct": found.max_deviation_pct,
        "t_max_deviation": found.t_max_deviation,
    }
    if found.model is None or t is None:
        return out
    latex = _model_latex(found.model)
    lags = low_order.real_lags(found.model)
    return out | {
        **asdict(found.model),
        "tau_1": lags[0] if lags else None,
        "tau_2": lags[1] if lags else None,
        "latex": latex,
        "mathml": _mathml(latex),
        "y": low_order.model_step(found.model, t),
    }


APPROXIMATE_EXAMPLES: dict[str, Any] = {
    "three lags and a zero": {"value": {"plant": {"type": "expr", "text": "(1-0.1 s)/((5s+1)(3s+1)(0.5s+1))"}}},
    "one method": {
        "value": {"plant": {"type": "expr", "text": "1/(s+1)^5"}, "methods": ["half_rule"], "types": ["SOPDT"]}
    },
}


@router.post(
    "/approximate", summary="Low-order models of a plant", responses={200: {"model": ApproximateAnswer}, **ERRORS}
)
def approximate(request: Annotated[ApproximateRequest, Body(openapi_examples=APPROXIMATE_EXAMPLES)]) -> Response:
    """First- and second-order models with dead time by several methods, beside the plant's exact step response.

    Each has its largest deviation from the true response. A method that does not suit the plant is in the list too,
    with `valid: false` and the reason.
    """
    with located("plant"):
        plant = request.plant.to_engine().require_proper()
    latex = request.plant.to_latex()
    found = low_order.approximate(plant, list(dict.fromkeys(request.methods)), list(dict.fromkeys(request.types)))
    curve = found.curve
    # Models tell themselves apart while they move; the settled end is left to the comparison.
    t = np.linspace(0.0, curve.theta + 0.6 * curve.horizon, request.points) if curve is not None else None
    answer = {
        "time_unit": "s",
        "plant": {"text": plant.to_text(), "latex": latex, "mathml": _mathml(latex), "order": plant.order},
        "character": _character(plant),
        "reason": found.reason,
        "t": t,
        "y": curve(t) if curve is not None and t is not None else None,
        "models": [_model(one, t) for one in found.models],
    }
    return json_response(answer, request.arrays)
