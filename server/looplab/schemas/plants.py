"""A plant of the library as a linear system: one input and one output of it, linearised at a steady state."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated, Literal

from pydantic import Field

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.steady_states import LinearModel, linearize, steady_state_near
from looplab.engine.state_space import StateSpaceModel
from looplab.engine.systems import TransferFunction
from looplab.plants import load_plant
from looplab.schemas.base import Model
from looplab.schemas.models import Values
from looplab.schemas.operating_points import find_operating_point

Pairs = tuple[tuple[str, float], ...]


class PlantSystem(Model):
    """y/u of a plant near the steady state of an operating point, as deviations from it."""

    type: Literal["plant"]
    id: Annotated[str, Field(max_length=64, description="As the list of plants has it.", examples=["cstr"])]
    params: Annotated[Values, Field(description="Parameters that are not nominal.")] = Field(default={})
    operating_point: Annotated[
        str | None, Field(max_length=64, description="Its inputs, parameters and states; null takes the nominal ones.")
    ] = None
    inputs: Annotated[Values, Field(description="Inputs that are not those of the point.")] = Field(default={})
    near: Annotated[Values, Field(description="States near the steady state, where not those of the point.")] = Field(
        default={}
    )
    input: Annotated[str, Field(max_length=32, description="Which input is u.", examples=["Q"])]
    output: Annotated[str, Field(max_length=32, description="Which output is y.", examples=["T"])]

    def to_model(self) -> StateSpaceModel:
        """The matrices, with the plant's own states; raises EngineError naming the field."""
        point, output, input = self._channel()
        return point.channel(output, input)

    def to_engine(self) -> TransferFunction:
        """The system for the engine, hidden modes kept; raises EngineError naming the field."""
        point, output, input = self._channel()
        return point.transfer_function(output, input)

    def to_latex(self) -> str:
        """The transfer function in factors."""
        return self.to_engine().to_latex()

    def _channel(self) -> tuple[LinearModel, int, int]:
        model = load_plant(self.id)
        for name, names, field in (
            (self.input, model.input_names, "input"),
            (self.output, model.output_names, "output"),
        ):
            if name not in names:
                raise InvalidInput(f"the plant has no such {field}", field=field, hint=f"it has {', '.join(names)}")
        settings = (tuple(sorted(values.items())) for values in (self.params, self.inputs, self.near))
        point = _linear_model(self.id, self.operating_point, *settings)
        return point, model.output_names.index(self.output), model.input_names.index(self.input)


# A loop is asked for at every move of a slider: its plant is the same again and again.
@lru_cache(maxsize=64)
def _linear_model(plant_id: str, name: str | None, params: Pairs, inputs: Pairs, near: Pairs) -> LinearModel:
    model = load_plant(plant_id)
    point = find_operating_point(name, model.document.operating_points)
    u = model.inputs({**(point.inputs if point else {}), **dict(inputs)})
    p = model.parameters({**(point.parameters if point else {}), **dict(params)}, "params")
    start = model.states({**(point.near if point else {}), **dict(near)}, model.initial_state(u, p), "near")
    try:
        state = steady_state_near(model, u, p, start)
    except InvalidInput as error:
        error.field = "operating_point" if error.field == "near" else "id"
        raise
    return linearize(model, state.x, u, p)
