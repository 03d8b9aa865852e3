"""The schema says yes to a lab, and no with the place and the reason to everything else."""

import re
from pathlib import Path
from typing import Any

import pytest

from looplab.labs import LabError, validate_lab
from looplab.labs.loader import lab_files, parse_lab
from looplab.labs.schema import json_schema
from looplab.schemas.schema_file import schema_text


def exercise(data: dict[str, Any], exercise_id: str) -> dict[str, Any]:
    return next(block for block in data["parts"][0]["blocks"] if block.get("id") == exercise_id)


def problems(data: Any) -> list[str]:
    with pytest.raises(LabError) as caught:
        validate_lab(data, "small.json")
    return [str(problem) for problem in caught.value.problems]


def test_the_small_lab_is_a_lab(data: dict[str, Any]) -> None:
    assert validate_lab(data).id == "small"


def test_a_text_may_be_its_lines(data: dict[str, Any]) -> None:
    text = validate_lab(data).parts[0].blocks[0]
    assert getattr(text, "markdown", "").startswith("Read\n\n$$G")


@pytest.mark.parametrize(
    ("path", "value", "where", "what"),
    [
        (("title",), 3, "title", "string"),
        (("minutes",), "10", "minutes", "integer"),
        (("minutes",), 10.5, "minutes", "integer"),
        (("colour",), "red", "colour", "no such key"),
        (("level",), "hard", "level", "introductory"),
        (("id",), "../etc", "id", "pattern"),
        (("id",), "small\n", "id", "pattern"),
        (("bench", "sliders", 0, "step"), float("nan"), "bench.sliders[0].step", "finite"),
        (("bench", "sliders", 0, "max"), float("inf"), "bench.sliders[0].max", "finite"),
        (("bench", "sliders", 0, "max"), True, "bench.sliders[0].max", "number"),
        (("bench", "sliders", 0, "max"), 0.05, "bench.sliders[0]", "min (0.1) must be below max (0.05)"),
        (("bench", "sliders", 0, "min"), 0, "bench.sliders[0]", "log scale needs min > 0"),
        (("bench", "controller"), {"type": "expr", "text": "1/s"}, "bench", "the controller has no Kc"),
        (("bench", "sliders", 1, "knob"), "Kc", "bench.sliders[1]", "only tau_I and tau_D"),
        (("bench", "controller", "Kc"), 50, "bench", "Kc = 50 is outside 0.1 to 20"),
        (("bench", "controller", "form"), "perfect", "bench.controller.form", "ideal"),
        (("bench", "panels", 0), "music", "bench.panels[0]", "step"),
        (("bench", "response"), {"input": {"type": "noise"}}, "bench.response.input", "step"),
        (("bench", "laplace"), {"type": "pulse", "width": 1}, "bench.laplace", "step"),
        (("parts", 0, "settings"), {"alpha": 1}, "", "has no slider"),
        (("parts", 0, "settings"), {"tau_I": -1}, "", "outside"),
        (("parts", 0, "blocks", 0, "type"), "video", "parts[0].blocks[0]", "text"),
        (("parts", 0, "blocks", 0, "markdown"), "", "parts[0].blocks[0].markdown", "at least 1"),
        (("parts", 0, "blocks", 1, "tests"), [], "parts[0].blocks[1].tests", "at least 4"),
        (("parts", 0, "blocks", 1, "fields", 0, "tolerance"), {}, "parts[0].blocks[1].fields[0].tolerance", "either"),
        (
            ("parts", 0, "blocks", 1, "fields", 0, "tolerance", "relative"),
            "1 %",
            "parts[0].blocks[1].fields[0].tolerance.relative",
            "number",
        ),
        (("parts", 0, "blocks", 1, "fields", 0, "answer"), 8, "parts[0].blocks[1].fields[0].answer", "quantity"),
        (
            ("parts", 0, "blocks", 1, "fields", 0, "answer"),
            {"value": 8},
            "parts[0].blocks[1].fields[0].answer.source",
            "needed",
        ),
        (
            ("parts", 0, "blocks", 1, "fields", 0, "answer"),
            {"quantity": "beauty"},
            "parts[0].blocks[1].fields[0].answer.quantity",
            "Ku",
        ),
        (("parts", 0, "blocks", 2, "id"), "ku", "", "exercise 'ku' is there twice"),
        (("parts", 0, "blocks", 3, "options", 1, "correct"), True, "parts[0].blocks[3]", "exactly one"),
        (("parts", 0, "blocks", 3, "options", 0, "correct"), False, "parts[0].blocks[3]", "exactly one"),
        (("parts", 0, "blocks", 4, "answer"), {"type": "tf", "num": [1], "den": []}, "parts[0].blocks[4].answer", ""),
        (("parts", 0, "blocks", 5, "specifications", 0, "measure"), "joy", "specifications[0].measure", "overshoot"),
        (("parts", 0, "blocks", 5, "specifications", 0, "limit"), None, "specifications[0].limit", "number"),
        (("parts", 0, "blocks", 5, "tests", 1, "feedback"), None, "tests[1]", "names words"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(
    data: dict[str, Any], path: tuple[str | int, ...], value: Any, where: str, what: str
) -> None:
    place: Any = data
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    first = problems(data)[0]
    assert where in first
    assert what in first


@pytest.mark.parametrize("data_", [None, [], "lab", 3, {}, {"id": "x"}])
def test_what_is_no_lab_at_all(data_: Any) -> None:
    assert problems(data_)


def test_a_path_exists_in_the_file(data: dict[str, Any]) -> None:
    """Union members that pydantic names on its way have no place in a path."""
    exercise(data, "system")["answer"] = {"type": "fopdt", "K": 1, "tau": "x", "theta": 0}
    assert problems(data)[0].startswith("parts[0].blocks[4].answer.tau: ")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not JSON"),
        ("{", "not JSON: .* at line 1, column 2"),
        ('{"id": NaN}', "not JSON"),
        ('{"id": "\\ud800"}', "not JSON"),
        ("[" * 100_000, "not JSON|JSON object"),
        (" " * 300_000, "256 KiB"),
    ],
)
def test_a_file_that_cannot_be_read(text: str, message: str) -> None:
    with pytest.raises(LabError) as caught:
        parse_lab(text, "x.json")
    assert re.search(message, caught.value.message)
    assert caught.value.message.startswith("x.json: ")


def test_a_number_too_large_for_a_float_is_refused(data: dict[str, Any]) -> None:
    import orjson

    text = orjson.dumps(data).replace(b'"minutes":10', b'"minutes":1e999')
    with pytest.raises(LabError):
        parse_lab(text)


def test_the_schema_for_editors_is_current(repository: Path) -> None:
    written = (repository / "labs" / "lab.schema.json").read_text(encoding="utf-8")
    assert written == schema_text(json_schema()), "run: looplab labs schema -o labs/lab.schema.json"


def test_every_lab_names_the_schema(repository: Path) -> None:
    folder = repository / "labs"
    for path in lab_files(folder).values():
        named = re.search(r'"\$schema": "([^"]*)"', path.read_text(encoding="utf-8"))
        assert named
        assert (folder / named[1]).is_file(), path.name
