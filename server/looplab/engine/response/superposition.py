"""Superposition made visible: a staircase as a sum of shifted steps, and convolution as a sum of shifted impulses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.response.inputs import InputSignal, step
from looplab.engine.response.simulate import rational_part, simulate
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.realization import StateSpace
from looplab.engine.systems.transfer_function import TransferFunction

MAX_TERMS = 50
MAX_NUMBERS = 60_000


@dataclass(frozen=True)
class Term:
    """The answer to one step of ``amplitude`` at ``start``, y of shape (count,)."""

    amplitude: float
    start: float
    y: FloatArray


@dataclass(frozen=True)
class Superposition:
    """A response as a sum.

    Attributes
    ----------
    t : ndarray, shape (count,)
    terms : tuple of Term
        One for each step of the staircase.
    free : ndarray, shape (count,)
        What the initial state does without input.
    total : ndarray, shape (count,)
        free and all terms added.
    error : float
        Largest difference to the response computed in one go, relative to its size.
    truncated_at : float or None
        Where the shortest of them was cut.
    """

    t: FloatArray
    terms: tuple[Term, ...]
    free: FloatArray
    total: FloatArray
    error: float
    truncated_at: float | None


def superposition(
    system: TransferFunction | StateSpace | FeedbackLoop,
    signal: InputSignal,
    horizon: float,
    points: int = 500,
    x0: npt.ArrayLike | None = None,
    theta: float | None = None,
) -> Superposition:
    r"""The response to a staircase as the sum of the responses to its steps, each shifted to its time.

    .. math:: y(t) = y_\mathrm{free}(t) + \sum_k \Delta u_k\, s(t - t_k), \qquad s = \text{unit step response}

    Parameters
    ----------
    system, horizon, points, x0, theta :
        As in simulate.
    signal : InputSignal
        A staircase of at most 50 steps: a step, a pulse, or held samples.

    Returns
    -------
    Superposition
        Each term by itself, their sum, and how far it is from the response in one go.

    Raises
    ------
    InvalidInput
        The signal is no staircase, or has too many steps.

    References
    ----------
    .. [1] A. V. Oppenheim, A. S. Willsky, Signals and Systems, 2nd ed., Prentice Hall 1997, section 2.2.
    """
    if not signal.held:
        raise InvalidInput(
            "only a staircase is a sum of steps", field="input", hint="use a step, a pulse or held samples"
        )
    jumps = signal.jumps()
    used = np.flatnonzero(jumps)
    if used.size > MAX_TERMS:
        raise InvalidInput(
            f"{used.size} steps are more than can be shown one by one ({MAX_TERMS})", field="input", hint="hold longer"
        )
    if used.size * points > MAX_NUMBERS:
        raise InvalidInput(
            f"{used.size} steps of {points} points each are more than {MAX_NUMBERS} numbers",
            field="points",
            hint="ask for fewer points",
        )
    whole = simulate(system, signal, horizon, points, x0, theta)
    free = simulate(system, signal.scaled(0.0), horizon, points, x0, theta)
    parts = [
        simulate(system, step(float(jumps[k]), float(signal.times[k])), horizon, points, None, theta) for k in used
    ]
    count = min(part.y.size for part in (whole, free, *parts))
    terms = tuple(
        Term(float(jumps[k]), float(signal.times[k]), part.y[:count]) for k, part in zip(used, parts, strict=True)
    )
    total = free.y[:count] + np.sum([term.y for term in terms], axis=0, initial=0.0)
    size = max((np.abs(v).max(initial=0.0) for v in (free.y[:count], *(term.y for term in terms))), default=0.0)
    difference = float(np.abs(total - whole.y[:count]).max(initial=0.0))
    return Superposition(
        whole.t,
        terms,
        free.y[:count],
        total,
        difference / size if size else 0.0,
        float(whole.t[count]) if count < points else None,
    )


@dataclass(frozen=True)
class Convolution:
    """The convolution integral as a sum of ``weights.size`` impulse responses, beside the exact response.

    Attributes
    ----------
    t : ndarray, shape (count,)
    times, weights : ndarray, shape (k,)
        Middle of each slice of the input, and u there times the slice's width [input*time].
    h : ndarray, shape (count,)
        Impulse response (without the impulse in it where D is not 0).
    total : ndarray, shape (count,)
        The sum.
    exact : ndarray, shape (count,)
    error : float
        Largest difference of the two; halving the slices quarters it where h and u are smooth.
    """

    t: FloatArray
    times: FloatArray
    weights: FloatArray
    h: FloatArray
    total: FloatArray
    exact: FloatArray
    error: float


def convolution(
    system: TransferFunction | StateSpace | FeedbackLoop,
    signal: InputSignal,
    horizon: float,
    points: int = 500,
    slices: int = 50,
    theta: float | None = None,
) -> Convolution:
    r"""The response from rest as a sum of impulse responses: each slice of the input is one impulse.

    .. math:: y(t) = \int_0^t h(t-\tau)\,u(\tau)\,d\tau \approx \sum_{\tau_k < t} h(t-\tau_k)\,u(\tau_k)\,\Delta\tau

    Parameters
    ----------
    system, horizon, points, theta :
        As in simulate.
    signal : InputSignal
        Without impulses of its own.
    slices : int
        Number of slices of the horizon, 1 to 500. The middle of each is where its impulse is put.

    Returns
    -------
    Convolution
        The sum, the exact response, and how far they are apart. What passes directly (D u) is added exactly.

    Raises
    ------
    InvalidInput
        The signal holds an impulse, or the number of slices is out of range.

    References
    ----------
    .. [1] A. V. Oppenheim, A. S. Willsky, Signals and Systems, 2nd ed., Prentice Hall 1997, section 2.2.
    """
    if signal.areas.any():
        raise InvalidInput("the response to an impulse is h itself", field="input", hint="use another input")
    if not 1 <= slices <= 500:
        raise InvalidInput("slices must be from 1 to 500", field="slices")
    exact = simulate(system, signal, horizon, points, None, theta)
    width = horizon / slices
    times = ((np.arange(slices) + 0.5) * width).astype(float)
    weights = signal.value(times) * width
    # A frequency that nothing has keeps the time axis that of the exact response.
    train = InputSignal(times, np.zeros((slices, 2)), weights, signal.omega)
    single = InputSignal(np.zeros(1), np.zeros((1, 2)), np.ones(1), signal.omega)
    total, h = (
        simulate(system, train, horizon, points, None, theta),
        simulate(system, single, horizon, points, None, theta),
    )
    system = rational_part(system)
    if isinstance(system, FeedbackLoop):
        theta, feedthrough = system.theta, 0.0
    elif isinstance(system, TransferFunction):
        theta, feedthrough = system.theta, system.high_frequency_gain
    else:
        theta, feedthrough = theta or 0.0, system.D
    count = min(exact.y.size, total.y.size, h.y.size)
    t = exact.t[:count]
    summed = total.y[:count] + (feedthrough * signal.shifted(theta).value(t) if feedthrough else 0.0)
    error = float(np.abs(summed - exact.y[:count]).max(initial=0.0))
    return Convolution(exact.t, times, weights, h.y[:count], summed, exact.y[:count], error)
