"""Runs a lab's own tests: the author's answer, typical mistakes, a blank and a wrong answer, for every exercise."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from html import unescape
from time import monotonic

from looplab.engine.errors import EngineError
from looplab.labs.grading import Result, grade
from looplab.labs.grading.expected import expected_value
from looplab.labs.grading.quantity import is_near
from looplab.labs.schema import Exercise, Lab, NumberExercise, NumberField, Test

CASES = ("author", "mistake", "blank", "wrong")


@dataclass(frozen=True)
class Outcome:
    """One test of one exercise; ``message`` says what happened instead, where it failed."""

    exercise: str
    case: str
    passed: bool
    message: str = ""


def run_tests(lab: Lab, seconds: float | None = None) -> list[Outcome]:
    """Every test of every exercise, and one for each kind of test that is missing.

    A lab from a stranger gets so many ``seconds``; what is not run by then counts as failed, and says so.
    """
    end = None if seconds is None else monotonic() + seconds
    outcomes = []
    for exercise in lab.exercises():
        for outcome in _run(lab, exercise):
            outcomes.append(outcome)
            if end is not None and monotonic() > end:
                late = f"not run: the tests of this lab take longer than {seconds:g} s"
                return [*outcomes, Outcome(exercise.id, "author", False, late)]
    return outcomes


def _run(lab: Lab, exercise: Exercise) -> Iterator[Outcome]:
    for test in exercise.tests:
        try:
            message = _judge(test, grade(lab, exercise, test.answer))
        except EngineError as error:
            message = f"the answer {test.answer!r} could not be graded: {error.message}"
        yield Outcome(exercise.id, test.case, not message, message)
    for case in CASES:
        if not any(test.case == case for test in exercise.tests):
            yield Outcome(exercise.id, case, False, f"there is no test of the case {case!r}")
    if isinstance(exercise, NumberExercise):
        for field in exercise.fields:
            message = _unreachable(field, lab)
            if message:
                yield Outcome(exercise.id, "mistake", False, message)


def _judge(test: Test, result: Result) -> str:
    """Why the lab's reaction is not the one that the test asks for; empty where it is."""
    if test.case == "author" and not result.correct:
        return f"the author's answer {test.answer!r} is marked {result.status}: {_words(result)}"
    if test.case == "blank" and result.status != "blank":
        return f"the blank answer {test.answer!r} is marked {result.status}, not blank"
    if test.case in ("mistake", "wrong") and result.status not in ("wrong", "partly", "unreadable"):
        return f"the {test.case} answer {test.answer!r} is marked {result.status}"
    if test.feedback is not None and test.feedback not in _words(result):
        return f"the feedback to {test.answer!r} lacks {test.feedback!r}; it is: {_words(result)}"
    return ""


def _unreachable(field: NumberField, lab: Lab) -> str:
    """A mistake that is as good as the right answer, or as an earlier mistake, never gets its feedback."""
    try:
        taken = [("the right answer", expected_value(field.answer, lab.bench))]
        for index, mistake in enumerate(field.mistakes):
            value = expected_value(mistake.answer, lab.bench)
            for what, other in taken:
                if is_near(value, other, field.tolerance):
                    return f"{field.id}: mistakes[{index}] ({value:g}) cannot be told from {what} ({other:g})"
            taken.append((f"mistakes[{index}]", value))
    except EngineError as error:
        return f"{field.id}: a number cannot be worked out: {error.message}"
    return ""


def _words(result: Result) -> str:
    """All that the student reads, without its tags."""
    html = " ".join([result.feedback_html, *(f"{check.text} {check.feedback_html}" for check in result.checks)])
    return " ".join(unescape(re.sub(r"<[^>]*>", "", html)).split())
