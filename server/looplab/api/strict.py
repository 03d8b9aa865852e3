"""Requests read strictly: NaN, 1e999, lone surrogates and deep nesting are errors before validation sees them."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

import orjson
from fastapi import Request, Response
from fastapi.routing import APIRoute

from looplab.api.errors import ApiError


class StrictRequest(Request):
    """A request whose JSON is parsed by orjson."""

    async def json(self) -> Any:
        """The body; raises ApiError with the place of the mistake."""
        try:
            return orjson.loads(await self.body())
        except orjson.JSONDecodeError as error:
            raise ApiError(
                400,
                "invalid_json",
                f"the body is not strict JSON: {error.msg} (line {error.lineno}, column {error.colno})",
                hint="numbers must be finite and within double precision; NaN and Infinity are not JSON",
            ) from None


class StrictRoute(APIRoute):
    """A route that hands its endpoint a StrictRequest."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """FastAPI's handler, reading strictly."""
        handler = super().get_route_handler()

        async def strict(request: Request) -> Response:
            return await handler(StrictRequest(request.scope, request.receive))

        return strict
