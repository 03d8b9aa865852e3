"""The bench beside a lab's text: one loop, the knobs a student may turn, the panels that show what happens."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from looplab.labs.schema.base import Line, Model, Number
from looplab.schemas import Controller, ExpressionSystem, InputShape, Loop, System
from looplab.schemas.laplace import TransformInput

Knob = Literal["Kc", "tau_I", "tau_D", "alpha"]
Panel = Literal[
    "step", "bode", "nyquist", "nichols", "root_locus", "sensitivity", "numbers",
    "response", "laplace", "routh", "stability", "state_space", "low_order",
    "limits", "bode_integral", "spectrum",
]  # fmt: skip


class Slider(Model):
    """One knob of the controller: its range, step and scale. Its name, unit and symbol come from the house's table."""

    knob: Knob = Field(description="Which setting of the controller it turns.")
    min: Number
    max: Number
    step: Number = Field(gt=0, description="One press of an arrow key.")
    scale: Literal["linear", "log"] = "linear"
    can_be_off: bool = Field(
        default=False,
        description="The student may switch this action off (the setting is then null): tau_I and tau_D.",
    )
    label: Line | None = Field(default=None, description="A plain name in place of the usual one.")

    @model_validator(mode="after")
    def _range(self) -> Self:
        if not self.min < self.max:
            raise ValueError(f"min ({self.min:g}) must be below max ({self.max:g})")
        if self.step > self.max - self.min:
            raise ValueError("step is larger than the whole range")
        if self.scale == "log" and self.min <= 0:
            raise ValueError("a log scale needs min > 0")
        if self.can_be_off and self.knob not in ("tau_I", "tau_D"):
            raise ValueError("only tau_I and tau_D can be switched off")
        return self


class ResponseView(Model):
    """How the analysis `response` opens."""

    of: Literal["plant", "open_loop", "closed_loop"] = "plant"
    input: InputShape
    sum: Literal["superposition", "convolution"] | None = Field(
        default=None, description="Show y as a sum: of steps, or of answers to slices of the input."
    )


class Bench(Model):
    """The loop of the lab. Every exercise that does not name a plant of its own is about this one."""

    plant: System
    controller: Controller = Field(description="The settings the bench opens with.")
    actuator: ExpressionSystem | None = Field(default=None, description="Between controller and plant; null is 1.")
    sensor: ExpressionSystem | None = Field(
        default=None, description="What the controller sees of the output; null is 1. Dead time may sit in either."
    )
    time_unit: Literal["s", "min"] = "s"
    sliders: Annotated[list[Slider], Field(min_length=1, max_length=8)]
    panels: Annotated[list[Panel], Field(min_length=1, max_length=8)] = Field(
        description="What the bench can show, the most important first: plots of the loop, and analyses of the plant "
        "and the loop with words and tables. The verdict is always there."
    )
    response: ResponseView | None = Field(default=None, description="What `response` opens with.")
    laplace: TransformInput | None = Field(default=None, description="The input that `laplace` opens with.")
    horizon: Annotated[float, Field(gt=0)] | None = Field(
        default=None, description="Length of the step response; found from the loop where left out."
    )

    @model_validator(mode="after")
    def _sliders_fit(self) -> Self:
        knobs = [slider.knob for slider in self.sliders]
        if len(set(knobs)) < len(knobs):
            raise ValueError("two sliders turn the same knob")
        settings = self.settings()
        for slider in self.sliders:
            if slider.knob not in settings:
                raise ValueError(f"the controller has no {slider.knob}; it has {', '.join(settings)}")
            check_setting(slider, settings[slider.knob])
        if len(set(self.panels)) < len(self.panels):
            raise ValueError("a panel is named twice")
        return self

    def settings(self) -> dict[str, float | None]:
        """The controller's settings as the bench opens."""
        data = self.controller.model_dump()
        return {knob: data[knob] for knob in Knob.__args__ if knob in data}  # type: ignore[attr-defined]

    def slider(self, knob: str) -> Slider | None:
        return next((slider for slider in self.sliders if slider.knob == knob), None)

    def controller_with(self, settings: dict[str, float | None]) -> Controller:
        """The bench's controller with some settings replaced; they are checked as any controller's are."""
        data: dict[str, Any] = self.controller.model_dump()
        return type(self.controller).model_validate({**data, **settings})

    def loop_of(self, controller: Controller) -> Loop:
        return Loop(plant=self.plant, controller=controller, actuator=self.actuator, sensor=self.sensor)

    def loop_with(self, settings: dict[str, float | None]) -> Loop:
        return self.loop_of(self.controller_with(settings))


def check_setting(slider: Slider, value: float | None) -> None:
    """Raise ValueError, in words for a person, where a knob cannot stand at this value."""
    if value is None:
        if not slider.can_be_off:
            raise ValueError(f"{slider.knob} cannot be switched off on this bench")
    elif not slider.min <= value <= slider.max:
        raise ValueError(f"{slider.knob} = {value:g} is outside {slider.min:g} to {slider.max:g}")
