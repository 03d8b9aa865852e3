"""Exercises: what is asked, what is right, what the typical mistakes are, and the tests that prove it."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from looplab.labs.schema.base import FieldName, Latex, Line, Model, Number, Slug, Text
from looplab.labs.schema.expected import Expected, LoopMeasure
from looplab.schemas import System


class Test(Model):
    """An answer, and what the lab must say to it. `looplab labs check` runs it."""

    __test__ = False  # not one of pytest's

    case: Literal["author", "mistake", "blank", "wrong"] = Field(
        description="author: the right answer; mistake: a typical one; blank: nothing; wrong: anything else."
    )
    answer: Any = Field(description="What the student would send, as the page sends it.")
    feedback: Line | None = Field(
        default=None, description="Words that must be in the feedback; a mistake has to have them."
    )

    @model_validator(mode="after")
    def _a_mistake_has_feedback(self) -> Self:
        if self.case == "mistake" and self.feedback is None:
            raise ValueError("a mistake's test names words of the feedback that it must get")
        return self


class _Exercise(Model):
    id: Slug
    title: Line
    prompt: Text
    points: Annotated[float, Field(gt=0, le=100)] = 1.0
    hints: Annotated[list[Text], Field(max_length=6, default_factory=list)]
    solution: Text = Field(description="Worked, and shown after the answer.")
    tests: Annotated[list[Test], Field(min_length=4, max_length=20)]


class Tolerance(Model):
    """How near is near enough. The student is told."""

    relative: Annotated[float, Field(gt=0, le=0.5)] | None = Field(default=None, description="0.01 is 1 %.")
    absolute: Annotated[float, Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        if (self.relative is None) == (self.absolute is None):
            raise ValueError("give either relative or absolute")
        return self


class Mistake(Model):
    """A wrong number that students are known to reach, and what to tell them."""

    answer: Expected
    feedback: Text


class NumberField(Model):
    """One number to fill in."""

    id: FieldName
    label: Line
    symbol: Latex | None = None
    unit: Annotated[str, Field(max_length=20)] = Field(default="", description="Shown behind the field: rad/s, %, dB.")
    answer: Expected
    tolerance: Tolerance
    mistakes: Annotated[list[Mistake], Field(max_length=10, default_factory=list)]


class NumberExercise(_Exercise):
    """One or several numbers."""

    type: Literal["number"]
    fields: Annotated[list[NumberField], Field(min_length=1, max_length=8)]

    @model_validator(mode="after")
    def _names(self) -> Self:
        _unique("field", [field.id for field in self.fields])
        return self


class Option(Model):
    id: Slug
    text: Text
    correct: bool = False
    feedback: Text = Field(description="Said to the student who picks it, right or wrong.")


class ChoiceExercise(_Exercise):
    """One option of several, or every right one where `several` is true."""

    type: Literal["choice"]
    several: bool = False
    options: Annotated[list[Option], Field(min_length=2, max_length=10)]

    @model_validator(mode="after")
    def _right_ones(self) -> Self:
        _unique("option", [option.id for option in self.options])
        right = sum(option.correct for option in self.options)
        if right == 0 or (right > 1 and not self.several):
            raise ValueError(
                f"{right} options are correct; there must be {'at least' if self.several else 'exactly'} one"
            )
        return self


class SystemMistake(Model):
    system: System
    feedback: Text


class TransferFunctionExercise(_Exercise):
    """A transfer function in s, typed; compared with the right one as a system, however it is written."""

    type: Literal["transfer_function"]
    symbol: Latex | None = None
    answer: System
    tolerance: Annotated[float, Field(gt=0, le=0.1)] = Field(
        default=1e-3, description="Largest relative difference of the frequency responses; the student is told."
    )
    mistakes: Annotated[list[SystemMistake], Field(max_length=10, default_factory=list)]


class Specification(Model):
    """One demand on the loop, checked by simulating or analysing what the student built."""

    measure: LoopMeasure
    relation: Literal["<=", ">="] = "<="
    limit: Number
    feedback: Text = Field(description="What to try when it is not met.")


class DesignExercise(_Exercise):
    """Settings of the bench's controller that make the loop meet specifications. It must be stable in any case."""

    type: Literal["design"]
    specifications: Annotated[list[Specification], Field(min_length=1, max_length=8)]

    @model_validator(mode="after")
    def _measures(self) -> Self:
        _unique("specification", [f"{s.measure} {s.relation}" for s in self.specifications])
        return self


Exercise = Annotated[
    NumberExercise | ChoiceExercise | TransferFunctionExercise | DesignExercise, Field(discriminator="type")
]


def _unique(what: str, names: list[str]) -> None:
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise ValueError(f"{what} {sorted(twice)[0]!r} is there twice")
