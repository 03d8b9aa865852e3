"""Grades a typed transfer function: compared as a system, so every way of writing it is right."""

from typing import Any

import numpy as np

from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.systems import TransferFunction, parse_transfer_function
from looplab.labs.grading.quantity import show
from looplab.labs.grading.result import Check, Result
from looplab.labs.schema import TransferFunctionExercise
from looplab.labs.text import plain, render_text

GRID = 240
"""Frequencies compared; two rational functions of order 50 that agree on 101 of them are the same."""


def grade_transfer_function(exercise: TransferFunctionExercise, answer: Any) -> Result:
    """``answer`` is the text of a transfer function in s."""
    if answer is None or (isinstance(answer, str) and not answer.strip()):
        return Result("blank", "<p>Type a transfer function first, for instance <code>2/(s+1)^2</code>.</p>")
    if not isinstance(answer, str):
        raise InvalidInput("The answer is the text of a transfer function.", field="answer", hint="2/(s+1)^2")
    try:
        given = parse_transfer_function(answer)
    except EngineError as error:
        hint = f" {plain(error.hint)}" if error.hint else ""
        return Result("unreadable", f"<p>{plain(error.message)}.{hint}</p>")
    right = exercise.answer.to_engine()
    if same_system(given, right, exercise.tolerance):
        return Result("correct", "<p>Correct.</p>", 1.0, _comparison(given, right, exercise.tolerance))
    for mistake in exercise.mistakes:
        if same_system(given, mistake.system.to_engine(), exercise.tolerance):
            return Result("wrong", render_text(mistake.feedback), 0.0, _comparison(given, right, exercise.tolerance))
    return Result(
        "wrong", "<p>Not yet: this is another system.</p>", 0.0, _comparison(given, right, exercise.tolerance)
    )


def same_system(a: TransferFunction, b: TransferFunction, tolerance: float) -> bool:
    """Equal dead times, and frequency responses that differ by at most ``tolerance`` of their size."""
    return same_dead_time(a, b, tolerance) and same_response(a, b, tolerance)


def same_dead_time(a: TransferFunction, b: TransferFunction, tolerance: float) -> bool:
    return abs(a.theta - b.theta) <= tolerance * max(a.theta, b.theta)


def same_response(a: TransferFunction, b: TransferFunction, tolerance: float) -> bool:
    """The rational parts alone: at high frequency e^{-iωθ} would magnify a rounded dead time without bound."""
    omega = _grid(a, b)
    with np.errstate(all="ignore"):
        x, y = (TransferFunction(G.zeros, G.poles, G.gain).response(omega) for G in (a, b))
    finite = np.isfinite(x) & np.isfinite(y)
    if not finite.any():
        return False
    x, y = x[finite], y[finite]
    return bool(np.all(np.abs(x - y) <= tolerance * np.maximum(np.abs(x), np.abs(y))))


def _grid(a: TransferFunction, b: TransferFunction) -> np.ndarray:
    corners = np.abs(np.concatenate([a.zeros, a.poles, b.zeros, b.poles]))
    corners = corners[corners > 0]
    low, high = (corners.min(), corners.max()) if corners.size else (1.0, 1.0)
    return np.geomspace(low / 100, high * 100, GRID)


def _comparison(given: TransferFunction, right: TransferFunction, tolerance: float) -> list[Check]:
    """Facts about the student's own system that narrow the search without giving the answer away."""
    gain, wanted = given.dc_gain, right.dc_gain
    # An integrator has no steady-state gain; two of them agree on that.
    both = np.isfinite(gain) and np.isfinite(wanted)
    same_gain = abs(gain - wanted) <= tolerance * abs(wanted) if both else np.isfinite(gain) == np.isfinite(wanted)
    checks = [
        _check("gain", "Steady-state gain", show(gain) if np.isfinite(gain) else "infinite", bool(same_gain)),
        _check("order", "Order", str(given.order), given.order == right.order),
    ]
    if given.theta or right.theta:
        checks.append(_check("theta", "Dead time", show(given.theta), same_dead_time(given, right, tolerance)))
    return checks


def _check(name: str, label: str, value: str, passed: bool) -> Check:
    return Check(name, passed, f"{label} {value}: {'right' if passed else 'not right'}.")
