"""What workers do with nonlinear models. A model comes as a plant's id or as a document."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import orjson

from looplab.engine.errors import EngineError, NonFinite, ParseError
from looplab.engine.nonlinear import CompiledModel, compile_model, latex_equations
from looplab.engine.nonlinear.control_loop import ControlLoop
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.systems.polynomial import FloatArray
from looplab.plants import load_plant, load_transfer_matrix
from looplab.plants.transfer_matrix import matrix_response

if TYPE_CHECKING:
    from looplab.engine.nonlinear.simulation import Simulation

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
    start: float = 0.0


@lru_cache(maxsize=32)
def _compiled(text: str) -> CompiledModel:
    return compile_model(orjson.loads(text))


def model_of(source: ModelSource) -> CompiledModel:
    """The model, made once: a slider moves the same one again and again."""
    return load_plant(source.text) if source.kind == PLANT else _compiled(source.text)


@contextmanager
def located_in(source: ModelSource, kind: type[EngineError] = EngineError) -> Iterator[None]:
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

    with located_in(source):
        model = model_of(source)
    with located_in(source, NonFinite):
        found = simulate_open_loop(
            model,
            np.linspace(settings.start, settings.start + settings.horizon, settings.points),
            settings.inputs,
            settings.parameters,
            settings.initial,
            method=settings.method,
        )
    return _simulation_answer(model, settings, found)


def simulate_matrix(plant_id: str, settings: OpenLoopSettings) -> dict[str, Any]:
    """The response of a transfer matrix as the API answers it, arrays as ndarrays."""
    matrix = load_transfer_matrix(plant_id)
    found = matrix_response(matrix, settings.inputs, settings.horizon, settings.points)
    outputs, inputs = (
        {each.name: np.ascontiguousarray(column) for each, column in zip(signals, values.T, strict=True)}
        for signals, values in ((matrix.outputs, found.y), (matrix.inputs, found.u))
    )
    return {
        "time_unit": matrix.time_unit,
        "horizon": settings.horizon,
        "t": found.t,
        "states": {},
        "outputs": outputs,
        "variables": {},
        "inputs": inputs,
        "events": [],
        "truncated_at": found.truncated_at,
        "truncated_reason": found.truncated_reason,
        "calls": 0,
    }


def control(source: ModelSource, settings: OpenLoopSettings, loops: Sequence[ControlLoop]) -> dict[str, Any]:
    """A simulation under control as the API answers it, arrays as ndarrays."""
    from looplab.engine.nonlinear.control_loop.simulation import simulate_control

    with located_in(source):
        model = model_of(source)
    with located_in(source, NonFinite):
        found = simulate_control(
            model,
            np.linspace(0.0, settings.horizon, settings.points),
            loops,
            settings.inputs,
            settings.parameters,
            settings.initial,
            method=settings.method,
        )
    return {
        **_simulation_answer(model, settings, found),
        "loops": [
            {
                "output": loop.output,
                "input": loop.input,
                **{name: getattr(loop, name) for name in ("r", "y_m", "u_command", "u", "history_error")},
                "modes": _modes(found.t, loop.auto),
                "metrics": asdict(loop.metrics),
            }
            for loop in found.loops
        ],
    }


def _modes(t: FloatArray, auto: npt.NDArray[np.bool_]) -> list[dict[str, Any]]:
    """The mode at the start, and each change as it is first seen."""
    first = [0, *(1 + np.flatnonzero(auto[1:] != auto[:-1])).tolist()]
    return [{"t": float(t[i]), "mode": "auto" if auto[i] else "manual"} for i in first]


def _simulation_answer(model: CompiledModel, settings: OpenLoopSettings, found: Simulation) -> dict[str, Any]:
    def by_name(names: tuple[str, ...], values: Any) -> dict[str, Any]:
        return {name: np.ascontiguousarray(column) for name, column in zip(names, values.T, strict=True)}

    return {
        "time_unit": model.document.time_unit,
        "horizon": settings.horizon,
        "t": found.t,
        "states": by_name(model.state_names, found.x),
        "outputs": by_name(model.output_names, found.y),
        "variables": by_name(model.variable_names, _variables(model, settings.parameters, found)),
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


def _variables(model: CompiledModel, parameters: Mapping[str, float], found: Simulation) -> np.ndarray:
    """The variables along a run, shape (count, variables); nan where one has no finite value."""
    p = model.parameters(parameters)
    none = (float("nan"),) * len(model.variable_names)

    def at(t: float, x: list[float], u: list[float]) -> tuple[float, ...]:
        try:
            return model.variables(t, x, u, p)
        except NonFinite:
            return none

    rows = [at(*point) for point in zip(found.t.tolist(), found.x.tolist(), found.u.tolist(), strict=True)]
    return np.array(rows, dtype=float).reshape(len(rows), len(model.variable_names))


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
