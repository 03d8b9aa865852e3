"""POST /state-space, and state-space systems wherever a system is taken."""

from typing import Any

import pytest

from looplab.api.answers.state_space import StateSpaceAnswer

TANKS = {"A": [[-1, 0], [1, -2]], "B": [[1], [0]], "C": [[0, 1]]}


def ask(post: Any, **request: Any) -> dict[str, Any]:
    answer = post("/state-space", request)
    assert answer.status_code == 200, answer.text
    StateSpaceAnswer.model_validate_json(answer.content)
    return answer.json()


def test_two_tanks(post: Any) -> None:
    found = ask(post, model=TANKS)
    assert sorted(p[0] for p in found["poles"]) == [-2, -1]
    assert found["stability"]["verdict"] == "stable" and found["stability"]["lyapunov_stable"]
    assert found["controllability"]["matrix"] == [[1, -1], [0, 1]]
    assert found["controllability"]["rank"] == found["observability"]["rank"] == 2
    assert found["minimal"] and found["gramians"]["reason"] is None
    assert found["gramians"]["controllability"][0][0] == pytest.approx(0.5)
    (channel,) = found["transfer_functions"]
    assert channel["system"]["text"] == "1/((s + 1) (s + 2))"
    assert "bmatrix" in found["latex"] and found["mathml"].startswith("<math")


def test_an_equation_with_a_hidden_mode(post: Any) -> None:
    found = ask(post, equation={"a": [1, 3, 2], "b": [1, 1], "form": "controllable"})
    assert found["A"] == [[0, 1], [-2, -3]]
    assert found["controllability"]["full"] and not found["observability"]["full"]
    assert [m["pole"] for m in found["modes"] if not m["observable"]] == [[pytest.approx(-1), 0]]
    (channel,) = found["transfer_functions"]
    assert channel["minimal"]["text"] == "1/(s + 2)"
    assert [c["pole"][0] for c in channel["cancelled"]] == [pytest.approx(-1)]
    assert channel["cancel_tolerance"] == 1e-8
    smallest = found["minimal_realization"]
    assert smallest["A"] == [[pytest.approx(-2)]] and smallest["D"] == [[0]]
    assert smallest["C"][0][0] * smallest["B"][0][0] == pytest.approx(1)


@pytest.mark.parametrize(
    ("text", "verdict", "word"),
    [
        ("1/(s+1)", "stable", "-1"),
        ("5", "stable", "no states"),
        ("1/s", "marginal", "0"),
        ("1/(s^2+4)", "marginal", "2j"),
        ("1/s^2", "unstable", "0"),
        ("1/(s-3)", "unstable", "3"),
    ],
)
def test_verdicts(post: Any, text: str, verdict: str, word: str) -> None:
    found = ask(post, system={"type": "expr", "text": text})
    assert found["stability"]["verdict"] == verdict
    assert word in found["stability"]["because"]
    assert (found["gramians"]["controllability"] is None) == (verdict != "stable")


def test_two_separate_integrators_are_marginal_and_two_in_a_row_are_not(post: Any) -> None:
    ends = {"B": [[1], [1]], "C": [[1, 1]]}
    assert ask(post, model={"A": [[0, 0], [0, 0]], **ends})["stability"]["lyapunov_stable"]
    assert not ask(post, model={"A": [[0, 1], [0, 0]], **ends})["stability"]["lyapunov_stable"]


def test_several_inputs_and_outputs(post: Any) -> None:
    found = ask(post, model={"A": [[-1, 0], [0, -2]], "B": [[1, 0], [0, 1]], "C": [[1, 0], [0, 1]], "D": [[0, 0]] * 2})
    texts = [(c["output"], c["input"], c["minimal"] and c["minimal"]["text"]) for c in found["transfer_functions"]]
    assert texts == [(0, 0, "1/(s + 1)"), (0, 1, None), (1, 0, None), (1, 1, "1/(s + 2)")]
    assert found["transfer_functions"][1]["reason"] == "this input does not reach this output"


def test_a_static_gain(post: Any) -> None:
    found = ask(post, model={"A": [], "B": [], "C": [], "D": [[3]]})
    assert found["poles"] == [] and found["transfer_functions"][0]["gain"] == 3


@pytest.mark.parametrize(
    ("request_", "path"),
    [
        ({"model": {"A": [[1, 2]], "B": [[1]], "C": [[1]]}}, "model.A"),
        ({"model": {"A": [[1]], "B": [[1], [1]], "C": [[1]]}}, "model.B"),
        ({"model": {"A": [[1]], "B": [[1]], "C": [[1]], "D": [[1, 2]]}}, "model.D"),
        ({"model": {"A": [], "B": [], "C": []}}, "model.B"),
        ({"model": {"A": [[1]], "B": [[1] * 5], "C": [[1]] * 5}}, "model.B"),
        ({"equation": {"a": [1, 1], "b": [1, 0, 0]}}, "equation.b"),
        ({"equation": {"a": [0], "b": [1]}}, "equation.a"),
        ({"system": {"type": "expr", "text": "s"}}, "system"),
        ({}, ""),
        ({"model": TANKS, "equation": {"a": [1], "b": [1]}}, ""),
    ],
)
def test_refusals_name_the_place(post: Any, request_: dict[str, Any], path: str) -> None:
    answer = post("/state-space", request_)
    assert answer.status_code == 422, answer.text
    assert answer.json()["error"]["path"] == path


def test_a_state_space_is_a_system_everywhere(post: Any) -> None:
    """1/((s+1)(s+2)) as matrices gives the loop that it gives as text."""

    def loop(plant: dict[str, Any]) -> Any:
        body = {"loop": {"plant": plant, "controller": {"type": "pid", "Kc": 2, "tau_I": 1}}, "horizon": 10}
        answer = post("/loop", body)
        assert answer.status_code == 200, answer.text
        return answer.json()

    matrices = loop({"type": "ss", **TANKS, "theta": 0.3})
    text = loop({"type": "expr", "text": "exp(-0.3s)/((s+1)(s+2))"})
    assert matrices["panels"]["step"]["setpoint"]["y"] == pytest.approx(text["panels"]["step"]["setpoint"]["y"])
    assert matrices["panels"]["margins"]["GM"] == pytest.approx(text["panels"]["margins"]["GM"])
    assert "bmatrix" in matrices["plant"]["latex"]


def test_a_hidden_unstable_mode_is_not_lost(post: Any) -> None:
    """The mode at +1 cannot be seen from outside; the loop is unstable all the same."""
    plant = {"type": "ss", "A": [[1, 0], [0, -2]], "B": [[0], [1]], "C": [[1, 1]]}
    answer = post("/loop", {"loop": {"plant": plant, "controller": {"type": "pid", "Kc": 1}}, "want": ["verdict"]})
    assert answer.json()["panels"]["verdict"]["verdict"] == "unstable"


def test_a_controller_as_matrices(post: Any) -> None:
    loop = {"plant": {"type": "expr", "text": "1/(s+1)"}, "controller": {"type": "ss", "A": [[0]], "B": [[1]],
            "C": [[0.5]], "D": [[2]]}}  # fmt: skip
    answer = post("/loop", {"loop": loop, "want": ["verdict"]})
    assert answer.json()["controller"]["text"] == "2 (s + 0.25)/s"
