"""The exact response of one linear system to an input made of pieces, from any initial state."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm, matrix_balance

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.delay_free import delay_free_response
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.response.delayed_loop import delayed_loop_response
from looplab.engine.response.inputs import InputSignal
from looplab.engine.stability.setpoint_transfer import setpoint_transfer
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.realization import StateSpace, realize
from looplab.engine.systems.transfer_function import LARGEST, TransferFunction

MIN_POINTS, MAX_POINTS = 2, 5000
LARGEST_VALUE = 1e9
LADDER = 52


@dataclass(frozen=True)
class SystemResponse:
    """y, u and the states over time.

    Attributes
    ----------
    t, u, y : ndarray, shape (count,)
        y and u hold the new value at a jump; u is the input itself, before any dead time. ``y`` is shorter than
        ``t`` where the response was cut.
    x : ndarray, shape (count, n)
        States, as many as y. With dead time they are those behind it: what is on its way is not among them.
    impulses : tuple of (time, area)
        Impulses in y, which no sample can show: those of the input that pass directly (D not 0).
    truncated_at, truncated_reason : float and str, or None
        Where the response was cut, and why.
    """

    t: FloatArray
    u: FloatArray
    y: FloatArray
    x: FloatArray
    impulses: tuple[tuple[float, float], ...]
    truncated_at: float | None
    truncated_reason: str | None


class _Stepper:
    """z = (states, a, b) carried over any time: the input's piece is two more states, in units of one sample."""

    def __init__(self, system: StateSpace, omega: float, h: float, breakpoints: int) -> None:
        n = system.B.size
        A, B, C = system.A, system.B, system.C
        self.scale = np.ones(n)
        if n:
            A, (self.scale, _) = matrix_balance(A, permute=False, separate=True)
            B, C = B / self.scale, C * self.scale
        # The input is scaled so that its column in the exponential is no larger than those of the states.
        self.unit = max(float(np.abs(B).max(initial=0.0)) / max(float(np.abs(A).max(initial=0.0)), 1.0 / h), 1e-300)
        self.n, self.h, self.omega = n, h, omega
        self.few = breakpoints < LADDER // 2
        self.M = np.zeros((n + 2, n + 2))
        self.M[:n, :n] = A * h
        self.M[:n, n] = B * (h / self.unit)
        self.M[n, n + 1] = omega * h if omega else 1.0
        self.M[n + 1, n] = -omega * h
        self.B = B
        # y, then z itself: the states, and what the next piece starts from.
        self.rows = np.vstack([np.zeros(n + 2), np.eye(n + 2)])
        self.rows[0, :n] = C
        self.rows[0, n] = system.D / self.unit

    def begin(self, x: FloatArray) -> FloatArray:
        """z for a state and no input yet."""
        return np.concatenate([x / self.scale, [0.0, 0.0]])

    def enter(self, z: FloatArray, start: FloatArray, area: float) -> FloatArray:
        """z with a new piece of the input, an impulse added to the states."""
        z = z.copy()
        z[: self.n] += self.B * area
        z[self.n] = start[0] * self.unit
        z[self.n + 1] = start[1] * self.unit * (1.0 if self.omega else self.h)
        return z

    @cached_property
    def step(self) -> FloatArray:
        """exp(M): over one sample."""
        return expm(self.M)

    @cached_property
    def ladder(self) -> list[FloatArray]:
        """exp(M/2), exp(M/4), ...: any part of a sample is a sum of these, no breakpoint needs its own."""
        return [expm(self.M * 0.5**k) for k in range(1, LADDER + 1)]

    def advance(self, z: FloatArray, part: float) -> FloatArray:
        """z later by a part, 0 to 1, of a sample."""
        if part <= 0.0:
            return z
        if part >= 1.0:
            return self.step @ z
        if self.few:
            return expm(self.M * part) @ z
        for rung in self.ladder:
            part *= 2.0
            if part >= 1.0:
                z = rung @ z
                part -= 1.0
                if part == 0.0:
                    break
        return z

    def samples(self, z: FloatArray, count: int) -> FloatArray:
        """y and z at z and at the ``count - 1`` samples after it, shape (count, 1 + n + 2)."""
        if count == 1:
            return (self.rows @ z)[None, :]
        return delay_free_response(self.M, self.rows, z[:, None], 1.0, count, self.step)[:, :, 0]


def _check(horizon: float, points: int) -> None:
    if not (np.isfinite(horizon) and 1e-9 <= horizon <= 1e9):
        raise InvalidInput("the horizon must be a time from 1e-9 to 1e9", field="horizon")
    if not MIN_POINTS <= points <= MAX_POINTS:
        raise InvalidInput(f"points must be from {MIN_POINTS} to {MAX_POINTS}", field="points")


def simulate(
    system: TransferFunction | StateSpace | FeedbackLoop,
    signal: InputSignal,
    horizon: float,
    points: int = 500,
    x0: npt.ArrayLike | None = None,
    theta: float | None = None,
) -> SystemResponse:
    r"""Response of one system to an input, exact to rounding, from any initial state.

    .. math:: y(t) = C e^{At} x_0 + \int_0^t C e^{A(t-s)} B\, u(s-\theta)\, ds + D\, u(t-\theta)

    Parameters
    ----------
    system : TransferFunction, StateSpace or FeedbackLoop
        Proper. For a transfer function the states are those of ``realize``. Of a loop y after its setpoint; with dead
        time it starts from rest, shows no states, and t may have up to twice as many samples.
    signal : InputSignal
    horizon : float
        Length of the simulation [time].
    points : int
        Samples of t, evenly from 0 to the horizon.
    x0 : array_like, shape (n,), or None
        State at t = 0; None is rest. Before t = 0 the input was zero.
    theta : float or None
        Dead time of a StateSpace, None for 0; a transfer function has its own [time].

    Returns
    -------
    SystemResponse
        Cut, with the reason, where |y| passes 1e9.

    Raises
    ------
    ImproperSystem, InvalidInput

    References
    ----------
    .. [1] C. F. Van Loan, Computing integrals involving the matrix exponential, IEEE Trans. Autom. Control 23 (1978)
       395-404.
    """
    _check(horizon, points)
    system = rational_part(system)
    if isinstance(system, FeedbackLoop):
        return _delayed(system, signal, horizon, points, x0)
    if isinstance(system, TransferFunction):
        theta = system.theta
        system = realize(system)
    n, delay = system.B.size, theta or 0.0
    if not np.isfinite(delay) or delay < 0:
        raise InvalidInput("the dead time must be zero or positive", field="theta")
    state = np.zeros(n) if x0 is None else np.atleast_1d(np.asarray(x0, dtype=float))
    if state.shape != (n,) or not np.abs(state).max(initial=0.0) <= LARGEST:
        raise InvalidInput(f"the initial state must be {n} finite numbers up to {LARGEST:g}", field="x0")
    t = np.linspace(0.0, horizon, points)
    with np.errstate(over="ignore", invalid="ignore"):
        stepper = _Stepper(system, signal.omega, horizon / (points - 1), signal.times.size)
        out = _march(stepper, signal.shifted(delay), state, points)
        stop, at, why = _end(t, out[:, 0])
    late = zip(signal.times + delay, system.D * signal.areas, strict=True)
    impulses = tuple((float(at), float(area)) for at, area in late if area and at <= horizon)
    return SystemResponse(t, signal.value(t), out[:stop, 0].copy(), out[:stop, 1:], impulses, at, why)


def rational_part(
    system: TransferFunction | StateSpace | FeedbackLoop,
) -> TransferFunction | StateSpace | FeedbackLoop:
    """A loop as its transfer function T where it has one; what has dead time in its feedback stays a loop."""
    if isinstance(system, FeedbackLoop) and not (system.theta and system.open_loop.gain):
        return setpoint_transfer(system)
    return system


def _end(t: FloatArray, y: FloatArray) -> tuple[int, float | None, str | None]:
    """How many samples stay within bounds, and where and why the rest is cut off."""
    with np.errstate(invalid="ignore"):
        bad = ~(np.abs(y) < LARGEST_VALUE)
    if not bad.any():
        return t.size, None, None
    stop = int(np.argmax(bad))
    return stop, float(t[stop]), f"the response grows beyond {LARGEST_VALUE:g}"


def _delayed(
    loop: FeedbackLoop, signal: InputSignal, horizon: float, points: int, x0: npt.ArrayLike | None
) -> SystemResponse:
    if x0 is not None and np.any(np.asarray(x0, dtype=float)):
        raise InvalidInput(
            "a loop with dead time starts from rest: what is on its way is part of its state", field="initial"
        )
    with np.errstate(over="ignore", invalid="ignore"):
        t, y = delayed_loop_response(loop, signal, horizon, points)
    stop, at, why = _end(t, y)
    return SystemResponse(t, signal.value(t), y[:stop], np.zeros((stop, 0)), (), at, why)


def _march(stepper: _Stepper, signal: InputSignal, x0: FloatArray, points: int) -> FloatArray:
    """y and x at every sample: from breakpoint to breakpoint, whole runs of samples at once."""
    n, h = stepper.n, stepper.h
    out = np.full((points, 1 + n), np.nan)
    z, at = stepper.begin(x0), 0.0
    done = 0
    edges = np.append(signal.times / h, np.inf)
    # A breakpoint within rounding of a sample is that sample.
    near = np.round(edges[:-1])
    edges[:-1] = np.where(np.abs(edges[:-1] - near) < 1e-12 * np.maximum(near, 1.0), near, edges[:-1])
    for i, edge in enumerate(edges):
        # Samples before this breakpoint; the one on it belongs to the piece that starts there.
        until = points if edge > points - 1 else int(np.ceil(edge))
        if until > done:
            z = stepper.advance(z, done - at)
            run = stepper.samples(z, until - done)
            out[done:until] = run[:, : 1 + n]
            z, at = run[-1, 1:], float(until - 1)
            done = until
        if done == points or not np.isfinite(z).all():
            break
        z = stepper.advance(z, edge - at)
        z = stepper.enter(z, signal.starts[i], float(signal.areas[i]))
        at = edge
    out[:, 1:] *= stepper.scale
    return out
