"""POST /pole-placement and POST /smith: answers that fit their shape, and refusals that name the place."""

from typing import Any

import pytest

from looplab.api.answers.design import PolePlacementAnswer, SmithAnswer

PLANT = {"type": "expr", "text": "2/((s+1)(s+2))"}
MODEL = {"type": "fopdt", "K": 1, "tau": 2, "theta": 4}


def ask(post: Any, path: str, request: dict[str, Any], shape: Any) -> dict[str, Any]:
    answer = post(path, request)
    assert answer.status_code == 200, answer.text
    shape.model_validate_json(answer.content)
    found: dict[str, Any] = answer.json()
    return found


def test_the_example_of_the_notes(post: Any) -> None:
    found = ask(post, "/pole-placement", {"plant": PLANT, "D_text": "(s^2+5s+16)(s+40)"}, PolePlacementAnswer)
    assert found["C"]["num"] == pytest.approx([44, 278])
    assert found["C"]["den"] == pytest.approx([1, 42])
    assert found["offset_pct"] == pytest.approx(100 * 84 / 640)
    assert (found["required"], found["added"], found["C"]["integrators"]) == (3, [], 0)
    assert found["C"]["pid"]["tau_I"] is None
    same = ask(post, "/pole-placement", {"plant": PLANT, "D": [1, 45, 216, 640]}, PolePlacementAnswer)
    assert same["C"]["num"] == pytest.approx([44, 278])


def test_missing_poles_are_added_where_asked(post: Any) -> None:
    request = {"plant": PLANT, "poles": [-3, [-2, 1], [-2, -1]], "integrator": True, "complete": True}
    found = ask(post, "/pole-placement", request, PolePlacementAnswer)
    assert found["added"] == [[-4.5, 0.0]]
    assert found["static_gain"] == 1
    assert found["C"]["pid"]["type"] == "pid"
    assert "4 of them" in post("/pole-placement", request | {"complete": False}).json()["error"]["message"]


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"plant": {"type": "expr", "text": "exp(-s)/(s+1)"}}, "plant"),
        ({"plant": {"type": "expr", "text": "(s+3)/((s+3)(s+1))"}}, "plant"),
        ({"D_text": "1/(s+1)"}, "D_text"),
        ({"D_text": "(s+1)^2"}, "D_text"),
        ({"D_text": None, "poles": [-1]}, "poles"),
        ({"D_text": None, "poles": [[-1, 2]]}, "poles.zeros"),
        ({"L_factor": [0]}, "L_factor"),
        ({"D_text": None}, ""),
    ],
)
def test_refusals_name_the_place(post: Any, change: dict[str, Any], path: str) -> None:
    answer = post("/pole-placement", {"plant": PLANT, "D_text": "(s+1)^3"} | change)
    assert answer.status_code == 422
    assert answer.json()["error"]["path"] == path


def test_three_loops_of_the_same_peak(post: Any) -> None:
    found = ask(post, "/smith", {"model": MODEL, "want": ["loops", "region"], "region_rows": 5}, SmithAnswer)
    assert [row["name"] for row in found["rows"]] == ["smith", "PI", "PID"]
    for row in found["rows"]:
        assert row["margins"]["Ms"] == pytest.approx(1.6, rel=1e-6)
        assert row["tolerates"]["K"][1] == pytest.approx(row["margins"]["GM"], rel=1e-6)
        assert row["tolerates"]["theta"][1] == pytest.approx(1 + row["margins"]["delay_margin"] / 4, rel=1e-6)
    region = found["region"]
    assert (region["along"], region["across"], len(region["rows"])) == ("theta", "K", 5)
    assert all(len(loop["intervals"]) == 5 for loop in region["loops"])


def test_a_mismatch_is_the_plants_not_the_models(post: Any) -> None:
    found = ask(post, "/smith", {"model": MODEL, "mismatch": {"theta": 2, "K": 2.5}, "points": 60}, SmithAnswer)
    assert found["tuning"]["Ms"] == pytest.approx(1.6)
    assert found["plant"]["text"] != found["model"]["text"]
    smith = found["rows"][0]
    assert not smith["closed_loop_stable"]
    assert smith["tolerates"]["theta"] is None
    assert smith["tolerates"]["reasons"]["theta"]


def test_known_failures_are_results(post: Any) -> None:
    unstable = {"type": "expr", "text": "2 exp(-0.2s)/(s-1)"}
    request = {"model": unstable, "want": ["loops", "region"], "points": 60}
    assert post("/smith", request).json()["error"]["path"] == "controller"
    found = ask(post, "/smith", request | {"Ms_limit": 2.0}, SmithAnswer)
    assert "unstable" in found["notes"][0]
    assert "plain PI" in found["tuning"]["how"]
    smith, pi, _ = found["rows"]
    assert (smith["closed_loop_stable"], pi["closed_loop_stable"]) == (False, True)
    assert "no plant at all" in found["region"]["loops"][0]["reason"]
    refused = post("/smith", {"model": PLANT})
    assert refused.json()["error"]["path"] == "model"
