"""Grading: by measuring and computing, one file per kind of exercise."""

from typing import Any

from looplab.labs.grading.choice import grade_choice
from looplab.labs.grading.design import grade_design
from looplab.labs.grading.number import grade_number
from looplab.labs.grading.result import Check, Result
from looplab.labs.grading.transfer_function import grade_transfer_function
from looplab.labs.schema import ChoiceExercise, DesignExercise, Exercise, Lab, NumberExercise

__all__ = ["Check", "Result", "grade"]


def grade(lab: Lab, exercise: Exercise, answer: Any) -> Result:
    """The verdict on an answer as the page sends it.

    Raises
    ------
    InvalidInput
        The answer does not have the shape that this kind of exercise takes; a student's slip is a result instead.
    """
    if isinstance(exercise, NumberExercise):
        return grade_number(exercise, answer, lab.bench)
    if isinstance(exercise, ChoiceExercise):
        return grade_choice(exercise, answer)
    if isinstance(exercise, DesignExercise):
        return grade_design(exercise, answer, lab.bench)
    return grade_transfer_function(exercise, answer)
