"""Time-domain panels: the step responses and what they are judged by."""

from __future__ import annotations

from typing import Any

from looplab.api.panels.context import LoopContext
from looplab.engine.loop import Response, loop_metrics
from looplab.engine.loop.gang_of_six import GANG, gang_steps


def _response(response: Response) -> dict[str, Any]:
    return {
        "y": response.y.copy(),
        "u": response.u.copy(),
        "y_m": None if response.y_m is None else response.y_m.copy(),
        "final_y": response.final_y,
        "truncated_at": response.truncated_at,
        "truncated_reason": response.truncated_reason,
    }


def step(context: LoopContext) -> dict[str, Any]:
    """y and u, and what a sensor makes of y, after unit steps of setpoint and load."""
    result = context.step
    setpoint, load = _response(result.setpoint), _response(result.load)
    if not context.verdict.closed_loop_stable:
        # The limits exist on paper only: this loop does not get there.
        setpoint["final_y"] = load["final_y"] = None
    return {"horizon": result.horizon, "t": result.t, "setpoint": setpoint, "load": load}


def metrics(context: LoopContext) -> dict[str, Any]:
    """Overshoot, rise, settling, offset, error integrals and effort, undefined ones with their reason."""
    setpoint, load = loop_metrics(context.step, stable=context.verdict.closed_loop_stable)
    return {"setpoint": vars(setpoint), "load": vars(load)}


def gang(context: LoopContext) -> dict[str, Any]:
    """Step responses of the gang of six."""
    steps = gang_steps(context.loop, context.horizon, context.points)
    curves = {name: getattr(steps, name).copy() for name in GANG}
    return {
        "t": steps.t,
        **curves,
        "truncated_reason": steps.truncated_reason,
        "feedforward": context.loop.feedforward,
    }
