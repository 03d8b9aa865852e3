"""From a syntax tree to the graph: names looked up, constants computed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from difflib import get_close_matches

from looplab.engine.errors import ParseError
from looplab.engine.nonlinear.language.functions import CALLABLE
from looplab.engine.nonlinear.language.graph import Graph
from looplab.engine.nonlinear.language.syntax import Node

RESERVED = frozenset(CALLABLE) | {"t", "pi"}


def add_expression(graph: Graph, node: Node, names: Mapping[str, int]) -> int:
    """Number of the graph's node for an expression.

    Parameters
    ----------
    graph : Graph
    node : Node
        No comparison.
    names : mapping
        Graph nodes of the names that may stand here, besides ``pi``.

    Raises
    ------
    ParseError
        A name is not declared, or constants leave the range of real numbers.
    """
    if node.kind == "number":
        return graph.constant(node.value)
    if node.kind == "name":
        if node.name == "pi":
            return graph.constant(math.pi)
        if node.name not in names:
            raise ParseError(
                f"unknown name {node.name[:40]!r}", column=node.column, hint=nearest_hint(node.name, names)
            )
        return names[node.name]
    if node.kind == "call":
        return _add_call(graph, node, names)
    operation = {"^": "pow"}.get(node.kind, node.kind)
    return _checked(graph, node, operation, *(add_expression(graph, arg, names) for arg in node.args))


def add_condition(graph: Graph, node: Node, names: Mapping[str, int]) -> tuple[int, bool]:
    """A comparison as (g, strict): it is true where g > 0, or where it is not strict also where g = 0.

    Raises
    ------
    ParseError
        As for an expression.
    """
    left, right = (add_expression(graph, arg, names) for arg in node.args)
    large, small = (right, left) if node.kind in ("<", "<=") else (left, right)
    return _checked(graph, node, "-", large, small), node.kind in ("<", ">")


def _add_call(graph: Graph, node: Node, names: Mapping[str, int]) -> int:
    if node.name == "if":
        condition, *branches = node.args
        left, right = (add_expression(graph, arg, names) for arg in condition.args)
        if condition.kind in (">", ">="):
            left, right = right, left
        operation = "if<" if condition.kind in ("<", ">") else "if<="
        return _checked(
            graph, node, operation, left, right, *(add_expression(graph, branch, names) for branch in branches)
        )
    args = [add_expression(graph, arg, names) for arg in node.args]
    if node.name == "clip":
        return _checked(graph, node, "min", _checked(graph, node, "max", args[0], args[1]), args[2])
    if node.name in ("min", "max"):
        out = args[0]
        for arg in args[1:]:
            out = _checked(graph, node, node.name, out, arg)
        return out
    return _checked(graph, node, node.name, *args)


def _checked(graph: Graph, node: Node, operation: str, *operands: int) -> int:
    """The operation's node; constants that it cannot be computed from are the author's mistake."""
    out = graph.apply(operation, *operands)
    if graph.value(out) is None and all(graph.value(operand) is not None for operand in operands):
        raise ParseError(
            "these constants leave the range of real numbers", column=node.column, hint="the result is not finite"
        )
    return out


def nearest_hint(name: str, names: Mapping[str, int]) -> str:
    """The declared names that a mistyped one may have meant."""
    declared = [*names, "pi"]
    same = [other for other in declared if other.lower() == name.lower()]
    near = same or get_close_matches(name, declared, n=3)
    if near:
        return f"did you mean {' or '.join(near)}?"
    shown = ", ".join(declared[:12])
    return f"declared are {shown}{' ...' if len(declared) > 12 else ''}"
