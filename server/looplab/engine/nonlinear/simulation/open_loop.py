"""Simulation of a model with given inputs: from discontinuity to discontinuity, with events located on the way."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import EngineError, InvalidInput, NonFinite
from looplab.engine.nonlinear.document import check_range
from looplab.engine.nonlinear.inputs import SAME_TIME, InputCourse
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation.result import EventRecord, Simulation
from looplab.engine.nonlinear.simulation.right_hand_side import RightHandSide, RunsAway
from looplab.engine.nonlinear.simulation.solvers import (
    METHODS,
    WEIGHTS,
    BudgetSpent,
    Counter,
    Problem,
    Solver,
    SolverFailed,
    Tolerances,
    make_solver,
)
from looplab.engine.nonlinear.simulation.watch import Watch, crossing
from looplab.engine.systems.polynomial import FloatArray

MAX_POINTS = 5_000
MAX_BREAKPOINTS = 4_000
# Events are looked for at least this often, however few points are asked for.
_LOOKS = 200
# How closely the end is approached where the equations cannot be computed any further, as part of the time so far.
_EDGE = 1e-9
_APPROACHES = 300
# Evaluations allowed: fewer for a larger model, so that each takes a fraction of a second.
_MOST_CALLS = 100_000
_MOST_OPERATIONS = 20_000_000

Courses = Mapping[str, float | InputCourse]


def call_budget(model: CompiledModel, method: str = "LSODA") -> int:
    """Evaluations of the equations that a simulation may take by default."""
    return min(_MOST_CALLS, _MOST_OPERATIONS // (100 + model.operations)) // WEIGHTS[method]


def simulate_open_loop(
    model: CompiledModel,
    times: npt.ArrayLike,
    inputs: Courses | None = None,
    parameters: Mapping[str, float] | None = None,
    initial: Mapping[str, float] | Sequence[float] | None = None,
    *,
    method: str = "LSODA",
    rtol: float = 1e-8,
    atol: npt.ArrayLike | None = None,
    budget: int | None = None,
) -> Simulation:
    r"""Simulate a model with given inputs.

    .. math:: \dot x = f(t, x, u(t), p), \quad y = g(t, x, u(t), p)

    The solver starts anew where an input or its slope jumps. Events and bounds of states are looked for between
    neighbouring times (at least 200 over the horizon), and located to rounding by repeating the step; an event that
    goes on and off again between two of them is not seen.

    Parameters
    ----------
    model : CompiledModel
    times : array_like, shape (count,)
        Strictly increasing, from 2 to 5000; the first is the start [time].
    inputs : mapping of str to float or InputCourse, or None
        Inputs that are not nominal.
    parameters : mapping of str to float, or None
        Parameters that are not nominal.
    initial : mapping of str to float, sequence of float, or None
        States that do not start at the model's own initial state, which follows the parameters and the inputs at the
        start; or all states.
    method : str
        LSODA, RK45, Radau or BDF.
    rtol, atol : float and array_like of shape (n,) or float, or None
        Tolerances of each step; atol is by default rtol/100 times the initial state, or times 1 where that is zero.
    budget : int or None
        Most evaluations of the equations; None takes ``call_budget``.

    Returns
    -------
    Simulation
        Cut, with the reason, at a stopping event, where a state leaves its bounds or runs away, where an equation has
        no finite value, or where the solver fails or needs too much work.

    Raises
    ------
    InvalidInput
        An argument is out of range.
    NonFinite
        The equations have no finite value at the start.

    References
    ----------
    .. [1] L. Petzold, Automatic selection of methods for solving stiff and nonstiff systems of ordinary differential
       equations, SIAM J. Sci. Stat. Comput. 4 (1983) 136-148.
    """
    t = _check_times(times)
    courses = _courses(model, inputs or {}, t)
    p = model.parameters(parameters or {})
    x0 = _initial(model, initial, [float(course.values(t[0])) for course in courses], p)
    if method not in METHODS:
        raise InvalidInput(f"the method must be one of {', '.join(METHODS)}", field="method")
    if not (1e-12 <= rtol <= 1e-2):
        raise InvalidInput("rtol must be from 1e-12 to 1e-2", field="rtol")
    scale = np.where(x0 == 0.0, 1.0, np.abs(x0))
    absolute = np.broadcast_to(rtol * 1e-2 * scale if atol is None else np.asarray(atol, dtype=float), x0.shape)
    if not (np.isfinite(absolute).all() and (absolute > 0).all()):
        raise InvalidInput("atol must be positive", field="atol")
    counter = Counter(call_budget(model, method) if budget is None else budget)
    run = _Run(model, courses, p, method, Tolerances(rtol, np.array(absolute), counter))
    with warnings.catch_warnings():
        # The solvers' complaints come back as a reason.
        warnings.simplefilter("ignore")
        run.go(t, x0)
    return _result(model, courses, p, run, counter)


class _Run:
    """The state of a simulation under way, and what it has gathered."""

    def __init__(
        self,
        model: CompiledModel,
        courses: list[InputCourse],
        p: Values,
        method: str,
        tolerances: Tolerances,
    ) -> None:
        self.rhs = RightHandSide(model, courses, p, tolerances.counter)
        self.watch = Watch(model, lambda t: self.rhs.u(t), p)
        self.courses, self.method, self.tolerances = courses, method, tolerances
        self.t, self.x = 0.0, np.zeros(0)
        self.on: list[bool] = []
        self.samples: list[tuple[float, FloatArray]] = []
        self.events: list[EventRecord] = []
        self.cut: str | None = None
        self.approaches = 0

    def go(self, times: FloatArray, x0: FloatArray) -> None:
        start, end = float(times[0]), float(times[-1])
        self.t, self.x = start, x0
        self.samples.append((start, x0))
        breaks = _breakpoints(self.courses, start, end)
        looks = np.linspace(start, end, _LOOKS + 1) if times.size < _LOOKS else times
        stops = _merged(np.concatenate([times, looks, breaks]), times)
        wanted = set(times.tolist())
        edges = [start, *(float(b) for b in stops[np.isin(stops, _snapped(breaks, stops))] if start < b < end), end]
        for begin, finish in pairwise(edges):
            inside = stops[(stops > begin) & (stops <= finish)].tolist()
            try:
                self._enter(begin)
                self._piece(inside, finish, wanted)
            except BudgetSpent as error:
                self.cut = f"{error.message} up to t = {self.t:.6g}; it may be too stiff or switch too fast"
            if self.cut is not None:
                return

    def _enter(self, begin: float) -> None:
        """Begin a piece of the inputs: what a jump turns on is on at once."""
        self.rhs.enter(begin)
        try:
            self.rhs.f(begin, self.x)
            on = self.watch.on(self.watch.measure(begin, self.x))
        except (NonFinite, RunsAway) as error:
            if len(self.samples) == 1 and not self.on:
                raise
            self.cut = error.message
            return
        turned = [i for i, now in enumerate(on) if now and self.on and not self.on[i]]
        self.on = on
        self._happen([(begin, i) for i in turned], lambda _: self.x)

    def _piece(self, stops: list[float], finish: float, wanted: set[float]) -> None:
        if self.cut is not None:
            return
        solver, max_step = None, np.inf
        for stop in stops:
            before = self.t
            try:
                solver = solver or self._solver(finish, max_step)
                x = solver.advance(stop)
                self._look(stop, x, self.watch.on(self.watch.measure(stop, x)))
            except (NonFinite, RunsAway, SolverFailed) as error:
                self._approach(stop, error)
                if self.cut is None:
                    # It was a long step that failed, not this time itself.
                    solver, max_step = None, 0.5 * (stop - before)
            if self.cut is not None:
                return
            if stop in wanted:
                self.samples.append((stop, self.x))

    def _solver(self, finish: float, max_step: float) -> Solver:
        problem = Problem(self.rhs.f, self.rhs.jacobian, self.t, self.x, finish, max_step)
        return make_solver(self.method, problem, self.tolerances)

    def _look(self, stop: float, x: FloatArray, on: list[bool]) -> None:
        """Go on to a state; events between here and there happen first."""
        turned = [i for i, now in enumerate(on) if now and not self.on[i]]
        if turned:
            begin, start = self.t, self.x

            def state_at(t: float) -> FloatArray:
                if t <= begin:
                    return start
                return x if t >= stop else self._solver(stop, np.inf).advance(t)

            found = sorted((crossing(state_at, self.watch.measure, i, (begin, stop)), i) for i in turned)
            self._happen(found, state_at)
        if self.cut is None:
            self.t, self.x, self.on = stop, x, on

    def _happen(self, found: list[tuple[float, int]], state_at: Callable[[float], FloatArray]) -> None:
        for t, index in found:
            each, x = self.watch.watched[index], state_at(t)
            if each.event:
                self.events.append(EventRecord(each.name, each.message, t, tuple(x.tolist())))
            if each.stops:
                self.t, self.x, self.cut = t, x, each.message
                return

    def _approach(self, stop: float, error: EngineError) -> None:
        """Go to ``stop`` in short steps; where the equations end before it, go as near as can be and cut there."""
        reach = stop - self.t
        least = _EDGE * abs(stop - self.samples[0][0])
        while reach > least and self.approaches < _APPROACHES:
            self.approaches += 1
            target = stop if reach >= stop - self.t else self.t + reach
            try:
                x = self._solver(target, 0.5 * reach).advance(target)
                self._look(target, x, self.watch.on(self.watch.measure(target, x)))
            except (NonFinite, RunsAway, SolverFailed) as again:
                error, reach = again, 0.25 * reach
                continue
            if self.cut is not None or target == stop:
                return
            reach *= 2.0
        near = self.watch.near(self.watch.measure(self.t, self.x))
        if near:
            self._happen([(self.t, near[0])], lambda _: self.x)
        else:
            self.cut = error.message


def _check_times(times: npt.ArrayLike) -> FloatArray:
    t = np.array(times, dtype=float)
    if t.ndim != 1 or not 2 <= t.size <= MAX_POINTS:
        raise InvalidInput(f"times must be a list of 2 to {MAX_POINTS} numbers", field="times")
    if not np.isfinite(t).all() or np.abs(t).max() > 1e9 or not (np.diff(t) > SAME_TIME * np.abs(t).max()).all():
        raise InvalidInput("times must be strictly increasing numbers up to 1e9", field="times")
    return t


def _courses(model: CompiledModel, inputs: Courses, t: FloatArray) -> list[InputCourse]:
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


def _initial(
    model: CompiledModel, initial: Mapping[str, float] | Sequence[float] | None, u: list[float], p: Values
) -> FloatArray:
    if initial is None or isinstance(initial, Mapping):
        own = model.initial_state(u, p)
        return np.array(model.states(initial or {}, own))
    values = [float(value) for value in initial]
    if len(values) != len(model.state_names):
        raise InvalidInput(f"the model has {len(model.state_names)} states, not {len(values)}", field="initial")
    return np.array(model.states(dict(zip(model.state_names, values, strict=True)), values))


def _breakpoints(courses: list[InputCourse], start: float, end: float) -> FloatArray:
    every = np.unique(np.concatenate([np.zeros(0), *(course.breakpoints() for course in courses)]))
    inside = every[(every > start) & (every < end)]
    if inside.size > MAX_BREAKPOINTS:
        raise InvalidInput(
            f"the inputs jump more than {MAX_BREAKPOINTS} times", field="inputs", hint="a shorter horizon has fewer"
        )
    return inside


def _merged(stops: FloatArray, times: FloatArray) -> FloatArray:
    """Sorted; of those that are the same to rounding one is kept, the time that was asked for where there is one."""
    snapped = _snapped(np.unique(stops), times)
    keep = np.unique(snapped)
    apart = np.diff(keep, prepend=-np.inf) > SAME_TIME * np.abs(keep)
    return keep[apart | np.isin(keep, times)]


def _snapped(values: FloatArray, grid: FloatArray) -> FloatArray:
    """Each value, or the grid's own where they are the same to rounding."""
    if not grid.size:
        return values
    right = np.clip(np.searchsorted(grid, values), 1, grid.size - 1)
    nearest = np.where(values - grid[right - 1] < grid[right] - values, grid[right - 1], grid[right])
    return np.where(np.abs(nearest - values) <= SAME_TIME * np.abs(values), nearest, values)


def _result(model: CompiledModel, courses: list[InputCourse], p: Values, run: _Run, counter: Counter) -> Simulation:
    if run.cut is not None and run.t > run.samples[-1][0]:
        run.samples.append((run.t, run.x))
    cut_at, reason = (run.t, run.cut) if run.cut is not None else (None, None)
    t = np.array([sample[0] for sample in run.samples])
    x = np.array([sample[1] for sample in run.samples])
    u = np.array([course.values(t) for course in courses]).reshape(len(courses), t.size).T
    y: list[Values] = []
    for at, state, now in zip(t.tolist(), x.tolist(), u.tolist(), strict=True):
        try:
            y.append(model.outputs(at, state, now, p))
        except NonFinite as error:
            if not y:
                raise
            cut_at, reason = at, error.message
            break
    count = len(y)
    return Simulation(
        t[:count],
        x[:count],
        np.array(y).reshape(count, len(model.output_names)),
        u[:count],
        tuple(run.events),
        cut_at,
        reason,
        counter.calls,
    )
