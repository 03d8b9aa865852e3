"""Exact derivatives, built on the graph itself by the chain rule."""

from __future__ import annotations

import math
from collections.abc import Callable

from looplab.engine.nonlinear.language.graph import LEAVES, Graph


class Differentiator:
    """Gradients of nodes with respect to leaves, kept so that shared subexpressions are differentiated once.

    ``min``, ``max``, ``abs``, ``sign``, ``clip`` and ``if`` are differentiated by the branch that is taken; where two
    branches meet, by the one whose value is taken.

    Parameters
    ----------
    graph : Graph
        Grows by the derivatives.
    variables : list of int
        Leaves to differentiate by.
    """

    def __init__(self, graph: Graph, variables: list[int]) -> None:
        self.graph = graph
        self.variables = frozenset(variables)
        self._known: dict[int, dict[int, int]] = {}
        self.zero, self.one = graph.constant(0.0), graph.constant(1.0)

    def gradient(self, node: int) -> dict[int, int]:
        """Derivatives of a node that are not zero: variable -> node."""
        for each in self.graph.reachable([node]):
            if each not in self._known:
                self._known[each] = self._of(each)
        return self._known[node]

    def _of(self, node: int) -> dict[int, int]:
        kind = str(self.graph.nodes[node][0])
        if kind in LEAVES:
            return {node: self.one} if node in self.variables else {}
        operands = self.graph.operands(node)
        gradients = [self._known[operand] for operand in operands]
        touched = sorted({variable for gradient in gradients for variable in gradient})
        if not touched or kind == "sign":
            return {}
        out = {}
        if kind in ("if<", "if<=", "min", "max"):
            choose = self._chooser(kind, operands)
            first, second = gradients[-2:]
            for variable in touched:
                out[variable] = choose(first.get(variable, self.zero), second.get(variable, self.zero))
        else:
            partials = [self._partial(kind, node, operands, i) if g else self.zero for i, g in enumerate(gradients)]
            for variable in touched:
                total = self.zero
                for partial, gradient in zip(partials, gradients, strict=True):
                    if variable in gradient:
                        total = self._add(total, self._mul(partial, gradient[variable]))
                out[variable] = total
        return {variable: found for variable, found in out.items() if found != self.zero}

    def _chooser(self, kind: str, operands: tuple[int, ...]) -> Callable[[int, int], int]:
        a, b = operands[:2]
        if kind == "max":
            a, b = b, a
        operation = kind if kind.startswith("if") else "if<"

        def choose(then: int, otherwise: int) -> int:
            return then if then == otherwise else self.graph.apply(operation, a, b, then, otherwise)

        return choose

    def _add(self, a: int, b: int) -> int:
        if a == self.zero:
            return b
        return a if b == self.zero else self.graph.apply("+", a, b)

    def _mul(self, a: int, b: int) -> int:
        """The product; a branch that is zero stays zero, whatever the other factor is there."""
        if self.zero in (a, b):
            return self.zero
        if a == self.one:
            return b
        if b == self.one:
            return a
        if -1.0 in (self.graph.value(a), self.graph.value(b)):
            return self.graph.apply("neg", b if self.graph.value(a) == -1.0 else a)
        for branch, factor in ((b, a), (a, b)):
            kind = str(self.graph.nodes[branch][0])
            if kind.startswith("if"):
                left, right, then, otherwise = self.graph.operands(branch)
                if self.zero in (then, otherwise):
                    parts = (self._mul(factor, then), self._mul(factor, otherwise))
                    return self.graph.apply(kind, left, right, *parts)
        return self.graph.apply("*", a, b)

    def _const(self, value: float) -> int:
        return self.graph.constant(value)

    def _inverse(self, a: int) -> int:
        return self.graph.apply("/", self.one, a)

    def _partial(self, kind: str, node: int, operands: tuple[int, ...], place: int) -> int:
        """Derivative of an operation by one operand."""
        apply, a = self.graph.apply, operands[0]
        if kind in ("+", "-", "neg"):
            return self.one if kind == "+" or (kind == "-" and place == 0) else self._const(-1.0)
        if kind == "*":
            # x*x has the same operand twice: each place counts once.
            return operands[1 - place]
        if kind == "/":
            inverse = self._inverse(operands[1])
            return inverse if place == 0 else apply("neg", apply("*", node, inverse))
        if kind == "pow":
            return self._power(node, a, operands[1], place)
        return self._of_function(kind, node, a)

    def _power(self, node: int, a: int, b: int, place: int) -> int:
        apply = self.graph.apply
        if place == 0:
            lower = apply("-", b, self.one)
            simple = {self.zero: self.one, self.one: a}
            return self._mul(b, simple[lower] if lower in simple else apply("pow", a, lower))
        # a^b log(a), which tends to 0 for a -> 0 and b > 0; for a < 0 there is no derivative by the exponent.
        at_zero = apply("if<", self.zero, b, self.zero, apply("log", a))
        elsewhere = apply("if<=", self.zero, a, at_zero, apply("log", a))
        return apply("if<", self.zero, a, apply("*", node, apply("log", a)), elsewhere)

    def _of_function(self, kind: str, node: int, a: int) -> int:
        apply, one = self.graph.apply, self.one
        if kind == "exp":
            return node
        if kind == "log":
            return self._inverse(a)
        if kind == "log10":
            return apply("/", self._const(1.0 / math.log(10.0)), a)
        if kind == "sqrt":
            return apply("/", self._const(0.5), node)
        if kind == "abs":
            return apply("sign", a)
        if kind == "sin":
            return apply("cos", a)
        if kind == "cos":
            return apply("neg", apply("sin", a))
        if kind == "sinh":
            return apply("cosh", a)
        if kind == "cosh":
            return apply("sinh", a)
        square = apply("*", node, node)
        if kind == "tan":
            return apply("+", one, square)
        if kind == "tanh":
            # 1 - tanh^2 loses its digits where tanh is near 1
            return self._inverse(apply("*", apply("cosh", a), apply("cosh", a)))
        if kind == "atan":
            return self._inverse(apply("+", one, apply("*", a, a)))
        # (1 - a)(1 + a) keeps the digits that 1 - a^2 loses near the ends
        root = apply("sqrt", apply("*", apply("-", one, a), apply("+", one, a)))
        return apply("/", one if kind == "asin" else self._const(-1.0), root)
