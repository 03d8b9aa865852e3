"""POST /state-feedback and what runs on it."""

from typing import Any

import numpy as np
import pytest

from looplab.api.answers.state_feedback import FeedbackRunAnswer, RegionAnswer, StateFeedbackAnswer

CART: dict[str, Any] = {"type": "ss", "A": [[0, 1], [0, 0]], "B": [[0], [1]], "C": [[1, 0]]}
PENDULUM: dict[str, Any] = {"type": "plant", "id": "cart-pendulum", "operating_point": "upright"}
POLES: dict[str, Any] = {"method": "poles", "poles": [[-2, 1], [-2, -1], -5, -6]}


def ask(post: Any, what: str, shape: Any, **request: Any) -> dict[str, Any]:
    answer = post(f"/state-feedback{what}", request)
    assert answer.status_code == 200, answer.text
    shape.model_validate_json(answer.content)
    return answer.json()


def test_a_cart_by_hand(post: Any) -> None:
    found = ask(
        post, "", StateFeedbackAnswer, plant=CART, gain={"method": "poles", "poles": [[-1, 1], [-1, -1]]},
        observer={"method": "poles", "poles": [-3, -3]}, controlled=["y1"],
    )  # fmt: skip
    assert found["K"][0] == pytest.approx([2, 2])
    assert [row[0] for row in found["L"]] == pytest.approx([6, 9])
    assert found["N"] == [[pytest.approx(2)]]
    assert found["closed_loop_stable"]
    # L(s) = (30 s + 18)/(s^2 (s^2 + 8 s + 23)): K (s I - A + B K + L C)^-1 L / s^2
    w = found["margins"]["omega_c"]
    assert abs((30j * w + 18) / ((1j * w) ** 2 * ((1j * w) ** 2 + 8j * w + 23))) == pytest.approx(1)


def test_the_pendulum_keeps_sixty_degrees_until_an_observer_is_put_in(post: Any) -> None:
    weights = {"method": "lqr", "Q": [1, 0, 10, 0], "R": [0.1]}
    bare = ask(post, "", StateFeedbackAnswer, plant=PENDULUM, gain=weights)
    assert bare["margins"]["PM_deg"] >= 60
    assert bare["feedback"]["residual"] < 1e-10
    seen = ask(post, "", StateFeedbackAnswer, plant=PENDULUM, gain=weights, observer={"method": "faster", "speed": 4})
    assert seen["margins"]["closed_loop_stable"] and seen["margins"]["PM_deg"] < 30
    assert seen["separation_error"] < 1e-8
    assert len(seen["closed_loop_poles"]) == 8


def test_a_run_is_caught_from_fifteen_degrees_and_not_from_sixty(post: Any) -> None:
    same: dict[str, Any] = {
        "plant": PENDULUM, "gain": POLES, "horizon": 6, "points": 61, "limits": {"F": [-20, 20]}, "controlled": ["x"],
    }  # fmt: skip
    run = ask(post, "/simulate", FeedbackRunAnswer, **same, initial={"phi": 0.2618}, setpoints={"x": 0.2})
    assert run["nonlinear"]["outcome"] == "caught"
    assert run["nonlinear"]["states"]["x"][-1] == pytest.approx(0.2, abs=1e-2)
    assert run["linear"]["states"]["x"][-1] == pytest.approx(0.2, abs=1e-3)
    lost = ask(post, "/simulate", FeedbackRunAnswer, **same, initial={"phi": 1.0472})["nonlinear"]
    assert lost["outcome"] == "end_of_track"
    assert lost["t"][-1] == lost["truncated_at"]
    assert np.abs(lost["inputs"]["F"]).max() == 20


def test_a_region_is_symmetric_and_contains_the_small_tilts(post: Any) -> None:
    found = ask(
        post, "/region", RegionAnswer, plant=PENDULUM, gain=POLES, horizon=6, limits={"F": [-20, 20]},
        horizontal={"state": "phi", "low": -1.2, "high": 1.2, "count": 7},
        vertical={"state": "omega", "low": -5, "high": 5, "count": 7},
    )  # fmt: skip
    outcomes = np.array(found["outcomes"])
    assert (outcomes == outcomes[::-1, ::-1]).all()
    assert outcomes[3, 3] == "caught"
    assert outcomes[3, 0] == "end_of_track"


def test_a_model_in_the_request_is_run_too(post: Any) -> None:
    model = {
        "id": "tank", "title": "A tank", "inputs": [{"name": "q", "value": 1, "min": 0, "max": 3}],
        "states": [{"name": "h", "initial": 1, "equation": "q - sqrt(h)", "min": 0}],
    }  # fmt: skip
    run = ask(
        post, "/simulate", FeedbackRunAnswer, plant={"type": "model", "model": model}, horizon=8, points=81,
        gain={"method": "poles", "poles": [-2, -3]}, controlled=["h"], integral=True, setpoints={"h": 1.5},
    )["nonlinear"]  # fmt: skip
    assert run["outputs"]["h"][-1] == pytest.approx(1.5, abs=1e-5)
    # at rest q = sqrt(h)
    assert run["inputs"]["q"][-1] == pytest.approx(np.sqrt(1.5), abs=1e-5)


@pytest.mark.parametrize(
    ("change", "path", "words"),
    [
        ({"gain": {"method": "poles", "poles": [-1]}}, "gain.poles", "1 poles for 2 states"),
        ({"gain": {"method": "lqr", "Q": [1, 1], "R": [-1]}}, "gain.R", "positive definite"),
        ({"gain": {"method": "lqr", "Q": [[1, 0], [0]], "R": [1]}}, "gain.Q", "2 x 2"),
        ({"controlled": ["y2"]}, "controlled", "no such signal"),
        ({"observer": {"method": "poles", "poles": [-1, -2]}, "measured": []}, "measured", "needs an output"),
        (
            {"plant": {**CART, "C": [[0, 1]]}, "observer": {"method": "faster"}},
            "observer.poles",
            "the mode at s = 0 is unobservable",
        ),
        ({"plant": {"type": "plant", "id": "nonsense"}}, "plant.id", "no plant"),
        ({"plant": {**PENDULUM, "actuators": ["x"]}}, "plant.actuators", "no such signal"),
        ({"plant": {**PENDULUM, "operating_point": "sideways"}}, "plant.operating_point", "no operating point"),
    ],
)
def test_what_cannot_be_is_refused_by_name(post: Any, change: dict[str, Any], path: str, words: str) -> None:
    request = {"plant": CART, "gain": {"method": "poles", "poles": [-1, -2]}, **change}
    response = post("/state-feedback", request)
    assert response.status_code == 422
    error = response.json()["error"]
    assert error["path"] == path
    assert words in error["message"]


def test_a_grid_is_held_to_its_limits(post: Any) -> None:
    axes = {"horizontal": {"state": "phi", "low": -1, "high": 1, "count": 61}}
    request = {"plant": PENDULUM, "gain": POLES, "horizon": 6, **axes}
    for vertical, path in (({"state": "omega", "count": 61}, "vertical.count"), ({"state": "phi"}, "vertical.state")):
        response = post("/state-feedback/region", {**request, "vertical": {"low": -1, "high": 1, **vertical}})
        assert response.status_code == 422
        assert response.json()["error"]["path"] == path
    linear = {**request, "plant": {**CART}, "gain": {"method": "poles", "poles": [-1, -2]}}
    response = post("/state-feedback/region", {**linear, "vertical": {"state": "x2", "low": -1, "high": 1, "count": 2}})
    assert "from everywhere" in response.json()["error"]["message"]
