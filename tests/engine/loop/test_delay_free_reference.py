"""y, u and dy/dt without dead time against sums of residues (80 digits)."""

from typing import Any

import numpy as np
import pytest

from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
from looplab.engine.systems import parse_transfer_function
from references import cases


@pytest.mark.parametrize("case", cases("delay_free_loops"))
@pytest.mark.parametrize("every", [1, 10])
def test_responses_equal_the_residue_sums(case: dict[str, Any], every: int) -> None:
    loop = FeedbackLoop(plant=parse_transfer_function(case["plant"]), controller=PID(**case["controller"]))
    result = closed_loop_step(loop, horizon=case["horizon"], points=60 * every + 1)
    np.testing.assert_allclose(result.t[::every], case["t"], rtol=1e-14)
    for name, response in (("setpoint", result.setpoint), ("load", result.load)):
        for signal in ("y", "u", "dy"):
            reference = np.array(case[name][signal])
            size = np.maximum(1.0, np.maximum.accumulate(np.abs(reference)))
            error = np.abs(getattr(response, signal)[::every] - reference) / size
            assert error.max() <= 1e-10, (name, signal, error.max())
