"""dx/dt as a solver calls it: inputs put in, evaluations counted, states that run away stopped."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Protocol

import numpy as np

from looplab.engine.errors import EngineError, NonFinite
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation.solvers import Counter
from looplab.engine.nonlinear.simulation.watch import LARGEST_STATE
from looplab.engine.systems.polynomial import FloatArray

# The sum of squares is quicker to look at than the largest state.
_TOO_LARGE = 4.0 * LARGEST_STATE**2


class Course(Protocol):
    """What an input does over time, as a solver needs it: piece by piece."""

    def piece(self, start: float) -> float | Callable[[float], float]:
        """u from ``start`` to where it begins anew: a number where it is constant, else a function of t."""


class RunsAway(EngineError):
    """A state has grown beyond all bounds."""


class RightHandSide:
    """f and its Jacobian for solvers, with the inputs of one piece of time.

    Parameters
    ----------
    model : CompiledModel
    courses : sequence of Course
        One for each input.
    p : tuple of float
    counter : Counter
    """

    def __init__(self, model: CompiledModel, courses: Sequence[Course], p: Values, counter: Counter) -> None:
        self._f, self._jacobian = model.f, model.state_jacobian
        self._courses, self._p, self._counter = courses, p, counter
        self._last = np.zeros((len(model.state_names),) * 2)
        self.u: Callable[[float], Values] = lambda t: ()
        self._constant: Values | None = None

    def enter(self, start: float) -> None:
        """Take the inputs of the piece that begins at ``start``."""
        pieces = [course.piece(start) for course in self._courses]
        self._constant = None
        if all(isinstance(piece, float) for piece in pieces):
            constant = tuple(piece for piece in pieces if isinstance(piece, float))
            self._constant = constant
            self.u = lambda t: constant
        else:
            self.u = lambda t: tuple(piece if isinstance(piece, float) else piece(t) for piece in pieces)

    def f(self, t: float, x: FloatArray) -> Values:
        """dx/dt."""
        self._counter.call()
        if not x.dot(x) < _TOO_LARGE:
            raise RunsAway(f"a state grows beyond {LARGEST_STATE:g}: it runs away")
        u = self._constant
        return self._f(t, x.tolist(), self.u(t) if u is None else u, self._p)

    def jacobian(self, t: float, x: FloatArray) -> FloatArray:
        """df/dx, or the last one that was finite: it only steers the solver's iteration, not its result."""
        self._counter.call()
        with suppress(NonFinite):
            self._last = self._jacobian(t, x.tolist(), self.u(t), self._p)
        return self._last
