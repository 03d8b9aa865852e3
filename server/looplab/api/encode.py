"""Answers as bytes: orjson straight from numpy, arrays as numbers or as base64 float32."""

from __future__ import annotations

import base64
from typing import Any, Literal

import numpy as np
import orjson
from starlette.responses import Response

Arrays = Literal["list", "f4"]

# Beyond this float32 is infinite: such an array stays a list of numbers.
LARGEST_F4 = 3e38


def complex_pairs(values: Any) -> list[list[float]]:
    """[[re, im], ...] of a complex array."""
    array = np.asarray(values, dtype=complex)
    return np.stack([array.real, array.imag], axis=-1).tolist()


def _as_f4(value: Any) -> Any:
    """What orjson does not know by itself: arrays as base64 float32, numpy's numbers as Python's."""
    if isinstance(value, np.generic):
        return value.item()
    if not isinstance(value, np.ndarray):
        raise TypeError(f"{type(value).__name__} is not JSON")
    if value.dtype.kind != "f" or np.abs(value).max(initial=0.0) > LARGEST_F4:
        return value.tolist()
    return {"dtype": "f4", "bdata": base64.b64encode(value.astype("<f4").tobytes()).decode()}


def json_response(content: Any, arrays: Arrays = "list") -> Response:
    """JSON of dicts, lists, numbers and float64 arrays.

    Infinite and undefined numbers must be None with a reason by now; orjson would write what is left as null.
    """
    if arrays == "f4":
        body = orjson.dumps(content, default=_as_f4, option=orjson.OPT_NON_STR_KEYS)
    else:
        body = orjson.dumps(content, option=orjson.OPT_SERIALIZE_NUMPY | orjson.OPT_NON_STR_KEYS)
    return Response(body, media_type="application/json")
