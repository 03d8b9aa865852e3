"""Simulation of a model with given inputs: from discontinuity to discontinuity, with events located on the way."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import NonFinite
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation.arguments import (
    Courses,
    call_budget,
    initial_state,
    input_courses,
    tolerances,
)
from looplab.engine.nonlinear.simulation.grid import breakpoints, check_times, looks, merged, snapped
from looplab.engine.nonlinear.simulation.result import Simulation
from looplab.engine.nonlinear.simulation.run import Run
from looplab.engine.nonlinear.simulation.solvers import Counter


def simulate_open_loop(
    model: CompiledModel,
    times: npt.ArrayLike,
    inputs: Courses | None = None,
    parameters: Mapping[str, float] | None = None,
    initial: Mapping[str, float] | Sequence[float] | None = None,
    *,
    method: str = "LSODA",
    rtol: float = 1e-8,
    atol: npt.ArrayLike | None = None,
    budget: int | None = None,
) -> Simulation:
    r"""Simulate a model with given inputs.

    .. math:: \dot x = f(t, x, u(t), p), \quad y = g(t, x, u(t), p)

    The solver starts anew where an input or its slope jumps. Events and bounds of states are looked for between
    neighbouring times (at least 200 over the horizon), and located to rounding by repeating the step; an event that
    goes on and off again between two of them is not seen.

    Parameters
    ----------
    model : CompiledModel
    times : array_like, shape (count,)
        Strictly increasing, from 2 to 5000; the first is the start [time].
    inputs : mapping of str to float or InputCourse, or None
        Inputs that are not nominal.
    parameters : mapping of str to float, or None
        Parameters that are not nominal.
    initial : mapping of str to float, sequence of float, or None
        States that do not start at the model's own initial state, which follows the parameters and the inputs at the
        start; or all states.
    method : str
        LSODA, RK45, Radau or BDF.
    rtol, atol : float and array_like of shape (n,) or float, or None
        Tolerances of each step; atol is by default rtol/100 times the initial state, or times 1 where that is zero.
    budget : int or None
        Most evaluations of the equations; None takes ``call_budget``.

    Returns
    -------
    Simulation
        Cut, with the reason, at a stopping event, where a state leaves its bounds or runs away, where an equation has
        no finite value, or where the solver fails or needs too much work.

    Raises
    ------
    InvalidInput
        An argument is out of range.
    NonFinite
        The equations have no finite value at the start.

    References
    ----------
    .. [1] L. Petzold, Automatic selection of methods for solving stiff and nonstiff systems of ordinary differential
       equations, SIAM J. Sci. Stat. Comput. 4 (1983) 136-148.
    """
    t = check_times(times)
    courses = input_courses(model, inputs or {}, t)
    p = model.parameters(parameters or {})
    x0 = initial_state(model, initial, [float(course.values(t[0])) for course in courses], p)
    allowed = call_budget(model, method)
    counter = Counter(allowed if budget is None else budget)
    run = Run(model, courses, p, method, tolerances(x0, rtol, atol, counter))
    breaks = breakpoints(courses, t[0], t[-1])
    stops = merged(np.concatenate([t, looks(t), breaks]), t)
    inner = stops[np.isin(stops, snapped(breaks, stops))].tolist()
    with warnings.catch_warnings():
        # The solvers' complaints come back as a reason.
        warnings.simplefilter("ignore")
        run.start(float(t[0]), x0)
        run.follow([float(t[0]), *(b for b in inner if t[0] < b < t[-1]), float(t[-1])], stops, set(t.tolist()))
    return _result(model, courses, p, run, counter)


def _result(model: CompiledModel, courses: list[InputCourse], p: Values, run: Run, counter: Counter) -> Simulation:
    if run.cut is not None and run.t > run.samples[-1][0]:
        run.samples.append((run.t, run.x))
    cut_at, reason = (run.t, run.cut) if run.cut is not None else (None, None)
    t = np.array([sample[0] for sample in run.samples])
    x = np.array([sample[1] for sample in run.samples])
    u = np.array([course.values(t) for course in courses]).reshape(len(courses), t.size).T
    y: list[Values] = []
    for at, state, now in zip(t.tolist(), x.tolist(), u.tolist(), strict=True):
        try:
            y.append(model.outputs(at, state, now, p))
        except NonFinite as error:
            if not y:
                raise
            cut_at, reason = at, error.message
            break
    count = len(y)
    return Simulation(
        t[:count],
        x[:count],
        np.array(y).reshape(count, len(model.output_names)),
        u[:count],
        tuple(run.events),
        cut_at,
        reason,
        counter.calls,
    )
