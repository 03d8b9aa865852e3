"""POST /routh and POST /stability: the notes' examples, exactly; every shape as described; refusals in the one form."""

from typing import Any

import numpy as np
import pytest
import schemathesis
from hypothesis import HealthCheck, settings

from looplab.api.answers.stability import RouthAnswer, StabilityAnswer
from looplab.api.app import create_app

schema = schemathesis.openapi.from_asgi("/api/v1/openapi.json", create_app())


def loop(plant: str, **controller: Any) -> dict[str, Any]:
    C = controller if "type" in controller else {"type": "pid", **controller}
    return {"plant": {"type": "expr", "text": plant}, "controller": C}


@pytest.fixture
def routh(post: Any) -> Any:
    def ask(**request: Any) -> dict[str, Any]:
        answer = post("/routh", request)
        assert answer.status_code == 200, answer.text
        RouthAnswer.model_validate_json(answer.content)
        body: dict[str, Any] = answer.json()
        for name, value in body.items():
            assert value is not None or name in body["reasons"], name
        return body

    return ask


@pytest.fixture
def stability(post: Any) -> Any:
    def ask(**request: Any) -> dict[str, Any]:
        answer = post("/stability", request)
        assert answer.status_code == 200, answer.text
        StabilityAnswer.model_validate_json(answer.content)
        return answer.json()

    return ask


def test_a_polynomial_with_a_zero_row(routh: Any) -> None:
    answer = routh(polynomial=[1, 2, 24, 48, -25, -50])
    assert [row["label"] for row in answer["array"]] == ["s^5", "s^4", "s^3", "s^2", "s^1", "s^0"]
    assert answer["array"][2]["kind"] == "auxiliary"
    assert answer["array"][4]["texts"] == ["338/3"]
    assert answer["auxiliary_polynomials"] == [
        {"degree": 4, "coefficients": [2, 0, 48, 0, -50], "text": "2 s^4 + 48 s^2 - 50"}
    ]
    assert (answer["sign_changes"], answer["rhp_roots"], answer["imaginary_axis_roots"], answer["lhp_roots"]) == (
        1,
        1,
        2,
        2,
    )
    assert not answer["stable"]
    assert answer["exact"]
    assert answer["polynomial_text"] == "s^5 + 2 s^4 + 24 s^3 + 48 s^2 - 25 s - 50"


@pytest.mark.parametrize(("Kc", "counts"), [(4, (0, 0, 3)), (8, (0, 2, 1)), (9, (2, 0, 1))])
def test_three_lags(routh: Any, Kc: float, counts: tuple[int, int, int]) -> None:
    answer = routh(loop=loop("1/(s+1)^3", Kc=Kc))
    assert (answer["rhp_roots"], answer["imaginary_axis_roots"], answer["lhp_roots"]) == counts
    (r,) = answer["gain_ranges"]
    assert (r["low"], r["high"]) == pytest.approx((0, 8), rel=1e-12)
    assert r["high_omega"] == pytest.approx([3**0.5], rel=1e-12)
    assert answer["gain"] == {"name": "Kc", "value": Kc, "in_range": Kc < 8}
    assert routh(loop=loop("1/(s+1)^3", Kc=0))["gain"]["in_range"]
    assert not routh(loop=loop("1/s", Kc=0))["gain"]["in_range"]
    (r,) = routh(loop=loop("1/(s+1)^3", Kc=Kc), negative=True)["gain_ranges"]
    assert r["low"] == pytest.approx(-1)


def test_a_direct_acting_controller_has_negative_gains(routh: Any) -> None:
    answer = routh(loop=loop("-1/(s+1)^3", Kc=4, action="direct"))
    assert answer["gain"]["value"] == -4
    assert answer["gain"]["in_range"]
    assert answer["gain_ranges"][0]["low"] == pytest.approx(-8)


def test_dead_time_has_no_array_but_ranges(routh: Any) -> None:
    answer = routh(loop=loop("exp(-s)/s", Kc=1))
    assert answer["array"] is None
    assert "no polynomial" in answer["reasons"]["array"]
    assert answer["rhp_roots"] == 0
    assert answer["stable"]
    assert answer["gain_ranges"][0]["high"] == pytest.approx(np.pi / 2, rel=1e-12)


def test_a_marginal_loop_with_dead_time(routh: Any) -> None:
    answer = routh(loop=loop("exp(-s)/s", Kc=np.pi / 2))
    assert not answer["stable"]
    assert "imaginary axis" in answer["because"]


def test_no_gain_at_all(routh: Any) -> None:
    answer = routh(loop=loop("(s+3)/(s^2*(s+2)*(s+4)*(s^2+2s+9)*(s^3+5))", Kc=1))
    assert answer["gain_ranges"] == []
    assert answer["reasons"]["gain_ranges"] == "no gain stabilises the loop"
    assert answer["rhp_roots"] >= 2


def test_PI_region_of_the_notes(routh: Any) -> None:
    answer = routh(loop=loop("1/(s^2+2s+2)", Kc=1, tau_I=0.25), tau_I=[0.1, 0.25, 0.4, 0.5, 2.0])
    highs = [cut["gain_ranges"][0]["high"] for cut in answer["pi_region"]["cuts"]]
    assert highs[:3] == pytest.approx([0.5, 2, 8], rel=1e-9)
    assert highs[3:] == [None, None]
    curve = answer["pi_region"]["boundary"]
    tau_I, Kc = np.array(curve["tau_I"]), np.array(curve["Kc"])
    assert (tau_I > 0).all() and (Kc > 0).all() and Kc.size > 20
    np.testing.assert_allclose(Kc, 4 / (1 / tau_I - 2), rtol=1e-6)


def test_expansion_that_loses_the_digits_is_not_shown(routh: Any) -> None:
    # The first crossing, at tan(pi/50), is for Kc = 1/cos(pi/50)^50 = 1.1038.
    for Kc, right in ((1.1, 0), (1.11, 2)):
        answer = routh(loop=loop("1/(s+1)^50", Kc=Kc))
        assert answer["array"] is None
        assert answer["stable"] is answer["gain"]["in_range"] is (right == 0)
        assert [answer[f"{side}_roots"] for side in ("rhp", "imaginary_axis", "lhp")] == [right, 0, 50 - right]


def test_the_hidden_mode_of_the_notes(stability: Any) -> None:
    answer = stability(loop=loop("3/((s+4)(s-4))", type="expr", text="(s-4)/s"))
    assert answer["verdict"] == "unstable"
    assert answer["bibo"]["stable"]
    inside = answer["internal"]
    assert not inside["internally_stable"]
    assert sorted(p[0] for p in inside["PS"]["poles"]) == pytest.approx([-3, -1, 4])
    assert sorted(p[0] for p in inside["T"]["poles"]) == pytest.approx([-3, -1])
    (hidden,) = inside["cancellations"]
    assert (hidden["root"], hidden["zero_of"], hidden["pole_of"], hidden["seen_in"]) == (
        [4, 0],
        "controller",
        "plant",
        ["PS"],
    )


@pytest.mark.parametrize(
    ("plant", "C", "verdict", "stable"),
    [
        ("1/(s+1)^3", {"Kc": 4}, "stable", True),
        ("1/(s+1)^3", {"Kc": 8}, "marginal", False),
        ("1/(s+1)^3", {"Kc": 9}, "unstable", False),
        ("exp(-s)/s", {"Kc": 1}, "stable", True),
        ("exp(-s)/s", {"Kc": 2}, "unstable", False),
        ("s exp(-s)/(s+1)^2", {"type": "expr", "text": "0.1/s"}, "marginal", False),
        ("1/(s-1)", {"Kc": 0}, "unstable", False),
        ("1/s^2", {"Kc": 1}, "marginal", False),
        ("1/s^2", {"Kc": 0}, "unstable", False),
        ("exp(-s)/s", {"Kc": np.pi / 2}, "marginal", False),
    ],
)
def test_loops(stability: Any, plant: str, C: dict[str, Any], verdict: str, stable: bool) -> None:
    answer = stability(loop=loop(plant, **C))
    assert answer["verdict"] == verdict
    assert answer["asymptotically_stable"] == stable == answer["internal"]["internally_stable"]
    assert answer["lyapunov_stable"] == (verdict != "unstable")
    assert answer["because"]


@pytest.mark.parametrize(
    ("A", "verdict", "geometric"),
    [([[0, 1], [0, 0]], "unstable", 1), ([[0, 0], [0, 0]], "marginal", 2), ([[-1]], "stable", None)],
)
def test_matrices(stability: Any, A: list[list[float]], verdict: str, geometric: int | None) -> None:
    answer = stability(A=A)
    assert answer["verdict"] == verdict
    assert [m["geometric"] for m in answer["axis_modes"]] == ([] if geometric is None else [geometric])
    assert answer["bibo"] is None
    assert "B and C" in answer["reasons"]["bibo"]


def test_resonance(stability: Any) -> None:
    for request in (
        {"system": {"type": "expr", "text": "1/(s^2+1)"}},
        {"A": [[-1, -2], [1, 1]], "B": [[1], [1]], "C": [[1, 0]]},
    ):
        answer = stability(**request)
        assert answer["verdict"] == "marginal"
        assert not answer["bibo"]["stable"]
        assert answer["bibo"]["unbounded"]["u"] == "sin(t)"
        assert answer["internal"] is None


@pytest.mark.parametrize(
    ("route", "request_", "path"),
    [
        ("/routh", {}, ""),
        ("/routh", {"polynomial": []}, "polynomial"),
        ("/routh", {"polynomial": [0, 0]}, "polynomial"),
        ("/routh", {"polynomial": [1, 2], "loop": loop("1/s", Kc=1)}, ""),
        ("/routh", {"loop": loop("1/s", Kc=1), "tau_I": [1]}, "loop.controller"),
        ("/routh", {"loop": loop("0", Kc=1, tau_I=1), "tau_I": [1]}, "loop.plant"),
        ("/routh", {"loop": loop("s", Kc=1)}, "loop.plant"),
        ("/routh", {"polynomial": [1, 2], "tau_I": [1]}, ""),
        ("/stability", {}, ""),
        ("/stability", {"A": [[1, 2]]}, "A"),
        ("/stability", {"A": [[1, 2], [3]]}, "A"),
        ("/stability", {"A": [[1]], "B": [[1]]}, ""),
        ("/stability", {"A": [[1]], "B": [[1], [2]], "C": [[1]]}, "B"),
        ("/stability", {"system": {"type": "expr", "text": "1/("}}, "system.text"),
    ],
)
def test_refusals(post: Any, route: str, request_: dict[str, Any], path: str) -> None:
    answer = post(route, request_)
    assert answer.status_code == 422, answer.text
    assert answer.json()["error"]["path"] == path
    assert answer.json()["error"]["message"]


# Coefficients of 1e-173 overflow in a quotient that is then refused as not finite.
@pytest.mark.filterwarnings("ignore:overflow:RuntimeWarning")
@schema.include(path_regex="/api/v1/(routh|stability)$").parametrize()
@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
def test_generated_requests(case: Any) -> None:
    response = case.call()
    assert response.status_code in (200, 400, 405, 422), response.text
    case.validate_response(response, checks=[schemathesis.checks.not_a_server_error])
