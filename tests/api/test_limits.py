"""POST /limits, /bode-integral and /spectrum: answers as described, nulls with reasons, errors in their place."""

from typing import Any

import numpy as np
import pytest

from looplab.api.answers.limits import BodeIntegralAnswer, LimitsAnswer
from looplab.api.answers.spectrum import SpectrumAnswer

LAG = {"plant": {"type": "fopdt", "K": 1, "tau": 5, "theta": 1}, "controller": {"type": "pid", "Kc": 2, "tau_I": 5}}


def expr(plant: str, Kc: float = 1.0, **more: Any) -> dict[str, Any]:
    return {"plant": {"type": "expr", "text": plant}, "controller": {"type": "pid", "Kc": Kc, **more}}


def ask(post: Any, path: str, request: dict[str, Any], shape: Any) -> dict[str, Any]:
    answer = post(path, request)
    assert answer.status_code == 200, answer.text
    shape.model_validate_json(answer.content)
    found: dict[str, Any] = answer.json()
    return found


def test_the_window_of_a_lag_with_dead_time(post: Any) -> None:
    found = ask(post, "/limits", {"loop": LAG, "u_limit": 4, "noise_omega": 20, "load_error": 0.5}, LimitsAnswer)
    limits = {limit["id"]: limit for limit in found["limits"]}
    assert limits["dead_time"]["omega"] == 1.0
    assert limits["dead_time"]["met"] is True
    assert limits["zero"]["omega"] is limits["zero"]["met"] is None
    assert {name for name, limit in limits.items() if limit["binding"]} == {"load", "actuator"}
    # |L| = 2/(5 omega) = 1
    assert found["omega_c"] == pytest.approx(0.4, rel=1e-9)
    assert "between 0.3464 and 0.7746" in found["window"]["because"]
    assert found["mismatch"]["robustly_stable"] is True
    assert found["constraints"] == found["integrals"] == []
    ideal = 2 * np.abs(np.sin(np.array(found["curves"]["omega"]) / 2))
    assert found["curves"]["ideal_S"] == pytest.approx(ideal, rel=1e-12)
    assert found["actuator"]["initial"] == pytest.approx(2.0)


def test_an_unstable_loop_still_has_its_window(post: Any) -> None:
    found = ask(post, "/limits", {"loop": expr("(s-1.5)/((s-1)(s+5))")}, LimitsAnswer)
    assert found["closed_loop_stable"] is False
    assert found["window"] == {
        "low": pytest.approx(2.0),
        "high": pytest.approx(0.75),
        "open": False,
        "because": "no bandwidth is left: it should be above 2 and below 0.75",
    }
    for name in ("actuator", "mismatch", "constraints", "integrals", "step", "load_left"):
        assert found[name] is None
        assert "not stable" in found["reasons"][name]
    assert found["peaks"]["Ms_bound"] == pytest.approx(5.0)


def test_lemmas_come_with_a_stable_loop(post: Any) -> None:
    found = ask(post, "/limits", {"loop": expr("(1-s)exp(-0.5s)/(s+1)^2", 0.3, tau_I=2)}, LimitsAnswer)
    assert len(found["integrals"]) == 3
    for integral in found["integrals"]:
        assert integral["value"] == pytest.approx(integral["theorem"], abs=1e-12)
    [constraint] = found["constraints"]
    assert constraint["S"] == pytest.approx([1, 0])
    [effect] = found["step"]["effects"]
    assert effect["effect"] == "undershoot"
    assert effect["bound_pct"] <= found["step"]["undershoot_pct"]


@pytest.mark.parametrize("loop", [expr("1/s"), expr("1/(s^2+1)", 0), expr("s/(s+1)^2"), expr("1/(s^2+4)", 5)])
def test_loops_at_the_edge_are_answered(post: Any, loop: dict[str, Any]) -> None:
    ask(post, "/limits", {"loop": loop, "arrays": "f4"}, LimitsAnswer)
    ask(post, "/bode-integral", {"loop": loop}, BodeIntegralAnswer)


def test_bode_integral_in_three_pieces(post: Any) -> None:
    found = ask(post, "/bode-integral", {"loop": expr("1/(s+4)")}, BodeIntegralAnswer)
    assert found["value"] == pytest.approx(-np.pi / 2, abs=1e-9)
    assert found["theorem"] == pytest.approx(-np.pi / 2, rel=1e-12)
    assert sum(piece["value"] for piece in found["pieces"]) == pytest.approx(found["value"], rel=1e-12)
    assert [piece["omega_to"] for piece in found["pieces"]][-1] is None
    refused = ask(post, "/bode-integral", {"loop": expr("2(s+1)/(s+4)")}, BodeIntegralAnswer)
    assert refused["value"] is refused["pieces"] is refused["limit_sL"] is None
    assert "as many zeros as poles" in refused["reasons"]["value"]


def test_a_sine_above_half_the_rate(post: Any) -> None:
    request = {"signal": {"type": "sines", "sines": [{"frequency": 9, "amplitude": 2}]}, "rate": 10, "samples": 40}
    found = ask(post, "/spectrum", request, SpectrumAnswer)
    assert found["lines"] == [{"amplitude": 2, "frequency": 9, "seen_at": 1, "k": 1, "aliased": True}]
    assert found["frequency"][int(np.argmax(found["amplitude"]))] == pytest.approx(1.0)
    assert max(found["amplitude"]) == pytest.approx(2.0)
    assert found["leakage_pct"] < 1e-10
    curves = found["curves"]
    at = np.interp(found["t"], curves["t"], curves["seen"])
    assert at == pytest.approx(found["values"], abs=1e-2)


def test_a_signal_of_a_loop(post: Any) -> None:
    signal = {"type": "loop", "loop": LAG, "of": "e", "noise": 0.1, "seed": 3}
    found = ask(post, "/spectrum", {"signal": signal, "rate": 4, "samples": 200, "remove_mean": True}, SpectrumAnswer)
    assert found["samples"] >= 200
    assert found["rate"] >= 4
    assert np.mean(found["values"]) == pytest.approx(0, abs=1e-12)
    assert found["parseval"]["residual"] < 1e-12
    assert found["lines"] is None
    assert found["reasons"]["lines"]


@pytest.mark.parametrize(
    ("path", "request_", "place"),
    [
        ("/limits", {"loop": LAG, "u_limit": 0}, "u_limit"),
        ("/limits", {"loop": LAG, "noise_gain": 1}, "noise_gain"),
        ("/limits", {"loop": LAG, "spread": {"K_pct": 95}}, "spread.K_pct"),
        ("/bode-integral", {"loop": expr("s^2")}, "loop.plant"),
        ("/spectrum", {"signal": {"type": "sines", "sines": []}, "rate": 1, "samples": 20}, "signal.sines"),
        ("/spectrum", {"signal": {"type": "samples", "values": [1, 2]}, "rate": 1, "samples": 20}, ""),
        (
            "/spectrum",
            {"signal": {"type": "loop", "loop": expr("1/(s-1)", 0.5)}, "rate": 1, "samples": 99},
            "signal.loop",
        ),
        ("/spectrum", {"signal": {"type": "samples", "values": [1, 2]}, "rate": 1, "window": "kaiser"}, "window"),
    ],
)
def test_errors_say_where(post: Any, path: str, request_: dict[str, Any], place: str) -> None:
    answer = post(path, request_)
    assert answer.status_code == 422, answer.text
    assert answer.json()["error"]["path"] == place
