"""Finding a plant by its id: in the folder of documents, or among those that code writes."""

from __future__ import annotations

import json
from collections.abc import Callable
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from typing import Any

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import BUILT_IN, CompiledModel, compile_model
from looplab.plants.distillation import distillation
from looplab.plants.tanks_in_series import tanks_in_series

Document = dict[str, Any]
# Plants too long to write by hand, such as a column with a state for each tray: id -> what writes the document.
BUILDERS: dict[str, Callable[[], Document]] = {"distillation": distillation, "tanks-in-series": tanks_in_series}


class UnknownPlant(InvalidInput):
    """There is no plant of this id."""


@cache
def _texts() -> dict[str, str]:
    """Every document as JSON, by id. An id is only ever looked up here, never made into a path."""
    folder = files(__package__).joinpath("models")
    written = {
        entry.name.removesuffix(".json"): entry.read_text(encoding="utf-8")
        for entry in folder.iterdir()
        if entry.name.endswith(".json")
    }
    built = {plant_id: json.dumps(build()) for plant_id, build in BUILDERS.items()}
    return dict(sorted({**written, **built}.items()))


def plant_ids() -> list[str]:
    """The ids of all plants, sorted."""
    return list(_texts())


def plant_document(plant_id: str) -> Document:
    """The document of a plant, a copy of the caller's own.

    Raises
    ------
    UnknownPlant
    """
    text = _texts().get(plant_id)
    if text is None:
        near = get_close_matches(plant_id, plant_ids(), n=1)
        raise UnknownPlant(
            "there is no plant of this id",
            field="id",
            hint=f"did you mean {near[0]}?" if near else f"there are {', '.join(plant_ids())}",
        )
    document: Document = json.loads(text)
    return document


@cache
def _compiled(plant_id: str) -> CompiledModel:
    return compile_model(plant_document(plant_id), BUILT_IN)


def load_plant(plant_id: str) -> CompiledModel:
    """A plant ready to compute, made once.

    Raises
    ------
    UnknownPlant
    """
    if plant_id not in _texts():
        plant_document(plant_id)
    return _compiled(plant_id)
