"""The phase plane of two states: directions, nullclines, steady states and trajectories."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput, NonFinite
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.steady_states.equations import SteadyEquations, require_autonomous
from looplab.engine.nonlinear.steady_states.nullclines import ZeroLine, zero_lines
from looplab.engine.nonlinear.steady_states.search import SteadyState, find_roots, steady_state
from looplab.engine.systems.polynomial import FloatArray

GRIDS = (5, 41)
MAX_TRAJECTORIES = 20
# Nullclines are looked for on a grid of so many cells each way, whatever the grid of the arrows.
_FINE = 80
_STARTS = 60


@dataclass(frozen=True)
class Trajectory:
    """A solution seen in the plane, arrays of shape (count,), and where and why it was cut."""

    t: FloatArray
    horizontal: FloatArray
    vertical: FloatArray
    truncated_at: float | None
    truncated_reason: str | None


@dataclass(frozen=True)
class PhasePlane:
    """Picture of two states, the others held.

    Attributes
    ----------
    horizontal, vertical : ndarray, shapes (n,) and (m,)
        Grid of the arrows.
    d_horizontal, d_vertical : ndarray, shape (m, n)
        Their rates; nan where the equations have no finite value [state/time].
    nullclines : pair of tuple of ZeroLine
        Where the rate of the first and of the second state is zero.
    steady_states : tuple of SteadyState
        Inside the window, judged in the plane.
    """

    horizontal: FloatArray
    vertical: FloatArray
    d_horizontal: FloatArray
    d_vertical: FloatArray
    nullclines: tuple[tuple[ZeroLine, ...], tuple[ZeroLine, ...]]
    steady_states: tuple[SteadyState, ...]


def phase_plane(
    model: CompiledModel, x: Values, u: Values, p: Values, states: tuple[int, int], window: FloatArray, grid: int = 21
) -> PhasePlane:
    r"""Vector field, nullclines and steady states of two states in a window.

    .. math:: (\dot x_i, \dot x_j) = (f_i, f_j)(x, u, p), \qquad f_i = 0, \qquad f_j = 0

    Parameters
    ----------
    model : CompiledModel
    x : tuple of float
        Where the other states are held.
    u, p : tuple of float
        Inputs and parameters, in the model's order.
    states : pair of int
        The horizontal and the vertical state.
    window : ndarray, shape (2, 2)
        Bounds of the two.
    grid : int
        Arrows each way, 5 to 41.

    Returns
    -------
    PhasePlane

    Raises
    ------
    InvalidInput
        The equations depend on t, or an argument is out of range.

    References
    ----------
    .. [1] S. H. Strogatz, Nonlinear Dynamics and Chaos, 2nd ed., Westview 2015, chapter 6.
    """
    require_autonomous(model)
    if states[0] == states[1]:
        raise InvalidInput("the two states must differ", field="vertical")
    if not GRIDS[0] <= grid <= GRIDS[1]:
        raise InvalidInput(f"grid must be from {GRIDS[0]} to {GRIDS[1]}", field="grid")
    equations = SteadyEquations(model, x, u, p, states)

    def rates(h: float, v: float) -> FloatArray:
        try:
            return equations.residual(np.array([h, v]))
        except NonFinite:
            return np.full(2, np.nan)

    h, v = (np.linspace(low, high, grid) for low, high in window)
    coarse = np.array([[rates(a, b) for a in h] for b in v])
    fine_h, fine_v = (np.linspace(low, high, _FINE + 1) for low, high in window)
    fine = np.array([[rates(a, b) for a in fine_h] for b in fine_v])
    first = zero_lines(lambda a, b: float(rates(a, b)[0]), fine[..., 0], fine_h, fine_v)
    second = zero_lines(lambda a, b: float(rates(a, b)[1]), fine[..., 1], fine_h, fine_v)
    known = [np.clip(np.array([x[index] for index in states]), window[:, 0], window[:, 1])]
    roots, _ = find_roots(equations, window, known, _STARTS)
    found = tuple(steady_state(equations, root, count) for root, count in roots)
    return PhasePlane(h, v, coarse[..., 0], coarse[..., 1], (first, second), found)


def trajectories(
    model: CompiledModel,
    x: Values,
    u: Values,
    p: Values,
    states: tuple[int, int],
    starts: Sequence[Mapping[str, float]],
    times: FloatArray,
) -> tuple[Trajectory, ...]:
    """Solutions of the whole model from starts in the plane, seen in the plane.

    Parameters
    ----------
    model : CompiledModel
    x : tuple of float
        Where the other states start.
    u, p : tuple of float
        Inputs and parameters, in the model's order.
    states : pair of int
        The horizontal and the vertical state.
    starts : sequence of mapping of str to float
        States by name, at most 20.
    times : ndarray, shape (count,)
        [time]

    Returns
    -------
    tuple of Trajectory
        In the order of the starts. With more than two states they may cross in the plane.

    Raises
    ------
    InvalidInput
        There is no such state, or a value is outside its bounds.
    NonFinite
        The equations have no finite value at a start.
    """
    # Its solvers take half a second to import.
    from looplab.engine.nonlinear.simulation import simulate_open_loop

    if len(starts) > MAX_TRAJECTORIES:
        raise InvalidInput(f"at most {MAX_TRAJECTORIES} starts", field="starts")
    inputs = dict(zip(model.input_names, u, strict=True))
    parameters = dict(zip(model.parameter_names, p, strict=True))
    out = []
    for index, start in enumerate(starts):
        begin = model.states(start, x, f"starts[{index}]")
        run = simulate_open_loop(model, times, inputs, parameters, begin)
        columns = (run.x[:, states[0]], run.x[:, states[1]])
        out.append(Trajectory(run.t, *columns, run.truncated_at, run.truncated_reason))
    return tuple(out)
