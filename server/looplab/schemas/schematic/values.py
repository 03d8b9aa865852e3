"""What a property of a drawing may be: a constant, or bound to a signal of the model."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Discriminator, Field, StringConstraints, Tag

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


def _spans(pair: list[float]) -> list[float]:
    if pair[0] == pair[1]:
        raise ValueError("must span a range: its two ends are equal")
    return pair


From = Annotated[Pair, AfterValidator(_spans), Field(alias="from", default_factory=lambda: [0.0, 1.0])]


class Binding(Model):
    """A number that follows a signal along a straight line, and stops at its ends unless `clamp` is false."""

    signal: Signal
    from_: From
    to: Pair = Field(default_factory=lambda: [0.0, 1.0])
    clamp: bool = True


class ColourBinding(Model):
    """A colour that follows a signal along a scale: blue to red, or pale to deep."""

    signal: Signal
    from_: From
    scale: Literal["temperature", "composition"]


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


def _constant_or_bound(value: object) -> str:
    """Decided by what was given, so that a mistake is told once and not for each way it might have been meant."""
    return "bound" if isinstance(value, dict | Model) else "constant"


Value = Annotated[
    Annotated[float, Tag("constant")] | Annotated[Binding, Tag("bound")], Discriminator(_constant_or_bound)
]
Colour = Annotated[
    Annotated[ColourName, Tag("constant")] | Annotated[ColourBinding, Tag("bound")], Discriminator(_constant_or_bound)
]


class Repeat(Model):
    """Draws a shape several times, moved by `step`; the index is put in place of `{i}` in its names and texts."""

    count: Annotated[int, Field(ge=1, le=100)]
    index: Annotated[str, StringConstraints(pattern=r"^[a-z]$")] = "i"
    first: Annotated[int, Field(ge=0, le=1000)] = 1
    step: Point
