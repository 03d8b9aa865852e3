"""The labs that come with looplab: each passes its own tests, and gives nothing away."""

from pathlib import Path
from typing import Any

import orjson
import pytest

from looplab.labs import Lab, LabError, Library, grade, read_lab, render_lab, run_tests, validate_lab
from looplab.labs.loader import lab_files

FOLDER = Path(__file__).resolve().parents[2] / "labs"
FILES = list(lab_files(FOLDER).values())


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_it_passes_its_own_tests(path: Path) -> None:
    outcomes = run_tests(read_lab(path))
    assert outcomes
    assert [f"{o.exercise} ({o.case}): {o.message}" for o in outcomes if not o.passed] == []


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_page_gets_no_answers(path: Path) -> None:
    lab = read_lab(path)
    rendered = render_lab(lab)
    forbidden = {"answer", "correct", "solution", "solution_html", "mistakes", "tests", "feedback", "feedback_html"}
    assert forbidden.isdisjoint(_keys(rendered))
    text = orjson.dumps(rendered).decode()
    for exercise in lab.exercises():
        assert exercise.solution not in text


def _keys(value: Any) -> set[str]:
    if isinstance(value, dict):
        return set(value) | {key for inner in value.values() for key in _keys(inner)}
    if isinstance(value, list):
        return {key for inner in value for key in _keys(inner)}
    return set()


# Golden values: notes/ERRATA of the course, ZN for 1/(s+1)^3, to the printed digits.
ZN_GOLDEN: list[tuple[str, Any]] = [
    ("omega-180", 3**0.5),
    ("ultimate-gain", 8),
    ("ultimate-period", 3.6276),
    ("zn-pi", {"Kc": 3.6, "tau_I": 3.0230}),
    ("zn-pid", {"Kc": 4.8, "tau_I": 1.8138, "tau_D": 0.45345}),
    ("zn-pid-measured", {"overshoot_pct": 42.7, "Ms": 2.24}),
]


@pytest.mark.parametrize(("exercise_id", "answer"), ZN_GOLDEN)
def test_the_golden_values_are_right(exercise_id: str, answer: Any) -> None:
    lab = read_lab(FOLDER / "ziegler-nichols-third-order.json")
    exercise = lab.exercise(exercise_id)
    assert exercise is not None
    assert grade(lab, exercise, answer).correct


# --- the library


@pytest.mark.parametrize(
    "lab_id",
    [
        "",
        ".",
        "..",
        "../labs/small",
        "small.json",
        "SMALL",
        "small\n",
        "-small",
        "lab.schema",
        "a" * 65,
        "sm\x00all",
        "%2e%2e",
        "/etc/passwd",
    ],
)
def test_an_id_that_is_none_finds_nothing(tmp_path: Path, data: dict[str, Any], lab_id: str) -> None:
    (tmp_path / "small.json").write_bytes(orjson.dumps(data))
    (tmp_path / "lab.schema.json").write_text("{}")
    assert Library(tmp_path).get(lab_id) is None


def test_a_library_sees_edits_and_outlives_a_broken_lab(tmp_path: Path, data: dict[str, Any]) -> None:
    path = tmp_path / "small.json"
    library = Library(tmp_path)
    assert library.all() == []
    path.write_bytes(orjson.dumps(data))
    (tmp_path / "broken.json").write_text("{")
    assert [lab.id for lab in library.all()] == ["small"]
    with pytest.raises(LabError, match=r"broken\.json: not JSON"):
        library.get("broken")
    path.write_bytes(orjson.dumps({**data, "title": "Another title"}))
    lab = library.get("small")
    assert lab is not None
    assert lab.title == "Another title"


def test_the_name_of_the_file_is_the_id(tmp_path: Path, data: dict[str, Any]) -> None:
    path = tmp_path / "other.json"
    path.write_bytes(orjson.dumps(data))
    with pytest.raises(LabError, match=r"id: 'small' is not the name of the file"):
        read_lab(path)


# --- self-tests find what is wrong


def _messages(lab: Lab) -> list[str]:
    return [outcome.message for outcome in run_tests(lab) if not outcome.passed]


def test_the_small_lab_is_in_order(lab: Lab) -> None:
    assert _messages(lab) == []


@pytest.mark.parametrize(
    ("test", "said"),
    [
        ({"case": "author", "answer": 7}, "marked wrong"),
        ({"case": "mistake", "answer": 8, "feedback": "ratio"}, "marked correct"),
        ({"case": "mistake", "answer": 18.06, "feedback": "Wonderful"}, "lacks 'Wonderful'"),
        ({"case": "blank", "answer": 0}, "not blank"),
        ({"case": "wrong", "answer": 8}, "marked correct"),
        ({"case": "wrong", "answer": {"Kx": 1}}, "could not be graded"),
    ],
)
def test_a_test_that_fails_is_reported(data: dict[str, Any], test: dict[str, Any], said: str) -> None:
    data["parts"][0]["blocks"][1]["tests"].append(test)
    messages = _messages(validate_lab(data))
    assert len(messages) == 1
    assert said in messages[0]


def test_a_case_without_a_test_is_reported(data: dict[str, Any]) -> None:
    tests = data["parts"][0]["blocks"][1]["tests"]
    tests[3] = {"case": "blank", "answer": ""}
    assert _messages(validate_lab(data)) == ["there is no test of the case 'wrong'"]


def test_a_mistake_that_is_right_is_reported(data: dict[str, Any]) -> None:
    data["parts"][0]["blocks"][1]["fields"][0]["mistakes"].append(
        {"answer": {"value": 8.01, "source": "a slip"}, "feedback": "Never said."}
    )
    (message,) = _messages(validate_lab(data))
    assert "cannot be told from the right answer" in message


def test_tests_that_take_too_long_are_cut_short(lab: Lab) -> None:
    outcomes = run_tests(lab, seconds=0)
    assert len(outcomes) == 2
    assert "not run" in outcomes[-1].message
    assert not outcomes[-1].passed


def test_a_number_that_does_not_exist_is_reported(data: dict[str, Any]) -> None:
    data["bench"]["plant"] = {"type": "fopdt", "K": 1, "tau": 1, "theta": 0}
    assert any("no ultimate gain" in message for message in _messages(validate_lab(data)))


# --- what the page gets


def test_what_is_rendered(lab: Lab) -> None:
    rendered = render_lab(lab)
    blocks = rendered["parts"][0]["blocks"]
    assert [block["type"] for block in blocks] == ["text", "number", "number", "choice", "transfer_function", "design"]
    assert [block.get("number") for block in blocks] == [None, 1, 2, 3, 4, 5]
    assert blocks[1]["fields"][0]["tolerance_text"] == "within 1 %"
    assert blocks[2]["fields"][1]["tolerance_text"] == "within 0.05 s"
    assert [spec["text"] for spec in blocks[5]["specifications"]] == [
        "overshoot at most 25 %",
        "sensitivity peak Ms at most 2",
        "gain margin at least 2",
    ]
    slider = rendered["bench"]["sliders"][1]
    assert slider["unit"] == "s"
    assert slider["value"] is None
    assert slider["symbol_mathml"].startswith("<math>")
