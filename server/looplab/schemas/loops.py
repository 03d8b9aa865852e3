"""A feedback loop as JSON."""

from __future__ import annotations

from pydantic import Field

from looplab.engine.loop import FeedbackLoop
from looplab.schemas.base import Model, located
from looplab.schemas.controllers import Controller
from looplab.schemas.systems import System


class Loop(Model):
    """u = C (r - y_m), y = P (A u + d), y_m = H y; dead times may sit in any of them."""

    plant: System = Field(description="P(s), proper.")
    controller: Controller = Field(description="C(s), a PID or any proper system.")
    actuator: System | None = Field(default=None, description="A(s), between controller and plant; null is 1.")
    sensor: System | None = Field(default=None, description="H(s), what the controller sees of y; null is 1.")
    disturbance: System | None = Field(
        default=None, description="Gd(s): y = P A u + Gd d; null lets the load enter at the plant input."
    )

    def to_engine(self) -> FeedbackLoop:
        """The loop for the engine; raises EngineError naming the field."""
        with located("plant"):
            plant = self.plant.to_engine()
        with located("controller"):
            controller = self.controller.to_engine()
        others = {}
        for name in ("actuator", "sensor", "disturbance"):
            system = getattr(self, name)
            with located(name):
                others[name] = None if system is None else system.to_engine()
        return FeedbackLoop(plant, controller, **others)
