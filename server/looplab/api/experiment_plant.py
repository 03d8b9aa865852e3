"""The plant of an experiment: a linear system, or one of the library with the pair of signals that is looked at."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.simulations import SimulationRequest, Values, open_loop_settings
from looplab.engine.errors import InvalidInput
from looplab.engine.systems import TransferFunction
from looplab.jobs.experiments import PlantPoint
from looplab.plants import load_plant
from looplab.schemas import Model, System, located

Name = Annotated[str, Field(max_length=32)]


class LibraryPlant(Model):
    """A nonlinear plant of the library at one of its operating points, where it is brought to rest first."""

    type: Literal["plant"]
    id: Annotated[str, Field(max_length=64)]
    input: Name
    output: Name
    operating_point: Annotated[str | None, Field(max_length=64)] = None
    inputs: Values = Field(default={})
    parameters: Values = Field(default={})
    initial: Values = Field(default={})

    def to_point(self) -> PlantPoint:
        """The same as a worker takes it; raises EngineError naming the field."""
        with located("plant"):
            document = load_plant(self.id).document
            settings = open_loop_settings(
                SimulationRequest(
                    horizon=1.0,
                    operating_point=self.operating_point,
                    parameters=self.parameters,
                    initial=self.initial,
                ),
                document,
            )
        inputs = {name: float(value) for name, value in settings.inputs.items() if isinstance(value, float | int)}
        return PlantPoint(self.id, self.input, self.output, inputs | self.inputs, settings.parameters, settings.initial)


AnyPlant = Annotated[System | LibraryPlant, Field(discriminator="type")]


def linear_plant(plant: System) -> TransferFunction:
    """The system for the engine; raises EngineError naming the field."""
    with located("plant"):
        return plant.to_engine().require_proper()


def require_horizon(horizon: float | None) -> float:
    """A nonlinear plant's horizon.

    Raises
    ------
    InvalidInput
        There is none.
    """
    if horizon is None:
        raise InvalidInput("a plant of the library needs a horizon", field="horizon", hint="some tens of its periods")
    return horizon
