"""What workers do with nonlinear models. A model comes as a plant's id or as a document."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import orjson

from looplab.engine.errors import EngineError, NonFinite, ParseError
from looplab.engine.nonlinear import CompiledModel, compile_model, latex_equations
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.plants import load_plant

# A plant's id, or the JSON text of a document.
PLANT, DOCUMENT = "plant", "document"
MAX_PROBLEMS = 20


@dataclass(frozen=True)
class ModelSource:
    """Which model: ``kind`` is PLANT or DOCUMENT, ``text`` the id or the JSON.

    Text, not the parsed document: what travels to a worker may be nested as deeply as a request can be.
    """

    kind: str
    text: str

    @classmethod
    def document(cls, document: Mapping[str, Any]) -> ModelSource:
        """A model that came with the request."""
        return cls(DOCUMENT, orjson.dumps(document).decode())


@dataclass(frozen=True)
class OpenLoopSettings:
    """What a simulation is made with; as the arguments of ``simulate_open_loop``."""

    horizon: float
    points: int
    inputs: Mapping[str, float | InputCourse]
    parameters: Mapping[str, float]
    initial: Mapping[str, float]
    method: str


@lru_cache(maxsize=32)
def _compiled(text: str) -> CompiledModel:
    return compile_model(orjson.loads(text))


def model_of(source: ModelSource) -> CompiledModel:
    """The model, made once: a slider moves the same one again and again."""
    return load_plant(source.text) if source.kind == PLANT else _compiled(source.text)


@contextmanager
def _located(source: ModelSource, kind: type[EngineError] = EngineError) -> Iterator[None]:
    """Errors in the model's own equations, where the model is part of the request, are in its field ``model``."""
    try:
        yield
    except kind as error:
        if source.kind == DOCUMENT:
            error.field = f"model.{error.field}" if error.field else "model"
        raise


def simulate(source: ModelSource, settings: OpenLoopSettings) -> dict[str, Any]:
    """A simulation as the API answers it, arrays as ndarrays."""
    # scipy's solvers take half a second to import: the server, which only names this function, does without.
    from looplab.engine.nonlinear.simulation import simulate_open_loop

    with _located(source):
        model = model_of(source)
    with _located(source, NonFinite):
        found = simulate_open_loop(
            model,
            np.linspace(0.0, settings.horizon, settings.points),
            settings.inputs,
            settings.parameters,
            settings.initial,
            method=settings.method,
        )

    def by_name(names: tuple[str, ...], values: Any) -> dict[str, Any]:
        return {name: np.ascontiguousarray(column) for name, column in zip(names, values.T, strict=True)}

    return {
        "time_unit": model.document.time_unit,
        "horizon": settings.horizon,
        "t": found.t,
        "states": by_name(model.state_names, found.x),
        "outputs": by_name(model.output_names, found.y),
        "inputs": by_name(model.input_names, found.u),
        "events": [
            {
                "name": event.name,
                "message": event.message,
                "t": event.t,
                "states": dict(zip(model.state_names, event.x, strict=True)),
            }
            for event in found.events
        ],
        "truncated_at": found.truncated_at,
        "truncated_reason": found.truncated_reason,
        "calls": found.calls,
    }


def validate(text: bytes) -> dict[str, Any]:
    """Every problem of a document, given as JSON, and its equations where there is none."""
    document: dict[str, Any] = orjson.loads(text)
    problems: list[EngineError] = []
    model: CompiledModel | None = None
    while len(problems) < MAX_PROBLEMS:
        try:
            model = compile_model(document)
            model.f(0.0, model.x0, model.u0, model.p0)
            model.outputs(0.0, model.x0, model.u0, model.p0)
            break
        except EngineError as error:
            problems.append(error)
            if not isinstance(error, ParseError) or error.field is None:
                break
            # The next mistake shows once this formula can be read.
            document = _mended(document, error.field)
    return {
        "valid": not problems,
        "problems": [
            {
                "path": problem.field or "",
                "message": problem.message,
                "hint": problem.hint,
                "column": problem.column if isinstance(problem, ParseError) else None,
            }
            for problem in problems
        ],
        "equations": [asdict(each) for each in latex_equations(model)] if model is not None and not problems else [],
    }


def _mended(document: dict[str, Any], path: str) -> dict[str, Any]:
    """The document with the formula at ``path``, such as ``states[0].equation``, replaced by one that can be read."""
    kind, rest = path.split("[")
    index, what = rest.split("].")
    items = [dict(item) for item in document[kind]]
    items[int(index)][what] = "0 > 1" if what == "when" else "0"
    return {**document, kind: items}
