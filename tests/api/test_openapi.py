"""The API describes itself: every route has an example, every example works, every answer fits its description."""

from typing import Any

import pytest
import schemathesis
from fastapi.testclient import TestClient
from hypothesis import HealthCheck, settings

from looplab.api.app import create_app

app = create_app()
DESCRIPTION = app.openapi()
OPERATIONS = [(path, method) for path, item in DESCRIPTION["paths"].items() for method in item]
schema = schemathesis.openapi.from_asgi("/api/v1/openapi.json", app)


def examples(operation: dict[str, Any]) -> dict[str, Any]:
    body = operation["requestBody"]["content"]["application/json"]
    return {name: example["value"] for name, example in body.get("examples", {}).items()}


def test_the_description_is_found_at_the_root_too(client: TestClient) -> None:
    found = client.get("/openapi.json")
    assert found.status_code == 200
    assert found.url.path == "/api/v1/openapi.json"
    assert found.json() == DESCRIPTION


@pytest.mark.parametrize(("path", "method"), OPERATIONS)
def test_every_route_says_what_it_is_for(path: str, method: str) -> None:
    operation = DESCRIPTION["paths"][path][method]
    assert operation["summary"]
    assert operation["description"]
    assert operation["tags"]
    if "requestBody" in operation:
        assert examples(operation)


@pytest.mark.parametrize(("path", "method"), [o for o in OPERATIONS if o[1] == "post"])
def test_every_example_works(client: TestClient, path: str, method: str) -> None:
    for name, example in examples(DESCRIPTION["paths"][path][method]).items():
        address = path.replace("{lab_id}", "ziegler-nichols-third-order").replace("{plant_id}", "cstr")
        response = client.post(address, json=example)
        assert response.status_code == 200, (name, response.text)


@schema.include(path_regex="/api/v1/(health|loop|tune|labs)$").parametrize()
@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
def test_generated_requests(case: Any) -> None:
    """Whatever fits the description is answered as described or refused in the one error shape; never a 500."""
    response = case.call()
    assert response.status_code in (200, 400, 405, 422), response.text
    case.validate_response(response, checks=[schemathesis.checks.not_a_server_error])
