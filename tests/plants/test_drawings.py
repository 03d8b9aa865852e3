"""A drawing shows what its plant computes, and nothing else."""

import json

import pytest

from looplab.plants import load_plant, plant_ids
from looplab.schemas.schematic import Schematic


@pytest.mark.parametrize("plant_id", plant_ids())
def test_a_drawing_moves_with_its_plant(plant_id, repository):
    path = repository / "server/looplab/plants/schematics" / f"{plant_id}.json"
    drawing, model = Schematic.model_validate(json.loads(path.read_text(encoding="utf-8"))), load_plant(plant_id)
    drawing.require_signals({*model.state_names, *model.input_names, *model.variable_names, *model.output_names})
    # every state and input is seen
    assert {name for _, name in drawing.signals()} >= {*model.state_names, *model.input_names}
