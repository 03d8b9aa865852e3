"""Control loops on nonlinear models: continuous and sampled PID, saturation, dead time, manual and auto."""

from looplab.engine.nonlinear.control_loop.metrics import LoopMetrics
from looplab.engine.nonlinear.control_loop.result import ControlledSimulation, LoopSignals
from looplab.engine.nonlinear.control_loop.sampled_pid import SampledPID
from looplab.engine.nonlinear.control_loop.settings import (
    ControlLoop,
    Instrument,
    Lag,
    MeasurementNoise,
    ModeChange,
)
from looplab.engine.nonlinear.control_loop.simulate import simulate_control

__all__ = [
    "ControlLoop",
    "ControlledSimulation",
    "Instrument",
    "Lag",
    "LoopMetrics",
    "LoopSignals",
    "MeasurementNoise",
    "ModeChange",
    "SampledPID",
    "simulate_control",
]
