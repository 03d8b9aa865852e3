"""POST /tune: the tables of the notes to the printed digits, and refusals with reasons."""

from typing import Any

import pytest

from looplab.api.answers.tune import TuneAnswer


def settings(post: Any, request: dict[str, Any]) -> dict[tuple[str, str], dict[str, Any]]:
    answer = post("/tune", request)
    assert answer.status_code == 200, answer.text
    TuneAnswer.model_validate_json(answer.content)
    return {(s["rule"], s["type"]): s for s in answer.json()["settings"]}


def test_ziegler_nichols_on_three_lags(post: Any) -> None:
    """Section 19.1.1 recomputed: Ku = 8, Pu = 3.6276."""
    answer = post("/tune", {"plant": {"type": "expr", "text": "1/(s+1)^3"}}).json()
    assert answer["ultimate"]["Ku"] == pytest.approx(8, rel=1e-12)
    assert answer["ultimate"]["omega_180"] == pytest.approx(3**0.5, rel=1e-12)
    assert round(answer["ultimate"]["Pu"], 4) == 3.6276
    found = settings(post, {"plant": {"type": "expr", "text": "1/(s+1)^3"}, "rules": ["ziegler_nichols"]})
    p, pi, pid = (found["ziegler_nichols", t] for t in ("P", "PI", "PID"))
    assert round(p["Kc"], 9) == 4
    assert p["tau_I"] is None
    assert p["tau_D"] is None
    assert (round(pi["Kc"], 9), round(pi["tau_I"], 4), pi["tau_D"]) == (3.6, 3.0230, None)
    assert (round(pid["Kc"], 9), round(pid["tau_I"], 4), round(pid["tau_D"], 5)) == (4.8, 1.8138, 0.45345)
    assert round(pid["alpha"] * pid["tau_D"], 6) == 0.045345


@pytest.mark.parametrize(
    "source",
    [
        {"model": {"K": 1, "tau": 0.5, "theta": 0.1}},
        {"plant": {"type": "fopdt", "K": 1, "tau": 0.5, "theta": 0.1}},
        {"plant": {"type": "expr", "text": "exp(-0.1s)/(0.5s+1)"}},
    ],
)
def test_cohen_coon(post: Any, source: dict[str, Any]) -> None:
    """Section 19.2 recomputed for (Kp, tau_p, tau_d) = (1, 0.5, 0.1)."""
    found = settings(post, {**source, "rules": ["cohen_coon"]})
    p, pi, pid = (found["cohen_coon", t] for t in ("P", "PI", "PID"))
    assert round(p["Kc"], 3) == 5.333
    assert (round(pi["Kc"], 3), round(pi["tau_I"], 4)) == (4.583, 0.2354)
    assert (round(pid["Kc"], 3), round(pid["tau_I"], 4), round(pid["tau_D"], 5)) == (6.917, 0.2274, 0.03509)


@pytest.mark.parametrize(
    ("plant", "rule", "word"),
    [
        ("1/(s+1)", "ziegler_nichols", "never reaches -180"),
        ("1/(s+1)", "cohen_coon", "needs dead time"),
        ("exp(-s)/s", "cohen_coon", "not for an integrating process"),
        ("exp(-0.2s)/(s-1)", "tyreus_luyben", "Kc between 1 and 7.2"),
        ("exp(-5s)/(s+1)", "itae_load", "beyond 1"),
        ("1/((s+1)(s^2+0.2s+1))", "simc", "real poles"),
        ("exp(-5s)/(s+1)", "cohen_coon", "beyond 4"),
        ("(1-s)/(s+1)^2", "cohen_coon", "wrong direction"),
        ("2(s+1)/(s(s-4))", "ziegler_nichols", "stable for gains above 2"),
        ("1/(s-1)^2", "ziegler_nichols", "no ultimate gain"),
    ],
)
def test_a_rule_refuses_with_its_reason(post: Any, plant: str, rule: str, word: str) -> None:
    found = settings(post, {"plant": {"type": "expr", "text": plant}, "rules": [rule]})
    for setting in found.values():
        assert setting["valid"] is False
        assert setting["Kc"] is None
        assert word in setting["reason"]


def test_settings_from_an_experiment(post: Any) -> None:
    found = settings(post, {"ultimate": {"Ku": 8, "Pu": 3.6276}, "types": ["PID"]})
    assert found["ziegler_nichols", "PID"]["Kc"] == pytest.approx(4.8)
    assert not found["cohen_coon", "PID"]["valid"]


def test_a_negative_plant_gets_negative_gains(post: Any) -> None:
    found = settings(post, {"plant": {"type": "expr", "text": "-2/(s+1)^3"}})
    assert found["ziegler_nichols", "P"]["Kc"] == pytest.approx(-2)
    assert found["cohen_coon", "P"]["Kc"] < 0
