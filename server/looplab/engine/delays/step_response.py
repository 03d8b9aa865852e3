"""Step responses of delayed systems, exact to rounding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.delays.steps import Steps
from looplab.engine.delays.system import DelaySystem
from looplab.engine.errors import InvalidInput
from looplab.engine.loop.step_response import LARGEST_VALUE, MAX_POINTS, MIN_POINTS, SHORTEST_DEAD_TIME, Response
from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class DelayStep:
    """Responses of every output to a unit step of each input.

    Attributes
    ----------
    t : ndarray, shape (N,)
        Evenly from 0 to the horizon [time].
    y, dy : ndarray, shape (N', p, m)
        Output i after a step of input j, and its slope (right-hand limits); N' < N where the response was cut.
    breakpoints : ndarray
        Times in (0, horizon) at which a signal inside the system jumps or has a kink [time].
    truncated_at, truncated_reason : float and str, or None
        Where the responses were cut, and why.
    """

    t: FloatArray
    y: FloatArray
    dy: FloatArray
    breakpoints: FloatArray
    truncated_at: float | None
    truncated_reason: str | None

    def response(self, output: int = 0, input: int = 0, final: float | None = None) -> Response:
        """One channel as the response that metrics are taken of; its u is the step itself."""
        t = self.t[: self.y.shape[0]]
        u = np.ones(t.size)
        return Response(
            t, self.y[:, output, input], u, self.dy[:, output, input], 0.0 * u, final,
            self.truncated_at, self.truncated_reason,
        )  # fmt: skip


def step_response(system: DelaySystem, horizon: float, points: int = 500) -> DelayStep:
    r"""Responses to unit steps from rest, by the method of steps.

    .. math:: \dot x = A x + B_1 u + B_2 w, \qquad w_i(t) = z_i(t - \tau_i)

    Between two breakpoints (sums of the dead times, as far as their kinks can be seen) every signal is analytic: there
    the equations are solved by collocation with polynomials of degree 24, on pieces that are halved until the last
    coefficients vanish.

    Parameters
    ----------
    system : DelaySystem
        Neutral ones included.
    horizon : float
        Length of the simulation, > 0 [time].
    points : int
        Samples, 20 to 5000.

    Returns
    -------
    DelayStep
        Cut, with the reason, where a value passes 1e9.

    Raises
    ------
    InvalidInput
        Horizon or points outside their range, or a dead time below a millionth of the horizon.
    NoConvergence
        The dead times are too short for the horizon.

    References
    ----------
    .. [1] R. Bellman, K. L. Cooke, Differential-Difference Equations, Academic Press 1963, ch. 3 (method of steps).
    .. [2] A. Bellen, M. Zennaro, Numerical Methods for Delay Differential Equations, Oxford 2003, ch. 3.
    """
    if not (np.isfinite(horizon) and horizon > 0):
        raise InvalidInput("the horizon must be a positive time", field="horizon")
    if not MIN_POINTS <= points <= MAX_POINTS:
        raise InvalidInput(f"points must be from {MIN_POINTS} to {MAX_POINTS}", field="points")
    if system.tau.size and system.tau.min() < SHORTEST_DEAD_TIME * horizon:
        raise InvalidInput(
            f"the dead time {system.tau.min():g} is shorter than a millionth of the horizon {horizon:g}",
            field="theta",
            hint="shorten the horizon, or leave the dead time out",
        )
    t = np.linspace(0.0, horizon, points)
    with np.errstate(over="ignore", invalid="ignore"):
        solved = Steps(system, horizon)
        y, dy = solved.outputs(t[t <= solved.end])
        bad = ~(np.abs(y) < LARGEST_VALUE).all(axis=(1, 2))
    stop = int(np.argmax(bad)) if bad.any() else y.shape[0]
    if stop == points:
        return DelayStep(t, y, dy, solved.breaks, None, None)
    return DelayStep(
        t, y[:stop], dy[:stop], solved.breaks, float(t[stop]), f"the response grows beyond {LARGEST_VALUE:g}"
    )
