"""Operating points of a model by name, in its document and in its request shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, TypeVar

from looplab.engine.errors import InvalidInput


class OperatingPointParts(Protocol):
    """What an operating point's document and its request shape have in common."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def inputs(self) -> Mapping[str, float]:
        """Inputs that are not nominal there."""

    @property
    def parameters(self) -> Mapping[str, float]:
        """Parameters that are not nominal there."""

    @property
    def near(self) -> Mapping[str, float]:
        """States there."""


P = TypeVar("P", bound=OperatingPointParts)


def find_operating_point(name: str | None, points: Sequence[P]) -> P | None:
    """The point of a name, None for no name; raises InvalidInput where the model has no such point."""
    if name is None:
        return None
    found = next((point for point in points if point.name == name), None)
    if found is None:
        known = ", ".join(point.name for point in points)
        raise InvalidInput(
            "the model has no operating point of this name",
            field="operating_point",
            hint=f"it has {known}" if known else "leave it out",
        )
    return found
