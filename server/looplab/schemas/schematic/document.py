"""A drawing as a whole: its view, its shapes, and the signals that move it."""

import re
from collections.abc import Collection, Iterator
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from looplab.engine.errors import InvalidInput
from looplab.schemas.base import Model
from looplab.schemas.schematic.shapes import AnyShape, Group
from looplab.schemas.schematic.values import Caption, Extent

MAX_DEPTH = 6
MAX_DRAWN = 2000
"""Shapes after repetition; a browser moves this many in a frame."""

_INDEX = re.compile(r"\{([a-z])([+-]1)?\}")


class Schematic(Model):
    """A live drawing of a plant: declarative, drawn by the browser, moved by the values of the model's signals."""

    title: Caption | None = Field(default=None, description="What is drawn; read to those who do not see it.")
    view: Annotated[list[Extent], Field(min_length=2, max_length=2)] = Field(description="Width and height.")
    shapes: Annotated[list[AnyShape], Field(min_length=1, max_length=200)]

    @model_validator(mode="after")
    def _can_be_drawn(self) -> Self:
        drawn = 0
        for path, shape, times, depth, scope in _walk(self.shapes, "shapes", {}):
            drawn += times
            if depth > MAX_DEPTH:
                raise ValueError(f"{path}: groups inside groups at most {MAX_DEPTH} deep")
            for where, text in _texts(shape, path):
                if unknown := {letter for letter, _ in _INDEX.findall(text)} - set(scope):
                    raise ValueError(f"{where}: {{{min(unknown)}}} is no index here; repeat names it")
        if drawn > MAX_DRAWN:
            raise ValueError(f"{drawn} shapes once repeated; at most {MAX_DRAWN}")
        return self

    def signals(self) -> list[tuple[str, str]]:
        """Every signal that moves the drawing, as (path, name), repeated names written out."""
        return [
            (where, name)
            for path, shape, _, _, scope in _walk(self.shapes, "shapes", {})
            for where, text in _texts(shape, path)
            if where.endswith(".signal")
            for name in _written_out(text, scope)
        ]

    def require_signals(self, known: Collection[str]) -> None:
        """Raise InvalidInput, with the path of the place, where a signal is none of the known names."""
        for path, name in self.signals():
            if name not in known:
                raise InvalidInput(
                    f"the drawing names a signal {name!r} that the model does not have",
                    field=path,
                    hint=f"signals of the model: {', '.join(sorted(known))}",
                )


Scope = dict[str, range]


def _walk(
    shapes: list[Any], path: str, scope: Scope, times: int = 1, depth: int = 1
) -> Iterator[tuple[str, Any, int, int, Scope]]:
    """Every shape with its path, how often it is drawn, its depth, and the indices that its texts may use."""
    for place, shape in enumerate(shapes):
        here, inner, drawn = f"{path}[{place}]", scope, times
        if shape.repeat:
            repeat = shape.repeat
            inner = scope | {repeat.index: range(repeat.first, repeat.first + repeat.count)}
            drawn = times * repeat.count
        yield here, shape, drawn, depth, inner
        if isinstance(shape, Group):
            yield from _walk(shape.shapes, f"{here}.shapes", inner, drawn, depth + 1)


def _texts(shape: Any, path: str) -> Iterator[tuple[str, str]]:
    """Every text of a shape that may hold an index, with its path."""
    for name in type(shape).model_fields:
        value = getattr(shape, name)
        if name in ("signal", "id", "label", "text", "name") and value:
            yield f"{path}.{name}", value
        elif signal := getattr(value, "signal", None):
            yield f"{path}.{name}.signal", signal


def _written_out(text: str, scope: Scope) -> Iterator[str]:
    found = _INDEX.search(text)
    if found is None:
        yield text
        return
    letter, shift = found.groups()
    for index in scope[letter]:
        number = str(index + int(shift or 0))
        yield from _written_out(text.replace(found[0], number), scope)
