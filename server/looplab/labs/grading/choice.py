"""Grades a choice; every option has feedback of its own."""

from typing import Any

from looplab.engine.errors import InvalidInput
from looplab.labs.grading.result import Check, Result
from looplab.labs.schema import ChoiceExercise
from looplab.labs.text import render_text


def grade_choice(exercise: ChoiceExercise, answer: Any) -> Result:
    """``answer`` is an option's id, or a list of them where several can be right."""
    picked = _picked(exercise, answer)
    if not picked:
        return Result("blank", "<p>Pick an answer first.</p>")
    options = {option.id: option for option in exercise.options}
    feedback = "".join(render_text(options[name].feedback) for name in options if name in picked)
    right = {option.id for option in exercise.options if option.correct}
    checks = [
        Check(name, name in right, "Right." if name in right else "Not this one.") for name in options if name in picked
    ]
    if picked == right:
        return Result("correct", feedback, 1.0, checks)
    if exercise.several and picked < right:
        return Result("partly", f"{feedback}<p>There are more.</p>", 0.0, checks)
    return Result("wrong", feedback, 0.0, checks)


def _picked(exercise: ChoiceExercise, answer: Any) -> set[str]:
    if answer is None or answer == "":
        return set()
    names = answer if isinstance(answer, list) else [answer]
    known = [option.id for option in exercise.options]
    if not all(isinstance(name, str) and name in known for name in names):
        raise InvalidInput("There is no such option.", field="answer", hint=f"The options are {', '.join(known)}.")
    if len(names) > 1 and not exercise.several:
        raise InvalidInput("Only one option can be picked.", field="answer")
    return set(names)
