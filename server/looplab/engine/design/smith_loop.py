"""A Smith predictor judged as the loops of PI and PID are, on a plant that need not be its model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from looplab.engine.delays import (
    DelaySystem,
    control_loop,
    delay_margins,
    delay_verdict,
    feedback,
    series,
    smith_predictor,
    step_response,
)
from looplab.engine.frequency import Margins
from looplab.engine.loop import PID, ClosedLoopStep, Response
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning import ComparedLoop
from looplab.engine.tuning.comparison import judge_step

# Time constants of an unstable mode of the model after which its rounding errors stand beside the response.
GROWTHS = 7.0


def _inverse_at_rest(system: TransferFunction) -> float:
    """1/G(0): zero with an integrator, infinite for a system that passes no constant."""
    gain = system.dc_gain
    return 0.0 if np.isinf(gain) else 1.0 / gain if gain else np.inf


def predictor_gain_inverse(controller: TransferFunction, model: TransferFunction) -> float:
    r"""One over the static gain of a Smith predictor: with an integrating model it is finite in spite of the integral.

    .. math:: \frac{1}{C_{smith}(0)} = \frac{1}{C(0)} + \lim_{s\to0} G_0(s)\,(1 - e^{-\theta s})

    Parameters
    ----------
    controller : TransferFunction
        C.
    model : TransferFunction
        G_0 with its dead time theta.

    Returns
    -------
    float
        K' theta where the model is K'/s and C integrates; infinite for two integrators.

    References
    ----------
    .. [1] K. Watanabe, M. Ito, IEEE Trans. Automatic Control 26 (1981) 1261-1269 (offset with integrating plants).
    """
    echo = 0.0
    if model.origin_order == 1:
        echo = model.origin_gain * model.theta
    elif model.origin_order > 1 and model.theta:
        echo = np.inf
    return _inverse_at_rest(controller) + echo


def _finals(controller: TransferFunction, model: TransferFunction, plant: TransferFunction) -> tuple[float | None, ...]:
    """Limits of y after unit steps of r and d, as if the loop were stable; None where infinite or undefined."""
    inverse, passes = predictor_gain_inverse(controller, model), _inverse_at_rest(plant)
    setpoint = 1.0 + inverse * passes
    load = passes + (1.0 / inverse if inverse else np.inf)
    return tuple(None if x == 0 or np.isnan(x) else float(1.0 / x) for x in (setpoint, load))


def _followed(model: TransferFunction) -> float:
    """How long responses can be followed beside a hidden mode that grows [time]."""
    fastest = float(model.poles.real.max(initial=0.0))
    return GROWTHS / fastest if fastest > 0 else np.inf


def smith_loop(
    controller: PID, model: TransferFunction, plant: TransferFunction, horizon: float, points: int = 400
) -> ComparedLoop:
    r"""Margins, metrics and responses of a Smith predictor on a plant.

    .. math:: y = P (u + d), \qquad u = \frac{C}{1 + C\,(G_0 - G_0 e^{-\theta s})}\,(r - y)

    Parameters
    ----------
    controller : PID
        C.
    model : TransferFunction
        What the predictor knows, with its dead time.
    plant : TransferFunction
        The plant itself.
    horizon : float
        Length of the responses [time].
    points : int
        Samples, 20 to 5000.

    Returns
    -------
    ComparedLoop
        ``margins.closed_loop_stable`` counts every mode; the predictor's own copy of an integrating model, which
        nothing shows and nothing moves, alone is left out.

    Raises
    ------
    ImproperSystem, IllPosedLoop, InvalidInput, NoConvergence

    References
    ----------
    .. [1] O. J. M. Smith, Closer control of loops with dead time, Chem. Eng. Progress 53(5) (1957) 217-219.
    """
    C = controller.to_transfer_function()
    predictor, P = smith_predictor(C, model), DelaySystem.from_transfer_function(plant.require_proper("plant"))
    L = series(predictor, P)
    found: Margins = delay_margins(L)
    if not found.closed_loop_stable and model.origin_order == 1:
        held = delay_verdict(feedback(L))
        if held.verdict == "marginal" and "origin" in held.because and found.gain_crossovers:
            room = min(float(np.mod(np.radians(c.PM_deg), 2.0 * np.pi)) / c.omega for c in found.gain_crossovers)
            reasons = {name: why for name, why in found.reasons.items() if name != "delay_margin"}
            found = replace(found, closed_loop_stable=True, delay_margin=room, reasons=reasons)
    stable = found.closed_loop_stable
    end = min(horizon, _followed(model))
    steps = step_response(control_loop(P, predictor), end, max(20, round(points * end / horizon)))
    cut = (steps.truncated_at, steps.truncated_reason)
    if end < horizon and steps.truncated_at is None:
        cut = (end, "the predictor's hidden unstable mode grows: beyond this time rounding is all that would be seen")
    t = steps.t[: steps.y.shape[0]]
    curves = [[np.ascontiguousarray(v[:, i, j]) for v in (steps.y, steps.dy) for i in (0, 1)] for j in (0, 1)]
    setpoint, load = (
        Response(t, y, u, dy, du, final if stable else None, *cut)
        for (y, u, dy, du), final in zip(curves, _finals(C, model, plant), strict=True)
    )
    return ComparedLoop(
        controller,
        found,
        judge_step(setpoint, setpoint=1.0, stable=stable),
        judge_step(load, setpoint=0.0, stable=stable),
        ClosedLoopStep(steps.t, horizon, setpoint, load),
    )


def known_failures(controller: PID, model: TransferFunction) -> tuple[str, ...]:
    """What a Smith predictor cannot do with this model, in sentences."""
    C = controller.to_transfer_function()
    out = []
    if (model.poles.real > 1e-9 * np.abs(model.poles)).any():
        out.append(
            "The model is unstable. The predictor carries a copy of it that feedback does not reach: a load, or the "
            "smallest rounding, grows without end, although the answer to a setpoint looks well at first."
        )
    if model.origin_order >= 1:
        size = predictor_gain_inverse(C, model)
        if model.origin_order == 1 and size:
            out.append(
                f"The model integrates. A constant load leaves an offset of {size:.4g} per unit of load (K' theta with "
                "an integral controller), because the predictor takes it for its own error."
            )
        out.append(
            "The predictor's own integrator is not held by the loop: build it as a moving average over the dead time, "
            "or use a modified predictor (Watanabe and Ito, Astrom and others)."
        )
    return tuple(out)
