"""Pieces of the API's description that every route shares."""

from __future__ import annotations

from typing import Any

from looplab.api.answers.base import Error, example_error


def _documented(description: str, example: dict[str, Any]) -> dict[str, Any]:
    return {"model": Error, "description": description, "content": {"application/json": {"example": example}}}


ERRORS: dict[int | str, dict[str, Any]] = {
    400: _documented(
        "The body is not strict JSON.",
        example_error("invalid_json", "the body is not strict JSON: ...", "", "numbers must be finite ..."),
    ),
    413: _documented(
        "The body is too large.",
        example_error("body_too_large", "the body is larger than 256 KiB", "", "send fewer points"),
    ),
    422: _documented(
        "The request is understood but cannot be answered.",
        example_error("parse_error", "unknown name 's2' (column 3)", "loop.plant.text", "for a power write s^2"),
    ),
}

BUSY: dict[int | str, dict[str, Any]] = {
    503: _documented(
        "Too much is being computed already; Retry-After says when to ask again.",
        example_error("overloaded", "the server is computing as much as it can", "", "ask again in a second"),
    ),
}
