"""The linear model at a point of a nonlinear one, and how far the two agree."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel, Jacobians
from looplab.engine.nonlinear.steady_states.verdict import judge
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.state_space.to_transfer_function import to_transfer_function
from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

_REST = 1e-8


@dataclass(frozen=True)
class LinearModel:
    """x - x0 and y - y0 of a model, for small deviations: d' = f0 + A d + B (u - u0), y = y0 + C d + D (u - u0).

    Attributes
    ----------
    x, u, p, y : tuple of float
        The point.
    f : tuple of float
        dx/dt there, not zero where the point is no equilibrium.
    jacobians : Jacobians
        A (n, n), B (n, m), C (q, n), D (q, m).
    equilibrium : bool
        Whether f is zero beyond rounding.
    poles : ndarray of complex
        Rightmost first [rad/time].
    verdict, because : str
    """

    x: Values
    u: Values
    p: Values
    y: Values
    f: Values
    jacobians: Jacobians
    equilibrium: bool
    poles: ComplexArray
    verdict: str
    because: str

    @property
    def time_constants(self) -> tuple[float, ...]:
        """1/abs(Re p) of the poles off the imaginary axis, slowest first, one for each pair [time]."""
        size = float(np.abs(self.poles).max(initial=0.0))
        shown = [p for p in self.poles if p.imag >= 0 and abs(p.real) > 1e-10 * size]
        return tuple(sorted((float(1.0 / abs(p.real)) for p in shown), reverse=True))

    def channel(self, output: int, input: int) -> StateSpaceModel:
        """One input and one output with all states; raises InvalidInput for more than 50 states."""
        J = self.jacobians
        return StateSpaceModel(J.A, J.B[:, [input]], J.C[[output]], J.D[[output]][:, [input]])

    def transfer_function(self, output: int, input: int) -> TransferFunction:
        """Transfer function of one input and output, hidden modes kept as equal zeros and poles."""
        return to_transfer_function(self.channel(output, input))


def linearize(model: CompiledModel, x: Values, u: Values, p: Values) -> LinearModel:
    r"""The linear model at a point, by exact derivatives.

    .. math:: A = \frac{\partial f}{\partial x},\; B = \frac{\partial f}{\partial u},\;
        C = \frac{\partial g}{\partial x},\; D = \frac{\partial g}{\partial u}

    Parameters
    ----------
    model : CompiledModel
    x, u, p : tuple of float
        The point, which need not be an equilibrium.

    Returns
    -------
    LinearModel
        ``equilibrium`` is True where each f_i is below 1e-8 of the sum of the sizes of its linear terms.

    Raises
    ------
    NonFinite
        A derivative does not exist there.

    References
    ----------
    .. [1] H. K. Khalil, Nonlinear Systems, 3rd ed., Prentice Hall 2002, section 4.3.
    """
    f = model.f(0.0, x, u, p)
    y = model.outputs(0.0, x, u, p)
    J = model.jacobians(0.0, x, u, p)
    terms = np.abs(J.A) @ np.abs(x) + (np.abs(J.B) @ np.abs(u) if u else 0.0)
    rest = bool((np.abs(f) <= _REST * np.maximum(terms, 1e-300)).all()) or not any(f)
    poles, verdict, because = judge(J.A)
    return LinearModel(tuple(x), tuple(u), tuple(p), y, f, J, rest, poles, verdict, because)


@dataclass(frozen=True)
class Comparison:
    """One output after a step of one input, of the linear and of the nonlinear model, both as absolute values.

    Attributes
    ----------
    size : float
        Of the step [input].
    t, linear, nonlinear : ndarray, shape (count,)
        Until the nonlinear simulation was cut.
    largest_deviation, at : float
        Largest abs(nonlinear - linear) and when [output], [time].
    relative : float or None
        That over the largest excursion of the linear response; None where it does not move.
    truncated_at, truncated_reason : float and str, or None
    """

    size: float
    t: FloatArray
    linear: FloatArray
    nonlinear: FloatArray
    largest_deviation: float
    at: float
    relative: float | None
    truncated_at: float | None
    truncated_reason: str | None


def linear_step(point: LinearModel, output: int, input: int, size: float, t: FloatArray) -> FloatArray:
    """The linear model's output after a step of one input at t = 0, exact at equally spaced times, shape (count,)."""
    J = point.jacobians
    n = len(point.x)
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n], whole[:n, n] = J.A, np.array(point.f) * (not point.equilibrium) + J.B[:, input] * size
    over_step = expm(whole * float(t[1] - t[0]))
    d = np.zeros(n + 1)
    d[n] = 1.0
    out = np.empty(t.size)
    for index in range(t.size):
        out[index] = point.y[output] + J.C[output] @ d[:n] + J.D[output, input] * size
        d = over_step @ d
    return out


@np.errstate(over="ignore", invalid="ignore")
def compare_step(
    model: CompiledModel, point: LinearModel, output: int, input: int, size: float, times: FloatArray
) -> Comparison:
    """Linear against nonlinear after a step of one input.

    Parameters
    ----------
    model : CompiledModel
    point : LinearModel
        Where both start.
    output, input : int
        Counted from 0.
    size : float
        Of the step [input].
    times : ndarray, shape (count,)
        Equally spaced from 0 [time].

    Returns
    -------
    Comparison

    Raises
    ------
    InvalidInput
        The input would leave its range.
    """
    # Its solvers take half a second to import.
    from looplab.engine.nonlinear.simulation import simulate_open_loop

    names = (model.input_names, model.parameter_names)
    u: Mapping[str, float] = dict(zip(names[0], point.u, strict=True))
    name = model.input_names[input]
    stepped = {**u, name: u[name] + size}
    model.inputs(stepped)
    run = simulate_open_loop(model, times, stepped, dict(zip(names[1], point.p, strict=True)), point.x)
    linear = linear_step(point, output, input, size, times)
    count = run.t.size
    if count and run.truncated_at is not None:
        # The cut lies between two of the times.
        count = int(np.searchsorted(times, run.t[-1], side="right"))
    linear, nonlinear, t = linear[:count], run.y[:count, output], times[:count]
    apart = np.abs(nonlinear - linear)
    if not np.isfinite(linear).all():
        raise InvalidInput("the linear response grows beyond all numbers", field="horizon", hint="a shorter horizon")
    worst = int(np.argmax(apart))
    moved = float(np.abs(linear - point.y[output]).max())
    relative = float(apart[worst]) / moved if moved > 0 else None
    cut = (run.truncated_at, run.truncated_reason)
    return Comparison(size, t, linear, nonlinear, float(apart[worst]), float(t[worst]), relative, *cut)
