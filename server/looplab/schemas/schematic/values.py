"""What a property of a drawing may be: a constant, or bound to a signal of the model."""

from typing import Annotated, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from looplab.schemas.base import Model

INDEX = r"\{[a-z](?:[+-]1)?\}"
"""Stands for the index of a repeated shape, or for a neighbour's: `{i}`, `{i+1}`, `{i-1}`."""

Signal = Annotated[str, StringConstraints(max_length=48, pattern=rf"^[A-Za-z](?:[A-Za-z0-9_]|{INDEX})*$")]
"""Name of a state, an input, a variable or an output; `x_{i}` inside a repeated shape."""

Caption = Annotated[str, StringConstraints(min_length=1, max_length=80, pattern=r"^[^\r\n]+$")]
"""One line of plain text."""

Coordinate = Annotated[float, Field(ge=-10_000, le=10_000)]
Extent = Annotated[float, Field(gt=0, le=10_000)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Point = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]


def _ordered(pair: list[float]) -> None:
    if pair[0] == pair[1]:
        raise ValueError("'from' must span a range: its two ends are equal")


class Binding(Model):
    """A number that follows a signal along a straight line, and stops at its ends unless `clamp` is false."""

    signal: Signal
    from_: Annotated[Pair, Field(alias="from", default_factory=lambda: [0.0, 1.0])]
    to: Pair = Field(default_factory=lambda: [0.0, 1.0])
    clamp: bool = True

    @model_validator(mode="after")
    def _spans(self) -> Self:
        _ordered(self.from_)
        return self


class ColourBinding(Model):
    """A colour that follows a signal along a scale: blue to red, or pale to deep."""

    signal: Signal
    from_: Annotated[Pair, Field(alias="from", default_factory=lambda: [0.0, 1.0])]
    scale: Literal["temperature", "composition"]

    @model_validator(mode="after")
    def _spans(self) -> Self:
        _ordered(self.from_)
        return self


ColourName = Literal[
    "ink",
    "muted",
    "line",
    "paper",
    "metal",
    "water",
    "product",
    "steam",
    "heat",
    "cold",
    "accent",
    "good",
    "bad",
    "warn",
    "force",
    "none",
]

Value = float | Binding
Colour = ColourName | ColourBinding


class Repeat(Model):
    """Draws a shape several times, moved by `step`; the index is put in place of `{i}` in its names and texts."""

    count: Annotated[int, Field(ge=1, le=100)]
    index: Annotated[str, StringConstraints(pattern=r"^[a-z]$")] = "i"
    first: Annotated[int, Field(ge=0, le=1000)] = 1
    step: Point
