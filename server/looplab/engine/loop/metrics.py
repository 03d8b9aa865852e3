"""What a step response is judged by. Undefined is None with a reason, never a made-up number."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.hermite import HermiteCurve
from looplab.engine.loop.step_response import Response

FloatArray = npt.NDArray[np.float64]

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
        Integrals of \\|e\\|, e^2 and t\\|e\\| over the horizon, e = r - y [output*time, ...].
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


def _rise(curve: HermiteCurve, final: float) -> float | None:
    low, high = curve.crossings(0.1 * final), curve.crossings(0.9 * final)
    return float(high[0] - low[0]) if low.size and high.size else None


def _settling(curve: HermiteCurve, final: float, span: float) -> float | None:
    """Last time outside the band around the final value; None when the record ends outside, or close to its end."""
    if abs(curve.y[-1] - final) > BAND * span:
        return None
    edges = np.concatenate([curve.crossings(final + BAND * span), curve.crossings(final - BAND * span)])
    return float(edges.max()) if edges.size else 0.0


def _overshoots(curve: HermiteCurve, final: float, direction: float) -> tuple[FloatArray, FloatArray]:
    """Times and heights of the successive summits beyond the final value."""
    t, y = curve.extrema()
    height = direction * (y - final)
    beyond = height > 1e-9 * max(abs(final), 1e-9)
    return t[beyond], height[beyond]


def _shape(curve: HermiteCurve, final: float, out: dict[str, float | None], why: dict[str, str]) -> None:
    """Peak, overshoot, rise, settling and decay of a response that moves from 0 to ``final``."""
    direction = np.sign(final)
    t_top, height = _overshoots(curve, final, direction)
    if t_top.size:
        i = int(np.argmax(height))
        out["peak"], out["t_peak"] = float(final + direction * height[i]), float(t_top[i])
        out["overshoot_pct"] = 100.0 * float(height[i]) / abs(final)
    else:
        out["overshoot_pct"] = 0.0
        out["peak"] = float(direction * (direction * curve.y).max())
        why["t_peak"] = "undefined: the response does not pass its final value"
    out["t_rise"] = _rise(curve, final)
    if out["t_rise"] is None:
        why["t_rise"] = "undefined: the response does not reach 90 % of its final value within the horizon"
    out["t_settle"] = _settling(curve, final, abs(final))
    if out["t_settle"] is None:
        why["t_settle"] = "undefined: not within 2 % of the final value at the end of the horizon"
    if height.size >= 2:
        out["decay_ratio"] = float(height[1] / height[0])
    else:
        why["decay_ratio"] = "undefined: there are not two overshoots within the horizon"


def _disturbed(curve: HermiteCurve, final: float, out: dict[str, float | None], why: dict[str, str]) -> None:
    """Peak and settling of a response that ends near where it began (a load step under control)."""
    t, y = curve.extrema()
    t, y = np.append(t, curve.t[[0, -1]]), np.append(y, curve.y[[0, -1]])
    i = int(np.argmax(np.abs(y)))
    out["peak"], out["t_peak"] = float(y[i]), float(t[i])
    span = abs(out["peak"] or 0.0)
    out["t_settle"] = _settling(curve, final, span) if span else 0.0
    if out["t_settle"] is None:
        why["t_settle"] = "undefined: not within 2 % of the largest deviation at the end of the horizon"
    for name in ("overshoot_pct", "t_rise"):
        why[name] = "undefined: meant for a setpoint step, whose final value is not zero"
    why["decay_ratio"] = "undefined: meant for a setpoint step"


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
    out: dict[str, float | None] = dict.fromkeys(NUMBERS)
    if not stable:
        return StepMetrics(reasons=dict.fromkeys(NUMBERS, "undefined: the closed loop is not stable"))
    why: dict[str, str] = {}
    final = response.final_y
    curve = HermiteCurve(response.t, response.y, response.dy)
    if final is None:
        why |= dict.fromkeys(NUMBERS[:8], "undefined: the response has no final value")
    else:
        out["final_value"], out["offset"] = final, setpoint - final
        if setpoint and abs(final) > 1e-9:
            _shape(curve, final, out, why)
        else:
            _disturbed(curve, final, out, why)
    out["IAE"], out["ISE"], out["ITAE"] = curve.absolute_integrals(setpoint)
    if final is not None and abs(setpoint - final) > 1e-9:
        for name in ("IAE", "ISE", "ITAE"):
            why[name] = "grows with the horizon: an offset remains"
    out["TV"] = abs(float(response.u[0])) + HermiteCurve(response.t, response.u, response.du).total_variation()
    return StepMetrics(**out, reasons=why)


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
    return float(f"{steps[np.searchsorted(steps, want / power - 1e-9)] * power:.6g}")
