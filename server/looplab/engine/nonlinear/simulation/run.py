"""A simulation under way: from discontinuity to discontinuity, with events located between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from looplab.engine.errors import EngineError, NonFinite
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation.result import EventRecord
from looplab.engine.nonlinear.simulation.right_hand_side import Course, RightHandSide, RunsAway
from looplab.engine.nonlinear.simulation.short_steps import Patience, ShortSteps
from looplab.engine.nonlinear.simulation.solvers import (
    BudgetSpent,
    Problem,
    Solver,
    SolverFailed,
    Tolerances,
    make_solver,
)
from looplab.engine.nonlinear.simulation.watch import Watch, crossing
from looplab.engine.systems.polynomial import FloatArray

# How closely the end is approached where the equations cannot be computed any further, as part of the time so far.
_EDGE = 1e-9
_APPROACHES = 300


@dataclass(frozen=True)
class Mark:
    """A place of a simulation to which it can go back."""

    t: float
    x: FloatArray
    on: list[bool]
    events: int
    samples: int


class Run:
    """The state of a simulation under way, and what it has gathered.

    Parameters
    ----------
    model : CompiledModel
    courses : sequence of Course
        One for each input.
    p : tuple of float
    method : str
    tolerances : Tolerances

    Attributes
    ----------
    t, x : float and ndarray, shape (n,)
        Where it is.
    samples : list of (float, ndarray)
        States at the times that were wanted, the start and the place of a cut included.
    events : list of EventRecord
    cut : str or None
        Why it cannot go on.
    max_step : float
        Longest step of the solver [time].
    patience : Patience or None
        Where it is given, a few explicit steps are tried before the solver: for pieces that are short.
    """

    def __init__(
        self,
        model: CompiledModel,
        courses: Sequence[Course],
        p: Values,
        method: str,
        tolerances: Tolerances,
    ) -> None:
        self.rhs = RightHandSide(model, courses, p, tolerances.counter)
        self.watch = Watch(model, lambda t: self.rhs.u(t), p)
        self.method, self.tolerances = method, tolerances
        self.t, self.x = 0.0, np.zeros(0)
        self.on: list[bool] = []
        self.samples: list[tuple[float, FloatArray]] = []
        self.events: list[EventRecord] = []
        self.cut: str | None = None
        self.approaches = 0
        self.max_step = np.inf
        self.used: Solver | None = None
        self.patience: Patience | None = None

    def start(self, t: float, x: FloatArray) -> None:
        """Put it at its start."""
        self.t, self.x = t, x
        self.samples.append((t, x))

    def follow(self, edges: Sequence[float], stops: FloatArray, wanted: set[float]) -> None:
        """Go from edge to edge, where the inputs begin anew."""
        for begin, finish in pairwise(edges):
            inside = stops[(stops > begin) & (stops <= finish)].tolist()
            with self.budgeted():
                self.enter(begin)
                self.advance(inside, finish, wanted)
            if self.cut is not None:
                return

    def mark(self) -> Mark:
        """Where it is."""
        return Mark(self.t, self.x, self.on, len(self.events), len(self.samples))

    def back(self, mark: Mark) -> None:
        """Go back to where it was."""
        self.t, self.x, self.on = mark.t, mark.x, mark.on
        del self.events[mark.events :], self.samples[mark.samples :]

    @contextmanager
    def budgeted(self) -> Iterator[None]:
        """Cut where the solver has used up its evaluations."""
        try:
            yield
        except BudgetSpent as error:
            self.cut = f"{error.message} up to t = {self.t:.6g}; it may be too stiff or switch too fast"

    def enter(self, begin: float) -> None:
        """Begin a piece of the inputs: what a jump turns on is on at once."""
        self.rhs.enter(begin)
        try:
            self.rhs.f(begin, self.x)
            on = self.watch.on(begin, self.x)
        except (NonFinite, RunsAway) as error:
            if len(self.samples) == 1 and not self.on:
                raise
            self.cut = error.message
            return
        turned = [i for i, now in enumerate(on) if now and self.on and not self.on[i]]
        self.on = on
        self._happen([(begin, i) for i in turned], lambda _: self.x)

    def advance(self, stops: list[float], finish: float, wanted: set[float]) -> None:
        """Go on to ``finish``, the last of ``stops``, with the inputs that were entered."""
        if self.cut is not None:
            return
        solver, max_step = None, self.max_step
        for stop in stops:
            before = self.t
            try:
                if solver is None:
                    solver = self.used = self._solver(finish, max_step, self.used)
                x = solver.advance(stop)
                self._look(stop, x, self.watch.on(stop, x))
            except (NonFinite, RunsAway, SolverFailed) as error:
                self._approach(stop, error)
                if self.cut is None:
                    # It was a long step that failed, not this time itself.
                    solver, max_step = None, min(self.max_step, 0.5 * (stop - before))
            if self.cut is not None:
                return
            if stop in wanted:
                self.samples.append((stop, self.x))

    def _solver(self, finish: float, max_step: float, used: Solver | None = None) -> Solver:
        def begin(t: float, x: FloatArray) -> Solver:
            problem = Problem(self.rhs.f, self.rhs.jacobian, t, x, finish, max_step)
            return make_solver(self.method, problem, self.tolerances, used)

        if self.patience is None or self.patience.left <= 0:
            return begin(self.t, self.x)
        return ShortSteps(self.rhs.rates, self.t, self.x, self.tolerances, self.patience, begin)

    def _look(self, stop: float, x: FloatArray, on: list[bool]) -> None:
        """Go on to a state; events between here and there happen first."""
        turned = [i for i, now in enumerate(on) if now and not self.on[i]] if on != self.on else []
        if turned:
            begin, start = self.t, self.x

            def state_at(t: float) -> FloatArray:
                if t <= begin:
                    return start
                return x if t >= stop else self._solver(stop, self.max_step).advance(t)

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
                x = self._solver(target, min(self.max_step, 0.5 * reach)).advance(target)
                self._look(target, x, self.watch.on(target, x))
            except (NonFinite, RunsAway, SolverFailed) as again:
                error, reach = again, 0.25 * reach
                continue
            if self.cut is not None or target == stop:
                return
            reach *= 2.0
        near = self.watch.near(self.t, self.x, [x for _, x in self.samples])
        if near:
            self._happen([(self.t, near[0])], lambda _: self.x)
        else:
            self.cut = error.message
