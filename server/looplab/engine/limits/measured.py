"""A loop as its controller sees it."""

from __future__ import annotations

from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.systems.transfer_function import TransferFunction


def measured_loop(loop: FeedbackLoop) -> FeedbackLoop:
    """The same L from plant and controller alone: all dead time in the plant, no setpoint weight, y as measured.

    Parameters
    ----------
    loop : FeedbackLoop
        Actuator, plant and sensor become one plant.

    Returns
    -------
    FeedbackLoop
        Its load enters before the actuator.
    """
    path = loop.path
    return FeedbackLoop(TransferFunction(path.zeros, path.poles, path.gain, loop.theta), loop.C.without_dead_time())
