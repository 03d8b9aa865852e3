"""POST /identify and /experiments: records in, models out, and on to /tune."""

import math
from typing import Any

import pytest
from fastapi.testclient import TestClient

from looplab.api.answers.experiments import IdentifyAnswer, RelayAnswer, StepTestAnswer, UltimateCycleAnswer

PLANT = {"type": "fopdt", "K": 2, "tau": 3, "theta": 1}


def test_from_the_experiment_to_the_settings(post: Any) -> None:
    record = post("/experiments/step-test", {"plant": PLANT, "start": 2, "points": 120})
    StepTestAnswer.model_validate_json(record.content)
    data = {name: record.json()[name] for name in ("t", "u", "y")}
    found = post("/identify", {"data": data, "compare": True})
    IdentifyAnswer.model_validate_json(found.content)
    answer = found.json()
    assert answer["model"] == pytest.approx({"K": 2, "tau": 3, "theta": 1}, rel=1e-6)
    assert answer["fit_pct"] == pytest.approx(100, abs=1e-4)
    assert len(answer["methods"]) == 8
    tuned = post("/tune", {"model": answer["model"], "rules": ["cohen_coon"]})
    assert tuned.status_code == 200
    assert post("/margins", {"plant": answer["system"]}).status_code != 500


@pytest.mark.parametrize(
    ("request_", "path", "word"),
    [
        ({"csv": "t,u,y\n1,=1+1,3\n"}, "csv", "line 2, column 2"),
        ({"data": {"t": [0, 1], "u": [0], "y": [0, 1]}}, "data.u", "2 times but 1 values"),
        ({"data": {"t": [], "u": [], "y": []}}, "data.u", "no input"),
        ({"csv": "t,u,y\n1,2,3", "data": {"t": [], "u": [], "y": []}}, "", "either"),
    ],
)
def test_what_cannot_be_read(post: Any, request_: dict[str, Any], path: str, word: str) -> None:
    refused = post("/identify", request_)
    assert refused.status_code == 422
    assert word in refused.json()["error"]["message"]
    assert refused.json()["error"]["path"] == path


def test_a_fit_past_its_budget_says_so(post: Any, client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    t = [0.1 * k for k in range(3000)]
    u = [math.sin(0.01 * k * k) for k in range(3000)]
    request = {"data": {"t": t, "u": u, "y": [math.tanh(v) for v in u]}, "method": "least_squares_sopdt"}
    monkeypatch.setattr(client.app.state.workers, "budget", 0.02)
    refused = post("/identify", request)
    assert refused.status_code == 422
    assert "0.02 s of computing" in refused.json()["error"]["message"]
    assert refused.json()["error"]["path"] == "method"


def test_uploads_may_be_larger_than_other_requests(post: Any) -> None:
    rows = "".join(f"{k},{int(k > 9000)},{max(0, k - 9000) ** 0.5:.12f}\n" for k in range(20_000))
    assert len(rows) > 256 * 1024
    answer = post("/identify", {"csv": "t,u,y\n" + rows, "method": "two_point"})
    assert answer.status_code == 200, answer.text
    assert "is used" in answer.json()["record"]["notes"][0]
    assert post("/identify", {"csv": "0" * 2_200_000}).status_code == 413
    assert post("/tune", {"csv": "0" * 300_000}).status_code == 413


def test_the_ultimate_cycle_and_the_relay(post: Any) -> None:
    found = post("/experiments/ultimate-cycle", {"plant": {"type": "expr", "text": "1/(s+1)^3"}})
    UltimateCycleAnswer.model_validate_json(found.content)
    assert found.json()["Ku"] == pytest.approx(8, rel=0.01)
    assert abs(found.json()["error_pct"]) < 1
    run = post("/experiments/relay", {"plant": PLANT})
    RelayAnswer.model_validate_json(run.content)
    assert run.json()["swing"] == pytest.approx(2 * (1 - math.exp(-1 / 3)), rel=1e-9)
    tuned = post("/tune", {"relay": run.json()["relay"], "rules": ["ziegler_nichols"], "types": ["PI"]}).json()
    assert tuned["settings"][0]["Kc"] == pytest.approx(0.45 * run.json()["Ku"], rel=1e-9)
    refused = post("/experiments/ultimate-cycle", {"plant": {"type": "expr", "text": "1/(s+1)"}})
    assert refused.status_code == 422
    assert "no ultimate gain" in refused.json()["error"]["message"]


def test_two_tanks_are_linear_and_answer_as_their_transfer_function(post: Any) -> None:
    """A1 A2 R1 R2 s^2 + (A1 R1 + A1 R2 + A2 R2) s + 1 = s^2 + 4 s + 1, and the gain is R2 = 1."""
    plant = {"type": "plant", "id": "two-tanks-interacting", "input": "Fi", "output": "h2"}
    request = {"size": 0.2, "horizon": 30, "points": 100}
    record = post("/experiments/step-test", {"plant": plant, **request}).json()
    linear = {"type": "tf", "num": [1], "den": [1, 4, 1]}
    exact = post("/experiments/step-test", {"plant": linear, **request}).json()
    assert [y - record["y0"] for y in record["y"]] == pytest.approx(exact["y"], abs=1e-6)
    data = {name: record[name] for name in ("t", "u", "y")}
    fit = post("/identify", {"data": data, "method": "least_squares_sopdt", "u_before": record["u0"]}).json()
    assert fit["model"]["K"] == pytest.approx(1, rel=1e-3)
    assert post("/experiments/step-test", {"plant": plant}).json()["error"]["path"] == "horizon"
    assert (
        post("/experiments/relay", {"plant": {**plant, "id": "none"}, "horizon": 9}).json()["error"]["path"]
        == "plant.id"
    )
