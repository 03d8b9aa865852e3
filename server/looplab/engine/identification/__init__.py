"""Low-order models from recorded or computed responses."""

from looplab.engine.identification.reaction_curve import two_point

__all__ = ["two_point"]
