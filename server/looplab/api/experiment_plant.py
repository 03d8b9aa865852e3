"""The plant of an experiment: a linear system, or one of the library with the pair of signals that is looked at."""

from __future__ import annotations

from looplab.api.simulations import SimulationRequest, open_loop_settings
from looplab.engine.errors import InvalidInput
from looplab.engine.systems import TransferFunction
from looplab.jobs.experiments import PlantPoint
from looplab.plants import load_plant
from looplab.schemas import PlantSystem, System, located


def library_point(plant: PlantSystem) -> PlantPoint:
    """A plant of the library as a worker takes it: nonlinear, and brought to rest at its operating point first.

    Raises
    ------
    EngineError
        Naming the field.
    """
    with located("plant"):
        settings = open_loop_settings(
            SimulationRequest(
                horizon=1.0, operating_point=plant.operating_point, parameters=plant.params, initial=plant.near
            ),
            load_plant(plant.id).document,
        )
    inputs = {name: float(value) for name, value in settings.inputs.items() if isinstance(value, float | int)}
    return PlantPoint(plant.id, plant.input, plant.output, inputs | plant.inputs, settings.parameters, settings.initial)


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
