"""Grading measures; it never looks an answer up in a table."""

import math
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from looplab.engine.errors import EngineError, InvalidInput
from looplab.labs import Lab, Result, grade, validate_lab
from looplab.labs.grading.quantity import read_number, show, show_beside


def answer(lab: Lab, exercise_id: str, given: Any) -> Result:
    exercise = lab.exercise(exercise_id)
    assert exercise is not None
    return grade(lab, exercise, given)


# --- numbers


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1.73", 1.73),
        (" 1,73 ", 1.73),
        ("1.73 rad/s", 1.73),
        ("1.73rad/s", 1.73),
        ("-2", -2.0),
        ("\N{MINUS SIGN}2", -2.0),
        ("+.5", 0.5),
        ("3.", 3.0),
        ("1e-3", 0.001),
        ("1.2.3", None),
        ("1,000.5", None),
        ("1,2,3", None),
        ("sqrt(3)", None),
        ("NaN", None),
        ("inf", None),
        ("1e999", None),
        ("1_000", None),
        ("0x10", None),
        ("٣", None),
        ("2 s", None),
        ("9" * 100, None),
    ],
)
def test_a_typed_number(text: str, value: float | None) -> None:
    assert read_number(text, "rad/s") == value


@pytest.mark.parametrize("given", [8, 8.0, "8", "8.0", " 8,0 ", {"Ku": 8}, {"Ku": "8"}, 8.08, 7.92])
def test_a_right_number(lab: Lab, given: Any) -> None:
    result = answer(lab, "ku", given)
    assert result.correct
    assert result.score == 1
    assert result.checks[0].passed


@pytest.mark.parametrize("given", [8.09, 7.91, -8, 0, "1e300"])
def test_a_wrong_number(lab: Lab, given: Any) -> None:
    result = answer(lab, "ku", given)
    assert result.status == "wrong"
    assert result.score == 0
    assert "within 1 %" in result.feedback_html


def test_a_typical_mistake_is_told_what_it_is(lab: Lab) -> None:
    assert "As a ratio" in answer(lab, "ku", 20 * math.log10(8)).feedback_html


@pytest.mark.parametrize("given", [None, "", "  ", {}, {"Ku": None}, {"Ku": ""}])
def test_a_blank(lab: Lab, given: Any) -> None:
    assert answer(lab, "ku", given).status == "blank"


@pytest.mark.parametrize("given", ["eight", "8 apples", "<script>", "\x00", "9" * 5000])
def test_what_is_no_number_is_said_kindly(lab: Lab, given: str) -> None:
    result = answer(lab, "ku", given)
    assert result.status == "unreadable"
    assert "cannot be read" in result.feedback_html
    assert "script" not in result.feedback_html


def test_several_numbers_earn_a_share_each(lab: Lab) -> None:
    result = answer(lab, "pi", {"Kc": "3.6", "tau_I": 4.353})
    assert result.status == "partly"
    assert result.score == 0.5
    assert [check.passed for check in result.checks] == [True, False]
    assert "Divide instead" in result.checks[1].feedback_html
    assert answer(lab, "pi", {"Kc": 3.6}).checks[1].text.endswith("Still empty.")


def test_an_absolute_tolerance(lab: Lab) -> None:
    assert answer(lab, "pi", {"Kc": 3.6, "tau_I": 3.073}).correct
    assert not answer(lab, "pi", {"Kc": 3.6, "tau_I": 3.0731}).correct


@pytest.mark.parametrize("given", [[8], True, {"Kx": 8}, {"Ku": [8]}, {"Ku": True}, {"Ku": {"Ku": 8}}])
def test_an_answer_of_another_shape_is_an_error(lab: Lab, given: Any) -> None:
    with pytest.raises(InvalidInput) as caught:
        answer(lab, "ku", given)
    assert (caught.value.field or "").startswith("answer")


def test_one_number_for_several_fields_is_an_error(lab: Lab) -> None:
    with pytest.raises(InvalidInput):
        answer(lab, "pi", 3.6)


# --- choice


def test_a_choice(lab: Lab) -> None:
    assert answer(lab, "why", "a").correct
    assert answer(lab, "why", ["a"]).correct
    assert answer(lab, "why", "b").feedback_html == "<p>Think again.</p>\n"
    assert answer(lab, "why", []).status == "blank"
    for wrong in ("z", ["a", "b"], 3, {"a": 1}, [["a"]]):
        with pytest.raises(InvalidInput):
            answer(lab, "why", wrong)


def test_a_choice_of_several(data: dict[str, Any]) -> None:
    choice = data["parts"][0]["blocks"][3]
    choice["several"] = True
    choice["options"][1]["correct"] = True
    lab = validate_lab(data)
    assert answer(lab, "why", ["b", "a"]).correct
    assert answer(lab, "why", ["a"]).status == "partly"
    assert answer(lab, "why", ["a", "b", "c"]).status == "wrong"


# --- transfer functions


@pytest.mark.parametrize(
    "text",
    [
        "2 exp(-0.5 s)/((s+1)(s+3))",
        "2 exp(-0.5 s)/(s^2+4s+3)",
        "(2/3) exp(-0.5s)/((s+1)(s/3+1))",
        "2(s+7) exp(-0.5 s)/((s+1)(s+3)(s+7))",
        "2.001 exp(-0.5 s)/((s+1)(s+3))",
    ],
)
def test_however_it_is_written(lab: Lab, text: str) -> None:
    assert answer(lab, "system", text).correct


@pytest.mark.parametrize(
    "text",
    [
        "2 exp(-0.501 s)/((s+1)(s+3))",
        "2.01 exp(-0.5 s)/((s+1)(s+3))",
        "2 exp(-0.5 s)/((s-1)(s+3))",
        "-2 exp(-0.5 s)/((s+1)(s+3))",
        "2 exp(-0.5 s)/((s+1)(s+3)(1e-3 s+1))",
        "0",
        "exp(-0.5 s)",
        "1/s",
        "s",
    ],
)
def test_another_system(lab: Lab, text: str) -> None:
    result = answer(lab, "system", text)
    assert result.status == "wrong"
    assert "another system" in result.feedback_html


def test_it_says_what_already_fits(lab: Lab) -> None:
    checks = {check.name: check.passed for check in answer(lab, "system", "2 exp(-0.5 s)/(s^2+5s+3)").checks}
    assert checks == {"gain": True, "order": True, "theta": True}
    assert "dead time" in answer(lab, "system", "2/((s+1)(s+3))").feedback_html.lower()


@pytest.mark.parametrize(
    "text", ["2/(s+1", "two", "1/0", "__import__('os')", "s^999", "9^9^9", "<b>", "\x00", "(" * 400]
)
def test_what_is_no_transfer_function(lab: Lab, text: str) -> None:
    result = answer(lab, "system", text)
    assert result.status == "unreadable"
    assert "<b>" not in result.feedback_html.replace("<p>", "")


def test_a_transfer_function_is_text(lab: Lab) -> None:
    with pytest.raises(InvalidInput):
        answer(lab, "system", {"type": "tf", "num": [1], "den": [1]})


# --- design


def test_a_design_that_meets_everything(lab: Lab) -> None:
    result = answer(lab, "design", {"Kc": 4.8, "tau_I": 3, "tau_D": 0.8})
    assert result.correct
    assert [check.name for check in result.checks] == ["closed_loop_stable", "overshoot_pct", "Ms", "GM"]
    overshoot, Ms = result.checks[1], result.checks[2]
    assert overshoot.measured == pytest.approx(20.2, abs=0.05)
    assert overshoot.limit == 25
    assert Ms.measured == pytest.approx(1.778, abs=0.001)


def test_the_settings_of_the_rule_do_not(lab: Lab) -> None:
    """Golden values of the rule on 1/(s+1)^3: overshoot 42.7 %, Ms 2.24."""
    result = answer(lab, "design", {"Kc": 4.8, "tau_I": 1.8138, "tau_D": 0.45345})
    assert result.status == "wrong"
    assert result.score == 0
    measured = {check.name: check.measured for check in result.checks}
    assert measured["overshoot_pct"] == pytest.approx(42.7, abs=0.05)
    assert measured["Ms"] == pytest.approx(2.24, abs=0.005)
    assert "Too lively" in result.checks[1].feedback_html
    assert "42.7 %, at most 25 %: not met" in result.checks[1].text


def test_an_unstable_design_is_measured_no_further(lab: Lab) -> None:
    result = answer(lab, "design", {"Kc": 9})
    assert result.status == "wrong"
    assert not any(check.passed for check in result.checks)
    assert result.checks[1].measured is None
    assert "unstable" in result.checks[1].text


def test_a_margin_that_is_infinite_is_large_enough(data: dict[str, Any]) -> None:
    data["bench"]["plant"] = {"type": "fopdt", "K": 1, "tau": 1, "theta": 0}
    result = answer(validate_lab(data), "design", {"Kc": 2})
    gain_margin = result.checks[3]
    assert gain_margin.passed
    assert gain_margin.measured is None
    assert "infinite" in gain_margin.text


def test_settings_left_out_stay_as_the_bench_opens(lab: Lab) -> None:
    a = answer(lab, "design", {"Kc": 2})
    b = answer(lab, "design", {"Kc": 2, "tau_I": None, "tau_D": None})
    assert a == b


@pytest.mark.parametrize("given", [None, {}])
def test_a_bench_that_was_not_touched(lab: Lab, given: Any) -> None:
    assert answer(lab, "design", given).status == "blank"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"Kc": 21}, "outside 0.1 to 20"),
        ({"Kc": None}, "cannot be switched off"),
        ({"Kc": "much"}, "not a number"),
        ({"Kc": 1e300}, "outside"),
        ({"tau_I": 0}, "outside"),
    ],
)
def test_a_setting_that_the_bench_does_not_have(lab: Lab, given: Any, said: str) -> None:
    result = answer(lab, "design", given)
    assert result.status == "unreadable"
    assert said in result.feedback_html


@pytest.mark.parametrize("given", [3, "Kc=3", [1, 2], {"alpha": 0.1}, {"Kc": True}, {"Kc": [1]}])
def test_a_design_of_another_shape_is_an_error(lab: Lab, given: Any) -> None:
    with pytest.raises(InvalidInput):
        answer(lab, "design", given)


# --- anything


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=12),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["Ku", "Kc", "tau_I", "x"]), inner, max_size=3)
    ),
    max_leaves=6,
)


@given(exercise_id=st.sampled_from(["ku", "pi", "why", "system", "design"]), anything=JSON)
@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_answer_gets_a_verdict_or_a_clear_error(lab: Lab, exercise_id: str, anything: Any) -> None:
    with suppress(EngineError):
        result = answer(lab, exercise_id, anything)
        assert 0 <= result.score <= 1
        assert result.correct == (result.score == 1)
        assert all(check.measured is None or math.isfinite(check.measured) for check in result.checks)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (8, "8"),
        (1.7320508, "1.73"),
        (0.25, "0.25"),
        (1234.5, "1234"),
        (-2.5, "\N{MINUS SIGN}2.5"),
        (0, "0"),
        (1e9, "1.00e+9"),
    ],
)
def test_a_number_is_shown_as_people_write_it(value: float, text: str) -> None:
    assert show(value).replace("e+09", "e+9") == text


def test_a_value_just_past_its_limit_shows_it() -> None:
    assert show_beside(25.003, 25) == "25.003"
    assert show_beside(42.7345, 25) == "42.7"
    assert show_beside(25, 25) == "25"
