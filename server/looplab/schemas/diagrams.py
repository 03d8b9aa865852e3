"""A block diagram as JSON: a tree of series, parallel and feedback connections whose leaves are systems."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from looplab.engine.delays import Block, in_feedback, in_parallel, in_series
from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.loop import PID
from looplab.schemas.base import Model, located
from looplab.schemas.controllers import Controller

MAX_DEPTH = 20
MAX_LEAVES = 60
MAX_ORDER = 50
MAX_DELAYS = 12

Sign = Literal[1, -1]


class SeriesDiagram(Model):
    """One after the other, the first gets the input."""

    op: Literal["series"]
    of: Annotated[list[Diagram], Field(min_length=1, max_length=20)]


class ParallelDiagram(Model):
    """The same input for all, their outputs added."""

    op: Literal["parallel"]
    of: Annotated[list[Diagram], Field(min_length=1, max_length=20)]
    signs: list[Sign] | None = Field(default=None, description="One for each; left out, all are added.")


class FeedbackDiagram(Model):
    """A loop: forward/(1 - sign forward backward)."""

    op: Literal["feedback"]
    forward: Diagram
    backward: Diagram | None = Field(default=None, description="null is 1.")
    sign: Sign = -1


def _kind(value: Any) -> str | None:
    if isinstance(value, str):
        return "name"
    if isinstance(value, dict):
        op = value.get("op")
        return op if isinstance(op, str) else "system"
    return getattr(value, "op", "system")


Diagram = Annotated[
    Annotated[Annotated[str, Field(max_length=32)], Tag("name")]
    | Annotated[SeriesDiagram, Tag("series")]
    | Annotated[ParallelDiagram, Tag("parallel")]
    | Annotated[FeedbackDiagram, Tag("feedback")]
    | Annotated[Controller, Tag("system")],
    Discriminator(
        _kind,
        custom_error_type="diagram_op",
        custom_error_message="op must be one of 'series', 'parallel', 'feedback', or a name or a system belongs here",
    ),
]


def leaf(shape: Any) -> Block:
    """A system or a controller as a block; raises EngineError naming the field."""
    system = shape.to_engine()
    return Block.of(system.to_transfer_function() if isinstance(system, PID) else system)


class _Builder:
    """Walks a tree; counts what it meets, so that a small request cannot grow without bounds."""

    def __init__(self, named: dict[str, Block]) -> None:
        self.named, self.leaves = named, 0

    def block(self, node: Any, place: str, depth: int = 0) -> Block:
        if depth > MAX_DEPTH:
            raise InvalidInput(f"the diagram is nested more than {MAX_DEPTH} deep", field=place)
        try:
            block = self._block(node, place, depth)
        except EngineError as error:
            # The connection that fails, not the matrices inside.
            if error.field is None or not error.field.startswith("diagram"):
                error.field = place if error.field in (None, "systems") else f"{place}.{error.field}"
            raise
        if block.system.order > MAX_ORDER or block.system.tau.size > MAX_DELAYS:
            raise InvalidInput(
                f"the diagram has {block.system.order} states and {block.system.tau.size} dead times here; "
                f"{MAX_ORDER} and {MAX_DELAYS} are the limits",
                field=place,
            )
        return block

    def _block(self, node: Any, place: str, depth: int) -> Block:
        if isinstance(node, SeriesDiagram | ParallelDiagram):
            parts = [self.block(part, f"{place}.of[{i}]", depth + 1) for i, part in enumerate(node.of)]
            if isinstance(node, SeriesDiagram):
                return in_series(parts)
            return in_parallel(parts, None if node.signs is None else [float(sign) for sign in node.signs])
        if isinstance(node, FeedbackDiagram):
            forward = self.block(node.forward, f"{place}.forward", depth + 1)
            back = None if node.backward is None else self.block(node.backward, f"{place}.backward", depth + 1)
            return in_feedback(forward, back, float(node.sign))
        self.leaves += 1
        if self.leaves > MAX_LEAVES:
            raise InvalidInput(f"the diagram has more than {MAX_LEAVES} blocks", field=place)
        if isinstance(node, str):
            if node not in self.named:
                raise InvalidInput(
                    f"there is no system named {node[:32]!r}",
                    field=place,
                    hint=f"systems names {', '.join(self.named)}" if self.named else "name it under systems",
                )
            return self.named[node]
        return leaf(node)


class BlockDiagram(Model):
    """Named systems, and how they are connected."""

    systems: Annotated[
        dict[Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,31}$")], Controller], Field(max_length=30)
    ] = Field(default={}, description="Systems and PID controllers by name.")
    diagram: Diagram = Field(description="A name, a system, or a connection of diagrams.")

    def to_engine(self) -> Block:
        """The connected system for the engine; raises EngineError naming the field."""
        named = {}
        for name, shape in self.systems.items():
            with located(f"systems.{name}"):
                named[name] = leaf(shape)
        return _Builder(named).block(self.diagram, "diagram")
