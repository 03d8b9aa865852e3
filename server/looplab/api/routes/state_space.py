"""A state-space model: poles, controllability, observability, hidden modes, transfer functions."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.responses import Response

from looplab.api.answers.state_space import StateSpaceAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import complex_pairs, json_response
from looplab.api.strict import StrictRoute
from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.stability import matrix_stability
from looplab.engine.state_space import (
    RankTest,
    StateSpaceModel,
    analyse_structure,
    from_ode,
    gramians,
    minimal,
    minimal_realization,
    to_transfer_function,
)
from looplab.engine.systems import TransferFunction
from looplab.labs.text import render_math
from looplab.schemas import Matrices, Model, StateSpaceSystem, System, located, state_space_latex
from looplab.schemas.base import Coefficients

router = APIRouter(tags=["state space"], route_class=StrictRoute)


class Equation(Model):
    """a_n y^(n) + ... + a_0 y = b_m u^(m) + ... + b_0 u."""

    a: Annotated[Coefficients, Field(description="Coefficients of y, highest derivative first.")]
    b: Annotated[Coefficients, Field(description="Coefficients of u, highest derivative first.")]
    form: Literal["phase", "controllable", "observable"] = "phase"


class StateSpaceRequest(Model):
    """The model itself, a linear differential equation, or any system (realised as a cascade of sections)."""

    model: Matrices | None = None
    equation: Equation | None = None
    system: System | None = Field(default=None, description="Its dead time is left out of the states.")
    tolerance: Annotated[float, Field(ge=1e-15, le=1e-2, description="Singular values below count as zero.")] = 1e-12
    cancel_tolerance: Annotated[float, Field(ge=0, le=0.1, description="Zeros this near to a pole cancel it.")] = 1e-8

    @model_validator(mode="after")
    def _one(self) -> StateSpaceRequest:
        if sum(source is not None for source in (self.model, self.equation, self.system)) != 1:
            raise ValueError("give one of model, equation or system")
        return self

    def to_engine(self) -> StateSpaceModel:
        """The model for the engine; raises EngineError naming the field."""
        if self.model is not None:
            with located("model"):
                return self.model.to_model()
        if self.equation is not None:
            with located("equation"):
                return from_ode(self.equation.a, self.equation.b, self.equation.form)
        assert self.system is not None
        with located("system"):
            if isinstance(self.system, StateSpaceSystem):
                return self.system.to_model()
            return StateSpaceModel.from_transfer_function(self.system.to_engine())


EXAMPLES: dict[str, Any] = {
    "two tanks": {"value": {"model": {"A": [[-1, 0], [1, -2]], "B": [[1], [0]], "C": [[0, 1]]}}},
    "an equation with a hidden mode": {
        "value": {"equation": {"a": [1, 3, 2], "b": [1, 1], "form": "controllable"}, "cancel_tolerance": 1e-6}
    },
    "a transfer function": {"value": {"system": {"type": "expr", "text": "(s+3)/(s^2*(s+2))"}}},
}


def _stability(model: StateSpaceModel) -> dict[str, Any]:
    if not model.states:
        return {"verdict": "stable", "because": "there are no states", "lyapunov_stable": True}
    found = matrix_stability(model.A)
    return {"verdict": found.verdict, "because": found.because, "lyapunov_stable": found.lyapunov_stable}


def _rank(test: RankTest) -> dict[str, Any]:
    whole = bool(np.isfinite(test.matrix).all())
    return {
        "matrix": test.matrix.tolist() if whole else None,
        "singular_values": test.singular_values.tolist(),
        "rank": test.rank,
        "full": test.full,
        "tolerance": test.tolerance,
        "reason": test.reason
        if whole
        else "powers of A leave double precision; " + (test.reason or "the modes decide"),
    }


def _text(system: TransferFunction) -> dict[str, str]:
    latex = system.to_latex()
    return {"text": system.to_text(), "latex": latex, "mathml": render_math(latex)}


def _minimal_realization(model: StateSpaceModel, tolerance: float) -> dict[str, Any]:
    found = minimal_realization(model, tolerance)
    return {
        "order": found.model.states,
        **{name: getattr(found.model, name).tolist() for name in "ABCD"},
        "removed": [asdict(mode) | {"pole": _pair(mode.pole)} for mode in found.removed],
        "tolerance": found.tolerance,
        "smallest_kept": found.smallest_kept,
        "largest_removed": found.largest_removed,
    }


def _pair(value: complex) -> list[float]:
    return [value.real, value.imag]


def _channel(model: StateSpaceModel, output: int, input: int, tolerance: float) -> dict[str, Any]:
    answer: dict[str, Any] = {"output": output, "input": input, "cancelled": [], "cancel_tolerance": tolerance}
    fields = ("zeros", "gain", "system", "minimal", "minimal_order", "closest_kept", "reason")
    answer |= dict.fromkeys(fields)
    try:
        system = to_transfer_function(model, output, input)
    except EngineError as error:
        return answer | {"reason": error.message}
    if system.gain == 0:
        answer["reason"] = "this input does not reach this output"
    found = minimal(system, tolerance) if system.gain else None
    answer |= {"zeros": complex_pairs(system.zeros), "gain": system.gain, "system": _text(system)}
    if found is not None:
        answer |= {
            "minimal": _text(found.system),
            "minimal_order": found.system.order,
            "closest_kept": found.closest_kept,
            "cancelled": [asdict(c) | {"pole": _pair(c.pole), "zero": _pair(c.zero)} for c in found.cancelled],
        }
    return answer


@router.post(
    "/state-space", summary="Analyse a state-space model", responses={200: {"model": StateSpaceAnswer}, **ERRORS}
)
def state_space(request: Annotated[StateSpaceRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Poles and verdict, controllability and observability with the singular values that decide, hidden modes,
    Gramians where they exist, a minimal realisation with what it leaves out, and the transfer function of each channel
    with what cancels in it."""
    model = request.to_engine()
    if model.inputs * model.outputs > 16:
        raise InvalidInput(
            f"{model.inputs} inputs and {model.outputs} outputs make more than 16 channels",
            field="model.B",
            hint="ask for a part of them",
        )
    structure, energy = analyse_structure(model, request.tolerance), gramians(model)
    latex = state_space_latex(model)
    answer = {
        **{name: getattr(model, name).tolist() for name in "ABCD"},
        "latex": latex,
        "mathml": render_math(latex),
        "poles": complex_pairs(model.poles),
        "stability": _stability(model),
        "controllability": _rank(structure.controllability),
        "observability": _rank(structure.observability),
        "modes": [asdict(m) | {"pole": _pair(m.pole)} for m in structure.modes],
        "stabilizable": structure.stabilizable,
        "detectable": structure.detectable,
        "minimal": structure.minimal,
        "minimal_realization": _minimal_realization(model, request.tolerance),
        "gramians": {
            name: None if value is None else value.tolist()
            for name, value in (
                ("controllability", energy.controllability),
                ("observability", energy.observability),
                ("hankel_singular_values", energy.hankel_singular_values),
            )
        }
        | {"reason": energy.reason},
        "transfer_functions": [
            _channel(model, output, input, request.cancel_tolerance)
            for output in range(model.outputs)
            for input in range(model.inputs)
        ],
    }
    return json_response(answer)
