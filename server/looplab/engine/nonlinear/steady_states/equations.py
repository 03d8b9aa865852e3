"""The equations of a steady state, 0 = f(x, u, p), along one of their quantities or at fixed values of all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.systems.polynomial import FloatArray

Box = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class SteadyEquations:
    """Equations of some states in these states, and in one quantity more where there is an ``over``.

    A point is the vector y of the free states and, last, the value of ``over``.

    Attributes
    ----------
    model : CompiledModel
    x, u, p : tuple of float
        Values of what is held.
    free : tuple of int
        States that are solved for, with the equation of each.
    over : str or None
        An input, a parameter or a state that is not free: the quantity that the solution is a curve over.
    """

    model: CompiledModel
    x: Values
    u: Values
    p: Values
    free: tuple[int, ...]
    over: str | None = None

    def arguments(self, y: FloatArray) -> tuple[list[float], list[float], list[float]]:
        """x, u and p at a point."""
        x, u, p = list(self.x), list(self.u), list(self.p)
        values = y.tolist()
        for index, value in zip(self.free, values, strict=False):
            x[index] = value
        if self.over is not None:
            model = self.model
            for names, target in ((model.state_names, x), (model.input_names, u), (model.parameter_names, p)):
                if self.over in names:
                    target[names.index(self.over)] = values[-1]
        return x, u, p

    def residual(self, y: FloatArray) -> FloatArray:
        """f of the free states, shape (k,); raises NonFinite."""
        f = self.model.f(0.0, *self.arguments(y))
        return np.array([f[index] for index in self.free])

    def jacobian(self, y: FloatArray) -> FloatArray:
        """Exact derivatives by y, shape (k, k) or (k, k + 1); raises NonFinite."""
        arguments = self.arguments(y)
        A = self.model.state_jacobian(0.0, *arguments)
        free = list(self.free)
        J = A[np.ix_(free, free)]
        if self.over is None:
            return J
        if self.over in self.model.state_names:
            column = A[free, self.model.state_names.index(self.over)]
        else:
            column = np.array(self.model.sensitivity(self.over)(0.0, *arguments))[free]
        return np.column_stack([J, column])


def require_autonomous(model: CompiledModel) -> None:
    """Refuse a model whose equations change with time; raises InvalidInput."""
    graph = model.graph
    if any(graph.nodes[node] == ("t",) for node in graph.reachable(list(model.equations.states))):
        raise InvalidInput(
            "the equations depend on the time t, so nothing stays at rest",
            field="states",
            hint="make what changes an input, and hold it",
        )


def known_states(model: CompiledModel, u: Values, p: Values) -> list[Values]:
    """The initial state, and the states of the operating points: where a search begins."""
    start = model.initial_state(u, p)
    near = [model.states(point.near, start) for point in model.document.operating_points if point.near]
    return [start, *dict.fromkeys(each for each in near if each != start)]


def search_box(model: CompiledModel, known: list[Values], given: Box | None = None) -> FloatArray:
    """Where steady states are looked for.

    Parameters
    ----------
    model : CompiledModel
    known : list of tuple of float
        States to have inside where the model declares no bounds.
    given : mapping of str to (float, float), or None
        Bounds of some states.

    Returns
    -------
    ndarray, shape (n, 2)
        Given bounds before declared ones; a missing one is half the size of the known states away, and at least 1.

    Raises
    ------
    InvalidInput
        There is no such state, or its bounds are not in order.
    """
    given = given or {}
    for name in given:
        if name not in model.state_names:
            hint = f"there are {', '.join(model.state_names[:12])}"
            raise InvalidInput(f"the model has no state {name[:40]!a}", field=f"box.{name[:40]}", hint=hint)
    box = np.empty((len(model.state_names), 2))
    for row, state, values in zip(box, model.document.states, np.array(known).T, strict=True):
        least, most = float(values.min()), float(values.max())
        reach = max(1.0, 0.5 * float(np.abs(values).max()))
        low = least - reach if state.min is None else state.min
        high = most + reach if state.max is None else state.max
        row[:] = given.get(state.name, (low, high))
        if not (np.isfinite(row).all() and row[0] < row[1]):
            raise InvalidInput("bounds are two numbers, the lower one first", field=f"box.{state.name}")
    return box
