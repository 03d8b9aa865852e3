"""The /labs routes: what they answer, and one clear error for what they cannot."""

from collections.abc import Iterator
from typing import Any

import orjson
import pytest
from fastapi.testclient import TestClient

from looplab.api.app import create_app

LAB = "/api/v1/labs/ziegler-nichols-third-order"


@pytest.fixture(scope="module")
def client() -> Iterator[TestClient]:
    with TestClient(create_app(), raise_server_exceptions=False) as client:
        yield client


def post(client: TestClient, path: str, body: bytes) -> Any:
    return client.post(path, content=body, headers={"Content-Type": "application/json"})


def test_the_list(client: TestClient) -> None:
    labs = client.get("/api/v1/labs").json()["labs"]
    first = next(lab for lab in labs if lab["id"] == "ziegler-nichols-third-order")
    assert set(first) == {"id", "title", "level", "section", "summary", "minutes", "exercises"}
    assert first["section"] == "19.1"
    assert first["exercises"] == 10


def test_a_lab(client: TestClient) -> None:
    lab = client.get(LAB).json()
    assert lab["bench"]["plant"] == {"type": "expr", "text": "1/(s+1)^3"}
    assert [part["id"] for part in lab["parts"]] == ["the-edge", "the-rule", "the-verdict", "by-hand"]
    assert "<math" in lab["parts"][0]["blocks"][0]["html"]
    assert b"solution" not in client.get(LAB).content


@pytest.mark.parametrize(
    ("exercise", "answer", "status"),
    [
        ("ultimate-gain", 8, "correct"),
        ("ultimate-gain", "18.06", "wrong"),
        ("ultimate-gain", None, "blank"),
        ("zn-pi", {"Kc": "3.6", "tau_I": ""}, "partly"),
        ("edge-closed-loop", "8/(s+1", "unreadable"),
        ("specification", {"Kc": 4.8, "tau_I": 3, "tau_D": 0.8}, "correct"),
        ("specification", {"Kc": 4.8, "tau_I": 1.8138, "tau_D": 0.45345}, "wrong"),
    ],
)
def test_an_answer_is_checked(client: TestClient, exercise: str, answer: Any, status: str) -> None:
    response = client.post(f"{LAB}/check", json={"exercise": exercise, "answer": answer})
    assert response.status_code == 200
    verdict = response.json()
    assert verdict["status"] == status
    assert verdict["correct"] == (status == "correct")
    assert (verdict["solution_html"] is not None) == (status == "correct")


def test_the_checks_of_a_design_have_their_measures(client: TestClient) -> None:
    answer = {"Kc": 4.8, "tau_I": 1.8138, "tau_D": 0.45345}
    verdict = client.post(f"{LAB}/check", json={"exercise": "specification", "answer": answer}).json()
    checks = {check["name"]: check for check in verdict["checks"]}
    assert checks["overshoot_pct"]["measured"] == pytest.approx(42.7, abs=0.05)
    assert checks["overshoot_pct"]["limit"] == 25
    assert checks["Ms"]["measured"] == pytest.approx(2.24, abs=0.005)
    assert [name for name, check in checks.items() if not check["passed"]] == ["overshoot_pct", "Ms"]


def test_the_solution_is_shown_on_request(client: TestClient) -> None:
    verdict = client.post(f"{LAB}/check", json={"exercise": "ultimate-gain", "reveal": True}).json()
    assert verdict["status"] == "revealed"
    assert not verdict["correct"]
    assert "<math" in verdict["solution_html"]


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"{",
        b"null",
        b"[]",
        b"{}",
        b'{"exercise": NaN}',
        b'{"exercise": "ultimate-gain", "answer": NaN}',
        b'{"exercise": "ultimate-gain", "answer": [1]}',
        b'{"exercise": "ultimate-gain", "answer": true}',
        b'{"exercise": "ultimate-gain", "answer": "\\ud800"}',
        b'{"exercise": "ultimate-gain", "answer": ' + b"[" * 50_000,
        b'{"exercise": "ultimate-gain", "answer": 8, "name": "x"}',
        b'{"exercise": "ultimate-gain", "reveal": 1}',
        b'{"exercise": "no-such-exercise", "answer": 8}',
        b'{"exercise": 7}',
        b'{"exercise": "zn-pi", "answer": 3.6}',
        b'{"exercise": "why-so-much", "answer": "nothing"}',
        b'{"exercise": "specification", "answer": {"alpha": 1}}',
        b'{"exercise": "edge-closed-loop", "answer": 8}',
        b'{"exercise": "edge-closed-loop", "answer": "' + b"x" * 300_000 + b'"}',
    ],
)
def test_what_no_page_would_send(client: TestClient, body: bytes) -> None:
    response = post(client, f"{LAB}/check", body)
    assert 400 <= response.status_code < 500
    assert set(response.json()["error"]) == {"code", "message", "path", "hint"}


@pytest.mark.parametrize("answer", [b"1e999", b"9" * 400, b'"1e999"', b'"' + b"9" * 5000 + b'"', b"-0.0"])
def test_a_number_out_of_all_proportion(client: TestClient, answer: bytes) -> None:
    response = post(client, f"{LAB}/check", b'{"exercise": "ultimate-gain", "answer": ' + answer + b"}")
    assert response.status_code in (200, 400, 422)
    assert b":NaN" not in response.content
    if response.status_code == 200:
        assert not response.json()["correct"]


@pytest.mark.parametrize(
    "lab_id", ["nothing", "..", "%2e%2e", "..%2f..%2fetc%2fpasswd", "lab.schema", "LAB", "a%00b", "x" * 3000, "%0a"]
)
@pytest.mark.parametrize("end", ["", "/check"])
def test_a_lab_that_is_not_there(client: TestClient, lab_id: str, end: str) -> None:
    path = f"/api/v1/labs/{lab_id}{end}"
    response = client.post(path, json={"exercise": "x"}) if end else client.get(path)
    assert response.status_code in (404, 405)
    assert response.json()["error"]["message"]


def test_a_lab_under_way_is_validated(client: TestClient, data: dict[str, Any]) -> None:
    good = client.post("/api/v1/labs/validate", json=data).json()
    assert good["valid"]
    assert all(test["passed"] for test in good["tests"])

    bad = client.post("/api/v1/labs/validate", json={**data, "minutes": "ten"}).json()
    assert bad == {
        "valid": False,
        "problems": [{"path": "minutes", "message": "input should be a valid integer"}],
        "tests": [],
    }

    data["parts"][0]["blocks"][1]["tests"][0]["answer"] = 7
    failing = client.post("/api/v1/labs/validate", json=data).json()
    assert not failing["valid"]
    assert [test["exercise"] for test in failing["tests"] if not test["passed"]] == ["ku"]


@pytest.mark.parametrize("body", [b"", b"[]", b"3", b"{", b'{"id": 1e999}'])
def test_what_is_no_lab_is_refused_or_reported(client: TestClient, body: bytes) -> None:
    response = post(client, "/api/v1/labs/validate", body)
    assert response.status_code < 500
    assert response.status_code >= 400 or not response.json()["valid"]


def test_hostile_text_in_a_lab_comes_out_harmless(client: TestClient, data: dict[str, Any]) -> None:
    data["parts"][0]["blocks"][0]["markdown"] = "<script>alert(1)</script> [x](javascript:alert(1))"
    verdict = client.post("/api/v1/labs/validate", json=data).json()
    assert not verdict["valid"]
    assert {problem["path"] for problem in verdict["problems"]} == {"parts[0].blocks[0].markdown"}


def test_the_routes_are_described_with_examples(client: TestClient) -> None:
    spec = orjson.loads(client.get("/api/v1/openapi.json").content)
    paths = spec["paths"]
    for path in ("/api/v1/labs", "/api/v1/labs/{lab_id}", "/api/v1/labs/{lab_id}/check", "/api/v1/labs/validate"):
        assert path in paths
    examples = paths["/api/v1/labs/{lab_id}/check"]["post"]["requestBody"]["content"]["application/json"]["examples"]
    for example in examples.values():
        response = client.post(f"{LAB}/check", json=example["value"])
        assert response.status_code == 200
