"""Step responses of y and u, exact with and without dead time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.dead_time import TimeGrid, delay_grid, delayed_response
from looplab.engine.loop.delay_free import delay_free_response
from looplab.engine.loop.equations import loop_equations
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

MIN_POINTS, MAX_POINTS = 20, 5000
SHORTEST_DEAD_TIME = 1e-6
LARGEST_VALUE = 1e9


@dataclass(frozen=True)
class Response:
    """y and u after a unit step, with their slopes; cut where the values leave +-1e9.

    All arrays have the shape of ``t`` [time] (right-hand limits at jumps). ``truncated_at`` [time] and
    ``truncated_reason`` are None for a whole response. ``y_m`` is what a sensor makes of y, None without a sensor.
    """

    t: FloatArray
    y: FloatArray
    u: FloatArray
    dy: FloatArray
    du: FloatArray
    final_y: float | None
    truncated_at: float | None = None
    truncated_reason: str | None = None
    y_m: FloatArray | None = None


@dataclass(frozen=True)
class ClosedLoopStep:
    """Responses to a unit step of the setpoint r and of the load d."""

    t: FloatArray
    horizon: float
    setpoint: Response
    load: Response


def _check(horizon: float, points: int, theta: float) -> None:
    if not (np.isfinite(horizon) and horizon > 0):
        raise InvalidInput("the horizon must be a positive time", field="horizon")
    if not MIN_POINTS <= points <= MAX_POINTS:
        raise InvalidInput(f"points must be from {MIN_POINTS} to {MAX_POINTS}", field="points")
    if 0 < theta < SHORTEST_DEAD_TIME * horizon:
        raise InvalidInput(
            f"the dead time {theta:g} is shorter than a millionth of the horizon {horizon:g}",
            field="theta",
            hint="shorten the horizon, or leave the dead time out",
        )


def _cut(t: FloatArray, rows: FloatArray, final: float | None, why: str) -> Response:
    """The response in the rows y, u, dy/dt, du/dt, shape (4, n), as far as it stays within bounds."""
    with np.errstate(invalid="ignore"):
        inside = np.abs(rows[:2]) < LARGEST_VALUE
    if inside.all():
        y, u, dy, du = rows
        return Response(t, y, u, dy, du, final)
    stop = int(inside.all(axis=0).argmin())
    y, u, dy, du = rows[:, :stop]
    return Response(t[:stop], y, u, dy, du, final, float(t[stop]), why)


def _final_values(loop: FeedbackLoop) -> tuple[float | None, float | None]:
    """Limits of y for s to 0 after unit steps of r and d, as if the loop were stable."""
    L = loop.open_loop
    P, C = loop.plant, loop.C
    if L.origin_order > 0:
        setpoint = 1.0
        # P/(1+L) ~ P/L = 1/C for small s.
        load = 1.0 / C.dc_gain if C.origin_order == 0 and C.dc_gain else (0.0 if C.origin_order > 0 else None)
        # A setpoint weight adds F P/(1+L): it vanishes with integral action, else shifts the final value.
        if loop.feedforward and load is not None:
            setpoint += loop.feedforward * load
        return setpoint, load
    if abs(1.0 + L.dc_gain) < 1e-12 or not np.isfinite(P.dc_gain):
        return None, None
    load = P.dc_gain / (1.0 + L.dc_gain)
    return L.dc_gain / (1.0 + L.dc_gain) + loop.feedforward * load, load


def closed_loop_step(loop: FeedbackLoop, horizon: float, points: int = 500) -> ClosedLoopStep:
    r"""y and u after unit steps of the setpoint and of the load, exact to rounding, dead time included.

    .. math:: y = \frac{P A C}{1 + L}\, r + \frac{P}{1 + L}\, d, \qquad u = C (r - H y), \qquad L = C A P H

    Parameters
    ----------
    loop : FeedbackLoop
        At rest before t = 0. Without actuator and sensor A = H = 1; a disturbance model Gd stands for P before d.
    horizon : float
        Length of the simulation, > 0 [time].
    points : int
        Samples wanted, 20 to 5000. With dead time the grid is chosen so that every multiple of the dead time is a
        sample; it then has up to twice as many points and may end a step before the horizon.

    Returns
    -------
    ClosedLoopStep
        The load enters at the plant input, or through Gd. An unstable response is cut where it leaves +-1e9, with
        the reason.

    Raises
    ------
    InvalidInput
        Horizon or points outside their range, or a dead time below a millionth of the horizon.
    NoConvergence
        The dead time is too long for the speed of the loop and the horizon.

    References
    ----------
    .. [1] R. Bellman, K. L. Cooke, Differential-Difference Equations, Academic Press 1963, ch. 3 (method of steps).
    """
    theta = loop.theta
    _check(horizon, points, theta)
    if not loop.has_one_dead_time:
        from looplab.engine.delays.loop_response import loop_step

        return loop_step(loop, horizon, points)
    equations = loop_equations(loop)
    with np.errstate(over="ignore", invalid="ignore"):
        if theta == 0.0:
            grid = TimeGrid(horizon / (points - 1), points)
            A, rows = equations.without_shift
            out = delay_free_response(A, rows, equations.starts, grid.h, grid.count)
        else:
            grid, out = delayed_response(equations.at, equations.starts, theta, horizon, points, abs(equations.DpDc))
    t, why = grid.t, f"the response grows beyond {LARGEST_VALUE:g}: the loop is unstable"
    final_r, final_d = _final_values(loop)
    setpoint, load = out.transpose(2, 1, 0)
    values = out[:, :2]
    if values.min() > -LARGEST_VALUE and values.max() < LARGEST_VALUE:
        both = (Response(t, y, u, dy, du, final) for (y, u, dy, du), final in ((setpoint, final_r), (load, final_d)))
        return ClosedLoopStep(t, horizon, *both)
    return ClosedLoopStep(t, horizon, _cut(t, setpoint, final_r, why), _cut(t, load, final_d, why))


def step_response(system: TransferFunction, horizon: float, points: int = 500) -> Response:
    """Unit step response of one system, exact to rounding; its dead time only shifts it.

    Parameters
    ----------
    system : TransferFunction
        Proper.
    horizon, points :
        As in closed_loop_step.

    Returns
    -------
    Response
        u is the step itself.

    Raises
    ------
    ImproperSystem, InvalidInput
    """
    _check(horizon, points, system.theta)
    ss = realize(system)
    n = ss.B.size
    A = np.zeros((n + 1, n + 1))
    A[:n, :n], A[:n, n] = ss.A, ss.B
    row = np.append(ss.C, ss.D)
    x0 = np.zeros((n + 1, 1))
    x0[-1] = 1.0
    grid, shift = TimeGrid(horizon / (points - 1), points), 0
    if system.theta:
        grid = delay_grid(system.theta, horizon, points)
        shift = grid.samples if grid.pieces_per_step == 1 else 1
        # Where a step is several dead times, the first sample comes that much after the dead time's end.
        x0 = expm(A * (shift * grid.h - system.theta)) @ x0 if grid.pieces_per_step > 1 else x0
    with np.errstate(over="ignore", invalid="ignore"):
        values = delay_free_response(A, np.stack([row, row @ A]), x0, grid.h, grid.count)[:, :, 0]
    rows = np.zeros((4, grid.count))
    if shift < grid.count:
        rows[::2, shift:] = values[: grid.count - shift].T
    rows[1] = 1.0
    final = system.dc_gain if np.isfinite(system.dc_gain) else None
    return _cut(grid.t, rows, final, f"the response grows beyond {LARGEST_VALUE:g}")
