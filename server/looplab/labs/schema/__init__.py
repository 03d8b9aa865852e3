"""The only definition of what a lab is. `looplab labs schema` writes it out for editors."""

from looplab.labs.schema.bench import Bench, Slider, check_setting
from looplab.labs.schema.exercises import (
    ChoiceExercise,
    DesignExercise,
    Exercise,
    NumberExercise,
    NumberField,
    Specification,
    Test,
    Tolerance,
    TransferFunctionExercise,
)
from looplab.labs.schema.expected import Expected, FromEngine, FromRule, LoopMeasure, Stated
from looplab.labs.schema.lab import Lab, Part, TextBlock, json_schema

__all__ = [
    "Bench",
    "ChoiceExercise",
    "DesignExercise",
    "Exercise",
    "Expected",
    "FromEngine",
    "FromRule",
    "Lab",
    "LoopMeasure",
    "NumberExercise",
    "NumberField",
    "Part",
    "Slider",
    "Specification",
    "Stated",
    "Test",
    "TextBlock",
    "Tolerance",
    "TransferFunctionExercise",
    "check_setting",
    "json_schema",
]
