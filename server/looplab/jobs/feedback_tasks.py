"""What workers do with state feedback: the design, its runs, and the region from which it catches the plant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from looplab.engine.design.state_feedback import (
    ByPoles,
    ByWeights,
    DesignSettings,
    Faster,
    GainResult,
    Push,
    StateFeedback,
    design_state_feedback,
    linear_loop,
    linear_run,
    loop_transfer,
    separated_poles,
    whole_loop_poles,
)
from looplab.engine.errors import EngineError, InvalidInput, NonFinite
from looplab.engine.frequency import margins
from looplab.engine.nonlinear.document import Quantity, Setting, State
from looplab.engine.nonlinear.steady_states import LinearModel, linearize, steady_state_near
from looplab.engine.state_space import StateSpaceModel
from looplab.engine.systems.polynomial import FloatArray
from looplab.jobs.points import ModelPoint, PointSettings, pairs
from looplab.jobs.tasks import ModelSource, located_in

if TYPE_CHECKING:
    from looplab.engine.nonlinear.state_feedback.simulation import FeedbackLoop, FeedbackRun

# Where an input has no range of its own.
NO_LIMIT = 1e9


@dataclass(frozen=True)
class NonlinearSource:
    """A model, where it is linearised, and the inputs that the feedback moves (None: the first)."""

    source: ModelSource
    settings: PointSettings
    actuators: tuple[str, ...] | None


@dataclass(frozen=True)
class FeedbackProblem:
    """A plant and the feedback that is wanted of it; outputs by name, ``measured`` None for all of them."""

    plant: StateSpaceModel | NonlinearSource
    gain: ByPoles | ByWeights
    observer: ByPoles | ByWeights | Faster | None
    measured: tuple[str, ...] | None
    controlled: tuple[str, ...]
    integral: bool


@dataclass(frozen=True)
class FeedbackRunSettings:
    """What a run is made with: states and setpoints by name, limits by input, and pushes.

    A push is the input's name (None: the first), size, start and duration.
    """

    horizon: float
    points: int
    initial: Mapping[str, float]
    setpoints: Mapping[str, float]
    limits: Mapping[str, tuple[float, float]]
    pushes: tuple[tuple[str | None, float, float, float], ...]


@dataclass(frozen=True)
class _Signal:
    name: str
    unit: str
    meaning: str
    value: float


@dataclass(frozen=True)
class _Prepared:
    """A problem with its signals and its gains; ``point`` and ``actuators`` of a nonlinear plant."""

    time_unit: str
    states: list[_Signal]
    inputs: list[_Signal]
    outputs: list[_Signal]
    found: StateFeedback
    point: ModelPoint | None
    linear: LinearModel | None
    actuators: tuple[int, ...]

    def loop(self, limits: Mapping[str, tuple[float, float]]) -> FeedbackLoop | None:
        """The nonlinear loop, where the plant is not linear already."""
        from looplab.engine.nonlinear.state_feedback.simulation import FeedbackLoop

        names = [each.name for each in self.inputs]
        for name in limits:
            _index(name, names, f"limits.{name}")
        if self.point is None or self.linear is None:
            if limits:
                raise InvalidInput(
                    "matrices answer without limits: their response is the linear one",
                    field="limits",
                    hint="leave the limits out, or send a model",
                )
            return None
        own = [self.point.model.document.inputs[index] for index in self.actuators]
        rows = [limits.get(each.name) or (_or(each.min, -NO_LIMIT), _or(each.max, NO_LIMIT)) for each in own]
        return FeedbackLoop(self.point.model, self.linear, self.found, self.actuators, np.array(rows))


def _or(value: float | None, other: float) -> float:
    return other if value is None else value


def _index(name: str, names: Sequence[str], field: str) -> int:
    if name not in names:
        raise InvalidInput("there is no such signal here", field=field, hint=f"there are {', '.join(names[:12])}")
    return names.index(name)


def _numbered(letter: str, count: int) -> list[_Signal]:
    return [_Signal(f"{letter}{k + 1}", "", "", 0.0) for k in range(count)]


def _named(items: Sequence[Setting | State | Quantity], values: Sequence[float]) -> list[_Signal]:
    return [_Signal(each.name, each.unit, each.meaning, value) for each, value in zip(items, values, strict=True)]


def _prepare(problem: FeedbackProblem) -> _Prepared:
    plant = problem.plant
    if isinstance(plant, StateSpaceModel):
        states, inputs, outputs = (
            _numbered(*each) for each in (("x", plant.states), ("u", plant.inputs), ("y", plant.outputs))
        )
        return _Prepared("s", states, inputs, outputs, _design(problem, plant, outputs), None, None, ())
    source = plant.source
    point = ModelPoint.of(source, plant.settings)
    names, document = point.model.input_names, point.model.document
    if not names:
        raise InvalidInput("the model has no input to move", field="plant")
    actuators = tuple(_index(name, names, "plant.actuators") for name in plant.actuators or names[:1])
    if len(set(actuators)) < len(actuators):
        raise InvalidInput("an input stands twice", field="plant.actuators")
    with located_in(source, NonFinite):
        x = steady_state_near(point.model, point.u, point.p, point.near).x
        linear = linearize(point.model, x, point.u, point.p)
    J, columns = linear.jacobians, list(actuators)
    model = StateSpaceModel(J.A, J.B[:, columns], J.C, J.D[:, columns])
    moved = [document.inputs[k] for k in actuators]
    states, inputs, outputs = (
        _named(document.states, linear.x),
        _named(moved, [linear.u[k] for k in actuators]),
        _named(document.outputs, linear.y),
    )
    found = _design(problem, model, outputs)
    return _Prepared(document.time_unit, states, inputs, outputs, found, point, linear, actuators)


def _design(problem: FeedbackProblem, model: StateSpaceModel, outputs: list[_Signal]) -> StateFeedback:
    every = [each.name for each in outputs]
    measured = every if problem.measured is None else list(problem.measured)
    for names, field in ((measured, "measured"), (problem.controlled, "controlled")):
        if len(set(names)) < len(names):
            raise InvalidInput("an output stands twice", field=field)
    settings = DesignSettings(
        problem.gain,
        problem.observer,
        tuple(_index(name, every, "measured") for name in measured),
        tuple(_index(name, every, "controlled") for name in problem.controlled),
        problem.integral,
    )
    return design_state_feedback(model, settings)


def _gain(found: GainResult | None) -> dict[str, Any] | None:
    if found is None:
        return None
    return {
        "desired": None if found.desired is None else pairs(found.desired),
        "obtained": pairs(found.obtained),
        "error": found.error,
        "condition": found.condition,
        "kept": pairs(found.kept),
        "residual": found.residual,
    }


def design(problem: FeedbackProblem) -> dict[str, Any]:
    """The gains, their poles and the margins at the plant's input, as the API answers it."""
    ready = _prepare(problem)
    found = ready.found
    loop = linear_loop(found)
    poles, apart = whole_loop_poles(loop.A, found), separated_poles(found)
    margin, reason = None, None
    try:
        margin = asdict(margins(loop_transfer(loop)))
    except EngineError as error:
        reason = error.message
    return {
        "time_unit": ready.time_unit,
        **{name: [asdict(each) for each in getattr(ready, name)] for name in ("states", "inputs", "outputs")},
        **{name: getattr(found.model, name).tolist() for name in "ABCD"},
        "poles": pairs(found.model.poles),
        "K": found.K.tolist(),
        "K_I": found.K_I.tolist() if found.settings.integral and found.settings.controlled else None,
        "N": found.N.tolist() if _has_gain(found) else None,
        "N_reason": found.N_reason,
        "L": None if found.L is None else found.L.tolist(),
        "feedback": _gain(found.feedback),
        "observer": _gain(found.observer),
        "closed_loop_poles": pairs(poles),
        "closed_loop_stable": bool((apart.real < 0).all()),
        "separation_error": float((np.abs(poles - apart) / np.maximum(1.0, np.abs(apart))).max()),
        "margins": margin,
        "margins_reason": reason,
    }


def _has_gain(found: StateFeedback) -> bool:
    settings = found.settings
    return bool(settings.controlled) and not settings.integral and found.N_reason is None


def _pushes(run: FeedbackRunSettings, inputs: list[_Signal]) -> list[Push]:
    names = [each.name for each in inputs]
    found = []
    for index, (name, size, start, duration) in enumerate(run.pushes):
        sizes = np.zeros(len(names))
        sizes[0 if name is None else _index(name, names, f"pushes[{index}].input")] = size
        found.append(Push(sizes, start, duration))
    return found


def _setpoints(run: FeedbackRunSettings, ready: _Prepared) -> FloatArray | None:
    held = [ready.outputs[k] for k in ready.found.settings.controlled]
    for name in run.setpoints:
        _index(name, [each.name for each in held], f"setpoints.{name}")
    if run.setpoints and ready.found.N_reason is not None:
        raise InvalidInput(ready.found.N_reason, field="setpoints")
    return np.array([run.setpoints.get(each.name, each.value) - each.value for each in held]) if held else None


def simulate_feedback(problem: FeedbackProblem, run: FeedbackRunSettings) -> dict[str, Any]:
    """The linear response, and the nonlinear run where the plant is nonlinear, as the API answers it."""
    ready = _prepare(problem)
    loop = ready.loop(run.limits)
    pushes, r = _pushes(run, ready.inputs), _setpoints(run, ready)
    t = np.linspace(0.0, run.horizon, run.points)
    names = [each.name for each in ready.states]
    for name in run.initial:
        _index(name, names, f"initial.{name}")
    x0 = np.array([run.initial.get(each.name, each.value) - each.value for each in ready.states])
    nonlinear = None
    if loop is not None:
        from looplab.engine.nonlinear.state_feedback.simulation import run_feedback

        assert isinstance(problem.plant, NonlinearSource)
        with located_in(problem.plant.source, NonFinite):
            nonlinear = _nonlinear_answer(ready, run_feedback(loop, t, run.initial, r, pushes))
    linear, reason = None, None
    try:
        found = linear_run(linear_loop(ready.found), t, x0, r, pushes)
        linear = {
            "t": found.t,
            "states": _by_name(ready.states, found.x),
            "outputs": _by_name(ready.outputs, found.y),
            "inputs": _by_name(ready.inputs, found.u),
            "estimates": None if found.estimate is None else _by_name(ready.states, found.estimate),
        }
    except InvalidInput as error:
        reason = error.message
    return {
        "time_unit": ready.time_unit,
        "horizon": run.horizon,
        "linear": linear,
        "linear_reason": reason,
        "nonlinear": nonlinear,
    }


def _by_name(signals: list[_Signal], deviations: FloatArray) -> dict[str, FloatArray]:
    return {each.name: each.value + column for each, column in zip(signals, deviations.T, strict=True)}


def _nonlinear_answer(ready: _Prepared, run: FeedbackRun) -> dict[str, Any]:
    def by_name(signals: list[_Signal], values: FloatArray) -> dict[str, FloatArray]:
        return {each.name: np.ascontiguousarray(column) for each, column in zip(signals, values.T, strict=True)}

    simulation = run.simulation
    states = [each.name for each in ready.states]
    return {
        "t": simulation.t,
        "states": by_name(ready.states, run.x),
        "outputs": by_name(ready.outputs, run.y),
        "commands": by_name(ready.inputs, run.command),
        "inputs": by_name(ready.inputs, run.u),
        "estimates": None if run.estimate is None else by_name(ready.states, run.estimate),
        "events": [
            {"name": e.name, "message": e.message, "t": e.t, "states": dict(zip(states, e.x, strict=False))}
            for e in simulation.events
        ],
        "outcome": run.outcome,
        "truncated_at": simulation.truncated_at,
        "truncated_reason": simulation.truncated_reason,
    }


def region(
    problem: FeedbackProblem, run: FeedbackRunSettings, names: tuple[str, str], starts: list[tuple[float, float]]
) -> list[str]:
    """How the run from each start ends."""
    from looplab.engine.nonlinear.state_feedback.simulation import explore_region

    loop = _prepare(problem).loop(run.limits)
    if loop is None:
        raise InvalidInput(
            "matrices have no region: a linear loop that is stable is so from everywhere",
            field="plant",
            hint="send a plant or a model",
        )
    return explore_region(loop, run.horizon, names, starts)
