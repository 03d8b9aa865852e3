"""A feedback loop as JSON."""

from __future__ import annotations

from pydantic import Field

from looplab.engine.loop import FeedbackLoop
from looplab.schemas.base import Model, located
from looplab.schemas.controllers import Controller
from looplab.schemas.systems import System


class Loop(Model):
    """Plant and controller under unit negative feedback; the load enters at the plant input."""

    plant: System = Field(description="P(s), proper.")
    controller: Controller = Field(description="C(s), a PID or any proper system.")

    def to_engine(self) -> FeedbackLoop:
        """The loop for the engine; raises EngineError naming the field."""
        with located("plant"):
            plant = self.plant.to_engine()
        with located("controller"):
            controller = self.controller.to_engine()
        return FeedbackLoop(plant, controller)
