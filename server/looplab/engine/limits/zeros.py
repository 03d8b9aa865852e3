"""What zeros do to a step response: undershoot for those on the right, overshoot for slow ones on the left."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, expm1

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.limits.interpolation import right_half_plane
from looplab.engine.limits.measured import measured_loop
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.hermite import HermiteCurves
from looplab.engine.loop.metrics import default_horizon
from looplab.engine.loop.step_response import Response, closed_loop_step, step_response
from looplab.engine.stability.closed_loop import closed_loop_poles
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

ComplexArray = npt.NDArray[np.complex128]

BAND = 0.02
# Below this part of the final value the error is rounding, and says nothing of its decay.
ROUNDING = 1e-9
# Farther than this the exponential leaves double precision, and the bound is nothing.
LARGEST_EXPONENT = 700.0
POINTS = 1500
# A lag has settled to rounding after so many of its time constants.
LAGS = 10.0
# A loop that has not settled is given twice the time, so often.
LONGER = 5


def undershoot_bound(c: float, t_settle: float, band: float = BAND) -> float:
    r"""Least undershoot of a unit step response that settles in a given time, because of a zero at c > 0.

    .. math:: M_u \ge \frac{1 - \delta}{e^{c\,t_s} - 1}

    Parameters
    ----------
    c : float
        The zero, > 0 [rad/time].
    t_settle : float
        From then on the response is within 1 +- band, > 0 [time].
    band : float
        delta [-].

    Returns
    -------
    float
        As a fraction of the final value [-].

    Raises
    ------
    InvalidInput
        c or t_settle is not positive.

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, lemma 4.1.
    """
    if not (c > 0 and t_settle > 0):
        raise InvalidInput("the zero and the settling time must be positive", field="c")
    return (1.0 - band) / expm1(c * t_settle) if c * t_settle < LARGEST_EXPONENT else 0.0


def overshoot_bound(c: float, t_settle: float, p: float, residue: float) -> float:
    r"""Least overshoot of a unit step response because of a zero at c < 0 that is slower than the slowest pole -p.

    .. math:: M_o \ge \frac{1}{e^{-c\,t_s} - 1}
        \left(1 - \frac{\eta}{1 - \eta}\, K e^{-p t_s}\, e^{-c\,t_s}\right), \qquad \eta = |c/p|, \quad
        |1 - y(t)| \le K e^{-pt} \text{ for } t \ge t_s

    Parameters
    ----------
    c : float
        The zero, -p < c < 0 [rad/time].
    t_settle : float
        > 0 [time].
    p : float
        Minus the real part of the slowest pole [rad/time].
    residue : float
        K e^{-p t_s}: the error at t_settle, or what it is bounded by if it decays as e^{-pt} [-].

    Returns
    -------
    float
        As a fraction of the final value; 0 where the lemma says nothing [-].

    Raises
    ------
    InvalidInput
        c is not between -p and 0, or t_settle is not positive.

    Notes
    -----
    The textbook drops e^{-(p + c) t_s} <= 1 behind K, which makes the bound weaker.

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, lemma 4.2.
    """
    if not (-p < c < 0 and t_settle > 0):
        raise InvalidInput("the zero must lie between the slowest pole and the origin", field="c")
    eta, exponent = abs(c) / p, -c * t_settle
    if exponent > LARGEST_EXPONENT:
        return 0.0
    return max(0.0, (1.0 - eta / (1.0 - eta) * residue * exp(exponent)) / expm1(exponent))


@dataclass(frozen=True)
class ZeroEffect:
    """One real zero c [rad/time]: ``effect`` "undershoot" or "overshoot", and its least size [%]."""

    c: float
    effect: str
    bound_pct: float


@dataclass(frozen=True)
class StepShape:
    """A step response seen with its zeros, in parts of its final value; None where it does not settle.

    Attributes
    ----------
    t_settle : float or None
        From then on within 2 % [time].
    undershoot_pct, overshoot_pct : float
        Farthest below the start and beyond the end [%].
    t_undershoot : float or None
        When [time]; None without undershoot.
    starts_up : bool or None
        Whether it first moves towards its final value; None where it does not move.
    effects : tuple of ZeroEffect
    reason : str or None
        Why there is nothing.
    """

    t_settle: float | None
    undershoot_pct: float | None
    overshoot_pct: float | None
    t_undershoot: float | None
    starts_up: bool | None
    effects: tuple[ZeroEffect, ...]
    reason: str | None = None


def step_shape(response: Response, zeros: ComplexArray, slowest: float) -> StepShape:
    """Undershoot, overshoot and settling of a response, and the bounds that its zeros set.

    Parameters
    ----------
    response : Response
        After a unit step, of a stable system with a final value that is not zero.
    zeros : ndarray of complex
        Those of the system that responds [rad/time].
    slowest : float
        p, minus the real part of its slowest pole [rad/time].

    Returns
    -------
    StepShape
        Zeros in the right half-plane give bounds on the undershoot, those between -p and 0 on the overshoot; for the
        latter the decay of the error is taken from the response.
    """
    final = response.final_y
    if final is None or final == 0.0 or response.truncated_at is not None:
        return StepShape(None, None, None, None, None, (), "the response has no final value other than zero")
    y = response.y / final
    curves = HermiteCurves(response.t, y[None, :], response.dy[None, :] / final)
    t_settle = curves.last_outside(0, 1.0, BAND)
    turns_t, turns_y = (values.tolist() for values in curves.extrema(0))
    lowest, at = min(zip(turns_y, turns_t, strict=True), default=(0.0, 0.0))
    highest = max(turns_y, default=1.0)
    moved = np.flatnonzero(np.abs(y) > ROUNDING)
    starts_up = bool(y[moved[0]] > 0) if moved.size else None
    under, over = 100.0 * max(0.0, -lowest), 100.0 * max(0.0, highest - 1.0)
    if t_settle is None:
        why = "the response does not come within 2 % of its final value in the time shown"
        return StepShape(None, under, over, at if under else None, starts_up, (), why)
    effects: list[ZeroEffect] = []
    if t_settle > 0:
        right, left = right_half_plane(zeros), zeros[(zeros.imag == 0) & (zeros.real < 0) & (zeros.real > -slowest)]
        for c in sorted(set(right.real[right.imag == 0].tolist())):
            effects.append(ZeroEffect(c, "undershoot", 100.0 * undershoot_bound(c, t_settle)))
        late = (response.t >= t_settle) & (np.abs(1.0 - y) > ROUNDING)
        decay = np.abs(1.0 - y[late]) * np.exp(slowest * (response.t[late] - t_settle))
        residue = max(BAND, float(decay.max(initial=0.0)))
        for c in sorted(set(left.real.tolist()), reverse=True):
            effects.append(ZeroEffect(c, "overshoot", 100.0 * overshoot_bound(c, t_settle, slowest, residue)))
    return StepShape(t_settle, under, over, at if under else None, starts_up, tuple(effects))


def loop_step_shape(loop: FeedbackLoop) -> StepShape:
    """step_shape of y after a setpoint step, with the zeros of T.

    Parameters
    ----------
    loop : FeedbackLoop
        Stable. Actuator, plant and sensor count as one plant, and the setpoint weight is left out.

    Returns
    -------
    StepShape
        Over a time in which the loop settles, if it does within 32 times the usual horizon.
    """
    alone = measured_loop(loop)
    L, _ = split_hidden_modes(alone.open_loop)
    poles = closed_loop_poles(FeedbackLoop(L, TransferFunction([], [], 1.0))).poles
    slowest, horizon = float(-poles.real.max(initial=-np.inf)), default_horizon(loop)
    shape = step_shape(closed_loop_step(alone, horizon, POINTS).setpoint, L.zeros, slowest)
    for _ in range(LONGER):
        if shape.t_settle is not None or shape.starts_up is None:
            break
        horizon *= 2.0
        shape = step_shape(closed_loop_step(alone, horizon, POINTS).setpoint, L.zeros, slowest)
    return shape


def plant_step_shape(plant: TransferFunction) -> StepShape:
    """step_shape of the plant alone, over its final value.

    Parameters
    ----------
    plant : TransferFunction
        Proper.

    Returns
    -------
    StepShape
        Nothing, with the reason, for a plant that does not come to rest, or comes to rest at zero.
    """
    reduced, _ = split_hidden_modes(plant)
    slowest = float(-plant.poles.real.max(initial=-np.inf))
    if not plant.poles.size or (plant.poles.real >= 0).any() or not plant.dc_gain:
        return StepShape(None, None, None, None, None, (), "the plant alone does not move to a value other than zero")
    horizon = reduced.theta + LAGS * plant.order / slowest
    return step_shape(step_response(reduced, horizon, POINTS), reduced.zeros, slowest)
