"""Operations of a model, each held once: equal subexpressions are the same node, wherever they were written."""

from __future__ import annotations

import math

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.language.functions import TOTAL

# ("const", value), ("t",), ("x" | "u" | "p", index), or an operation of functions.TOTAL with its operands' numbers.
Entry = tuple[str | float, ...]
LEAVES = ("const", "t", "x", "u", "p")
COMMUTATIVE = ("+", "*")


class Graph:
    """Nodes by number; an operand's number is lower than that of what uses it.

    Parameters
    ----------
    limit : int
        Most nodes there may be.
    """

    def __init__(self, limit: int) -> None:
        self.nodes: list[Entry] = []
        self.limit = limit
        self._numbers: dict[Entry, int] = {}

    def _number(self, entry: Entry) -> int:
        found = self._numbers.get(entry)
        if found is None:
            if len(self.nodes) >= self.limit:
                raise InvalidInput(
                    f"the equations and their derivatives take more than {self.limit} operations",
                    hint="simplify the equations, or use fewer states",
                )
            found = self._numbers[entry] = len(self.nodes)
            self.nodes.append(entry)
        return found

    def constant(self, value: float) -> int:
        """A number."""
        return self._number(("const", value))

    def leaf(self, kind: str, index: int | None = None) -> int:
        """The time ("t"), or a state, input or parameter ("x", "u", "p") by its index."""
        return self._number((kind,) if index is None else (kind, index))

    def value(self, node: int) -> float | None:
        """The number that a node is, or None where it is not constant."""
        kind, *rest = self.nodes[node]
        return float(rest[0]) if kind == "const" else None

    def operands(self, node: int) -> tuple[int, ...]:
        """Numbers of a node's operands."""
        kind, *rest = self.nodes[node]
        return () if kind in LEAVES else tuple(int(number) for number in rest)

    def apply(self, operation: str, *operands: int) -> int:
        """An operation on nodes; on numbers it is computed, where that is finite."""
        values = [self.value(node) for node in operands]
        known = [value for value in values if value is not None]
        if len(known) == len(values):
            result = TOTAL[operation](*known)
            if math.isfinite(result):
                return self.constant(result)
        if operation in COMMUTATIVE:
            operands = tuple(sorted(operands))
        return self._number((operation, *operands))

    def reachable(self, outputs: list[int]) -> list[int]:
        """Every node that the outputs need, operands first."""
        seen: set[int] = set()
        waiting = list(outputs)
        while waiting:
            node = waiting.pop()
            if node not in seen:
                seen.add(node)
                waiting.extend(self.operands(node))
        return sorted(seen)
