"""All expressions of a document in one graph: names looked up, variables in the order in which they need each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.nonlinear.document import ModelDocument
from looplab.engine.nonlinear.language import (
    Graph,
    Limits,
    Node,
    add_condition,
    add_expression,
    parse_condition,
    parse_expression,
)


@dataclass(frozen=True)
class Equations:
    """Graph nodes of a model's expressions.

    Attributes
    ----------
    graph : Graph
    syntax : dict
        Syntax trees by place in the document, e.g. ``states[0].equation``.
    leaves : dict
        Nodes of parameters, inputs and states by name.
    variables, states, outputs, events, initial : tuple of int
        Nodes in the document's order; of an event, the one that is positive where it is on.
    strict : tuple of bool
        For each event, whether its comparison excludes equality.
    """

    graph: Graph
    syntax: dict[str, Node]
    leaves: dict[str, int]
    variables: tuple[int, ...]
    states: tuple[int, ...]
    outputs: tuple[int, ...]
    events: tuple[int, ...]
    initial: tuple[int, ...]
    strict: tuple[bool, ...]


def read_equations(document: ModelDocument, limits: Limits) -> Equations:
    """Parse every expression of a document.

    Raises
    ------
    ParseError
        With the expression's place and the column in it.
    InvalidInput
        Variables that need each other in a circle, or more operations than the limits allow.
    """
    graph = Graph(limits.nodes)
    leaves: dict[str, int] = {}
    leaves |= {item.name: graph.leaf("p", index) for index, item in enumerate(document.parameters)}
    leaves |= {item.name: graph.leaf("u", index) for index, item in enumerate(document.inputs)}
    leaves |= {item.name: graph.leaf("x", index) for index, item in enumerate(document.states)}
    reader = _Reader(graph, limits, {"t": graph.leaf("t"), **leaves})
    fixed = {item.name: leaves[item.name] for item in (*document.parameters, *document.inputs)}
    variables = reader.variables(document)
    events = [reader.condition(f"events[{i}].when", event.when) for i, event in enumerate(document.events)]
    return Equations(
        graph,
        reader.syntax,
        leaves,
        variables,
        tuple(reader.expression(f"states[{i}].equation", state.equation) for i, state in enumerate(document.states)),
        tuple(reader.expression(f"outputs[{i}].expression", y.expression) for i, y in enumerate(document.outputs)),
        tuple(node for node, _ in events),
        tuple(
            reader.expression(f"states[{i}].initial", state.initial, fixed)
            if isinstance(state.initial, str)
            else graph.constant(state.initial)
            for i, state in enumerate(document.states)
        ),
        tuple(strict for _, strict in events),
    )


class _Reader:
    def __init__(self, graph: Graph, limits: Limits, names: dict[str, int]) -> None:
        self.graph, self.limits, self.names = graph, limits, names
        self.syntax: dict[str, Node] = {}

    def expression(self, path: str, text: str, names: Mapping[str, int] | None = None) -> int:
        with _at(path):
            self.syntax[path] = parse_expression(text, self.limits)
            return add_expression(self.graph, self.syntax[path], self.names if names is None else names)

    def condition(self, path: str, text: str) -> tuple[int, bool]:
        with _at(path):
            self.syntax[path] = parse_condition(text, self.limits)
            return add_condition(self.graph, self.syntax[path], self.names)

    def variables(self, document: ModelDocument) -> tuple[int, ...]:
        paths = {variable.name: f"variables[{i}].expression" for i, variable in enumerate(document.variables)}
        for variable in document.variables:
            path = paths[variable.name]
            with _at(path):
                self.syntax[path] = parse_expression(variable.expression, self.limits)
        uses = {name: sorted(_names_in(self.syntax[path]) & set(paths)) for name, path in paths.items()}
        for name in _dependencies_first(uses, paths):
            with _at(paths[name]):
                self.names[name] = add_expression(self.graph, self.syntax[paths[name]], self.names)
        return tuple(self.names[name] for name in paths)


def _names_in(node: Node) -> set[str]:
    out, waiting = set(), [node]
    while waiting:
        each = waiting.pop()
        if each.kind == "name":
            out.add(each.name)
        waiting.extend(each.args)
    return out


def _dependencies_first(uses: Mapping[str, list[str]], paths: Mapping[str, str]) -> list[str]:
    """Names in an order in which each comes after those it uses."""
    order: list[str] = []
    waiting = {name: set(used) for name, used in uses.items()}
    while waiting:
        ready = [name for name, used in waiting.items() if not used]
        if not ready:
            circle = _circle(uses, waiting)
            raise InvalidInput(
                f"the variables {' -> '.join(circle)} need each other",
                field=paths[circle[0]],
                hint="a variable may use others, but not in a circle",
            )
        order += ready
        waiting = {name: used - set(ready) for name, used in waiting.items() if name not in ready}
    return order


def _circle(uses: Mapping[str, list[str]], among: Mapping[str, object]) -> list[str]:
    """A closed walk from use to use; there is one, as each of ``among`` uses another of them."""
    walk = [next(iter(among))]
    while walk[-1] not in walk[:-1]:
        walk.append(next(used for used in uses[walk[-1]] if used in among))
    return walk[walk.index(walk[-1]) :]


@contextmanager
def _at(path: str) -> Iterator[None]:
    """Give an error the place of the expression it is in."""
    try:
        yield
    except EngineError as error:
        error.field = path
        raise
