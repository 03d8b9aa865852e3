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


def test_nyquist_answers_the_arcs_that_close_the_curve(post: Any) -> None:
    answer = ask(post, "/nyquist", system("exp(-0.5s)/(s^2(s^2+1))"), NyquistAnswer)
    at_zero, at_one = answer["arcs"]
    assert at_zero == {"omega": 0, "multiplicity": 2, "start_deg": 180, "end_deg": -180, "turn_deg": 360}
    # At j the rest is exp(-0.5j)/(j^2 (2j)): 90 deg less the dead time's 28.6.
    assert at_one["start_deg"] == pytest.approx(180 - 28.64788975654116)
    assert at_one["turn_deg"] == 180


def test_nyquist_says_where_bodes_criterion_misleads(post: Any) -> None:
    """Astrom & Murray, 2nd ed., sec. 10.2: stable, though the curve crosses left of -1 twice."""
    criterion = ask(post, "/nyquist", system("3(s+6)^2/(s(s+1)^2)"), NyquistAnswer)["bode_criterion"]
    assert criterion["explanation"] == (
        "Bode: unstable, for |L| = 12 > 1 at omega_180 = 2. Nyquist: stable. They disagree, and Nyquist is right: "
        "Bode's criterion does not hold here, because there are 2 phase crossovers."
    )
    simple = ask(post, "/nyquist", system("4/(s+1)^3"), NyquistAnswer)["bode_criterion"]
    assert simple["explanation"] == (
        "Bode: stable, for |L| = 0.5 < 1 at omega_180 = 1.732. Nyquist: stable. "
        "The conditions of Bode's criterion are met, and the two agree."
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("8/(s+1)^3", "Bode: on the limit of stability, for |L| = 1 at omega_180 = 1.732."),
        ("1/(s+1)", "Bode: stable, for the phase never crosses -180 deg."),
        ("1/(s^2(s+1))", "Nyquist: unstable. They disagree"),
        ("(s+1)/(s^2(0.1s+1))", "proves nothing here, because L has 2 poles at the origin"),
        ("500 exp(-100s)/(s+1)", "Bode: no verdict"),
    ],
)
def test_what_bodes_criterion_says(post: Any, text: str, words: str) -> None:
    assert words in ask(post, "/nyquist", system(text), NyquistAnswer)["bode_criterion"]["explanation"]


def test_root_locus_in_a_window(post: Any) -> None:
    """Two branches of 1/(s(s+1)(s+2)) meet at -1 + 1/sqrt(3)."""
    meeting = -1 + 3**-0.5
    view = {"re": [meeting - 1e-3, meeting + 1e-3], "im": [-1e-3, 1e-3]}
    answer = ask(post, "/root-locus", {**system("1/(s(s+1)(s+2))"), "view": view}, RootLocusAnswer)
    assert answer["view"] == view
    assert answer["gains"] is None
    assert len(answer["branches"]) == 2
    for branch in answer["branches"]:
        assert len(branch["gains"]) == len(branch["re"]) == len(branch["im"]) > 40
        assert min(abs(s - meeting) for s in branch["re"]) < 1e-12


@pytest.mark.parametrize("re", [[1, 1], [2, 1], [1, 1 + 1e-9], [1], [1, 2, 3]])
def test_a_window_must_be_one(post: Any, re: list[float]) -> None:
    response = post("/root-locus", {**system("1/(s(s+1))"), "view": {"re": re, "im": [-1, 1]}})
    assert response.status_code == 422, response.text
    assert response.json()["error"]["path"].startswith("view")


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
