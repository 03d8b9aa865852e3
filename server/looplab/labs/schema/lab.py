"""A lab as a whole."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal, Self

from pydantic import ConfigDict, Field, model_validator

from looplab.labs.schema.base import Line, Model, Slug, Text
from looplab.labs.schema.bench import Bench, check_setting
from looplab.labs.schema.exercises import (
    ChoiceExercise,
    DesignExercise,
    Exercise,
    NumberExercise,
    TransferFunctionExercise,
)


class TextBlock(Model):
    """Prose and formulas."""

    type: Literal["text"]
    markdown: Text


Block = Annotated[
    TextBlock | NumberExercise | ChoiceExercise | TransferFunctionExercise | DesignExercise,
    Field(discriminator="type"),
]


class Part(Model):
    """A step of the lab with a heading of its own."""

    id: Slug
    title: Line
    settings: dict[str, float | None] | None = Field(
        default=None, description="Settings that the bench offers to take for this part, such as proportional only."
    )
    blocks: Annotated[list[Block], Field(min_length=1, max_length=40)]


class Lab(Model):
    """One lab: its text, its bench, its exercises and their tests."""

    model_config = ConfigDict(title="looplab lab")

    schema_: Annotated[str, Field(alias="$schema", max_length=200)] = Field(
        description="./lab.schema.json, so that an editor completes and checks what is written."
    )
    id: Slug = Field(description="The file's name without .json.")
    title: Line
    level: Literal["introductory", "intermediate", "advanced"]
    section: Line = Field(description="Section of the lecture notes, such as 19.1.")
    minutes: Annotated[int, Field(ge=5, le=240)]
    summary: Line = Field(description="One sentence for the list of labs.")
    objectives: Annotated[list[Text], Field(min_length=1, max_length=8)]
    bench: Bench
    parts: Annotated[list[Part], Field(min_length=1, max_length=20)]

    @model_validator(mode="after")
    def _whole(self) -> Self:
        for what, names in (
            ("part", [part.id for part in self.parts]),
            ("exercise", [exercise.id for exercise in self.exercises()]),
        ):
            twice = {name for name in names if names.count(name) > 1}
            if twice:
                raise ValueError(f"{what} {sorted(twice)[0]!r} is there twice")
        for part in self.parts:
            for knob, value in (part.settings or {}).items():
                slider = self.bench.slider(knob)
                if slider is None:
                    raise ValueError(f"part {part.id!r} sets {knob}, which has no slider")
                check_setting(slider, value)
        return self

    def exercises(self) -> Iterator[Exercise]:
        for part in self.parts:
            yield from (block for block in part.blocks if not isinstance(block, TextBlock))

    def exercise(self, exercise_id: str) -> Exercise | None:
        return next((exercise for exercise in self.exercises() if exercise.id == exercise_id), None)


def json_schema() -> dict[str, Any]:
    """The schema of labs/lab.schema.json, for editors."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **Lab.model_json_schema(by_alias=True),
    }
