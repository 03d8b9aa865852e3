"""Grades a design: the loop that the student built is simulated and analysed, and held against the specifications."""

import math
from typing import Any

from looplab.engine.errors import EngineError, InvalidInput
from looplab.labs.grading.quantity import read_number, show, show_beside
from looplab.labs.grading.result import Check, Result
from looplab.labs.measures import LoopMeasures, Measured, unit, words
from looplab.labs.schema import Bench, DesignExercise, Specification, check_setting
from looplab.labs.text import plain, render_text

_UNSTABLE = "<p>The loop is past its edge: it does not come to rest. Less gain, or more integral time.</p>"
_RELATIONS = {"<=": "at most", ">=": "at least"}


def grade_design(exercise: DesignExercise, answer: Any, bench: Bench) -> Result:
    """``answer`` is ``{knob: value or null}``; a knob left out keeps the bench's first setting."""
    try:
        settings = _settings(answer, bench)
    except ValueError as error:
        if isinstance(error, EngineError):
            raise
        return Result("unreadable", f"<p>{plain(_sentence(str(error)))}</p>")
    if not settings:
        return Result("blank", "<p>Turn the knobs of the bench first.</p>")
    try:
        loop = bench.loop_with(settings).to_engine()
    except EngineError as error:
        return Result("unreadable", f"<p>{plain(_sentence(error.message))}</p>")
    measures = LoopMeasures(loop, bench.horizon)
    stable = measures.stable
    checks = [
        Check(
            "closed_loop_stable",
            stable,
            "The loop is stable." if stable else "The loop is unstable.",
            feedback_html="" if stable else _UNSTABLE,
        )
    ]
    for spec in exercise.specifications:
        measured = measures.measure(spec.measure) if stable else Measured(None, "the loop is unstable")
        checks.append(_check(spec, measured, bench.time_unit))
    failed = sum(not check.passed for check in checks)
    if not failed:
        return Result("correct", "<p>Every specification is met.</p>", 1.0, checks)
    if not stable:
        return Result("wrong", checks[0].feedback_html, 0.0, checks)
    return Result("wrong", f"<p>{len(checks) - failed} of {len(checks)} checks are met.</p>", 0.0, checks)


def meets(spec: Specification, value: float) -> bool:
    """The limit itself is met: 0.1 of an offset that comes out as 0.10000000000000003 is 0.1."""
    slack = 1e-9 * max(1.0, abs(spec.limit))
    return value <= spec.limit + slack if spec.relation == "<=" else value >= spec.limit - slack


def demand(spec: Specification, time_unit: str) -> str:
    """The specification in words: "overshoot at most 25 %"."""
    return (
        f"{words(spec.measure)} {_RELATIONS[spec.relation]} {show(spec.limit)} {unit(spec.measure, time_unit)}".strip()
    )


def _check(spec: Specification, measured: Measured, time_unit: str) -> Check:
    name, value = spec.measure, measured.value
    if value is None:
        text = f"{_sentence(demand(spec, time_unit), '')}: not measured, because {measured.reason}."
        return Check(name, False, text, None, spec.limit)
    passed = meets(spec, value)
    shown = f"{show_beside(value, spec.limit)} {unit(name, time_unit)}".strip()
    limit = f"{_RELATIONS[spec.relation]} {show(spec.limit)} {unit(name, time_unit)}".strip()
    return Check(
        name,
        passed,
        f"{_sentence(words(name), '')} {shown}, {limit}: {'met' if passed else 'not met'}.",
        value if math.isfinite(value) else None,
        spec.limit,
        "" if passed else render_text(spec.feedback),
    )


def _settings(answer: Any, bench: Bench) -> dict[str, float | None]:
    if answer is None:
        return {}
    if not isinstance(answer, dict):
        raise InvalidInput("The answer is the knobs of the bench.", field="answer", hint='{"Kc": 2, "tau_I": 3}')
    settings: dict[str, float | None] = {}
    for knob, value in answer.items():
        slider = bench.slider(knob)
        if slider is None:
            names = ", ".join(slider.knob for slider in bench.sliders)
            raise InvalidInput("The bench has no such knob.", field="answer", hint=f"It has {names}.")
        if isinstance(value, str):
            number = read_number(value)
            if number is None:
                raise ValueError(f"{knob} is not a number")
            value = number
        elif isinstance(value, bool) or not isinstance(value, (int, float, type(None))):
            raise InvalidInput("A setting is a number, or null for off.", field=f"answer.{knob}")
        check_setting(slider, value)
        settings[knob] = value if value is None else float(value)
    return settings


def _sentence(text: str, stop: str = ".") -> str:
    return text[:1].upper() + text[1:] + ("" if text.endswith(stop) else stop)
