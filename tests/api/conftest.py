"""A client of the application, and short ways to ask it."""

from collections.abc import Callable, Iterator
from typing import Any

import orjson
import pytest
from fastapi.testclient import TestClient
from httpx2 import Response

from looplab.api.app import create_app


@pytest.fixture(scope="session")
def client() -> Iterator[TestClient]:
    with TestClient(create_app(), raise_server_exceptions=False) as client:
        yield client


@pytest.fixture
def post(client: TestClient) -> Callable[[str, Any], Response]:
    """POST /api/v1<path> with a JSON body, or with raw bytes."""

    def send(path: str, body: Any) -> Response:
        content = body if isinstance(body, bytes) else orjson.dumps(body)
        return client.post(f"/api/v1{path}", content=content, headers={"Content-Type": "application/json"})

    return send


@pytest.fixture
def loop_of(post: Callable[[str, Any], Response]) -> Callable[..., dict[str, Any]]:
    """Panels of POST /loop for a plant as text and PID settings."""

    def ask(plant: str, settings: dict[str, Any], **request: Any) -> dict[str, Any]:
        loop = {"plant": {"type": "expr", "text": plant}, "controller": {"type": "pid", **settings}}
        answer = post("/loop", {"loop": loop, **request})
        assert answer.status_code == 200, answer.text
        panels: dict[str, Any] = answer.json()["panels"]
        return panels

    return ask
