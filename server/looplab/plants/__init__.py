"""The plants that come with looplab: models in the same language as an author's own."""

from looplab.plants.drawings import plant_drawing
from looplab.plants.groups import group_of, shelved
from looplab.plants.library import UnknownPlant, load_plant, plant_document, plant_ids
from looplab.plants.transfer_matrix import load_transfer_matrix, transfer_matrix_document, transfer_matrix_ids

__all__ = [
    "UnknownPlant",
    "group_of",
    "load_plant",
    "load_transfer_matrix",
    "plant_document",
    "plant_drawing",
    "plant_ids",
    "shelved",
    "transfer_matrix_document",
    "transfer_matrix_ids",
]
