"""Control loops on nonlinear models: continuous and sampled PID, saturation, dead time, manual and auto.

They are simulated by ``control_loop.simulation``, which needs scipy's solvers and is imported where it is used.
"""

from looplab.engine.nonlinear.control_loop.settings import (
    ControlLoop,
    Instrument,
    Lag,
    MeasurementNoise,
    ModeChange,
)

__all__ = ["ControlLoop", "Instrument", "Lag", "MeasurementNoise", "ModeChange"]
