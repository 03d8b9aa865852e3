"""What an input of a model does over time, as JSON."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.inputs import MAX_PARTS, InputCourse, noise, table
from looplab.engine.response import InputSignal
from looplab.schemas.base import Model, located
from looplab.schemas.inputs import PulseInput, RampInput, SampledInput, Samples, SineInput, Start, StepInput


class NoiseInput(Model):
    """Normal noise, a new value every ``interval``; its power has halved at 2.78/interval [rad/time]."""

    type: Literal["noise"]
    std: Annotated[float, Field(ge=0, description="Standard deviation.")]
    interval: Annotated[float, Field(gt=0, description="Time from value to value [time].")]
    seed: Annotated[int, Field(ge=0, le=2**31, description="The same seed gives the same noise.")] = 0
    start: Start = 0.0

    def to_signal(self, horizon: float) -> InputSignal:
        """The signal for the engine; raises EngineError naming the field."""
        return noise(self.std, self.interval, horizon, self.seed, self.start)


Signal = Annotated[
    StepInput | PulseInput | RampInput | SineInput | SampledInput | NoiseInput, Field(discriminator="type")
]


class Table(Model):
    """Values of an input at given times; the first also before them, the last also after."""

    times: Samples
    values: Samples
    hold: Literal["zero", "linear"] = "zero"


class Course(Model):
    """A level or a table, and signals that are added to it."""

    level: Annotated[float | None, Field(description="Left out: the nominal value.")] = None
    table: Table | None = None
    add: Annotated[list[Signal], Field(max_length=MAX_PARTS, description="Changes, each zero before it starts.")] = (
        Field(default=[])
    )

    def to_engine(self, nominal: float, horizon: float) -> InputCourse:
        """The course for the engine; raises EngineError naming the field."""
        course = InputCourse(nominal if self.level is None else self.level)
        if self.table is not None:
            if self.level is not None:
                raise InvalidInput("give a level or a table, not both", field="table")
            with located("table"):
                course = table(self.table.times, self.table.values, self.table.hold)
        for index, signal in enumerate(self.add):
            with located(f"add[{index}]"):
                added = signal.to_signal(horizon) if isinstance(signal, NoiseInput) else signal.to_engine()
            course = course.plus(added)
        return course


def course_kind(value: object) -> str:
    """Told apart by their shape, so that a mistake in one is not reported as one in the other."""
    return "course" if isinstance(value, dict | Course) else "number"


InputCourses = Annotated[
    dict[
        str, Annotated[Annotated[float, Tag("number")] | Annotated[Course, Tag("course")], Discriminator(course_kind)]
    ],
    Field(max_length=50, description="By input: a number, or what it does over time. Left out: nominal."),
]
