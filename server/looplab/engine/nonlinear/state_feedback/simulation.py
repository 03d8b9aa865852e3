"""Simulation of a nonlinear model under state feedback, and where it begins that it is caught."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import matrix_balance, solve_continuous_lyapunov

from looplab.engine.design.state_feedback import Push, StateFeedback, linear_loop
from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation import Simulation, simulate_open_loop
from looplab.engine.nonlinear.state_feedback.closed_model import ClosedModel, Wiring, closed_model, parameter_values
from looplab.engine.nonlinear.steady_states import LinearModel
from looplab.engine.response.inputs import pulse
from looplab.engine.systems.polynomial import FloatArray

# Caught: the deviation, measured by the linear loop's Lyapunov function, has shrunk to this part of where it began.
CAUGHT = 1e-3
# A deviation of this part of a state is none.
AT_REST = 1e-5
# Less exact than a run that is drawn: only the end counts.
REGION_RTOL = 1e-6
# Evaluations of one run of many: several times what a run takes that settles.
REGION_CALLS = 3_000


@dataclass(frozen=True)
class FeedbackLoop:
    """A model, the point it was linearised at, and what moves which of its inputs.

    Attributes
    ----------
    plant : CompiledModel
    point : LinearModel
    found : StateFeedback
        Of the linear model's chosen inputs.
    inputs : tuple of int
        Which inputs of the model the feedback moves.
    limits : ndarray, shape (m, 2), or None
        Least and greatest value of those inputs.
    """

    plant: CompiledModel
    point: LinearModel
    found: StateFeedback
    inputs: tuple[int, ...]
    limits: FloatArray | None

    @property
    def wiring(self) -> Wiring:
        """What of it makes a difference to the formulas."""
        settings = self.found.settings
        observer = self.found.L is not None
        return Wiring(
            self.inputs,
            settings.measured if observer else (),
            settings.controlled,
            observer,
            settings.integral and bool(settings.controlled),
            self.limits is not None,
        )

    @cached_property
    def lyapunov(self) -> FloatArray | None:
        """P with V = e' P e falling along every path of e' = (A - B K) e, shape (n, n); None where that is unstable."""
        model = self.found.model
        closed = model.A - model.B @ self.found.K
        if not (np.linalg.eigvals(closed).real < 0).all():
            return None
        # States of whatever units count alike.
        scale = matrix_balance(closed, permute=False, separate=True)[1][0]
        return np.asarray(solve_continuous_lyapunov(closed.T, -np.diag(scale**-2.0)))

    def rest(self, r: FloatArray | None) -> FloatArray:
        """Where the linear loop comes to rest at setpoints r, as a deviation, shape (n,)."""
        n = len(self.point.x)
        if r is None or not r.any():
            return np.zeros(n)
        loop = linear_loop(self.found)
        return np.asarray(np.linalg.lstsq(loop.A, -loop.B_r @ r, rcond=None)[0][:n])

    def closed(self) -> ClosedModel:
        """The closed loop as a model."""
        return closed_model(self.plant, self.wiring)

    def parameters(self) -> dict[str, float]:
        """Values of every parameter of the closed loop."""
        own = dict(zip(self.plant.parameter_names, self.point.p, strict=True))
        return own | parameter_values(self.closed(), self.point, self.wiring, self.found, self.limits)


@dataclass(frozen=True)
class FeedbackRun:
    """A run under state feedback.

    Attributes
    ----------
    simulation : Simulation
        Of the whole loop; its states begin with the plant's.
    x, y : ndarrays, shapes (count, n) and (count, p)
    command, u : ndarrays, shape (count, m)
        What the feedback asks for, and what the limits leave of it.
    estimate : ndarray, shape (count, n), or None
        The observer's.
    outcome : str
        As ``outcome_of`` says.
    """

    simulation: Simulation
    x: FloatArray
    y: FloatArray
    command: FloatArray
    u: FloatArray
    estimate: FloatArray | None
    outcome: str


def run_feedback(
    loop: FeedbackLoop,
    t: FloatArray,
    initial: Mapping[str, float],
    r: FloatArray | None = None,
    pushes: Sequence[Push] = (),
    rtol: float = 1e-8,
) -> FeedbackRun:
    """The nonlinear model under its state feedback.

    Parameters
    ----------
    loop : FeedbackLoop
    t : ndarray, shape (count,)
        Increasing from 0 [time].
    initial : mapping of str to float
        States of the plant that do not start at the steady state. The observer starts there.
    r : ndarray, shape (q,), or None
        Setpoints as deviations, from the start on.
    pushes : sequence of Push
        Added to what the feedback does, after the limits; 8 at most.
    rtol : float
        As in ``simulate_open_loop``.

    Returns
    -------
    FeedbackRun
        Cut, with the reason, as ``simulate_open_loop`` cuts it.

    Raises
    ------
    InvalidInput
        A state is unknown or out of its range.
    """
    found = _simulate(loop, t, initial, r, pushes, rtol)
    n, p, m = len(loop.plant.state_names), len(loop.plant.output_names), len(loop.inputs)
    estimate = found.x[:, -n:] + np.array(loop.point.x) if loop.found.L is not None else None
    extra = found.y[:, p:].reshape(-1, m, 2)
    return FeedbackRun(
        found, found.x[:, :n], found.y[:, :p], extra[:, :, 0], extra[:, :, 1], estimate, outcome_of(loop, found, r)
    )


def _simulate(
    loop: FeedbackLoop,
    t: FloatArray,
    initial: Mapping[str, float],
    r: FloatArray | None,
    pushes: Sequence[Push],
    rtol: float,
    budget: int | None = None,
) -> Simulation:
    closed = loop.closed()
    own = loop.plant.states(initial, loop.point.x)
    start = dict(zip(loop.plant.state_names, own, strict=True))
    inputs: dict[str, float | InputCourse] = {
        name: value
        for index, (name, value) in enumerate(zip(loop.plant.input_names, loop.point.u, strict=True))
        if index not in loop.inputs
    }
    if r is not None:
        inputs |= {f"{closed.prefix}r{k}": value for k, value in enumerate(r.tolist())}
    if pushes:
        for j in range(len(loop.inputs)):
            parts = tuple(pulse(float(each.size[j]), each.duration, each.start) for each in pushes)
            inputs[f"{closed.prefix}d{j}"] = InputCourse(0.0, parts)
    return simulate_open_loop(closed.model, t, inputs, loop.parameters(), start, rtol=rtol, budget=budget)


def outcome_of(loop: FeedbackLoop, run: Simulation, r: FloatArray | None = None) -> str:
    """How a run ended: "caught", the name of an event, "stopped" or "unsettled".

    Caught is a run to the end whose deviation from where the linear loop comes to rest, measured as V = e' P e with P
    from the Lyapunov equation of A - B K, has shrunk to 1e-3 of its largest. Otherwise the first event tells what went
    wrong.
    """
    P = loop.lyapunov
    if run.truncated_at is None and P is not None:
        e = run.x[:, : len(loop.point.x)] - np.array(loop.point.x) - loop.rest(r)
        V = np.einsum("ti,ij,tj->t", e, P, e)
        # At rest from the start: what is left of it is rounding.
        nothing = float(np.diag(P) @ (AT_REST * np.array(loop.point.x)) ** 2)
        if V[-1] <= CAUGHT * max(V.max(), nothing):
            return "caught"
    if run.events:
        return run.events[0].name
    return "unsettled" if run.truncated_at is None else "stopped"


def explore_region(
    loop: FeedbackLoop, horizon: float, names: tuple[str, str], starts: Sequence[tuple[float, float]]
) -> list[str]:
    """How the run from each start ends, for starts in two states of which the others begin at the steady state.

    Parameters
    ----------
    loop : FeedbackLoop
    horizon : float
        [time]
    names : (str, str)
        The two states.
    starts : sequence of (float, float)

    Returns
    -------
    list of str
        As ``outcome_of`` says.

    Raises
    ------
    InvalidInput
        There is no such state, or a start is out of its range.
    """
    for name in names:
        if name not in loop.plant.state_names:
            raise InvalidInput(
                "the model has no such state", field="axes", hint=f"it has {', '.join(loop.plant.state_names)}"
            )
    t = np.array([0.0, horizon])
    return [
        outcome_of(loop, _simulate(loop, t, dict(zip(names, start, strict=True)), None, (), REGION_RTOL, REGION_CALLS))
        for start in starts
    ]
