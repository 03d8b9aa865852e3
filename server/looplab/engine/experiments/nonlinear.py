"""The same experiments on nonlinear models: a step test, proportional control, and a relay."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.experiments.gain_search import GainSearch, search_ultimate_gain
from looplab.engine.experiments.oscillation import Oscillation, oscillation
from looplab.engine.experiments.relay import Relay, RelayRun, limit_cycle
from looplab.engine.experiments.step_test import StepTest, StepTestResult, limited_note
from looplab.engine.loop.controllers import PID
from looplab.engine.nonlinear.control_loop import ControlLoop, Instrument
from looplab.engine.nonlinear.control_loop.simulation import simulate_control
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation import simulate_open_loop
from looplab.engine.nonlinear.steady_states.equations import SteadyEquations
from looplab.engine.nonlinear.steady_states.newton import solve
from looplab.engine.response.inputs import step
from looplab.engine.systems.polynomial import FloatArray

_PER_HALF = 150
_DOUBLINGS = 16
_RTOL = 1e-8


@dataclass(frozen=True)
class Point:
    """A model at rest, and the pair of signals that is looked at.

    Attributes
    ----------
    model : CompiledModel
    input, output : str
    inputs, parameters, initial : mapping of str to float
        Inputs, parameters and states there.
    u0, y0 : float
        [input, output]
    at_rest : bool
        Whether a steady state was found near the start.
    """

    model: CompiledModel
    input: str
    output: str
    inputs: Mapping[str, float]
    parameters: Mapping[str, float]
    initial: Mapping[str, float]
    u0: float
    y0: float
    at_rest: bool
    notes: tuple[str, ...] = field(default=())

    def output_of(self, y: FloatArray) -> FloatArray:
        """The column of the output, shape (n,)."""
        return np.ascontiguousarray(y[:, self.model.output_names.index(self.output)])


def rest_point(
    model: CompiledModel,
    input: str,
    output: str,
    inputs: Mapping[str, float],
    parameters: Mapping[str, float],
    initial: Mapping[str, float],
) -> Point:
    """The steady state nearest to a start, by Newton's method; the start itself, with a note, where there is none.

    Raises
    ------
    InvalidInput
        The model has no such input or output.
    """
    for name, names, what in ((input, model.input_names, "input"), (output, model.output_names, "output")):
        if name not in names:
            raise InvalidInput(f"the model has no {what} of this name", field=what, hint=", ".join(names))
    p, u = model.parameters(parameters), model.inputs(inputs)
    x = list(model.initial_state(u, p))
    for name, value in initial.items():
        if name not in model.state_names:
            raise InvalidInput(
                "the model has no state of this name", field="initial", hint=", ".join(model.state_names)
            )
        x[model.state_names.index(name)] = value
    start = np.array(x, dtype=float)
    reach = np.maximum(0.25 * np.abs(start), 1e-3 * max(1.0, float(np.abs(start).max(initial=0.0))))
    equations = SteadyEquations(model, tuple(x), tuple(u), tuple(p), tuple(range(len(x))))
    root = solve(equations, start, np.stack([start - reach, start + reach], axis=1))
    at_rest = root is not None and bool((np.abs(root.y - start) <= 2.0 * reach).all())
    if root is not None and at_rest:
        x = root.y.tolist()
    y = model.outputs(0.0, x, u, p)
    return Point(
        model,
        input,
        output,
        inputs,
        parameters,
        dict(zip(model.state_names, x, strict=True)),
        float(u[model.input_names.index(input)]),
        float(y[model.output_names.index(output)]),
        at_rest,
        () if at_rest else ("no steady state was found near the start: the plant moves by itself",),
    )


def nonlinear_step_test(point: Point, test: StepTest) -> StepTestResult:
    """A step test on a nonlinear model; arguments and result as of ``linear_step_test``."""
    t = test.times()
    change = test.applied(point.u0)
    course = InputCourse(point.u0, (step(change, test.made_at()),))
    found = simulate_open_loop(point.model, t, {**point.inputs, point.input: course}, point.parameters, point.initial)
    y = point.output_of(found.y)
    return StepTestResult(
        found.t,
        test.inputs(found.t, point.u0),
        test.measured(found.t, y),
        y,
        (*point.notes, *limited_note(test, change)),
        found.truncated_at,
        found.truncated_reason,
    )


@dataclass(frozen=True)
class NonlinearRinging:
    """A run of a nonlinear model under proportional control, after a step of the setpoint.

    Attributes
    ----------
    t, r, u, y : ndarray, shape (n,)
    oscillation : Oscillation
    truncated_at, truncated_reason : float and str, or None
    """

    Kc: float
    t: FloatArray
    r: FloatArray
    u: FloatArray
    y: FloatArray
    oscillation: Oscillation
    truncated_at: float | None
    truncated_reason: str | None


def nonlinear_ring(
    point: Point, Kc: float, bump: float, horizon: float, points: int = 1000, sensor: Instrument | None = None
) -> NonlinearRinging:
    """Response of u = u0 + Kc (r - y) to a small step of r.

    Parameters
    ----------
    point : Point
    Kc : float
        [input/output]
    bump : float
        Step of the setpoint, small enough that the model is nearly linear over it [output].
    horizon : float
        [time]
    points : int
    sensor : Instrument or None
        A lag and a dead time in the measurement.

    Returns
    -------
    NonlinearRinging
    """
    controller = PID(abs(Kc), action="reverse" if Kc > 0 else "direct")
    loop = ControlLoop(
        point.output,
        point.input,
        InputCourse(point.y0, (step(bump, 0.0),)),
        controller,
        bias=point.u0,
        sensor=sensor or Instrument(),
    )
    inputs = {name: value for name, value in point.inputs.items() if name != point.input}
    found = simulate_control(
        point.model, np.linspace(0.0, horizon, points), [loop], inputs, point.parameters, point.initial, rtol=_RTOL
    )
    y = point.output_of(found.y)
    signals = found.loops[0]
    seen = Oscillation(y, y, None, None)
    if y.size > 2:
        seen = oscillation(found.t, y - point.y0, np.gradient(y, found.t), _RTOL * float(np.abs(y).max()))
    return NonlinearRinging(Kc, found.t, signals.r, signals.u, y, seen, found.truncated_at, found.truncated_reason)


def nonlinear_ultimate_cycle(
    point: Point, start: float, bump: float, horizon: float, sensor: Instrument | None = None
) -> tuple[GainSearch, NonlinearRinging]:
    """Search of the ultimate gain from responses alone; the run at that gain beside it.

    Raises
    ------
    NoConvergence
        The loop does not begin to oscillate within 2^16 times the first gain, or does so at once.
    """
    found = search_ultimate_gain(
        lambda Kc: nonlinear_ring(point, Kc, bump, horizon, sensor=sensor).oscillation, start, _DOUBLINGS
    )
    return found, nonlinear_ring(point, found.Ku, bump, horizon, sensor=sensor)


def nonlinear_relay(point: Point, relay: Relay, horizon: float, half: float, switches: int = 24) -> RelayRun:
    """A relay around a nonlinear model, simulated from switch to switch.

    Parameters
    ----------
    point : Point
    relay : Relay
        With hysteresis: a model without dead time would switch without end.
    horizon : float
        When the run ends at the latest [time].
    half : float
        About the longest half period: how far ahead one look for the next switch goes [time].
    switches : int
        How many switches end the run.

    Returns
    -------
    RelayRun

    Raises
    ------
    InvalidInput
        The relay has no hysteresis.
    """
    if not relay.hysteresis:
        raise InvalidInput(
            "on a plant without dead time the relay needs hysteresis, or it switches without end",
            field="hysteresis",
            hint="a few times the noise of the measurement",
        )
    at, out, reason = 0.0, 1, None
    state = dict(point.initial)
    t, u, y, times = [np.zeros(1)], [np.full(1, relay.amplitude)], [np.zeros(1)], [0.0]
    while len(times) <= switches and at < horizon and reason is None:
        inputs = {**point.inputs, point.input: point.u0 + out * relay.amplitude}
        look = np.linspace(at, at + half, _PER_HALF)
        found = simulate_open_loop(point.model, look, inputs, point.parameters, state)
        e = point.output_of(found.y) - point.y0
        passed = np.flatnonzero(relay.sign * out * e - relay.hysteresis > 0)
        stop = int(passed[0]) if passed.size else found.t.size - 1
        if passed.size and stop > 0:
            share = (relay.sign * out * relay.hysteresis - e[stop - 1]) / (e[stop] - e[stop - 1])
            when = float(found.t[stop - 1] + share * (found.t[stop] - found.t[stop - 1]))
            # To where the level is passed, which the straight line between two samples tells to their distance squared.
            last = simulate_open_loop(
                point.model,
                [float(found.t[stop - 1]), max(when, float(np.nextafter(found.t[stop - 1], np.inf)))],
                inputs,
                point.parameters,
                dict(zip(point.model.state_names, found.x[stop - 1].tolist(), strict=True)),
            )
            t.append(np.append(found.t[1:stop], last.t[-1]))
            y.append(np.append(e[1:stop], point.output_of(last.y)[-1] - point.y0))
            state = dict(zip(point.model.state_names, last.x[-1].tolist(), strict=True))
            at = float(last.t[-1])
            u.append(np.full(t[-1].size, out * relay.amplitude))
            out = -out
            times.append(at)
        else:
            t.append(found.t[1:])
            y.append(e[1:])
            u.append(np.full(found.t.size - 1, out * relay.amplitude))
            state = dict(zip(point.model.state_names, found.x[-1].tolist(), strict=True))
            at = float(found.t[-1])
            reason = found.truncated_reason
    every_t, every_y = np.concatenate(t), np.concatenate(y)
    slope = np.gradient(every_y, every_t) if every_t.size > 2 else np.zeros(every_t.size)
    return limit_cycle(relay, every_t, np.concatenate(u), every_y, slope, np.array(times), reason)
