"""What every shape has in common: strict, finite, and no unknown fields."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from looplab.engine.errors import EngineError


class Model(BaseModel):
    """A request shape: numbers are finite numbers (never strings), unknown fields are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


# [re, im], or a plain number where it is real.
Complex = Annotated[list[float], Field(min_length=2, max_length=2)] | float
Coefficients = Annotated[list[float], Field(min_length=1, max_length=51)]
Roots = Annotated[list[Complex], Field(max_length=50)]
DeadTime = Annotated[float, Field(ge=0, description="Dead time, exact [time].")]


def to_complex(value: list[float] | float) -> complex:
    """The number meant by [re, im] or by a plain number."""
    return complex(*value) if isinstance(value, list) else complex(value)


def json_path(data: Any, location: Sequence[int | str]) -> str:
    """`parts[0].blocks[2].tolerance`, without the names of union members that pydantic puts in between."""
    path = ""
    for depth, key in enumerate(location):
        last = depth == len(location) - 1
        if isinstance(key, int) and isinstance(data, list):
            path += f"[{key}]"
            data = data[key] if key < len(data) else None
        elif isinstance(key, str) and isinstance(data, dict) and (key in data or last):
            path += f".{key}" if path else key
            data = data.get(key)
    return path


@contextmanager
def located(field: str) -> Iterator[None]:
    """Put the name of an outer field in front of the field that an engine error names."""
    try:
        yield
    except EngineError as error:
        error.field = f"{field}.{error.field}" if error.field else field
        raise
