"""Reading a plain dict strictly: wanted fields of the right kind, and no others."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from looplab.engine.errors import InvalidInput

T = TypeVar("T")
MAX_TEXT = 2_000
MAX_NAME = 32
LARGEST_NUMBER = 1e300
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)


class Fields:
    """The fields of one object; every mistake names its place.

    Parameters
    ----------
    data : object
        Should be a mapping with strings as keys.
    path : str
        Place of the object in the document, "" for the document itself.
    """

    def __init__(self, data: object, path: str = "") -> None:
        if not isinstance(data, Mapping):
            raise InvalidInput("an object {...} belongs here", field=path or None)
        self.data: Mapping[Any, Any] = data
        self.path = path
        self.seen: set[str] = set()

    def at(self, key: str) -> str:
        """Place of a field in the document."""
        return f"{self.path}.{key}" if self.path else key

    def get(self, key: str, required: bool = False) -> Any:
        """A field as it is; None where it is left out."""
        self.seen.add(key)
        value = self.data.get(key)
        if required and value is None:
            raise InvalidInput(f"the field {key!r} is missing", field=self.at(key))
        return value

    def text(self, key: str, default: str | None = None, longest: int = MAX_TEXT) -> str:
        """A string; required where there is no default."""
        value = self.get(key, default is None)
        if value is None:
            return default or ""
        if not isinstance(value, str):
            raise InvalidInput(f"{key} must be a text", field=self.at(key))
        if len(value) > longest:
            raise InvalidInput(f"{key} is longer than {longest} characters", field=self.at(key))
        return value

    def name(self, key: str = "name", pattern: re.Pattern[str] = _NAME, longest: int = MAX_NAME) -> str:
        """A name: a letter, then letters, digits and underscores."""
        value = self.text(key)
        if len(value) > longest or not pattern.fullmatch(value):
            raise InvalidInput(
                f"{value[:40]!a} cannot be a name",
                field=self.at(key),
                hint=f"up to {longest} letters of the English alphabet, digits and _; a letter first",
            )
        return value

    def number(self, key: str) -> float:
        """A finite number."""
        return as_number(self.get(key, True), self.at(key))

    def optional_number(self, key: str) -> float | None:
        """A finite number, or None where it is left out."""
        value = self.get(key)
        return None if value is None else as_number(value, self.at(key))

    def numbers(self, key: str) -> dict[str, float]:
        """Numbers by name; empty where the field is left out."""
        value = self.get(key)
        if value is None:
            return {}
        if not isinstance(value, Mapping) or not all(isinstance(name, str) for name in value):
            raise InvalidInput(f"{key} must be an object of numbers", field=self.at(key))
        return {name: as_number(number, f"{self.at(key)}.{name}") for name, number in value.items()}

    def list(self, key: str, read: Callable[[Fields], T], most: int) -> tuple[T, ...]:
        """Objects, each read by ``read``; empty where the field is left out."""
        value = self.get(key)
        if value is None:
            return ()
        if not isinstance(value, Sequence) or isinstance(value, str | bytes):
            raise InvalidInput(f"{key} must be a list", field=self.at(key))
        if len(value) > most:
            raise InvalidInput(f"{key} has more than {most} entries", field=self.at(key))
        out = []
        for index, item in enumerate(value):
            fields = Fields(item, f"{self.at(key)}[{index}]")
            out.append(read(fields))
            fields.done()
        return tuple(out)

    def done(self) -> None:
        """Refuse what no reader has asked for."""
        for key in self.data:
            if key not in self.seen:
                raise InvalidInput(
                    f"unknown field {str(key)[:60]!a}",
                    field=self.path or None,
                    hint=f"known are {', '.join(sorted(self.seen))}",
                )


def as_number(value: object, path: str) -> float:
    """A finite float; neither a bool nor a text is one."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InvalidInput("a number belongs here", field=path)
    if not abs(value) <= LARGEST_NUMBER or not math.isfinite(value):
        raise InvalidInput(f"numbers must be finite, up to {LARGEST_NUMBER:g}", field=path)
    return float(value)
