"""How a judged loop is written in the answers that set loops side by side."""

from __future__ import annotations

from typing import Any

import numpy as np

from looplab.engine.loop import Response as StepCurve
from looplab.engine.tuning import ComparedLoop

MARGINS = ("GM", "GM_dB", "PM_deg", "omega_c", "delay_margin", "Ms", "Mt")
SETPOINT = ("overshoot_pct", "t_rise", "t_settle", "decay_ratio", "offset", "IAE", "ISE", "ITAE", "TV")
LOAD = ("peak", "t_settle", "IAE", "ISE", "ITAE", "TV")


def _curve(response: StepCurve) -> dict[str, Any]:
    return {
        # Columns of one array: the encoder wants them in one piece.
        **{name: np.ascontiguousarray(getattr(response, name)) for name in ("t", "y", "u")},
        "truncated_at": response.truncated_at,
        "truncated_reason": response.truncated_reason,
    }


def judged_answer(loop: ComparedLoop) -> dict[str, Any]:
    """Verdict, margins, metrics and responses, with the reasons of what is null."""
    margins = {name: getattr(loop.margins, name) for name in MARGINS}
    return {
        "closed_loop_stable": loop.margins.closed_loop_stable,
        "margins": margins | {"reasons": {k: v for k, v in loop.margins.reasons.items() if k in MARGINS}},
        "setpoint": {n: getattr(loop.setpoint, n) for n in SETPOINT}
        | {"reasons": {k: v for k, v in loop.setpoint.reasons.items() if k in SETPOINT}},
        "load": {n: getattr(loop.load, n) for n in LOAD}
        | {"reasons": {k: v for k, v in loop.load.reasons.items() if k in LOAD}},
        "responses": {"setpoint": _curve(loop.steps.setpoint), "load": _curve(loop.steps.load)},
    }
