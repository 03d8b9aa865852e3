"""A drawing shows what its plant computes, and nothing else."""

import json

import pytest

from looplab.plants import load_plant, load_transfer_matrix, plant_drawing, plant_ids, transfer_matrix_ids
from looplab.schemas.schematic import Schematic


@pytest.mark.parametrize("plant_id", plant_ids())
def test_a_drawing_moves_with_its_plant(plant_id, repository):
    path = repository / "server/looplab/plants/schematics" / f"{plant_id}.json"
    drawing, model = Schematic.model_validate(json.loads(path.read_text(encoding="utf-8"))), load_plant(plant_id)
    drawing.require_signals({*model.state_names, *model.input_names, *model.variable_names, *model.output_names})
    # every state and input is seen
    assert {name for _, name in drawing.signals()} >= {*model.state_names, *model.input_names}


@pytest.mark.parametrize("plant_id", transfer_matrix_ids())
def test_a_transfer_matrix_is_drawn_with_its_signals(plant_id):
    drawing, matrix = Schematic.model_validate(plant_drawing(plant_id)), load_transfer_matrix(plant_id)
    assert {name for _, name in drawing.signals()} == {each.name for each in (*matrix.inputs, *matrix.outputs)}
