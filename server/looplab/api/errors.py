"""One error shape for every route: {"error": {"code", "message", "path", "hint"}}, 4xx, or 503 when busy."""

from __future__ import annotations

import re

import orjson
from fastapi import FastAPI, HTTPException, Request
from fastapi.exceptions import RequestValidationError
from numpy.linalg import LinAlgError
from starlette.exceptions import HTTPException as StarletteHTTPException
from starlette.responses import Response

from looplab.engine.errors import EngineError
from looplab.jobs import Overloaded
from looplab.schemas import json_path


class ApiError(HTTPException):
    """An error of the API itself, ready to be sent."""

    def __init__(self, status: int, code: str, message: str, path: str = "", hint: str | None = None) -> None:
        super().__init__(status, message)
        self.code, self.message, self.path, self.hint = code, message, path, hint


def error_body(code: str, message: str, path: str = "", hint: str | None = None) -> bytes:
    """The error shape as JSON."""
    return orjson.dumps({"error": {"code": code, "message": message, "path": path, "hint": hint}})


def error_response(error: ApiError) -> Response:
    """The answer that carries an error."""
    body = error_body(error.code, error.message, error.path, error.hint)
    return Response(body, error.status_code, media_type="application/json")


def code_of(error: EngineError) -> str:
    """invalid_input for InvalidInput, and so on."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", type(error).__name__).lower()


_HINTS = {
    "missing": "this field is required",
    "extra_forbidden": "remove it, or look up the field's name in /api/v1/openapi.json",
    "finite_number": "numbers must be finite",
    "json_invalid": "send one JSON object with Content-Type: application/json",
    "model_attributes_type": "send one JSON object with Content-Type: application/json",
    "model_type": "an object {...} belongs here",
    "union_tag_not_found": 'say which kind it is: {"type": "expr", "text": "1/(s+1)^3"}',
}


def _validation_error(error: RequestValidationError) -> ApiError:
    problems = error.errors()
    # A wrong type of a system shows up once per member of the union: the deepest location is the meant one.
    first = max(problems, key=lambda p: len(p["loc"]))
    message = str(first["msg"])
    if not error.body:
        return ApiError(422, "invalid_request", "the request has no JSON body", "", _HINTS["json_invalid"])
    if first["type"] == "extra_forbidden":
        message = f"unknown field {str(first['loc'][-1])[:60]!r}"
    elif first["type"] == "missing":
        message = f"the field {str(first['loc'][-1])!r} is missing"
    path = json_path(error.body, first["loc"][1:])
    return ApiError(422, "invalid_request", message, path, _HINTS.get(first["type"]))


def install(app: FastAPI) -> None:
    """Make every error of the application take the one shape."""

    @app.exception_handler(ApiError)
    async def _api_error(_: Request, error: ApiError) -> Response:
        return error_response(error)

    @app.exception_handler(EngineError)
    async def _engine_error(_: Request, error: EngineError) -> Response:
        return error_response(ApiError(422, code_of(error), error.message, error.field or "", error.hint))

    @app.exception_handler(Overloaded)
    async def _overloaded(_: Request, error: Exception) -> Response:
        response = error_response(
            ApiError(503, "overloaded", "the server is computing as much as it can", hint="ask again in a second")
        )
        response.headers["Retry-After"] = str(Overloaded.retry_after)
        return response

    @app.exception_handler(ArithmeticError)
    @app.exception_handler(LinAlgError)
    async def _out_of_range(_: Request, error: Exception) -> Response:
        return error_response(
            ApiError(
                422,
                "out_of_range",
                "the numbers of this request are too large, too small or too far apart to compute with",
                hint="choose units in which they are moderate",
            )
        )

    @app.exception_handler(RequestValidationError)
    async def _invalid(_: Request, error: RequestValidationError) -> Response:
        return error_response(_validation_error(error))

    @app.exception_handler(StarletteHTTPException)
    async def _http(request: Request, error: StarletteHTTPException) -> Response:
        code = {404: "not_found", 405: "method_not_allowed"}.get(error.status_code, "http_error")
        message = {
            404: "there is nothing at this address",
            405: f"this address does not answer {request.method}",
        }.get(error.status_code, str(error.detail))
        response = error_response(
            ApiError(error.status_code, code, message, hint="the routes are listed in /api/v1/openapi.json")
        )
        for name, value in (error.headers or {}).items():
            response.headers[name] = value
        return response
