"""A loop with dead time, from its setpoint to y, for any input made of pieces: exact, not only for a step.

The input is the state of a generator, r' = s or a rotation, that is joined to the loop. A piece of the input that
begins at t_k sets off one solution of the joined equations, the same for every k but for its size and its start. All
are sampled on one grid, on which t_k need not lie: what is missing to the next sample, delta, is made up for by
exp(delta A(z)) in the rows that are read off, with z the shift by the dead time.
"""

from __future__ import annotations

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.dead_time import DelayGrid, delay_grid, delayed_response
from looplab.engine.loop.equations import LoopEquations, loop_equations
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.shift_series import circle_radius, expm_batch, pieces_of_dead_time
from looplab.engine.loop.step_response import SHORTEST_DEAD_TIME
from looplab.engine.response.inputs import InputSignal
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

MAX_NUMBERS = 2_000_000


class _Joined:
    """[loop states, r, d, s] as a function of the shift z, with y read off ``offsets`` after each sample."""

    def __init__(self, equations: LoopEquations, omega: float, offsets: FloatArray) -> None:
        self.equations, self.omega, self.offsets = equations, omega, offsets
        self.r = equations.base.shape[0] - 2

    def __call__(self, z: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        loop, rows = self.equations.at(z)
        k, n = loop.shape[:2]
        A = np.zeros((k, n + 1, n + 1), dtype=complex)
        A[:, :n, :n] = loop
        A[:, self.r, n] = self.omega or 1.0
        A[:, n, self.r] = -self.omega
        y = np.concatenate([rows[:, :1], np.zeros((k, 1, 1))], axis=2)
        return A, np.concatenate([y @ expm_batch(A * d) if d else y for d in self.offsets], axis=1)

    @property
    def starts(self) -> FloatArray:
        """After a jump of r to 1, after s has become 1, and after a unit impulse of r, shape (n + 1, 3)."""
        x0 = np.zeros((self.r + 3, 3))
        x0[self.r, 0] = x0[-1, 1] = 1.0
        x0[: self.r, 2] = self.equations.base[: self.r, self.r]
        return x0


def _jumps(signal: InputSignal) -> FloatArray:
    """What each piece of the input adds to the one before, carried on: (r, s, area), shape (k, 3)."""
    a, b = signal.starts[:-1].T
    lasted, w = np.diff(signal.times), signal.omega
    if w:
        cos, sin = np.cos(w * lasted), np.sin(w * lasted)
        carried = np.stack([a * cos + b * sin, b * cos - a * sin], axis=1)
    else:
        carried = np.stack([a + b * lasted, b], axis=1)
    new = signal.starts.astype(float)
    new[1:] -= carried
    return np.column_stack([new, signal.areas])


def _grid(joined: _Joined, theta: float, horizon: float, points: int, neutral: float) -> tuple[DelayGrid, int]:
    """A grid with a sample for each piece of the dead time, and the points to ask for to get it."""
    pieces = pieces_of_dead_time(joined, theta, circle_radius(neutral))
    wanted = max(points, int(np.ceil(horizon * pieces / theta)) + 1)
    return delay_grid(theta, horizon, wanted, pieces), wanted


def delayed_loop_response(
    loop: FeedbackLoop, signal: InputSignal, horizon: float, points: int
) -> tuple[FloatArray, FloatArray]:
    r"""y of a loop at rest with dead time after any setpoint.

    .. math:: y(t) = \sum_k \Delta g_k\, \phi(t - t_k)

    Parameters
    ----------
    loop : FeedbackLoop
        With a dead time in the plant.
    signal : InputSignal
        The setpoint; phi answers a jump, a slope (or sine) and an impulse of it.
    horizon : float
        Length of the simulation [time].
    points : int
        Samples wanted; every multiple of the dead time is one, so there may be more, up to twice as many.

    Returns
    -------
    t, y : ndarray, shape (count,)
        y is not finite where the response grows out of double precision.

    Raises
    ------
    InvalidInput
        Dead time in the controller or below a millionth of the horizon; an impulse that y would hold; too many pieces.
    NoConvergence
        The dead time is too long for the speed of the loop and the horizon.

    References
    ----------
    .. [1] R. Bellman, K. L. Cooke, Differential-Difference Equations, Academic Press 1963, ch. 3 (method of steps).
    """
    theta, equations = loop.plant.theta, loop_equations(loop)
    if loop.C.theta:
        raise InvalidInput(
            "a controller with a dead time of its own cannot be simulated here",
            field="loop.controller",
            hint="move the dead time into the plant",
        )
    if theta < SHORTEST_DEAD_TIME * horizon:
        raise InvalidInput(
            f"the dead time {theta:g} is shorter than a millionth of the horizon {horizon:g}",
            field="loop.plant.theta",
            hint="shorten the horizon, or leave the dead time out",
        )
    if equations.DpDc and signal.areas.any():
        raise InvalidInput(
            "plant and controller pass an impulse on again and again", field="input", hint="use a short pulse"
        )
    neutral = abs(equations.DpDc)
    grid, wanted = _grid(_Joined(equations, signal.omega, np.zeros(1)), theta, horizon, points, neutral)
    place = signal.times / grid.h
    first = np.ceil(place - 1e-9).astype(int)
    late = np.maximum(first - place, 0.0) * grid.h
    offsets, which = np.unique(np.where(late < 1e-9 * grid.h, 0.0, late), return_inverse=True)
    if offsets.size * grid.count > MAX_NUMBERS:
        raise InvalidInput(
            f"{signal.times.size} pieces of the input are too many for a loop with dead time",
            field="input",
            hint="use fewer samples, or fewer slices",
        )
    joined = _Joined(equations, signal.omega, offsets)
    grid, phi = delayed_response(joined, joined.starts, theta, horizon, wanted, neutral, on=grid)
    y = np.zeros(grid.count)
    for jump, start, k in zip(_jumps(signal), first, which, strict=True):
        if start < grid.count:
            y[start:] += phi[: grid.count - start, k] @ jump
    every = max(1, grid.count // points)
    return grid.t[::every], y[::every]
