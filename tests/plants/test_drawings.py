"""A drawing shows what its plant computes, and nothing else."""

import json

import pytest

from looplab.schemas.schematic import Schematic
from plants import FOLDER, plant

WITH_DOCUMENT = [path.stem for path in sorted((FOLDER / "models").glob("*.json"))] + ["tanks-in-series"]


@pytest.mark.parametrize("plant_id", WITH_DOCUMENT)
def test_a_drawing_moves_with_its_plant(plant_id):
    text = (FOLDER / "schematics" / f"{plant_id}.json").read_text(encoding="utf-8")
    drawing, model = Schematic.model_validate(json.loads(text)), plant(plant_id)
    drawing.require_signals({*model.state_names, *model.input_names, *model.variable_names, *model.output_names})
    # every state and input is seen
    assert {name for _, name in drawing.signals()} >= {*model.state_names, *model.input_names}
