"""Systems with dead times anywhere inside them: connections, exact responses, frequency analyses and verdicts."""

from looplab.engine.delays.blocks import Block, in_feedback, in_parallel, in_series
from looplab.engine.delays.connections import append, connect, feedback, parallel, series, summing
from looplab.engine.delays.conversion import MinimalDelaySystem, minimal_delay_system, single_transfer_function
from looplab.engine.delays.frequency import delay_bode, delay_margins, delay_nyquist
from looplab.engine.delays.loop_response import loop_system
from looplab.engine.delays.poles import DelayPoles, rightmost_poles
from looplab.engine.delays.resolvent import frequency_response, transfer_matrix
from looplab.engine.delays.smith import control_loop, smith_predictor
from looplab.engine.delays.step_response import DelayStep, step_response
from looplab.engine.delays.system import DelaySystem
from looplab.engine.delays.verdict import count_right_of, delay_verdict

__all__ = [
    "Block",
    "DelayPoles",
    "DelayStep",
    "DelaySystem",
    "MinimalDelaySystem",
    "append",
    "connect",
    "control_loop",
    "count_right_of",
    "delay_bode",
    "delay_margins",
    "delay_nyquist",
    "delay_verdict",
    "feedback",
    "frequency_response",
    "in_feedback",
    "in_parallel",
    "in_series",
    "loop_system",
    "minimal_delay_system",
    "parallel",
    "rightmost_poles",
    "series",
    "single_transfer_function",
    "smith_predictor",
    "step_response",
    "summing",
    "transfer_matrix",
]
