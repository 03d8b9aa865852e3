r"""Step responses of a feedback loop with dead times in several places.

Dead time and linear systems commute: with :math:`\theta` the sum of all dead times in the loop, every signal is that of
the loop with :math:`\theta` in its sensor alone, some time later or earlier. That loop has one dead time, and the fast
kernel answers it.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from math import ceil, lcm

import numpy as np

from looplab.engine.delays.connections import append, connect
from looplab.engine.delays.one_delay import ShiftEquations
from looplab.engine.delays.system import DelaySystem
from looplab.engine.loop.dead_time import DelayGrid, TimeGrid, delay_grid, delayed_response
from looplab.engine.loop.delay_free import delay_free_response
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.shift_series import circle_radius, pieces_of_dead_time
from looplab.engine.loop.step_response import LARGEST_VALUE, MAX_POINTS, ClosedLoopStep, Response
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

ONE = TransferFunction()
# Dead times whose ratio has no larger denominator share a grid.
LARGEST_DENOMINATOR = 60


@lru_cache(maxsize=64)
def loop_system(loop: FeedbackLoop) -> DelaySystem:
    r"""The closed loop with each dead time where it is.

    .. math:: u = C (r - y_m) + F r, \qquad y = P (A u + d) \text{ or } P A u + G_d d, \qquad y_m = H y

    Parameters
    ----------
    loop : FeedbackLoop

    Returns
    -------
    DelaySystem
        From r and d to y, u and y_m; every mode kept.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 12.1.
    """
    blocks = [loop.C, loop.actuator or ONE, loop.plant, loop.sensor or ONE]
    if loop.disturbance is not None:
        blocks.append(loop.disturbance)
    inner = append(*(DelaySystem.from_transfer_function(block) for block in blocks))
    C, A, P, H, G = range(5)
    size = len(blocks)
    F, E = np.zeros((size, size)), np.zeros((size, 2))
    out, straight = np.zeros((3, size)), np.zeros((3, 2))
    F[C, H], E[C, 0] = -1.0, 1.0
    F[A, C], E[A, 0] = 1.0, loop.feedforward
    F[P, A] = F[H, P] = 1.0
    out[0, P] = out[1, C] = out[2, H] = 1.0
    straight[1, 0] = loop.feedforward
    if loop.disturbance is None:
        E[P, 1] = 1.0
    else:
        F[H, G] = E[G, 1] = out[0, G] = 1.0
    return connect(inner, F, E, out, straight)


def _collected(loop: FeedbackLoop) -> FeedbackLoop:
    """The loop with all its dead time in the sensor."""
    sensor = loop.sensor or ONE
    return FeedbackLoop(
        loop.plant.without_dead_time(),
        loop.controller if not loop.C.theta else loop.C.without_dead_time(),
        loop.actuator and loop.actuator.without_dead_time(),
        TransferFunction(sensor.zeros, sensor.poles, sensor.gain, loop.theta),
        loop.disturbance and loop.disturbance.without_dead_time(),
    )


def _shifts(loop: FeedbackLoop) -> FloatArray:
    """How much later y, u and y_m come than in the collected loop, after steps of r and of d, shape (2, 3) [time]."""
    controller, plant = loop.C.theta, loop.plant.theta
    actuator = loop.actuator.theta if loop.actuator else 0.0
    enters = loop.load_path.theta
    return np.array(
        [
            [controller + actuator + plant, controller, 0.0],
            [enters, enters - actuator - plant, enters - actuator - plant - controller],
        ]
    )


def _aligned(points: int, horizon: float, theta: float, pieces: int, shifts: FloatArray) -> int:
    """Points for which the shifts are whole samples, where their ratios to the dead time are simple."""
    per_dead_time = theta * (points - 1) / horizon
    if per_dead_time < 1.0:
        return points
    ratios = [Fraction(float(s / theta)).limit_denominator(LARGEST_DENOMINATOR) for s in np.unique(shifts)]
    simple = all(abs(float(r) * theta - s) <= 1e-12 * theta for r, s in zip(ratios, np.unique(shifts), strict=True))
    unit = lcm(pieces, *(r.denominator for r in ratios))
    samples = unit * ceil(per_dead_time / unit - 1e-9)
    wanted = ceil(samples * horizon / theta - 1e-9) + 1
    return wanted if simple and wanted <= min(2 * points, MAX_POINTS) else points


def loop_step(loop: FeedbackLoop, horizon: float, points: int) -> ClosedLoopStep:
    """Responses of a loop with any of actuator, sensor, disturbance model and dead time in the controller.

    Parameters
    ----------
    loop : FeedbackLoop
    horizon, points :
        As in closed_loop_step, which has checked them.

    Returns
    -------
    ClosedLoopStep
        Exact to rounding. Where the dead times have simple ratios the grid holds every jump and kink of y, u and y_m.
    """
    system = loop_system(_collected(loop))
    p = system.outputs
    twice = DelaySystem(
        system.A,
        system.B,
        np.vstack([system.C1, system.C]),
        np.vstack([system.D[:p], system.D]),
        system.tau,
    )
    shifts, theta = _shifts(loop), loop.theta
    plain = ShiftEquations(twice, np.zeros(2 * p))
    early = max(0.0, -float(shifts.min()))
    with np.errstate(over="ignore", invalid="ignore"):
        if theta:
            pieces = pieces_of_dead_time(plain.at, theta, circle_radius(plain.echo))
            points = _aligned(points, horizon, theta, pieces, shifts)
            grid: TimeGrid = delay_grid(theta, horizon, points, pieces)
        else:
            grid = TimeGrid(horizon / (points - 1), points)
        whole = np.ceil(shifts / grid.h - 1e-9)
        offsets = whole * grid.h - shifts
        offsets[offsets < 1e-9 * grid.h] = 0.0
        equations = ShiftEquations(twice, offsets.ravel())
        more = int(np.ceil(early / grid.h)) + 1
        if isinstance(grid, DelayGrid):
            longer = replace(grid, count=grid.count + more)
            _, values = delayed_response(
                equations.at, equations.starts, theta, horizon, points, equations.echo, on=longer
            )
        else:
            A, rows = equations.at(np.ones(1, dtype=complex))
            values = delay_free_response(A[0].real, rows[0].real, equations.starts, grid.h, grid.count + more)
    why = f"the response grows beyond {LARGEST_VALUE:g}: the loop is unstable"
    responses = []
    for j, final in enumerate(_final_values(loop)):
        shifted = np.zeros((grid.count, 2 * p))
        for i in range(p):
            shift = int(whole[j, i])
            column = j * p + i
            moved = values[max(0, -shift) : max(0, grid.count - shift), :, j]
            shifted[max(0, shift) :, i] = moved[:, column]
            shifted[max(0, shift) :, p + i] = moved[:, 2 * p + column]
        responses.append(_cut(grid.t, shifted, loop.sensor is not None, final, why))
    return ClosedLoopStep(grid.t, horizon, *responses)


def _cut(t: FloatArray, rows: FloatArray, measured: bool, final: float | None, why: str) -> Response:
    y, u, y_m, dy, du, _ = rows.T
    with np.errstate(invalid="ignore"):
        bad = ~((np.abs(y) < LARGEST_VALUE) & (np.abs(u) < LARGEST_VALUE) & (np.abs(y_m) < LARGEST_VALUE))
    stop = int(np.argmax(bad)) if bad.any() else t.size
    whole = stop == t.size
    return Response(
        t[:stop], y[:stop], u[:stop], dy[:stop], du[:stop], final,
        None if whole else float(t[stop]), None if whole else why, y_m[:stop] if measured else None,
    )  # fmt: skip


def _at_rest(N: TransferFunction, L: TransferFunction) -> float | None:
    """Limit of N/(1 + L) for s to 0; None where it is infinite or undefined."""
    if not N.gain:
        return 0.0
    order, gain = N.origin_order, N.origin_gain
    if L.gain and L.origin_order > 0:
        order, gain = order - L.origin_order, gain / L.origin_gain
    else:
        if abs(1.0 + L.dc_gain) < 1e-12:
            return None
        gain /= 1.0 + L.dc_gain
    return gain if order == 0 else 0.0 if order < 0 else None


def _final_values(loop: FeedbackLoop) -> tuple[float | None, float | None]:
    """Limits of y after unit steps of r and d, as if the loop were stable."""
    forward = loop.plant * (loop.actuator or ONE)
    L = loop.open_loop
    setpoint = _at_rest(forward * loop.C, L)
    if loop.feedforward:
        weight = _at_rest(forward, L)
        setpoint = None if setpoint is None or weight is None else setpoint + loop.feedforward * weight
    return setpoint, _at_rest(loop.load_path, L)
