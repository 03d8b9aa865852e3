"""Pieces that every part of a lab is made of: names, numbers and texts."""

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, StringConstraints, WithJsonSchema

from looplab.schemas import Model

MAX_TEXT = 6000
"""Longest text of one block, in characters; Markdown of this size renders in a fraction of a second."""


def _join_lines(value: Any) -> Any:
    """JSON has no multi-line strings, so a text may be given as a list of its lines."""
    if isinstance(value, list) and all(isinstance(line, str) for line in value):
        return "\n".join(value)
    return value


Slug = Annotated[str, StringConstraints(pattern=r"^[a-z0-9][a-z0-9-]{0,63}$")]
"""Name of a lab, a part or an exercise, safe in an address."""

FieldName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,31}$")]
"""Name of a field of an answer; use the symbol: Ku, tau_I, omega_180."""

Line = Annotated[str, StringConstraints(min_length=1, max_length=300, pattern=r"^[^\r\n]+$")]
"""One line of plain text."""

Latex = Annotated[str, StringConstraints(min_length=1, max_length=200)]
"""A formula without its dollar signs."""

Text = Annotated[
    str,
    BeforeValidator(_join_lines),
    StringConstraints(min_length=1, max_length=MAX_TEXT),
    WithJsonSchema(
        {
            "description": "Markdown with $math$ and $$display math$$; a string, or a list of its lines.",
            "anyOf": [
                {"type": "string", "minLength": 1, "maxLength": MAX_TEXT},
                {"type": "array", "items": {"type": "string"}, "minItems": 1},
            ],
        }
    ),
]

Number = Annotated[float, Field(allow_inf_nan=False)]

__all__ = ["FieldName", "Latex", "Line", "Model", "Number", "Slug", "Text"]
