"""y, u and dy/dt with dead time against an independent method of steps (60 digits)."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
from looplab.engine.systems import parse_transfer_function
from references import cases

TOLERANCE = 1e-10  # relative to the largest value so far, and never below 1


def worst_error(case: dict[str, Any], subdivide: int) -> dict[str, float]:
    """Largest errors at the reference's samples, with ``subdivide`` output samples between two of them."""
    loop = FeedbackLoop(plant=parse_transfer_function(case["plant"]), controller=PID(**case["controller"]))
    t = np.array(case["t"])
    result = closed_loop_step(loop, horizon=t[-1], points=(t.size - 1) * subdivide + 1)
    at = np.searchsorted(result.t, t - 1e-9 * t[-1])
    np.testing.assert_allclose(result.t[at], t, rtol=0, atol=1e-12 * t[-1])
    errors = {}
    for name, response in (("setpoint", result.setpoint), ("load", result.load)):
        for signal in ("y", "u", "dy"):
            reference, values = np.array(case[name][signal]), getattr(response, signal)
            seen = at < values.size  # an unstable response may end early
            assert seen.all() or response.truncated_reason
            assert seen.sum() >= 20
            size = np.maximum(1.0, np.maximum.accumulate(np.abs(reference)))
            errors[f"{name} {signal}"] = float((np.abs(values[at[seen]] - reference[seen]) / size[seen]).max())
    return errors


@pytest.mark.parametrize("case", cases("delayed_loops"))
@pytest.mark.parametrize("density", [1, 4])
def test_responses_equal_the_method_of_steps(case: dict[str, Any], density: int) -> None:
    most = 4999 // (len(case["t"]) - 1)
    errors = worst_error(case, min(Fraction(case["step"]).numerator * density, most))
    assert max(errors.values()) <= TOLERANCE, errors


@pytest.mark.parametrize("case", [c for c in cases("delayed_loops") if Fraction(c.values[0]["step"]).denominator == 1])
def test_samples_many_dead_times_apart(case: dict[str, Any]) -> None:
    errors = worst_error(case, 1)
    assert max(errors.values()) <= TOLERANCE, errors
