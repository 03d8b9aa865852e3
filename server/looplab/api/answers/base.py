"""What every answer shape has in common."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field


class Answer(BaseModel):
    """An answer: no field that is not described."""

    model_config = ConfigDict(extra="forbid")


class PackedArray(Answer):
    """An array asked for as "f4": base64 of little-endian float32, as Plotly reads it (if it fits in float32)."""

    dtype: str
    bdata: str


Numbers = list[float] | PackedArray
ComplexPair = Annotated[list[float], Field(min_length=2, max_length=2, description="[re, im]")]
Reasons = Annotated[dict[str, str], Field(description="Why a field is null.")]


class ErrorDetail(Answer):
    """What is wrong, where, and what would be right."""

    code: str
    message: str
    path: Annotated[str, Field(description="Place in the request, e.g. loop.plant.text")]
    hint: str | None


class Error(Answer):
    """The one error shape."""

    error: ErrorDetail


def example_error(code: str, message: str, path: str, hint: str | None) -> dict[str, Any]:
    """An error as an OpenAPI example."""
    return {"error": {"code": code, "message": message, "path": path, "hint": hint}}
