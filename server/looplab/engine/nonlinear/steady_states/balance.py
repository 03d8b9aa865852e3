"""A balance over one state: its rate of change, and what adds and takes away, with the others at rest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput, NonFinite
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.steady_states.continuation import checked_range, trace_all
from looplab.engine.nonlinear.steady_states.equations import (
    Box,
    SteadyEquations,
    known_states,
    require_autonomous,
    search_box,
)
from looplab.engine.systems.polynomial import FloatArray

_POINTS = 201
_LEVELS = (0.5, 0.0, 1.0, 0.25, 0.75)


@dataclass(frozen=True)
class BalanceBranch:
    """One curve: values of the state, all states, its rate, and the variables by name; nan where undefined.

    ``states`` has the shape (count, n), ``rate`` and each of ``curves`` (count,).
    """

    states: FloatArray
    rate: FloatArray
    curves: Mapping[str, FloatArray]


@dataclass(frozen=True)
class BalanceCurve:
    """The balance over ``state`` from ``low`` to ``high``: a steady state is where the rate is zero."""

    state: str
    low: float
    high: float
    branches: tuple[BalanceBranch, ...]


def balance_curve(
    model: CompiledModel,
    u: Values,
    p: Values,
    state: str,
    low: float | None = None,
    high: float | None = None,
    curves: Sequence[str] = (),
    box: Box | None = None,
    near: Values | None = None,
) -> BalanceCurve:
    r"""The rate of one state over its value, where all the other states are at rest.

    .. math:: \dot x_s = f_s(x, u, p) \quad\text{along}\quad f_i(x, u, p) = 0,\; i \ne s

    For a reactor's temperature this is heat generated against heat removed.

    Parameters
    ----------
    model : CompiledModel
    u, p : tuple of float
        Inputs and parameters, in the model's order.
    state : str
    low, high : float or None
        Range of the state; None takes its bounds, or around what is known.
    curves : sequence of str
        Variables to evaluate along it, such as the two heats.
    box : mapping of str to (float, float), or None
        Bounds of the other states.
    near : tuple of float or None
        A state to start from.

    Returns
    -------
    BalanceCurve
        Several branches where the others have several states of rest for one value.

    Raises
    ------
    InvalidInput
        There is no such state or variable, or the equations depend on t.

    References
    ----------
    .. [1] C. van Heerden, Autothermic processes, Ind. Eng. Chem. 45 (1953) 1242-1247.
    """
    require_autonomous(model)
    if state not in model.state_names:
        hint = f"there are {', '.join(model.state_names[:12])}"
        raise InvalidInput(f"the model has no state {state[:40]!a}", field="state", hint=hint)
    for index, name in enumerate(curves):
        if name not in model.variable_names:
            there = ", ".join(model.variable_names[:12]) or "none"
            raise InvalidInput(
                f"the model has no variable {name[:40]!a}", field=f"curves[{index}]", hint=f"there are {there}"
            )
    s = model.state_names.index(state)
    known = known_states(model, u, p)
    if near is not None:
        known.insert(0, near)
    bounds = search_box(model, known, box)
    least, most = (float(bounds[s, 0]) if low is None else low), (float(bounds[s, 1]) if high is None else high)
    least, most = checked_range(model.document.states[s], least, most)
    others = tuple(index for index in range(len(model.state_names)) if index != s)
    equations = SteadyEquations(model, known[0], u, p, others, state)
    if not others:
        paths = [np.linspace(least, most, _POINTS)[:, None]]
    else:
        whole = np.vstack([bounds[list(others)], [least, most]])
        levels = [least + part * (most - least) for part in _LEVELS]
        starts = [np.array(x)[list(others)] for x in known]
        found = trace_all(equations, whole, starts, levels, 15, False)[1]
        paths = [np.array([point.y for point in curve.points]) for curve in found]
    branches = tuple(_branch(equations, path, s, curves) for path in paths)
    return BalanceCurve(state, least, most, branches)


def _branch(equations: SteadyEquations, path: FloatArray, s: int, curves: Sequence[str]) -> BalanceBranch:
    model = equations.model
    places = [model.variable_names.index(name) for name in curves]
    states = np.empty((len(path), len(model.state_names)))
    rate = np.full(len(path), np.nan)
    values = np.full((len(path), len(places)), np.nan)
    for row, y in enumerate(path):
        arguments = equations.arguments(y)
        states[row] = arguments[0]
        try:
            rate[row] = model.f(0.0, *arguments)[s]
            if places:
                variables = model.variables(0.0, *arguments)
                values[row] = [variables[place] for place in places]
        except NonFinite:
            continue
    return BalanceBranch(states, rate, dict(zip(curves, values.T, strict=True)))
