"""How well a loop has kept its setpoint, from the curves of a simulation."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from looplab.engine.loop.hermite import HermiteCurves
from looplab.engine.loop.metrics import StepMetrics, step_metrics
from looplab.engine.loop.step_response import Response
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.systems.polynomial import FloatArray

_STEP_NUMBERS = ("overshoot_pct", "t_rise", "t_settle", "decay_ratio")
# The output has arrived where it ends this near to the setpoint, as part of the step.
_ARRIVED = 0.02


@dataclass(frozen=True)
class LoopMetrics:
    """Metrics over the horizon (up to a cut); None is explained in ``reasons`` under the field's name.

    Attributes
    ----------
    IAE, ISE, ITAE : float or None
        Integrals of \\|e\\|, e^2 and t\\|e\\|, e = r - y with the true output, t from the start [output*time, ...].
    TV : float
        Sum of the ups and downs of u after saturation, between the times asked for [input].
    saturated_pct : float
        Part of the times asked for at which u was at a limit [%].
    overshoot_pct, t_rise, t_settle, decay_ratio : float or None
        Of the answer to the setpoint's step, as in ``StepMetrics``, where the setpoint does one step and y arrives.
    """

    IAE: float | None
    ISE: float | None
    ITAE: float | None
    TV: float
    saturated_pct: float
    overshoot_pct: float | None = None
    t_rise: float | None = None
    t_settle: float | None = None
    decay_ratio: float | None = None
    reasons: dict[str, str] = field(default_factory=dict)


def loop_metrics(
    t: FloatArray, y: FloatArray, u: FloatArray, saturated: FloatArray, setpoint: InputCourse, cut: bool
) -> LoopMetrics:
    """Metrics of sampled curves, cubic between the samples.

    Parameters
    ----------
    t, y, u : ndarray, shape (count,)
        Times, the output and the controller's output after saturation.
    saturated : ndarray, shape (count,)
        Whether u was at a limit.
    setpoint : InputCourse
    cut : bool
        Whether the simulation was cut.

    Returns
    -------
    LoopMetrics
    """
    out: dict[str, Any] = {"TV": float(np.abs(np.diff(u)).sum()), "saturated_pct": 100.0 * float(np.mean(saturated))}
    if t.size < 3:
        why = dict.fromkeys(("IAE", "ISE", "ITAE", *_STEP_NUMBERS), "undefined: there are fewer than three samples")
        return LoopMetrics(None, None, None, **out, reasons=why)
    e = setpoint.values(t) - y
    (integrals,) = HermiteCurves(t - t[0], e[None], np.gradient(e, t)[None]).absolute_integrals(1)
    if cut:
        return LoopMetrics(*integrals, **out, reasons=dict.fromkeys(_STEP_NUMBERS, "undefined: the simulation was cut"))
    found, reasons = _step(t, y, u, setpoint)
    out |= {name: getattr(found, name) for name in _STEP_NUMBERS if found}
    return LoopMetrics(*integrals, **out, reasons=reasons)


def _step(
    t: FloatArray, y: FloatArray, u: FloatArray, setpoint: InputCourse
) -> tuple[StepMetrics | None, dict[str, str]]:
    """Metrics of the answer to the one step of the setpoint."""
    jumps = setpoint.breakpoints()
    jumps = jumps[(jumps >= t[0]) & (jumps < t[-1])]
    one = jumps.size == 1 and all(part.held for part in setpoint.parts)
    if not one:
        return None, dict.fromkeys(_STEP_NUMBERS, "undefined: meant for a setpoint that does one step")
    after = t >= jumps[0] * (1.0 - 1e-12)
    t, y, u = t[after] - jumps[0], y[after], u[after]
    size = float(setpoint.values(t[-1] + jumps[0])) - setpoint.level
    if t.size < 20 or not size:
        return None, dict.fromkeys(_STEP_NUMBERS, "undefined: fewer than 20 samples after the step")
    y = (y - setpoint.level) / size
    if abs(y[-1] - 1.0) > _ARRIVED:
        return None, dict.fromkeys(_STEP_NUMBERS, "undefined: y is not within 2 % of the setpoint at the end")
    found = step_metrics(Response(t, y, u, np.gradient(y, t), np.gradient(u, t), 1.0), setpoint=1.0, stable=True)
    return found, {name: found.reasons[name] for name in _STEP_NUMBERS if name in found.reasons}
