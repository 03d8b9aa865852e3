"""The drawing of a plant: its document's own, else the one of the same id beside the documents."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import Any

from looplab.plants.library import plant_document
from looplab.plants.transfer_matrix import transfer_matrix_ids


@cache
def _texts() -> dict[str, str]:
    """Every drawing as JSON, by id. An id is only ever looked up here, never made into a path."""
    return {
        entry.name.removesuffix(".json"): entry.read_text(encoding="utf-8")
        for entry in files(__package__).joinpath("schematics").iterdir()
        if entry.name.endswith(".json")
    }


def plant_drawing(plant_id: str) -> dict[str, Any] | None:
    """The drawing of a plant, a copy of the caller's own; None where nobody has drawn it.

    Raises
    ------
    UnknownPlant
    """
    own: dict[str, Any] | None = None
    if plant_id not in transfer_matrix_ids():
        own = plant_document(plant_id).get("schematic")
    if own is not None:
        return own
    text = _texts().get(plant_id)
    return None if text is None else json.loads(text)
