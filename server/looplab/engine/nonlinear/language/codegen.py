"""Straight-line Python written from the graph's nodes, and compiled.

No text of a user comes here: every name is made from a node's number, every number is a float's repr, and every
operation is one of this module's templates.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from looplab.engine.nonlinear.language.functions import PLAIN, TOTAL
from looplab.engine.nonlinear.language.graph import Graph

Values = tuple[float, ...]
Point = tuple[float, Sequence[float], Sequence[float], Sequence[float]]
Function = Callable[[float, Sequence[float], Sequence[float], Sequence[float]], Values]

_FAST = {
    "+": "{0} + {1}",
    "-": "{0} - {1}",
    "*": "{0} * {1}",
    "/": "{0} / {1}",
    "neg": "-{0}",
    "pow": "power({0}, {1})",
    "abs": "abs({0})",
    "sign": "1.0 if {0} > 0.0 else -1.0 if {0} < 0.0 else {0} * 0.0",
    "min": "{0} if {0} < {1} else {1} if {1} <= {0} else nan",
    "max": "{0} if {0} > {1} else {1} if {1} >= {0} else nan",
    "if<": "{2} if {0} < {1} else {3} if {0} >= {1} else nan",
    "if<=": "{2} if {0} <= {1} else {3} if {0} > {1} else nan",
    **{name: f"{name}({{0}})" for name in PLAIN},
}
_TOTAL = {**_FAST, "/": "divide({0}, {1})"}
_POWERS = {1.0: "{0}", 2.0: "{0} * {0}", 3.0: "{0} * {0} * {0}", -1.0: "1.0 / {0}", 0.5: "sqrt({0})"}
_TOTAL_POWERS = {**_POWERS, -1.0: "divide(1.0, {0})"}

_SPACE = {"__builtins__": {}, "nan": math.nan, "inf": math.inf, "abs": math.fabs}
_FAST_SPACE = {**_SPACE, **PLAIN, "power": math.pow}
_TOTAL_SPACE = {**_SPACE, **{name: TOTAL[name] for name in PLAIN}, "power": TOTAL["pow"], "divide": TOTAL["/"]}


def compile_function(graph: Graph, outputs: list[int], otherwise: Callable[[Values, Point], Values]) -> Function:
    """A function of (t, x, u, p) that returns the values of nodes as a tuple of finite floats.

    Standard-library arithmetic does the work while it can. Where that raises or a value is not finite, a second
    version whose operations are total decides: only an ``if`` may discard what is not finite.

    Parameters
    ----------
    graph : Graph
    outputs : list of int
        Nodes whose values are wanted.
    otherwise : callable
        Called with the values and the point where one of the values is not finite in the end; what it returns (or
        raises) is the result.
    """
    total = _define(graph, outputs, total=True)

    def rescue(t: float, x: Sequence[float], u: Sequence[float], p: Sequence[float]) -> Values:
        values = total(t, x, u, p)
        return values if all(map(math.isfinite, values)) else otherwise(values, (t, x, u, p))

    return _define(graph, outputs, total=False, rescue=rescue)


def _define(graph: Graph, outputs: list[int], total: bool, rescue: Function | None = None) -> Function:
    space = dict(_TOTAL_SPACE if total else _FAST_SPACE)
    name, lines = _body(graph, outputs, total)
    result = f"({''.join(f'{name[output]}, ' for output in outputs)})"
    if total:
        body = [*lines, f"return {result}"]
    else:
        space |= {"rescue": rescue, "failures": (ArithmeticError, ValueError)}
        # inf and nan survive the sum, and times zero both are nan
        check = " + ".join(name[output] for output in outputs) or "0.0"
        body = [
            "try:",
            *(f"    {line}" for line in lines),
            f"    if ({check}) * 0.0 == 0.0:",
            f"        return {result}",
            "except failures:",
            "    pass",
            "return rescue(t, x, u, p)",
        ]
    source = "\n".join(["def function(t, x, u, p):", *(f"    {line}" for line in body)])
    exec(compile(source, "<looplab model>", "exec"), space)
    return space["function"]  # type: ignore[return-value]


def _body(graph: Graph, outputs: list[int], total: bool) -> tuple[dict[int, str], list[str]]:
    """What each node is called, and the statements that compute them in order."""
    name: dict[int, str] = {}
    lines: list[str] = []
    for node in graph.reachable(outputs):
        kind, *rest = graph.nodes[node]
        if kind == "const":
            value = float(rest[0])
            name[node] = repr(value) if value >= 0.0 else f"({value!r})"
        elif kind == "t":
            name[node] = "t"
        else:
            name[node] = f"v{node}"
            if kind in ("x", "u", "p"):
                lines.append(f"v{node} = {kind}[{int(rest[0])}]")
            else:
                template = _template(graph, node, str(kind), total)
                lines.append(f"v{node} = {template.format(*(name[o] for o in graph.operands(node)))}")
    return name, lines


def _template(graph: Graph, node: int, kind: str, total: bool) -> str:
    if kind == "pow":
        exponent = graph.value(graph.operands(node)[1])
        special = (_TOTAL_POWERS if total else _POWERS).get(math.nan if exponent is None else exponent)
        if special is not None:
            return special
    return (_TOTAL if total else _FAST)[kind]
