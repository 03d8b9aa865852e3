"""The plants that come with looplab: models in the same language as an author's own."""

from looplab.plants.library import UnknownPlant, load_plant, plant_document, plant_ids

__all__ = ["UnknownPlant", "load_plant", "plant_document", "plant_ids"]
