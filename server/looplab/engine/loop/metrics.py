"""What a step response is judged by. Undefined is None with a reason, never a made-up number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import copysign

import numpy as np

from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.hermite import HermiteCurves
from looplab.engine.loop.step_response import SHORTEST_DEAD_TIME, ClosedLoopStep, Response

Numbers = dict[str, float | None]

BAND = 0.02
NUMBERS = (
    "final_value", "offset", "overshoot_pct", "peak", "t_peak", "t_rise", "t_settle", "decay_ratio",
    "IAE", "ISE", "ITAE", "TV",
)  # fmt: skip


@dataclass(frozen=True)
class StepMetrics:
    """Metrics of a unit-step response; None is explained in ``reasons`` under the field's name.

    Attributes
    ----------
    final_value, offset, peak : float or None
        Limit of y, what remains of the error r - y, and the extreme of y [output].
    overshoot_pct : float or None
        (peak - final)/\\|final - start\\| in percent [%]; 0 when y never passes its final value.
    t_peak, t_rise, t_settle : float or None
        Time of the peak; from 10 % to 90 % of the final value; last entry into +-2 % of the final value [time].
    decay_ratio : float or None
        Second overshoot over the first [-].
    IAE, ISE, ITAE : float or None
        Integrals of \\|e\\|, e^2 and t\\|e\\| over the horizon, e = r - y [output*time, ...]. ``reasons`` says so where
        the response has not settled by its end, or where they grow with it.
    TV : float or None
        Total variation of u over the horizon, the jump at t = 0 included [input].
    """

    final_value: float | None = None
    offset: float | None = None
    overshoot_pct: float | None = None
    peak: float | None = None
    t_peak: float | None = None
    t_rise: float | None = None
    t_settle: float | None = None
    decay_ratio: float | None = None
    IAE: float | None = None
    ISE: float | None = None
    ITAE: float | None = None
    TV: float | None = None
    reasons: dict[str, str] = field(default_factory=dict)


def _shape(curves: HermiteCurves, row: int, setpoint: float, final: float, out: Numbers, why: dict[str, str]) -> None:
    """Peak, overshoot, rise, settling and decay of a response that moves from 0 to ``final``."""
    direction, end = copysign(1.0, final), final - setpoint
    times, turns = curves.extrema(row)
    beyond = direction * (turns - end)
    summits = (beyond > 1e-9 * max(abs(final), 1e-9)).nonzero()[0]
    if summits.size:
        height = beyond[summits]
        best = int(height.argmax())
        out["peak"], out["t_peak"] = final + direction * float(height[best]), float(times[summits[best]])
        out["overshoot_pct"] = 100.0 * float(height[best]) / abs(final)
    else:
        out["overshoot_pct"] = 0.0
        out["peak"] = setpoint + float(direction * (direction * curves.y[row]).max())
        why["t_peak"] = "undefined: the response does not pass its final value"
    low, high = (_first_reached(curves, row, part * final - setpoint, direction) for part in (0.1, 0.9))
    if low is not None and high is not None:
        out["t_rise"] = high - low
    else:
        why["t_rise"] = "undefined: the response does not reach 90 % of its final value within the horizon"
    out["t_settle"] = curves.last_outside(row, end, BAND * abs(final))
    if out["t_settle"] is None:
        why["t_settle"] = "undefined: not within 2 % of the final value at the end of the horizon"
    if summits.size >= 2:
        out["decay_ratio"] = float(height[1] / height[0])
    else:
        why["decay_ratio"] = "undefined: there are not two overshoots within the horizon"


def _first_reached(curves: HermiteCurves, row: int, level: float, direction: float) -> float | None:
    """When a response from rest reaches a level: at once where it jumps beyond."""
    jumps = direction * (float(curves.y[row, 0]) - level) >= 0.0
    return 0.0 if jumps else curves.first_crossing(row, level)


def _disturbed(
    curves: HermiteCurves, row: int, setpoint: float, final: float, out: Numbers, why: dict[str, str]
) -> None:
    """Peak and settling of a response that ends near where it began (a load step under control)."""
    times, turns = curves.extrema(row)
    t = np.concatenate([times, curves.t[[0, -1]]])
    y = np.concatenate([turns, curves.y[row, [0, -1]]]) + setpoint
    at = int(np.abs(y).argmax())
    out["t_peak"], peak = float(t[at]), float(y[at])
    out["peak"], span = peak, abs(peak)
    out["t_settle"] = curves.last_outside(row, final - setpoint, BAND * span) if span else 0.0
    if out["t_settle"] is None:
        why["t_settle"] = "undefined: not within 2 % of the largest deviation at the end of the horizon"
    for name in ("overshoot_pct", "t_rise"):
        why[name] = "undefined: meant for a setpoint step, whose final value is not zero"
    why["decay_ratio"] = "undefined: meant for a setpoint step"


def _judge(responses: Sequence[Response], setpoints: Sequence[float], stable: bool) -> list[StepMetrics]:
    """Metrics of responses over one time axis: the curves of all are measured together."""
    if not stable:
        return [
            StepMetrics(reasons=dict.fromkeys(NUMBERS, "undefined: the closed loop is not stable")) for _ in responses
        ]
    count = len(responses)
    values = np.array([*(r.y for r in responses), *(r.u for r in responses)])
    slopes = np.array([*(r.dy for r in responses), *(r.du for r in responses)])
    # The first rows are the errors y - r.
    for errors, setpoint in zip(values, setpoints, strict=False):
        if setpoint:
            errors -= setpoint
    curves = HermiteCurves(responses[0].t, values, slopes)
    integrals, variation = curves.absolute_integrals(count), curves.total_variation(count)
    judged = []
    for row, (response, setpoint) in enumerate(zip(responses, setpoints, strict=True)):
        out: Numbers = dict.fromkeys(NUMBERS)
        why: dict[str, str] = {}
        final = response.final_y
        if final is None:
            why |= dict.fromkeys(NUMBERS[:8], "undefined: the response has no final value")
        else:
            out["final_value"], out["offset"] = final, setpoint - final
            shape = _shape if setpoint and abs(final) > 1e-9 else _disturbed
            shape(curves, row, setpoint, final, out, why)
        out["IAE"], out["ISE"], out["ITAE"] = integrals[row]
        if final is not None and abs(setpoint - final) > 1e-9:
            for name in ("IAE", "ISE", "ITAE"):
                why[name] = "grows with the horizon: an offset remains"
        elif final is not None and out["t_settle"] is None:
            for name in ("IAE", "ISE", "ITAE", "TV"):
                why[name] = "up to the horizon: the response has not settled by then"
        out["TV"] = abs(float(response.u[0])) + variation[row]
        judged.append(StepMetrics(**out, reasons=why))
    return judged


def step_metrics(response: Response, *, setpoint: float, stable: bool) -> StepMetrics:
    r"""Judge one step response.

    .. math::

        \mathrm{IAE} = \int |e|\,dt,\quad \mathrm{ISE} = \int e^2\,dt,\quad \mathrm{ITAE} = \int t|e|\,dt,\quad
        \mathrm{TV} = \int |\dot u|\,dt + \text{jumps}

    Between the samples the curves are cubic Hermite polynomials through the exact values and slopes, so that peaks and
    crossing times are not tied to the grid.

    Parameters
    ----------
    response : Response
        From closed_loop_step.
    setpoint : float
        r: 1 for a setpoint step, 0 for a load step [output].
    stable : bool
        Verdict of the closed loop; an unstable loop has no metrics.

    Returns
    -------
    StepMetrics

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, secs. 5.4 and 12.2.
    """
    return _judge([response], [setpoint], stable)[0]


def loop_metrics(step: ClosedLoopStep, *, stable: bool) -> tuple[StepMetrics, StepMetrics]:
    """Judge the setpoint and the load response of a loop: step_metrics of both.

    Parameters
    ----------
    step : ClosedLoopStep
    stable : bool
        Verdict of the closed loop.

    Returns
    -------
    setpoint, load : StepMetrics
    """
    if step.setpoint.t.size == step.load.t.size:
        setpoint, load = _judge([step.setpoint, step.load], [1.0, 0.0], stable)
    else:
        setpoint = step_metrics(step.setpoint, setpoint=1.0, stable=stable)
        load = step_metrics(step.load, setpoint=0.0, stable=stable)
    return setpoint, load


def default_horizon(loop: FeedbackLoop) -> float:
    """A horizon that suits the plant, not the controller, so that the time axis holds while gains move [time].

    Eight ultimate periods where the plant has them, else ten times the sum of lags and dead time; rounded to 1, 2, 3,
    5 or 8 times a power of ten.
    """
    from looplab.engine.frequency.crossings import crossings

    P = loop.path
    # A lag without end (an integrator) has no time constant; unstable poles count by their speed.
    lags = [1.0 / abs(p) if p.imag == 0 else 1.0 / max(abs(p.real), 0.25 * abs(p)) for p in P.poles if p != 0]
    want = 10.0 * (sum(lags) + P.theta)
    found = crossings(P)
    above = found.phase_omega[np.isfinite(found.phase_log_magnitude)]
    if above.size:
        want = max(8.0 * 2.0 * np.pi / above.min(), 2.0 * want / 3.0)
    if not want > 0:
        want = 10.0 / abs(P.gain) ** (1.0 / max(P.relative_degree, 1)) if P.gain else 10.0
    steps = np.array([1.0, 2.0, 3.0, 5.0, 8.0, 10.0])
    power = 10.0 ** np.floor(np.log10(want))
    horizon = float(f"{steps[np.searchsorted(steps, want / power - 1e-9)] * power:.6g}")
    # A dead time much shorter than the horizon is not simulated.
    return min(horizon, 0.5 * P.theta / SHORTEST_DEAD_TIME) if P.theta else horizon
