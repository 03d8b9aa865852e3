"""/frequency, /margins, /nyquist and /root-locus: values of the notes, the shapes described, bad input."""

from typing import Any

import pytest

from looplab.api.answers.base import Error
from looplab.api.answers.frequency import FrequencyAnswer
from looplab.api.answers.loop import MarginsAnswer, NyquistAnswer, RootLocusAnswer


def system(text: str) -> dict[str, Any]:
    return {"system": {"type": "expr", "text": text}}


def ask(post: Any, route: str, body: dict[str, Any], shape: Any) -> dict[str, Any]:
    response = post(route, body)
    assert response.status_code == 200, response.text
    shape.model_validate_json(response.content)
    answer: dict[str, Any] = response.json()
    return answer


def test_frequency_of_a_lag(post: Any) -> None:
    answer = ask(post, "/frequency", {**system("1/(2s+1)"), "omega": [0.05, 0.5, 5.0]}, FrequencyAnswer)
    assert answer["mag_dB"][1] == pytest.approx(-3.0102999566398, abs=1e-10)
    assert answer["phase_deg"][1] == pytest.approx(-45)
    assert answer["bandwidth"]["omega"] == pytest.approx(0.5)
    (corner,) = answer["asymptotes"]["corners"]
    assert corner == {
        "omega": 0.5, "kind": "pole", "s": [-0.5, 0], "multiplicity": 1, "zeta": None, "slope_change": -1,
        "phase_change_deg": -90, "phase_from": pytest.approx(0.05), "phase_to": pytest.approx(5),
    }  # fmt: skip


def test_margins_of_the_notes(post: Any) -> None:
    """Section 17.3.1: GM = 5 dB on exp(-0.1 s)/(0.5 s + 1) gives Kc = 4.781, PM 48.5 deg."""
    answer = ask(post, "/margins", system("4.781 exp(-0.1s)/(0.5s+1)"), MarginsAnswer)
    assert round(answer["GM_dB"], 2) == 5.00
    assert round(answer["PM_deg"], 1) == 48.5
    assert answer["closed_loop_stable"] is True


def test_a_hidden_mode_is_seen_where_plant_and_controller_are_known(post: Any) -> None:
    loop = {"plant": {"type": "expr", "text": "3/((s+4)(s-4))"}, "controller": {"type": "expr", "text": "(s-4)/s"}}
    assert ask(post, "/margins", {"loop": loop}, MarginsAnswer)["closed_loop_stable"] is False


def test_nyquist_of_an_unstable_plant(post: Any) -> None:
    answer = ask(post, "/nyquist", system("2/(s-1)"), NyquistAnswer)
    assert (answer["N"], answer["P"], answer["Z"]) == (-1, 1, 0)
    assert answer["explanation"] == (
        "Z = N + P = -1 + 1 = 0: the curve turns around -1 once counter-clockwise, "
        "L has one pole in the right half-plane"
    )


def test_root_locus_with_dead_time(post: Any) -> None:
    answer = ask(post, "/root-locus", system("exp(-s)/s"), RootLocusAnswer)
    assert answer["complete"] is True
    assert answer["breakaways"][0]["s"][0] == pytest.approx(-1)
    assert answer["imaginary_axis_crossings"][0]["K"] == pytest.approx(1.5707963267948966)


def test_root_locus_for_negative_gains(post: Any) -> None:
    answer = ask(post, "/root-locus", {**system("1/(s+1)^3"), "gains": "negative"}, RootLocusAnswer)
    assert answer["asymptotes"]["angles_deg"] == [0, 120, 240]
    assert answer["imaginary_axis_crossings"] == [{"omega": 0, "K": pytest.approx(1)}]


@pytest.mark.parametrize("route", ["/frequency", "/margins", "/nyquist", "/root-locus"])
@pytest.mark.parametrize(
    "body",
    [{}, {"system": {"type": "expr", "text": "s"}}, {"system": {"type": "expr", "text": "1/q"}}, {"x": 1},
     {**system("1/s"), "loop": {}}, {"system": {"type": "zpk", "poles": [-1] * 51}},
     {"system": {"type": "fopdt", "K": 1, "tau": 1, "theta": -1}}],
    ids=str,
)  # fmt: skip
def test_bad_input(post: Any, route: str, body: dict[str, Any]) -> None:
    response = post(route, body)
    assert response.status_code == 422, response.text
    Error.model_validate_json(response.content)


def test_frequencies_must_increase(post: Any) -> None:
    response = post("/frequency", {**system("1/s"), "omega": [2, 1]})
    assert response.status_code == 422
    assert response.json()["error"]["path"] == "omega"
