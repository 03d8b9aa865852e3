"""Where a controlled simulation starts: names and ranges checked, parameters and states of the loops filled in."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.nonlinear.control_loop.loop_model import LoopModel, loop_model, structure_of
from looplab.engine.nonlinear.control_loop.sampled_pid import Range
from looplab.engine.nonlinear.control_loop.settings import ControlLoop, Lag
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation.arguments import Courses, initial_state, input_courses
from looplab.engine.systems.polynomial import FloatArray

MAX_LOOPS = 3
# The setpoint before the start is looked up this far before it, as part of the horizon.
_BEFORE = 1e-9
# Within this part of u's range before a limit, clamping slows the integrator down to a stop.
CLAMPING_BAND = 1e-6


@dataclass(frozen=True)
class LoopStart:
    """One loop before it acts.

    Attributes
    ----------
    limits : Range
        Of u [input].
    u : float
        The input [input].
    r, y, sensor : float
        Setpoint and output [output].
    """

    limits: Range
    u: float
    r: float
    y: float


@dataclass(frozen=True)
class Start:
    """All that a controlled simulation starts from.

    Attributes
    ----------
    closed : LoopModel
    courses : dict of str to InputCourse
        Of the plant's inputs that no loop moves.
    p : tuple of float
        Parameters of the closed loop's model.
    x : ndarray
        Its states.
    loops : tuple of LoopStart
    """

    closed: LoopModel
    courses: dict[str, InputCourse]
    p: Values
    x: FloatArray
    loops: tuple[LoopStart, ...]


@contextmanager
def within(place: str) -> Iterator[None]:
    """Give an error the place of what it is in."""
    try:
        yield
    except EngineError as error:
        error.field = f"{place}.{error.field}" if error.field else place
        raise


def prepare(
    model: CompiledModel,
    times: FloatArray,
    loops: Sequence[ControlLoop],
    inputs: Courses,
    parameters: Mapping[str, float],
    initial: Mapping[str, float] | Sequence[float] | None,
) -> Start:
    """Check everything, and put it together.

    Raises
    ------
    InvalidInput
        A name is unknown, a value outside its range, or two loops move the same input.
    IllPosedLoop
        A loop is algebraic.
    """
    _check_names(model, loops)
    t0 = float(times[0])
    given = dict(inputs)
    limits = []
    for index, loop in enumerate(loops):
        level = given.pop(loop.input, None)
        with within(f"loops[{index}]"):
            if isinstance(level, InputCourse):
                raise InvalidInput(f"{loop.input} is moved by this loop: it has no course of its own", field="input")
            bias = loop.bias if loop.bias is not None else level
            if bias is not None:
                _in_range(model, loop.input, float(bias), "bias" if loop.bias is not None else "input")
                given[loop.input] = float(bias)
            limits.append(_limits(model, loop))
    courses = input_courses(model, given, times)
    u = [float(course.values(t0)) for course in courses]
    p = model.parameters(parameters)
    x = initial_state(model, initial, u, p)
    y = model.outputs(t0, x.tolist(), u, p)
    before = t0 - _BEFORE * float(times[-1] - t0)
    starts = tuple(
        LoopStart(
            Range(-math.inf if low is None else float(low), math.inf if high is None else float(high)),
            u[model.input_names.index(loop.input)],
            float(loop.setpoint.values(before)),
            y[model.output_names.index(loop.output)],
        )
        for loop, (low, high) in zip(loops, limits, strict=True)
    )
    structures = tuple(
        structure_of(model, loop, (low is not None, high is not None))
        for loop, (low, high) in zip(loops, limits, strict=True)
    )
    closed = loop_model(model, structures)
    settings: dict[str, float] = dict(zip(model.parameter_names, p, strict=True))
    states: dict[str, float] = dict(zip(model.state_names, x.tolist(), strict=True))
    for loop, start, name in zip(loops, starts, closed.names, strict=True):
        settings |= {name(part): value for part, value in _settings(loop, start).items()}
        states |= {
            loop.input: start.u,
            name("I"): start.u,
            name("s"): start.y,
            name("filter"): loop.gamma * start.r - start.y,
        }
    moved = {loop.input for loop in loops}
    return Start(
        closed,
        {n: course for n, course in zip(model.input_names, courses, strict=True) if n not in moved},
        tuple(settings[name] for name in closed.model.parameter_names),
        # Speeds of second-order lags are zero.
        np.array([states.get(name, 0.0) for name in closed.model.state_names]),
        starts,
    )


def _check_names(model: CompiledModel, loops: Sequence[ControlLoop]) -> None:
    if not 1 <= len(loops) <= MAX_LOOPS:
        raise InvalidInput(f"there must be 1 to {MAX_LOOPS} loops", field="loops")
    moved: dict[str, int] = {}
    for index, loop in enumerate(loops):
        with within(f"loops[{index}]"):
            if loop.output not in model.output_names:
                raise InvalidInput(
                    f"the model has no output {loop.output[:40]!a}",
                    field="output",
                    hint=f"there are {', '.join(model.output_names[:12])}",
                )
            if loop.input not in model.input_names:
                raise InvalidInput(
                    f"the model has no input {loop.input[:40]!a}",
                    field="input",
                    hint=f"there are {', '.join(model.input_names[:12])}" if model.input_names else None,
                )
            if loop.input in moved:
                raise InvalidInput(f"{loop.input} is moved by loops[{moved[loop.input]}] already", field="input")
        moved[loop.input] = index


def _limits(model: CompiledModel, loop: ControlLoop) -> tuple[float | None, float | None]:
    item = model.document.inputs[model.input_names.index(loop.input)]
    for name in ("u_min", "u_max"):
        value = getattr(loop, name)
        if value is not None:
            _in_range(model, loop.input, value, name)
    low = item.min if loop.u_min is None else loop.u_min
    high = item.max if loop.u_max is None else loop.u_max
    if low is not None and high is not None and not low < high:
        raise InvalidInput("u_min must be less than u_max", field="u_max")
    return low, high


def _in_range(model: CompiledModel, name: str, value: float, field: str) -> None:
    try:
        model.inputs({name: value})
    except InvalidInput as error:
        error.field = field
        raise


def _settings(loop: ControlLoop, start: LoopStart) -> dict[str, float]:
    """Values of every parameter that a loop can have; the structure decides which are there."""
    low, high = start.limits.low, start.limits.high
    span = high - low if math.isfinite(high - low) else max(abs(e) for e in (low, high, start.u, 1.0) if e * 0 == 0)
    out = {
        "Kc": loop.Kc,
        "Ki": loop.Ki,
        "beta": loop.controller.beta,
        "r0": start.r,
        "gamma": loop.gamma,
        "KD": loop.Kc / loop.controller.alpha if loop.filter_time else 0.0,
        "Tf": loop.filter_time,
        "u_min": low,
        "u_max": high,
        "T_t": loop.tracking_time,
        "band": CLAMPING_BAND * span,
    }
    return out | _lag("s_", loop.sensor.lag) | _lag("valve_", loop.valve.lag)


def _lag(own: str, lag: Lag | None) -> dict[str, float]:
    if lag is None:
        return {}
    return {f"{own}tau": lag.tau, f"{own}zeta": lag.zeta or 0.0, f"{own}rate": lag.rate or 0.0}
