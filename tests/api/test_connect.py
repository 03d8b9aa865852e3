"""POST /connect: block diagrams with dead times, and loops with actuator and sensor in every route."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from httpx2 import Response

Post = Callable[[str, Any], Response]

LAG = {"type": "fopdt", "K": 1, "tau": 1, "theta": 1}
PI = {"type": "pid", "Kc": 2, "tau_I": 1}
PREDICTOR = {
    "op": "feedback",
    "forward": "C",
    "backward": {"op": "parallel", "of": ["ahead", "model"], "signs": [1, -1]},
}
SYSTEMS = {"C": PI, "ahead": {"type": "fopdt", "K": 1, "tau": 1}, "model": LAG}


def smith(plant: dict[str, Any]) -> dict[str, Any]:
    forward = {"op": "series", "of": [PREDICTOR, "P"]}
    return {"systems": SYSTEMS | {"P": plant}, "diagram": {"op": "feedback", "forward": forward}}


def answer(post: Post, body: dict[str, Any], path: str = "/connect") -> dict[str, Any]:
    found = post(path, body)
    assert found.status_code == 200, found.text
    result: dict[str, Any] = found.json()
    return result


def test_a_perfect_smith_predictor_answers_as_without_dead_time(post: Post) -> None:
    found = answer(post, smith(LAG) | {"want": ["step", "minimal"], "horizon": 10, "points": 201})
    t, y = np.array(found["step"]["t"]), np.array(found["step"]["y"])
    np.testing.assert_allclose(y, np.where(t > 1 - 1e-9, -np.expm1(-2 * (t - 1)), 0), rtol=0, atol=1e-11)
    assert found["verdict"]["stable"]
    assert found["step"]["final_value"] == pytest.approx(1.0)
    # C, the model with and without its dead time, and the plant.
    assert found["order"] == 4
    assert found["delays"] == [1.0, 1.0]
    assert not found["complete"]
    assert found["transfer_function"] is None
    assert "dead time" in found["reasons"]["transfer_function"]
    assert found["margins"] is None
    assert "want" in found["reasons"]["margins"]
    assert found["minimal"]["order"] < 4
    assert {mode["hidden_from"] for mode in found["minimal"]["removed"]} <= {"input", "output"}
    assert found["minimal"]["tolerance"] == 1e-10


def test_a_wrong_model_shows_in_verdict_and_frequency(post: Post) -> None:
    tight = smith({"type": "fopdt", "K": 1, "tau": 1, "theta": 1.4})
    tight["systems"]["C"] = {"type": "pid", "Kc": 8, "tau_I": 1}
    found = answer(post, tight | {"want": ["step", "frequency"], "omega": [0.1, 10]})
    assert found["verdict"]["verdict"] == "unstable"
    assert found["verdict"]["rhp_poles"] > 0
    assert found["step"]["final_value"] is None
    assert "not stable" in found["reasons"]["step.final_value"]
    omega = np.array(found["frequency"]["omega"])
    s = 1j * omega
    C = 8 * (s + 1) / s
    L = np.exp(-1.4 * s) / (s + 1) * C / (1 + C * (1 - np.exp(-s)) / (s + 1))
    np.testing.assert_allclose(found["frequency"]["mag_dB"], 20 * np.log10(np.abs(L / (1 + L))), rtol=0, atol=1e-7)
    assert omega[0] == pytest.approx(0.1)
    assert omega[-1] == pytest.approx(10)


def test_margins_and_nyquist_of_the_open_predictor_loop(post: Post) -> None:
    body = smith({"type": "fopdt", "K": 1.1, "tau": 0.8, "theta": 1.3})
    body["diagram"] = body["diagram"]["forward"]
    found = answer(post, body | {"want": ["margins", "nyquist"]})
    assert found["margins"]["closed_loop_stable"]
    assert found["margins"]["GM"] > 1
    assert (found["nyquist"]["N"], found["nyquist"]["P"], found["nyquist"]["Z"]) == (0, 0, 0)
    w = found["margins"]["omega_180"]
    C = 2 * (1j * w + 1) / (1j * w)
    L = 1.1 * np.exp(-1.3j * w) / (0.8j * w + 1) * C / (1 + C * (1 - np.exp(-1j * w)) / (1j * w + 1))
    assert 1 / abs(L) == pytest.approx(found["margins"]["GM"], rel=1e-9)
    assert abs(L.imag) < 1e-9


def test_a_chain_is_still_one_transfer_function(post: Post) -> None:
    chain = {
        "op": "series",
        "of": [{"type": "expr", "text": "2 exp(-0.5s)/(s+1)"}, {"type": "expr", "text": "exp(-s)"}],
    }
    found = answer(post, {"diagram": chain, "want": []})
    assert found["transfer_function"]["text"] == "2/(s + 1) exp(-1.5 s)"
    assert "<math" in found["transfer_function"]["mathml"]
    assert (found["order"], found["delays"], found["complete"]) == (1, [1.5], True)
    loop = {
        "op": "feedback",
        "forward": {"type": "expr", "text": "2/(s+1)"},
        "backward": {"type": "expr", "text": "1/(s+3)"},
    }
    assert answer(post, {"diagram": loop, "want": []})["transfer_function"]["text"] == "2 (s + 3)/(s^2 + 4 s + 5)"


def test_the_loop_as_a_diagram_is_the_loop(post: Post) -> None:
    systems = {
        "C": {"type": "pid", "Kc": 1.2, "tau_I": 2},
        "valve": {"type": "expr", "text": "exp(-0.1s)/(0.3s+1)"},
        "P": {"type": "fopdt", "K": 1, "tau": 2, "theta": 0.5},
        "sensor": {"type": "expr", "text": "exp(-0.25s)/(0.1s+1)"},
    }
    diagram = {"op": "feedback", "forward": {"op": "series", "of": ["C", "valve", "P"]}, "backward": "sensor"}
    loop = {
        "plant": systems["P"],
        "controller": systems["C"],
        "actuator": systems["valve"],
        "sensor": systems["sensor"],
    }
    by_loop = answer(
        post, {"loop": loop, "horizon": 17, "points": 401, "want": ["step", "margins", "verdict"]}, "/loop"
    )
    step = by_loop["panels"]["step"]
    t = np.array(step["t"])
    by_diagram = answer(
        post, {"systems": systems, "diagram": diagram, "want": ["step"], "horizon": float(t[-1]), "points": t.size}
    )
    np.testing.assert_allclose(by_diagram["step"]["y"], step["setpoint"]["y"], rtol=0, atol=1e-11)
    assert by_diagram["verdict"]["stable"] == by_loop["panels"]["verdict"]["closed_loop_stable"]
    # The measured signal is y through the sensor: later and flatter.
    y, y_m = np.array(step["setpoint"]["y"]), np.array(step["setpoint"]["y_m"])
    assert not y_m[t < 0.1 + 0.5 + 0.25 - 1e-9].round(12).any()
    assert y[t < 0.8].max() > 0.02
    assert by_loop["sensor"]["theta"] == 0.25
    assert by_loop["actuator"]["order"] == 1
    assert by_loop["disturbance"] is None
    open_loop = {"op": "series", "of": ["C", "valve", "P", "sensor"]}
    margins = answer(post, {"systems": systems, "diagram": open_loop, "want": ["margins"]})["margins"]
    for name in ("GM", "PM_deg", "Ms", "Mt", "delay_margin"):
        assert margins[name] == pytest.approx(by_loop["panels"]["margins"][name], rel=1e-8)


def test_actuator_and_sensor_count_in_every_route_that_takes_a_loop(post: Post) -> None:
    loop = {"plant": {"type": "expr", "text": "1/(s+1)^3"}, "controller": {"type": "pid", "Kc": 2, "tau_I": 3}}
    with_sensor = loop | {
        "sensor": {"type": "expr", "text": "0.5 exp(-0.4s)"},
        "actuator": {"type": "expr", "text": "1/(0.2s+1)"},
    }
    whole = {"plant": {"type": "expr", "text": "0.5 exp(-0.4s)/((s+1)^3 (0.2s+1))"}, "controller": loop["controller"]}
    for path in ("/margins", "/nyquist", "/stability"):
        one, other = answer(post, {"loop": with_sensor}, path), answer(post, {"loop": whole}, path)
        for name in ("GM", "PM_deg", "Ms", "N", "P", "Z", "closed_loop_stable", "verdict"):
            if name in other:
                assert one[name] == (pytest.approx(other[name]) if isinstance(other[name], float) else other[name])
    routh = answer(post, {"loop": loop | {"sensor": {"type": "expr", "text": "1/(s+2)"}}}, "/routh")
    assert len(routh["array"]) == 6, "three lags, one integrator, one sensor"


def test_a_controller_may_have_a_dead_time(post: Post) -> None:
    loop = {"plant": {"type": "expr", "text": "1/(s+1)"}, "controller": {"type": "expr", "text": "exp(-0.5s)"}}
    panels = answer(post, {"loop": loop, "want": ["step"], "horizon": 5, "points": 101}, "/loop")["panels"]
    t, step = np.array(panels["step"]["t"]), panels["step"]
    early = t < 1.0 - 1e-9
    # Until its own answer comes back u is the delayed step; the load meets the plant alone until then.
    np.testing.assert_allclose(np.array(step["setpoint"]["u"])[t < 0.5 - 1e-9], 0, atol=1e-14)
    y = np.where(t > 0.5, -np.expm1(-(t - 0.5)), 0)
    np.testing.assert_allclose(np.array(step["setpoint"]["y"])[early], y[early], atol=1e-12)
    np.testing.assert_allclose(np.array(step["load"]["y"])[t < 0.5], -np.expm1(-t[t < 0.5]), atol=1e-12)
    assert step["setpoint"]["y_m"] is None


def test_a_disturbance_has_its_own_way_to_y(post: Post) -> None:
    loop = {
        "plant": LAG,
        "controller": {"type": "pid", "Kc": 0.5},
        "disturbance": {"type": "expr", "text": "3/(5s+1)"},
    }
    answered = answer(post, {"loop": loop, "want": ["step", "sensitivity"], "horizon": 100}, "/loop")
    step = answered["panels"]["step"]
    assert step["load"]["final_y"] == pytest.approx(3 / 1.5)
    gang = answered["panels"]["sensitivity"]
    s = 1j * np.array(gang["omega"])
    L = 0.5 * np.exp(-s) / (s + 1)
    np.testing.assert_allclose(gang["PS_dB"], 20 * np.log10(np.abs(3 / (5 * s + 1) / (1 + L))), rtol=0, atol=1e-8)


@pytest.mark.parametrize(
    ("body", "path", "words"),
    [
        ({"diagram": "P"}, "diagram", "no system named"),
        ({"systems": {"P": {"type": "expr", "text": "1/(q+1)"}}, "diagram": "P"}, "systems.P.text", "q"),
        ({"systems": {"P": {"type": "expr", "text": "s"}}, "diagram": "P"}, "systems.P", "differentiates"),
        ({"diagram": {"op": "series", "of": []}}, "diagram.of", "at least 1"),
        ({"diagram": {"op": "product", "of": ["P"]}}, "diagram", "op must be"),
        ({"diagram": {"op": "parallel", "of": [LAG, LAG], "signs": [1]}}, "diagram.signs", "2 signs"),
        (
            {"diagram": {"op": "series", "of": [LAG, {"op": "feedback", "forward": {"type": "expr", "text": "-1"}}]}},
            "diagram.of[1]",
            "algebraic loop",
        ),
        ({"diagram": {"op": "series", "of": [LAG, "nobody"]}}, "diagram.of[1]", "nobody"),
        ({"diagram": {"op": "feedback", "forward": LAG, "sign": 2}}, "diagram.sign", ""),
        ({"diagram": LAG, "extra": 1}, "extra", "unknown field"),
        ({"systems": {"1 bad": LAG}, "diagram": LAG}, "systems", ""),
    ],
)
def test_mistakes_are_named_with_their_place(post: Post, body: dict[str, Any], path: str, words: str) -> None:
    found = post("/connect", body)
    assert found.status_code == 422, found.text
    error = found.json()["error"]
    assert error["path"].startswith(path), error
    assert words in error["message"]


def test_small_requests_cannot_grow_without_bounds(post: Post) -> None:
    deep: Any = LAG
    for _ in range(40):
        deep = {"op": "feedback", "forward": deep}
    assert post("/connect", {"diagram": deep}).status_code == 422
    for depth in (100, 250, 1000, 5000):
        body = b'{"diagram": ' + b'{"op": "feedback", "forward": ' * depth + b'"P"' + b"}" * (depth + 1)
        assert post("/connect", body).status_code in (400, 422), depth
    wide: Any = "P"
    for _ in range(3):
        wide = {"op": "parallel", "of": [wide] * 10}
    systems = {"P": {"type": "expr", "text": "1/(s+1)^5"}}
    for diagram, words in ((wide, "more than 60 blocks"), ({"op": "parallel", "of": ["P"] * 20}, "limits")):
        refused = post("/connect", {"systems": systems, "diagram": diagram})
        assert refused.status_code == 422
        assert words in refused.json()["error"]["message"]


def test_what_cannot_be_computed_leaves_the_rest(post: Post) -> None:
    """A dead time far too short for the horizon: no step response, but a verdict and a reason."""
    loop = {
        "op": "feedback",
        "forward": {"type": "expr", "text": "exp(-0.001s)/(s+1)"},
        "backward": {"type": "expr", "text": "exp(-0.7s)"},
    }
    found = answer(post, {"diagram": loop, "want": ["step"], "horizon": 100})
    assert found["step"] is None
    assert "too short" in found["reasons"]["step"]
    assert found["verdict"]["stable"]


def test_wrong_instruments_are_named(post: Post) -> None:
    loop = {"plant": LAG, "controller": PI}
    for name in ("actuator", "sensor", "disturbance"):
        wrong = post("/loop", {"loop": loop | {name: {"type": "expr", "text": "1/(q+1)"}}})
        assert wrong.status_code == 422
        assert wrong.json()["error"]["path"] == f"loop.{name}.text"
        improper = post("/loop", {"loop": loop | {name: {"type": "expr", "text": "s"}}})
        assert improper.json()["error"]["path"] == f"loop.{name}"


def test_a_minimal_realisation_says_what_it_left_out(post: Post) -> None:
    model = {"A": [[-1, 0], [0, -2]], "B": [[1], [0]], "C": [[1, 1]]}
    found = answer(post, {"model": model}, "/state-space")["minimal_realization"]
    assert found["order"] == 1
    assert found["A"] == [[-1]]
    assert found["removed"] == [{"pole": [-2, 0], "hidden_from": "input", "stable": True}]
    assert found["tolerance"] == 1e-12
    assert found["largest_removed"] < 1e-15 < found["smallest_kept"]
