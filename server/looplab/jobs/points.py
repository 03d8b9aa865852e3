"""A model with values to compute at, and the shapes of what is answered about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from looplab.engine.errors import InvalidInput, NonFinite
from looplab.engine.nonlinear import CompiledModel
from looplab.engine.nonlinear.steady_states import SteadyState, outputs_at, steady_state_near
from looplab.jobs.tasks import ModelSource, located_in, model_of

Values = tuple[float, ...]


@dataclass(frozen=True)
class PointSettings:
    """Inputs and parameters that are not nominal, and states to begin at."""

    inputs: Mapping[str, float]
    parameters: Mapping[str, float]
    near: Mapping[str, float]


@dataclass(frozen=True)
class ModelPoint:
    """A model with values to compute at."""

    model: CompiledModel
    u: Values
    p: Values
    near: Values

    @classmethod
    def of(cls, source: ModelSource, settings: PointSettings) -> ModelPoint:
        """The model with settings put in; raises EngineError."""
        with located_in(source):
            model = model_of(source)
        u, p = model.inputs(settings.inputs), model.parameters(settings.parameters)
        with located_in(source, NonFinite):
            near = model.states(settings.near, model.initial_state(u, p), "near")
        return cls(model, u, p, near)

    def head(self) -> dict[str, Any]:
        """What every answer begins with."""
        return {
            "time_unit": self.model.document.time_unit,
            "inputs": dict(zip(self.model.input_names, self.u, strict=True)),
            "parameters": dict(zip(self.model.parameter_names, self.p, strict=True)),
        }

    def names(self, x: Values) -> dict[str, float]:
        """States by name."""
        return dict(zip(self.model.state_names, x, strict=True))

    def steady_state(self, state: SteadyState) -> dict[str, Any]:
        """A steady state as the API answers it."""
        model = self.model
        try:
            variables: dict[str, float | None] = dict(
                zip(model.variable_names, model.variables(0.0, state.x, self.u, self.p), strict=True)
            )
        except NonFinite:
            variables = dict.fromkeys(model.variable_names)
        return {
            "x": self.names(state.x),
            "outputs": outputs_at(model, state, self.u, self.p),
            "variables": variables,
            "residual": state.residual,
            "eigenvalues": pairs(state.eigenvalues),
            "verdict": state.verdict,
            "because": state.because,
            "kind": state.kind,
            "free": list(state.free),
            "found_by": state.found_by,
        }

    def near_or_given(self) -> Values:
        """The steady state near the point, or the point itself where nothing comes to rest."""
        try:
            return steady_state_near(self.model, self.u, self.p, self.near).x
        except InvalidInput:
            return self.near


def pairs(values: Any) -> list[list[float]]:
    """[[re, im], ...]."""
    return [[float(value.real), float(value.imag)] for value in values]


def bounds(box: Mapping[str, list[float]]) -> dict[str, tuple[float, float]]:
    """Bounds by name, as the engine takes them."""
    return {name: (low, high) for name, (low, high) in box.items()}


def column(values: Any) -> list[float | None]:
    """Numbers, None where undefined."""
    return [value if np.isfinite(value) else None for value in values.tolist()]


def index_of(name: str | None, names: tuple[str, ...], field: str) -> int:
    """Place of a name, the first for none; raises InvalidInput naming ``field``."""
    if name is None:
        return 0
    if name not in names:
        raise InvalidInput(f"the model has no such {field}", field=field, hint=f"it has {', '.join(names[:12])}")
    return names.index(name)


def per(unit: str, other: str) -> str:
    """K/(cal/min); 1 where there is no unit."""
    if not other:
        return unit
    below = f"({other})" if any(sign in other for sign in " /*") else other
    return f"{unit or '1'}/{below}"
