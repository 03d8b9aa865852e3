"""Controllers, the feedback loop, its responses and their metrics."""

from looplab.engine.loop.controllers import PID
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.metrics import StepMetrics, default_horizon, loop_metrics, step_metrics
from looplab.engine.loop.step_response import ClosedLoopStep, Response, closed_loop_step, step_response

__all__ = [
    "PID",
    "ClosedLoopStep",
    "FeedbackLoop",
    "Response",
    "StepMetrics",
    "closed_loop_step",
    "default_horizon",
    "loop_metrics",
    "step_metrics",
    "step_response",
]
