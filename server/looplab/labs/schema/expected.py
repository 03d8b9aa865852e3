"""Where a right number comes from: worked out by the engine, given by a tuning rule, or stated with its source."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from looplab.engine.tuning import RuleName, TypeName
from looplab.labs.schema.base import Line, Model, Number
from looplab.schemas import Controller, System

LoopMeasure = Literal[
    "GM", "GM_dB", "omega_180", "PM_deg", "omega_c", "delay_margin", "Ms", "omega_Ms", "Mt", "omega_Mt",
    "final_value", "offset", "overshoot_pct", "t_peak", "peak", "t_rise", "t_settle", "decay_ratio",
    "IAE", "ISE", "ITAE", "TV",
    "load_peak", "load_t_settle", "load_IAE", "load_ISE", "load_ITAE", "load_TV", "load_offset",
]  # fmt: skip
"""What can be measured on a loop: the margins, the setpoint step, and (`load_`) the load step."""

Quantity = Literal[LoopMeasure, "Ku", "Pu"]


class FromEngine(Model):
    """Measured on a loop by the same engine that draws the plots, so it cannot go stale."""

    quantity: Quantity
    plant: System | None = Field(default=None, description="The bench's plant where left out.")
    controller: Controller | None = Field(default=None, description="A gain of 1 where left out.")
    times: Number = Field(default=1.0, description="Factor, for instance 0.159155 for Hz in place of rad/s.")


class FromRule(Model):
    """One setting that a tuning rule gives for a plant."""

    rule: RuleName
    type: TypeName
    setting: Literal["Kc", "tau_I", "tau_D"]
    plant: System | None = Field(default=None, description="The bench's plant where left out.")
    times: Number = 1.0


class Stated(Model):
    """A number given by the author, who says where it comes from."""

    value: Number
    source: Line = Field(description="Book and page, or how it was worked out.")


def _which(data: Any) -> str | None:
    keys = data if isinstance(data, dict) else getattr(type(data), "model_fields", {})
    for tag, key in (("rule", "rule"), ("stated", "value"), ("engine", "quantity")):
        if key in keys:
            return tag
    return None


Expected = Annotated[
    Annotated[FromEngine, Tag("engine")] | Annotated[FromRule, Tag("rule")] | Annotated[Stated, Tag("stated")],
    Discriminator(
        _which,
        custom_error_type="expected",
        custom_error_message="say where the number comes from: quantity (the engine), rule, or value with source",
    ),
]
