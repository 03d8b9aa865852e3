"""Drawings are read strictly, and what is wrong is named by its place."""

import json
import re
from pathlib import Path

import pytest
from pydantic import ValidationError

from looplab.engine.errors import InvalidInput
from looplab.schemas import json_path
from looplab.schemas.schematic import Schematic

FOLDER = Path(__file__).resolve().parents[2] / "server" / "looplab" / "plants" / "schematics"
DRAWINGS = sorted(FOLDER.glob("*.json"))

TANK = {"kind": "tank", "x": 10, "y": 10, "width": 100, "height": 80, "level": {"signal": "h", "from": [0, 2]}}


def drawing(*shapes: object, **more: object) -> dict[str, object]:
    return {"view": [480, 320], "shapes": list(shapes), **more}


@pytest.mark.parametrize("path", DRAWINGS, ids=lambda path: path.stem)
def test_the_drawings_of_our_plants_are_right(path: Path):
    schematic = Schematic.model_validate(json.loads(path.read_text(encoding="utf-8")))
    assert schematic.title
    assert schematic.signals()


def test_the_example_for_authors_is_right():
    (example,) = re.findall(r"```json\n(.*?)```", (FOLDER / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert Schematic.model_validate(json.loads(example)).signals()[1] == ("shapes[1].level.signal", "h")


def test_there_is_a_drawing_of_every_plant():
    assert {path.stem for path in DRAWINGS} >= {
        *("heater", "thermometer", "cstr", "jacketed-cstr", "cart-pendulum", "gravity-drained-tank", "two-tanks"),
        *("two-tanks-interacting", "tanks-in-series", "jacketed-cooler", "distillation", "level-loop"),
        *("cruise-control", "body-temperature"),
    }


@pytest.mark.parametrize(
    ("shape", "path", "message"),
    [
        ({"kind": "teapot", "x": 0, "y": 0}, "shapes[0]", "does not match any of the expected tags"),
        (TANK | {"width": 0}, "shapes[0].width", "greater than 0"),
        (TANK | {"height": float("nan")}, "shapes[0].height", "finite"),
        (TANK | {"x": "10"}, "shapes[0].x", "valid number"),
        (TANK | {"colour": "red"}, "shapes[0].colour", "not permitted"),
        (TANK | {"fill": "red"}, "shapes[0].fill", "Input should be 'ink'"),
        (TANK | {"level": {"signal": "h", "from": [1, 1]}}, "shapes[0].level.from", "must span a range"),
        (TANK | {"level": {"signal": "2h"}}, "shapes[0].level.signal", "match pattern"),
        ({"kind": "pipe", "points": [[0, 0]]}, "shapes[0].points", "at least 2 items"),
        ({"kind": "text", "x": 0, "y": 0, "text": "a\nb"}, "shapes[0].text", "match pattern"),
        (TANK | {"repeat": {"count": 101, "step": [0, 1]}}, "shapes[0].repeat.count", "less than or equal to 100"),
        (
            {"kind": "group", "x": 0, "y": 0, "shapes": [TANK, {"kind": "disc", "x": 0, "y": 0}]},
            "shapes[0].shapes[1].r",
            "required",
        ),
    ],
)
def test_what_is_wrong_is_named_by_its_place(shape, path, message):
    data = drawing(shape)
    with pytest.raises(ValidationError) as refused:
        Schematic.model_validate(data)
    (error,) = refused.value.errors()
    assert json_path(data, error["loc"]) == path
    assert message in error["msg"]


def test_an_index_outside_a_repeat_is_refused():
    with pytest.raises(ValidationError, match=r"shapes\[0\]\.level\.signal: \{i\} is no index here"):
        Schematic.model_validate(drawing(TANK | {"level": {"signal": "x_{i}"}}))


def test_a_drawing_is_not_larger_than_a_browser_moves():
    row = TANK | {"repeat": {"count": 100, "step": [0, 1]}}
    many = {"kind": "group", "x": 0, "y": 0, "shapes": [row], "repeat": {"count": 100, "step": [1, 0]}}
    with pytest.raises(ValidationError, match="10100 shapes once repeated; at most 2000"):
        Schematic.model_validate(drawing(many))
    deep: dict[str, object] = TANK
    for _ in range(6):
        deep = {"kind": "group", "x": 0, "y": 0, "shapes": [deep]}
    with pytest.raises(ValidationError, match="at most 6 deep"):
        Schematic.model_validate(drawing(deep))


def test_signals_are_written_out_with_their_places():
    schematic = Schematic.model_validate(
        drawing(
            TANK | {"level": {"signal": "M_{i}"}, "repeat": {"count": 3, "step": [0, 12]}},
            {"kind": "readout", "signal": "x_D", "x": 0, "y": 0},
            {
                "kind": "group",
                "x": {"signal": "x"},
                "y": 0,
                "repeat": {"count": 2, "index": "k", "first": 0, "step": [9, 0]},
                "shapes": [
                    {
                        "kind": "line",
                        "points": [[0, 0], [1, 0]],
                        "stroke": {"signal": "T_{k+1}", "scale": "temperature"},
                    }
                ],
            },
        )
    )
    assert schematic.signals() == [
        *(("shapes[0].level.signal", f"M_{i}") for i in (1, 2, 3)),
        ("shapes[1].signal", "x_D"),
        ("shapes[2].x.signal", "x"),
        *(("shapes[2].shapes[0].stroke.signal", f"T_{k}") for k in (1, 2)),
    ]


def test_a_signal_that_the_model_lacks_is_refused_with_its_place():
    schematic = Schematic.model_validate(drawing(TANK, {"kind": "readout", "signal": "F", "x": 0, "y": 0}))
    schematic.require_signals({"h", "F"})
    with pytest.raises(InvalidInput, match="names a signal 'F'") as refused:
        schematic.require_signals({"h"})
    assert refused.value.field == "shapes[1].signal"
    assert refused.value.hint == "signals of the model: h"


def test_a_drawing_survives_the_way_to_json_and_back():
    data = drawing(TANK, title="A tank")
    schematic = Schematic.model_validate(data)
    again = Schematic.model_validate(schematic.model_dump(by_alias=True))
    assert again == schematic
    assert schematic.model_dump(by_alias=True)["shapes"][0]["level"]["from"] == [0, 2]
