"""A model that can be computed: equations, outputs and their exact Jacobians as functions of (t, x, u, p)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from looplab.engine.errors import InvalidInput, NonFinite
from looplab.engine.nonlinear.document import ModelDocument, Setting, State, check_range, read_document
from looplab.engine.nonlinear.equations import read_equations
from looplab.engine.nonlinear.fields import as_number
from looplab.engine.nonlinear.language import (
    Differentiator,
    Function,
    Limits,
    Point,
    Values,
    compile_function,
    explain,
)
from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class Jacobians:
    """Derivatives at a point: A = df/dx (n, n), B = df/du (n, m), C = dy/dx (q, n), D = dy/du (q, m)."""

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: FloatArray


class CompiledModel:
    """A model read, checked, differentiated and ready to compute.

    Every function takes ``t`` (float) and ``x``, ``u``, ``p`` (sequences of Python floats in the order of
    ``state_names``, ``input_names`` and ``parameter_names``) and returns a tuple of finite floats, or raises NonFinite
    naming the equation and the time. Numpy scalars work too, but slowly: pass ``array.tolist()``.

    Parameters
    ----------
    document : ModelDocument
    limits : Limits

    Attributes
    ----------
    equations : Equations
        Graph nodes of every expression.
    syntax : dict
        Syntax trees by place in the document, e.g. ``states[0].equation``, for ``to_latex``.
    state_names, input_names, parameter_names, output_names, variable_names : tuple of str
    u0, p0 : tuple of float
        Nominal inputs and parameters.
    """

    def __init__(self, document: ModelDocument, limits: Limits) -> None:
        self.document = document
        self.limits = limits
        self.equations = read_equations(document, limits)
        self.graph, self.syntax = self.equations.graph, self.equations.syntax
        self.state_names = tuple(state.name for state in document.states)
        self.input_names = tuple(each.name for each in document.inputs)
        self.parameter_names = tuple(each.name for each in document.parameters)
        self.output_names = tuple(each.name for each in document.outputs)
        self.variable_names = tuple(each.name for each in document.variables)
        self.u0: Values = tuple(each.value for each in document.inputs)
        self.p0: Values = tuple(each.value for each in document.parameters)
        leaves = self.equations.leaves
        self._x = [leaves[name] for name in self.state_names]
        self._u = [leaves[name] for name in self.input_names]
        # Before anything is computed, so that a model which is too large is refused at once.
        gradients = Differentiator(self.graph, [*self._x, *self._u])
        self._df = [gradients.gradient(node) for node in self.equations.states]
        self._dy = [gradients.gradient(node) for node in self.equations.outputs]
        self._sensitivities: dict[str, Function] = {}

    # --- values to start from ---------------------------------------------------------------------------------

    @cached_property
    def x0(self) -> Values:
        """Initial state at the nominal inputs and parameters."""
        return self.initial_state()

    def initial_state(self, u: Sequence[float] | None = None, p: Sequence[float] | None = None) -> Values:
        """Initial state; where it is given as an expression it follows the inputs and parameters."""
        return self._initial(0.0, (), self.u0 if u is None else u, self.p0 if p is None else p)

    def inputs(self, values: Mapping[str, float], field: str = "inputs") -> Values:
        """u with some inputs set and the others nominal; raises InvalidInput naming ``field``.name."""
        return _set(self.document.inputs, self.u0, values, field)

    def parameters(self, values: Mapping[str, float], field: str = "parameters") -> Values:
        """p with some parameters set and the others nominal; raises InvalidInput naming ``field``.name."""
        return _set(self.document.parameters, self.p0, values, field)

    def states(self, values: Mapping[str, float], x: Sequence[float], field: str = "initial") -> Values:
        """x with some states set; raises InvalidInput naming ``field``.name."""
        return _set(self.document.states, x, values, field)

    # --- functions of (t, x, u, p) ----------------------------------------------------------------------------

    @cached_property
    def f(self) -> Function:
        """dx/dt, n values."""
        return self._compile(self.equations.states, self._places("states", "equation"))

    @cached_property
    def outputs(self) -> Function:
        """y, q values."""
        return self._compile(self.equations.outputs, self._places("outputs", "expression"))

    @cached_property
    def variables(self) -> Function:
        """Values of the variables."""
        return self._compile(self.equations.variables, self._places("variables", "expression"))

    @cached_property
    def events(self) -> Function:
        """One value for each event: it is on where that is positive, or zero unless ``event_strict``."""
        return self._compile(self.equations.events, self._places("events", "when"))

    @property
    def event_strict(self) -> tuple[bool, ...]:
        """For each event, whether its comparison excludes equality."""
        return self.equations.strict

    @cached_property
    def state_jacobian(self) -> JacobianFunction:
        """A = df/dx alone, shape (n, n): what an implicit solver asks for."""
        return self._matrix(self._df, self._x, "states", "equation")

    def jacobians(self, t: float, x: Sequence[float], u: Sequence[float], p: Sequence[float]) -> Jacobians:
        """Exact derivatives of f and y by x and u.

        Parameters
        ----------
        t : float
            [time]
        x, u, p : sequence of float
            Lengths n, m and k.

        Returns
        -------
        Jacobians

        Raises
        ------
        NonFinite
            A derivative does not exist at this point, as that of sqrt(h) at h = 0.
        """
        point = (t, x, u, p)
        return Jacobians(self.state_jacobian(*point), self._B(*point), self._C(*point), self._D(*point))

    @cached_property
    def _B(self) -> JacobianFunction:
        return self._matrix(self._df, self._u, "states", "equation")

    @cached_property
    def _C(self) -> JacobianFunction:
        return self._matrix(self._dy, self._x, "outputs", "expression")

    @cached_property
    def _D(self) -> JacobianFunction:
        return self._matrix(self._dy, self._u, "outputs", "expression")

    def sensitivity(self, name: str) -> Function:
        """df/d(name) for a parameter or an input, n values: a function of (t, x, u, p).

        Raises
        ------
        InvalidInput
            The model has no such parameter or input, or its derivatives are too many.
        """
        if name not in (*self.parameter_names, *self.input_names):
            raise InvalidInput(f"the model has no parameter or input {name[:40]!a}", field=name[:40])
        if name not in self._sensitivities:
            graph, leaf = self.graph, self.equations.leaves[name]
            # The limit is on what every model carries; one more column is asked for knowingly.
            graph.limit += self.limits.nodes
            by = Differentiator(graph, [leaf])
            column = [by.gradient(node).get(leaf, by.zero) for node in self.equations.states]
            self._sensitivities[name] = self._compile(column, self._places("states", "equation"))
        return self._sensitivities[name]

    @cached_property
    def operations(self) -> int:
        """Operations that one evaluation of f takes."""
        return len(self.graph.reachable(list(self.equations.states)))

    # --- how they are made ------------------------------------------------------------------------------------

    @cached_property
    def _initial(self) -> Function:
        return self._compile(self.equations.initial, self._places("states", "initial"))

    def _places(self, kind: str, what: str) -> list[str]:
        items = getattr(self.document, kind)
        return [f"{kind}[{index}].{what}" for index in range(len(items))]

    def _compile(self, nodes: Sequence[int], places: Sequence[str], subject: str = "{}") -> Function:
        graph = self.graph

        def fail(values: Values, point: Point) -> Values:
            bad = next(index for index, value in enumerate(values) if not math.isfinite(value))
            reason = explain(graph, nodes[bad], *point)
            what = subject.format(places[bad])
            raise NonFinite(
                f"{what} has no finite value at t = {point[0]:.6g}: it takes {reason}", t=point[0], field=places[bad]
            )

        return compile_function(graph, list(nodes), fail)

    def _matrix(self, gradients: list[dict[int, int]], by: list[int], kind: str, what: str) -> JacobianFunction:
        places = self._places(kind, what)
        found = [
            (row * len(by) + column, gradient[leaf], places[row])
            for row, gradient in enumerate(gradients)
            for column, leaf in enumerate(by)
            if leaf in gradient
        ]
        function = self._compile([f[1] for f in found], [f[2] for f in found], "a derivative of {}")
        return JacobianFunction(function, (len(gradients), len(by)), [f[0] for f in found])


class JacobianFunction:
    """A matrix as a function of (t, x, u, p), of which only the entries that can differ from zero are computed."""

    def __init__(self, function: Function, shape: tuple[int, int], places: list[int]) -> None:
        self._function, self._shape, self._places = function, shape, np.array(places, dtype=np.intp)

    def __call__(self, t: float, x: Sequence[float], u: Sequence[float], p: Sequence[float]) -> FloatArray:
        """The matrix, a new array."""
        out = np.zeros(self._shape)
        if self._places.size:
            out.flat[self._places] = self._function(t, x, u, p)
        return out


def _set(items: Sequence[Setting | State], nominal: Sequence[float], values: Mapping[str, float], field: str) -> Values:
    place = {item.name: index for index, item in enumerate(items)}
    out = list(nominal)
    for name, value in values.items():
        path = f"{field}.{name[:40]}"
        if name not in place:
            known = ", ".join(list(place)[:12])
            raise InvalidInput(
                f"the model has no {name[:40]!a} here", field=path, hint=f"there are {known}" if known else None
            )
        item = items[place[name]]
        out[place[name]] = as_number(value, path)
        check_range(out[place[name]], item.min, item.max, name, path)
    return tuple(out)


def compile_model(data: Mapping[str, object], limits: Limits = Limits()) -> CompiledModel:  # noqa: B008 (frozen)
    """Read a model's document and make its functions.

    Parameters
    ----------
    data : mapping
        The document as ``json.loads`` gives it.
    limits : Limits
        Larger ones (``BUILT_IN``) are for documents that our own code has written.

    Returns
    -------
    CompiledModel

    Raises
    ------
    ParseError
        A formula cannot be read: its place in ``field``, its ``column``, and a hint.
    InvalidInput
        The document is malformed or larger than the limits.
    """
    return CompiledModel(read_document(data, limits), limits)
