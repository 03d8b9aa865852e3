"""Grades numbers: each field against its own tolerance, with its own feedback."""

from math import isfinite
from typing import Any

from looplab.engine.errors import InvalidInput
from looplab.labs.grading.expected import expected_value
from looplab.labs.grading.quantity import is_near, read_number, show, tolerance_text
from looplab.labs.grading.result import Check, Result, Status
from looplab.labs.schema import Bench, NumberExercise, NumberField
from looplab.labs.text import render_text


def grade_number(exercise: NumberExercise, answer: Any, bench: Bench) -> Result:
    """``answer`` is ``{field: number or text}``; where there is one field, the number alone will do."""
    given = _by_field(exercise, answer)
    if all(_is_blank(value) for value in given.values()):
        return Result("blank", "<p>Type a number first.</p>")
    checks = [_check(field, given.get(field.id), bench) for field in exercise.fields]
    right = sum(check.passed for check in checks)
    if right == len(checks):
        return Result("correct", "<p>Correct.</p>", 1.0, checks)
    unread = any(not check.passed and check.measured is None for check in checks)
    if len(checks) == 1:
        return Result("unreadable" if unread else "wrong", checks[0].feedback_html, 0.0, checks)
    status: Status = "partly" if right else "unreadable" if unread else "wrong"
    return Result(status, f"<p>{right} of {len(checks)} are right.</p>", right / len(checks), checks)


def _by_field(exercise: NumberExercise, answer: Any) -> dict[str, Any]:
    names = [field.id for field in exercise.fields]
    if answer is None:
        return {}
    given = answer if isinstance(answer, dict) else {names[0]: answer}
    if not isinstance(answer, dict) and len(names) > 1:
        raise InvalidInput(
            "This exercise has several numbers.", field="answer", hint=f"Send an object with {', '.join(names)}."
        )
    for name, value in given.items():
        if name not in names:
            raise InvalidInput("There is no such field.", field="answer", hint=f"The fields are {', '.join(names)}.")
        if isinstance(value, bool) or not isinstance(value, (int, float, str, type(None))):
            raise InvalidInput("An answer is a number or what was typed.", field=f"answer.{name}")
    return given


def _check(field: NumberField, given: Any, bench: Bench) -> Check:
    if _is_blank(given):
        return _failed(field, "Still empty.", "<p>Still empty.</p>")
    value = read_number(given, field.unit) if isinstance(given, str) else float(given)
    if value is None or not isfinite(value):
        return _failed(
            field, "Not a number.", "<p>That cannot be read as a number. Type it like <code>1.73</code>.</p>"
        )
    if is_near(value, expected_value(field.answer, bench), field.tolerance):
        return Check(field.id, True, f"{field.label}: {show(value, 4)} is right.", value, None, "<p>Right.</p>")
    for mistake in field.mistakes:
        if is_near(value, expected_value(mistake.answer, bench), field.tolerance):
            return _failed(field, "A known slip.", render_text(mistake.feedback), value)
    tolerance = tolerance_text(field.tolerance, field.unit)
    return _failed(field, "Not right yet.", f"<p>Not yet: it has to be right {tolerance}.</p>", value)


def _failed(field: NumberField, text: str, feedback_html: str, value: float | None = None) -> Check:
    return Check(field.id, False, f"{field.label}: {text}", value, None, feedback_html)


def _is_blank(value: Any) -> bool:
    return value is None or (isinstance(value, str) and not value.strip())
