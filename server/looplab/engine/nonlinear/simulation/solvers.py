"""Solvers for initial value problems behind one interface: carry the state on to the next time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from scipy.integrate import BDF, RK45, Radau, ode

from looplab.engine.errors import EngineError
from looplab.engine.systems.polynomial import FloatArray

METHODS = ("LSODA", "RK45", "Radau", "BDF")
# Work per evaluation of the model, in evaluations by LSODA: the others are written in Python.
WEIGHTS = {"LSODA": 1, "RK45": 6, "Radau": 10, "BDF": 30}
_CLASSES: dict[str, Any] = {"RK45": RK45, "Radau": Radau, "BDF": BDF}
# Times closer than this part of them are the same to a solver.
_NO_TIME = 1e-14

RightHandSide = Callable[[float, FloatArray], Any]


class SolverFailed(EngineError):
    """The solver cannot meet its tolerances here."""


class BudgetSpent(EngineError):
    """The solver has used up its evaluations of the model."""


class Counter:
    """Counts the work of a simulation and ends it when there is too much: no solver stops by itself.

    Attributes
    ----------
    calls : int
        Evaluations of the model so far.
    """

    def __init__(self, budget: int) -> None:
        self.calls = 0
        self.budget = budget

    def call(self) -> None:
        """One evaluation of the model."""
        self.calls += 1
        if self.calls > self.budget:
            raise BudgetSpent(f"the solver needs more than {self.budget} evaluations of the model")


class Solver(Protocol):
    """What the simulation needs of a solver."""

    def advance(self, t: float) -> FloatArray:
        """The state at a later time; raises SolverFailed, or whatever the right-hand side raises."""


@dataclass(frozen=True)
class Tolerances:
    """Relative and absolute (n,) error of a step, and the count of the work."""

    rtol: float
    atol: FloatArray
    counter: Counter


@dataclass(frozen=True)
class Problem:
    """What is to be solved: dx/dt = f(t, x) with its Jacobian, from (t, x) on until ``end``, in steps of at most."""

    f: RightHandSide
    jac: RightHandSide
    t: float
    x: FloatArray
    end: float
    max_step: float = np.inf


class _Lsoda:
    def __init__(self, problem: Problem, tolerances: Tolerances) -> None:
        # zero stands for no limit
        max_step = problem.max_step if np.isfinite(problem.max_step) else 0.0
        self.solver = ode(problem.f, problem.jac).set_integrator(
            "lsoda",
            rtol=tolerances.rtol,
            atol=tolerances.atol,
            with_jacobian=True,
            max_step=max_step,
            # the right-hand side counts
            nsteps=10**7,
        )
        self.solver.set_initial_value(problem.x, problem.t)

    def advance(self, t: float) -> FloatArray:
        if t - self.solver.t <= _NO_TIME * abs(t):
            return np.array(self.solver.y)
        x = self.solver.integrate(t)
        if not self.solver.successful():
            raise SolverFailed(f"the solver could not go on at t = {self.solver.t:.6g}")
        return np.array(x)


class _Stepping:
    def __init__(self, name: str, problem: Problem, tolerances: Tolerances) -> None:
        options: dict[str, Any] = {"rtol": tolerances.rtol, "atol": tolerances.atol, "max_step": problem.max_step}
        if name != "RK45":
            options["jac"] = problem.jac
        # Between its steps, which can be very long, Radau is far less exact than at their ends.
        self.ends = name == "Radau"
        self.solver = _CLASSES[name](problem.f, problem.t, problem.x, problem.end, **options)
        self.between: Any = None

    def advance(self, t: float) -> FloatArray:
        if self.ends:
            self.solver.t_bound, self.solver.status = t, "running"
        while self.solver.t < t:
            if self.solver.status != "running":
                if t - self.solver.t <= _NO_TIME * abs(t):
                    break
                raise SolverFailed(f"the solver could not go on at t = {self.solver.t:.6g}")
            try:
                self.solver.step()
            except (ValueError, np.linalg.LinAlgError) as error:
                # EngineError is a ValueError too: those of the right-hand side go their way.
                if isinstance(error, EngineError):
                    raise
                raise SolverFailed(f"the solver could not go on at t = {self.solver.t:.6g}") from None
            self.between = None
        if self.solver.t <= t:
            return np.array(self.solver.y)
        if self.between is None:
            self.between = self.solver.dense_output()
        return np.array(self.between(t))


def make_solver(method: str, problem: Problem, tolerances: Tolerances) -> Solver:
    """A solver at the start of a problem; ``method`` is one of METHODS. LSODA may look a step beyond the end."""
    return _Lsoda(problem, tolerances) if method == "LSODA" else _Stepping(method, problem, tolerances)
