"""The tuning routes beside /tune: the rules, the best settings, the comparison, the map, the forms."""

from typing import Any

import numpy as np
import pytest

from looplab.api.answers.compare import CompareAnswer, GainMapAnswer
from looplab.api.answers.tune import FormsAnswer, OptimalAnswer, RuleList, TradeOffAnswer, TuneAnswer

PLANT = {"type": "fopdt", "K": 1, "tau": 5, "theta": 1}
LAGS = {"type": "expr", "text": "1/(s+1)^3"}


def ask(post: Any, path: str, request: dict[str, Any], shape: Any) -> dict[str, Any]:
    answer = post(path, request)
    assert answer.status_code == 200, answer.text
    shape.model_validate_json(answer.content)
    found: dict[str, Any] = answer.json()
    return found


def test_every_rule_is_listed_with_formula_and_source(client: Any) -> None:
    answer = client.get("/api/v1/tune/rules")
    RuleList.model_validate_json(answer.content)
    rules = answer.json()["rules"]
    assert len(rules) == 19
    for rule in rules:
        assert rule["source"]
        assert rule["validity"]
        assert all(formula["mathml"].startswith("<math") for formula in rule["formulas"])
    assert [r["form"] for r in rules if r["id"] == "simc"] == ["series"]


def test_each_rule_says_what_it_started_from(post: Any) -> None:
    found = ask(post, "/tune", {"plant": LAGS}, TuneAnswer)
    by = {(s["rule"], s["type"]): s for s in found["settings"]}
    assert by["ziegler_nichols", "PI"]["basis"]["values"]["Ku"] == pytest.approx(8)
    # Half rule: lags 1, 1, 1 -> tau 1.5, theta 1.5; and 1.5, 1 with theta 0.5.
    assert by["simc", "PI"]["basis"]["values"] == pytest.approx({"K": 1, "tau": 1.5, "theta": 1.5})
    pid = by["simc", "PID"]
    assert (pid["basis"]["values"]["tau_1"], pid["basis"]["values"]["tau_2"]) == pytest.approx((1.5, 1.0))
    assert pid["published"]["form"] == "series"
    assert pid["series"] == pytest.approx({k: pid["published"][k] for k in ("Kc", "tau_I", "tau_D")})
    assert by["cohen_coon", "PD"]["tau_I"] is None
    zn = by["ziegler_nichols", "PID"]
    assert zn["parallel"] == pytest.approx({"Kp": 4.8, "Ki": 4.8 / 1.8137994, "Kd": 4.8 * 0.45344985})
    assert zn["series"] == pytest.approx({"Kc": 2.4, "tau_I": 0.9068997, "tau_D": 0.9068997})


def test_a_type_that_a_rule_does_not_have(post: Any) -> None:
    [only] = ask(post, "/tune", {"plant": LAGS, "rules": ["amigo"], "types": ["PD"]}, TuneAnswer)["settings"]
    assert not only["valid"]
    assert "no settings for PD" in only["reason"]
    assert only["formula"] is None


def test_tau_c_and_a_relay(post: Any) -> None:
    found = ask(post, "/tune", {"plant": PLANT, "rules": ["simc"], "types": ["PI"], "tau_c": 4}, TuneAnswer)
    assert found["settings"][0]["Kc"] == pytest.approx(5 / (4 + 1))
    relay = {"amplitude": 1, "swing": 0.5, "Pu": 2}
    found = ask(post, "/tune", {"relay": relay, "rules": ["tyreus_luyben"], "types": ["PI"]}, TuneAnswer)
    assert found["settings"][0]["Kc"] == pytest.approx(4 / (np.pi * 0.5) / 3.2)
    assert found["model"] is None


def test_the_best_settings(post: Any) -> None:
    found = ask(post, "/tune/optimal", {"plant": PLANT, "Ms_limit": 1.5}, OptimalAnswer)
    assert found["Ms"] <= 1.5 * (1 + 1e-9)
    assert found["active"] == ["Ms"]
    loop = {"plant": PLANT, "controller": found["controller"]}
    panels = post("/loop", {"loop": loop, "want": ["margins", "metrics"], "horizon": 80}).json()["panels"]
    assert panels["margins"]["Ms"] == pytest.approx(found["Ms"], rel=1e-9)
    assert panels["metrics"]["load"]["IAE"] == pytest.approx(found["value"], rel=1e-3)


def test_the_price_of_robustness(post: Any) -> None:
    found = ask(post, "/tune/trade-off", {"plant": PLANT, "Ms_limits": [2.0, 1.4]}, TradeOffAnswer)
    assert [p["Ms_limit"] for p in found["points"]] == [1.4, 2.0]
    assert found["points"][0]["optimum"]["value"] > found["points"][1]["optimum"]["value"]


def test_rows_of_a_comparison_are_the_loops_own_numbers(post: Any) -> None:
    true = {"type": "expr", "text": "1.2 exp(-s)/((4s+1)(s+1))"}
    request = {
        "plant": PLANT,
        "true_plant": true,
        "entries": [
            {"rule": "simc", "type": "PI"},
            {"rule": "simc", "type": "PID"},
            {"label": "mine", "controller": {"type": "pid", "form": "series", "Kc": 2, "tau_I": 3, "tau_D": 0.3}},
        ],
        "horizon": 40,
    }
    simc, refused, mine = ask(post, "/compare", request, CompareAnswer)["rows"]
    # Tuned on the model, judged on the true plant.
    assert simc["controller"]["Kc"] == pytest.approx(2.5)
    loop = {"plant": true, "controller": simc["controller"]}
    panels = post("/loop", {"loop": loop, "want": ["margins", "metrics"], "horizon": 40}).json()["panels"]
    assert simc["margins"]["Ms"] == pytest.approx(panels["margins"]["Ms"], rel=1e-9)
    assert simc["setpoint"]["overshoot_pct"] == pytest.approx(panels["metrics"]["setpoint"]["overshoot_pct"], rel=1e-3)
    assert simc["load"]["IAE"] == pytest.approx(panels["metrics"]["load"]["IAE"], rel=1e-3)
    assert len(simc["responses"]["setpoint"]["t"]) == len(simc["responses"]["setpoint"]["y"])
    assert not refused["valid"]
    assert refused["responses"] is None
    assert "1 lags" in refused["reason"]
    assert mine["label"] == "mine"
    assert mine["type"] == "PID"
    assert mine["controller"]["form"] == "series"


def test_an_unstable_row_says_so(post: Any) -> None:
    request = {"plant": PLANT, "entries": [{"controller": {"type": "pid", "Kc": 20, "tau_I": 2}}], "spread_pct": 10}
    [row] = ask(post, "/compare", request, CompareAnswer)["rows"]
    assert row["closed_loop_stable"] is False
    assert row["setpoint"]["IAE"] is None
    assert "not stable" in row["setpoint"]["reasons"]["IAE"]
    assert row["sensitivity"]["setpoint"] is None
    assert len(row["sensitivity"]["unstable"]) == row["sensitivity"]["cases"] == 9


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"entries": []}, "entries"),
        ({"entries": [{"rule": "simc"}]}, "entries[0]"),
        ({"entries": [{"rule": "simc", "type": "PI"}] * 13}, "entries"),
        ({"entries": [{"rule": "simc", "type": "PI"}] * 5, "spread_pct": 10}, ""),
        ({"spread_pct": 91}, "spread_pct"),
        ({"plant": {"type": "expr", "text": "s"}}, "plant"),
        ({"true_plant": {"type": "expr", "text": "s"}}, "true_plant"),
    ],
)
def test_bad_comparisons(post: Any, change: dict[str, Any], path: str) -> None:
    answer = post("/compare", {"plant": PLANT, "entries": [{"rule": "simc", "type": "PI"}], **change})
    assert answer.status_code == 422
    assert answer.json()["error"]["path"] == path


def test_a_map_is_a_grid_with_nulls_where_unstable(post: Any) -> None:
    found = ask(post, "/gain-map", {"plant": LAGS, "points": [8, 6]}, GainMapAnswer)
    assert (len(found["Ms"]), len(found["Ms"][0])) == (6, 8)
    assert any(v is None for row in found["Ms"] for v in row)
    assert any(v is not None for row in found["value"] for v in row)
    assert max(v for v in found["boundary"]["Kc"] if v is not None) < 8


def test_forms_of_a_controller(post: Any) -> None:
    series = {"type": "pid", "form": "series", "Kc": 2, "tau_I": 4, "tau_D": 1}
    found = ask(post, "/controller-forms", {"controller": series}, FormsAnswer)
    assert found["ideal"] == pytest.approx({"Kc": 2.5, "tau_I": 5, "tau_D": 0.8})
    assert found["series"] == pytest.approx({"Kc": 2, "tau_I": 4, "tau_D": 1})
    assert found["proportional_band_pct"] == pytest.approx(40)
    ideal = {"type": "pid", "Kc": 1, "tau_I": 2, "tau_D": 1}
    found = ask(post, "/controller-forms", {"controller": ideal}, FormsAnswer)
    assert found["series"] is None
    assert "tau_I < 4 tau_D" in found["series_reason"]
    assert found["parallel"] == {"Kp": 1, "Ki": 0.5, "Kd": 1}
