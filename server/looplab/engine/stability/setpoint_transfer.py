"""The closed loop from setpoint to output as one transfer function."""

from __future__ import annotations

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.stability.closed_loop import closed_loop_poles
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction


def setpoint_transfer(loop: FeedbackLoop) -> TransferFunction:
    r"""Zeros, poles and gain of T, what y sees of the setpoint r.

    .. math:: T(s) = \frac{L(s)}{1 + L(s)}, \qquad L = P C

    Parameters
    ----------
    loop : FeedbackLoop
        Without dead time and setpoint weight.

    Returns
    -------
    TransferFunction
        Modes that cancel inside the loop are not in it.

    Raises
    ------
    InvalidInput
        With dead time T is no rational function; with a setpoint weight y does not see r through T alone.

    References
    ----------
    .. [1] K. J. Åström, R. M. Murray, Feedback Systems, 2nd ed., Princeton University Press 2021, sec. 12.1.
    """
    if loop.theta and loop.open_loop.gain:
        raise InvalidInput(
            "with dead time in the loop the closed loop is no rational function",
            field="plant.theta",
            hint="the step responses of the loop are exact; plant and open loop take any input",
        )
    if loop.feedforward:
        raise InvalidInput("a setpoint weight is not part of T", field="controller.beta", hint="use beta 1")
    L, _ = split_hidden_modes(loop.open_loop)
    poles = closed_loop_poles(FeedbackLoop(L, TransferFunction([], [], 1.0))).poles
    return TransferFunction(L.zeros, poles, L.gain / (1.0 + L.high_frequency_gain), loop.theta)
