"""What a controlled simulation gives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.nonlinear.control_loop.metrics import LoopMetrics
from looplab.engine.nonlinear.simulation.result import Simulation
from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class LoopSignals:
    """Signals of one loop, each of shape (count,); at a jump the new value.

    Attributes
    ----------
    output, input : str
    r : ndarray
        Setpoint [output].
    y_m : ndarray
        What the controller sees: the output after sensor, dead time and noise; of a sampled controller its last
        sample [output].
    u_command, u : ndarray
        The controller's output before and after saturation [input].
    auto : ndarray of bool
    history_error : float or None
        Largest error of the past that a dead time of a continuous loop looks up, estimated, in the signal's own unit;
        None without such a dead time, as everything is exact then but the solver's tolerance.
    metrics : LoopMetrics
    """

    output: str
    input: str
    r: FloatArray
    y_m: FloatArray
    u_command: FloatArray
    u: FloatArray
    auto: npt.NDArray[np.bool_]
    history_error: float | None
    metrics: LoopMetrics


@dataclass(frozen=True)
class ControlledSimulation(Simulation):
    """A simulated model under control: as ``Simulation``, whose ``u`` is what enters the model after the valves.

    Attributes
    ----------
    loops : tuple of LoopSignals
    """

    loops: tuple[LoopSignals, ...]
