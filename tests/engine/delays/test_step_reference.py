"""Loops with several dead times against an independent method of steps (60 digits)."""

from typing import Any

import numpy as np
import pytest

from looplab.engine.delays import DelaySystem, control_loop, loop_system, smith_predictor, step_response
from looplab.engine.loop import FeedbackLoop, closed_loop_step
from looplab.engine.systems import TransferFunction
from references import cases

TOLERANCE = 1e-10  # relative to the largest value so far, and never below 1
LOOPS = [c for c in cases("several_dead_times") if "H" in c.values[0]["blocks"]]
SMITH = [c for c in cases("several_dead_times") if "late" in c.values[0]["blocks"]]
# What the tabulated controller of a Smith predictor is made of: C/(1 + C G) is in the table.
PREDICTORS = {
    "smith_exact": ("2", "1", "1", "1"),
    "smith_mismatch": ("2", "1", "1", "1"),
    "smith_late_model": ("1", "1", "1", "1.5"),
    "smith_biproper": ("0.5", "2", "s+2", "1"),
}


def system(block: dict[str, Any]) -> TransferFunction:
    return TransferFunction.from_polynomials(block["num"], block["den"], block["theta"])


def loop_of(case: dict[str, Any]) -> FeedbackLoop:
    blocks = {name: system(block) for name, block in case["blocks"].items()}
    return FeedbackLoop(blocks["P"], blocks["C"], blocks["A"], blocks["H"], blocks.get("G"))


def worst(values: np.ndarray, expected: np.ndarray) -> float:
    size = np.maximum(1.0, np.maximum.accumulate(np.abs(expected)))
    return float((np.abs(values - expected) / size).max())


@pytest.mark.parametrize("case", LOOPS)
def test_method_of_steps_of_any_system(case: dict[str, Any]) -> None:
    t = np.array(case["setpoint"]["t"])
    found = step_response(loop_system(loop_of(case)), float(t[-1]), t.size)
    np.testing.assert_allclose(found.t, t, atol=1e-12)
    for j, signal in enumerate(("setpoint", "load")):
        for i, name in enumerate(("y", "u", "y_m")):
            assert worst(found.y[:, i, j], np.array(case[signal][name])) <= TOLERANCE, (signal, name)


@pytest.mark.parametrize("case", LOOPS)
def test_the_kernel_with_shifted_outputs(case: dict[str, Any]) -> None:
    """The fast way has a grid of its own: compared where it meets the table's samples."""
    loop = loop_of(case)
    reference = np.array(case["setpoint"]["t"])
    found = closed_loop_step(loop, float(reference[-1]), 2401)
    nearest = np.abs(reference[:, None] - found.t).argmin(axis=1)
    meets = np.abs(found.t[nearest] - reference) < 1e-10
    assert meets.sum() >= 10
    for signal in ("setpoint", "load"):
        response = getattr(found, signal)
        for name in ("y", "u", "y_m"):
            values = getattr(response, name)
            assert worst(values[nearest[meets]], np.array(case[signal][name])[meets]) <= TOLERANCE, (signal, name)


@pytest.mark.parametrize("case", SMITH)
def test_a_smith_predictor_and_a_plant_that_is_not_its_model(case: dict[str, Any]) -> None:
    Kc, tau_I, ahead, theta = PREDICTORS[case["name"]]
    gain, time = float(Kc), float(tau_I)
    C = TransferFunction([-1 / time], [0], gain)
    zeros = [-2.0] if ahead == "s+2" else []
    predictor = smith_predictor(C, TransferFunction(zeros, [-1.0], 1.0, float(theta)))
    loop = control_loop(DelaySystem.from_transfer_function(system(case["blocks"]["P"])), predictor)
    t = np.array(case["setpoint"]["t"])
    found = step_response(loop, float(t[-1]), t.size)
    for j, signal in enumerate(("setpoint", "load")):
        for i, name in enumerate(("y", "u")):
            assert worst(found.y[:, i, j], np.array(case[signal][name])) <= TOLERANCE, (signal, name)


def test_a_perfect_model_takes_the_dead_time_out_of_the_loop() -> None:
    """C = 2 (1 + 1/s) on e^{-s}/(s+1): y = 1 - e^{-2(t-1)} after the dead time, as without one."""
    G = TransferFunction((), [-1.0], 1.0, 1.0)
    loop = control_loop(DelaySystem.from_transfer_function(G), smith_predictor(TransferFunction([-1.0], [0.0], 2.0), G))
    found = step_response(loop, 12.0, 241)
    expected = np.where(found.t > 1 - 1e-9, -np.expm1(-2 * (found.t - 1)), 0.0)
    np.testing.assert_allclose(found.y[:, 0, 0], expected, rtol=0, atol=1e-12)
