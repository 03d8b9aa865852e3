"""What the steady states of a nonlinear model are asked with, whether it is a plant or comes with the request."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from looplab.api.simulations import ModelParts, Values
from looplab.engine.nonlinear.steady_states.phase_plane import GRIDS, MAX_TRAJECTORIES
from looplab.engine.nonlinear.steady_states.search import MAX_STARTS, STARTS
from looplab.jobs.points import PointSettings
from looplab.schemas import Model
from looplab.schemas.operating_points import find_operating_point

Range = Annotated[list[float], Field(min_length=2, max_length=2, description="[low, high]")]
Ranges = Annotated[dict[str, Range], Field(max_length=200, description="By state; left out: its declared bounds.")]
Starts = Annotated[
    int, Field(ge=1, le=MAX_STARTS, description="Points of the box from which steady states are sought.")
]
ShortName = Annotated[str, Field(max_length=32)]
Horizon = Annotated[float | None, Field(ge=1e-9, le=1e9, description="[time]; null goes by the slowest mode.")]

SETTING = {"operating_point", "inputs", "parameters", "near", "model"}


class SettingRequest(Model):
    """Inputs and parameters at which steady states are asked for."""

    operating_point: Annotated[
        str | None, Field(max_length=64, description="Its inputs, parameters and states are the nominal ones.")
    ] = None
    inputs: Annotated[Values, Field(description="Left out: nominal.")] = Field(default={})
    parameters: Annotated[Values, Field(description="Left out: nominal.")] = Field(default={})
    near: Annotated[Values, Field(description="States to start from; left out: those of the point.")] = Field(
        default={}
    )

    def settings(self, model: ModelParts) -> PointSettings:
        """The request as a worker takes it; raises InvalidInput where there is no such operating point."""
        point = find_operating_point(self.operating_point, model.operating_points)
        return PointSettings(
            {**(point.inputs if point else {}), **self.inputs},
            {**(point.parameters if point else {}), **self.parameters},
            {**(point.near if point else {}), **self.near},
        )

    def options(self) -> dict[str, Any]:
        """What is asked, without where."""
        return self.model_dump(exclude=SETTING)


class SteadyStatesRequest(SettingRequest):
    """Where to look for steady states, and from how many starts."""

    box: Ranges = Field(default={})
    starts: Starts = STARTS


class ContinuationRequest(SettingRequest):
    """Over which input or parameter steady states are followed."""

    over: Annotated[ShortName, Field(description="An input or a parameter.")]
    low: Annotated[float | None, Field(description="null: its declared least value.")] = None
    high: Annotated[float | None, Field(description="null: its declared greatest value.")] = None
    box: Ranges = Field(default={})
    starts: Annotated[Starts, Field(description="At each of a few values of the quantity.")] = 20


class LinearizeRequest(SettingRequest):
    """Where the linear model is taken, which channel is shown, and which steps compare it with the model."""

    at: Annotated[
        Literal["steady-state", "point"],
        Field(description="The steady state near the states given, or the very point, equilibrium or not."),
    ] = "steady-state"
    input: Annotated[ShortName | None, Field(description="null: the first.")] = None
    output: Annotated[ShortName | None, Field(description="null: the first.")] = None
    steps: Annotated[
        list[float], Field(max_length=4, description="Sizes of steps of the input, added to its value there.")
    ] = Field(default=[])
    horizon: Horizon = None


class PhasePlaneRequest(SettingRequest):
    """Which two states, in which window, and where trajectories start."""

    horizontal: Annotated[ShortName | None, Field(description="null: the first state.")] = None
    vertical: Annotated[ShortName | None, Field(description="null: the first other state.")] = None
    ranges: Ranges = Field(default={})
    held: Annotated[Values, Field(description="The other states; left out: at the steady state nearby.")] = Field(
        default={}
    )
    grid: Annotated[int, Field(ge=GRIDS[0], le=GRIDS[1], description="Arrows each way.")] = 21
    starts: Annotated[
        list[Annotated[dict[str, float], Field(max_length=200)]],
        Field(max_length=MAX_TRAJECTORIES, description="One trajectory from each: states by name."),
    ] = Field(default=[])
    horizon: Horizon = None


class BalanceRequest(SettingRequest):
    """Over which state the balance is drawn, and which variables with it."""

    state: ShortName
    low: Annotated[float | None, Field(description="null: its declared least value.")] = None
    high: Annotated[float | None, Field(description="null: its declared greatest value.")] = None
    curves: Annotated[
        list[ShortName] | None,
        Field(max_length=6, description="Variables; null: heat_generated and heat_removed where the model has them."),
    ] = None
    box: Ranges = Field(default={})
    starts: Starts = 40
