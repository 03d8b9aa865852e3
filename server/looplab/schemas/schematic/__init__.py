"""Live drawings of plants as JSON: the only definition of what a drawing may hold."""

from looplab.schemas.schematic.document import Schematic

__all__ = ["Schematic"]
