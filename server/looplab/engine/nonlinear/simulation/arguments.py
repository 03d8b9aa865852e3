"""What every simulation is asked with, checked: courses of inputs, initial state, tolerances, budget."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.document import check_range
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation.solvers import METHODS, WEIGHTS, Counter, Tolerances
from looplab.engine.systems.polynomial import FloatArray

# Evaluations allowed: fewer for a larger model, so that each takes a fraction of a second.
_MOST_CALLS = 100_000
_MOST_OPERATIONS = 20_000_000

Courses = Mapping[str, float | InputCourse]


def call_budget(model: CompiledModel, method: str = "LSODA") -> int:
    """Evaluations of the equations that a simulation may take by default; raises InvalidInput of an unknown method."""
    if method not in METHODS:
        raise InvalidInput(f"the method must be one of {', '.join(METHODS)}", field="method")
    return min(_MOST_CALLS, _MOST_OPERATIONS // (100 + model.operations)) // WEIGHTS[method]


def input_courses(model: CompiledModel, inputs: Courses, t: FloatArray) -> list[InputCourse]:
    """A course for each input of the model; raises InvalidInput where one is unknown or leaves its range."""
    levels = {name: course for name, course in inputs.items() if not isinstance(course, InputCourse)}
    constant = model.inputs({name: float(level) for name, level in levels.items()})
    for name in inputs:
        if name not in model.input_names:
            model.inputs({name: 0.0})
    courses = []
    for item, level in zip(model.document.inputs, constant, strict=True):
        given = inputs.get(item.name)
        course = given if isinstance(given, InputCourse) else InputCourse(level)
        values = course.values(np.concatenate([t, course.breakpoints()]))
        for value in (values.min(), values.max()):
            check_range(float(value), item.min, item.max, item.name, f"inputs.{item.name}")
        courses.append(course)
    return courses


def initial_state(
    model: CompiledModel, initial: Mapping[str, float] | Sequence[float] | None, u: list[float], p: Values
) -> FloatArray:
    """The initial state; raises InvalidInput where a state is unknown or outside its bounds."""
    if initial is None or isinstance(initial, Mapping):
        own = model.initial_state(u, p)
        return np.array(model.states(initial or {}, own))
    values = [float(value) for value in initial]
    if len(values) != len(model.state_names):
        raise InvalidInput(f"the model has {len(model.state_names)} states, not {len(values)}", field="initial")
    return np.array(model.states(dict(zip(model.state_names, values, strict=True)), values))


def tolerances(x0: FloatArray, rtol: float, atol: npt.ArrayLike | None, counter: Counter) -> Tolerances:
    """Tolerances of a step; ``atol`` is by default rtol/100 times the initial state, or times 1 where that is zero.

    Raises
    ------
    InvalidInput
        A tolerance is out of range.
    """
    if not (1e-12 <= rtol <= 1e-2):
        raise InvalidInput("rtol must be from 1e-12 to 1e-2", field="rtol")
    scale = np.where(x0 == 0.0, 1.0, np.abs(x0))
    absolute = np.broadcast_to(rtol * 1e-2 * scale if atol is None else np.asarray(atol, dtype=float), x0.shape)
    if not (np.isfinite(absolute).all() and (absolute > 0).all()):
        raise InvalidInput("atol must be positive", field="atol")
    return Tolerances(rtol, np.array(absolute), counter)
