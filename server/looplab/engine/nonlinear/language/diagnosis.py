"""Where an expression stops being a finite real number, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from looplab.engine.nonlinear.language.functions import TOTAL
from looplab.engine.nonlinear.language.graph import Graph


def evaluate(
    graph: Graph, outputs: list[int], t: float, x: Sequence[float], u: Sequence[float], p: Sequence[float]
) -> dict[int, float]:
    """Values of the outputs and of every node they need, nan and inf among them."""
    given = {"x": x, "u": u, "p": p}
    values: dict[int, float] = {}
    for node in graph.reachable(outputs):
        kind, *rest = graph.nodes[node]
        if kind == "const":
            values[node] = float(rest[0])
        elif kind == "t":
            values[node] = t
        elif kind in given:
            values[node] = given[str(kind)][int(rest[0])]
        else:
            values[node] = TOTAL[str(kind)](*(values[operand] for operand in graph.operands(node)))
    return values


def explain(graph: Graph, output: int, t: float, x: Sequence[float], u: Sequence[float], p: Sequence[float]) -> str:
    """The first operation on the way to an output that has no finite value, such as "log of -0.2"."""
    values = evaluate(graph, [output], t, x, u, p)
    node = output
    while True:
        operands = _used(graph, node, values)
        bad = [operand for operand in operands if not math.isfinite(values[operand])]
        if not bad:
            return _words(str(graph.nodes[node][0]), [values[operand] for operand in operands])
        node = bad[0]


def _used(graph: Graph, node: int, values: dict[int, float]) -> tuple[int, ...]:
    """Operands that the value depends on: of an ``if``, the comparison and the branch that is taken."""
    operands = graph.operands(node)
    kind = str(graph.nodes[node][0])
    if not kind.startswith("if"):
        return operands
    a, b = values[operands[0]], values[operands[1]]
    taken = a < b if kind == "if<" else a <= b
    return (*operands[:2], operands[2] if taken else operands[3])


def _words(kind: str, values: list[float]) -> str:
    shown = [f"{value:.4g}" for value in values]
    if kind == "/" and values[1] == 0.0:
        return "a division by zero"
    if kind == "pow":
        return f"{shown[0]} to the power {shown[1]}"
    if kind in ("+", "-", "*", "/"):
        return f"{shown[0]} {kind} {shown[1]}, which is too large"
    return f"{kind} of {shown[0]}" if shown else "a value that is not finite"
