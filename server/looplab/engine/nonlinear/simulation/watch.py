"""Events, bounds of states and the largest state: what can end a simulation, watched from sample to sample."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import le

import numpy as np
from scipy.optimize import brentq

from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.systems.polynomial import FloatArray

# Beyond this a state has run away.
LARGEST_STATE = 1e12
# A bound may be passed by this part of it: rounding of the solver is not a violation.
_BOUND_SLACK = 1e-9
# An event as near as this part of its largest value is reached, where the equations end there.
_REACHED = 1e-6

# Values of all that is watched at (t, x): positive is on.
Measure = Callable[[float, FloatArray], list[float]]


@dataclass(frozen=True)
class Watched:
    """One thing that is watched.

    Attributes
    ----------
    name, message : str
        Of an event; the message alone of a bound.
    stops : bool
        Whether the simulation ends there.
    event : bool
        Whether the author declared it as an event.
    strict : bool
        Whether it is off where its value is exactly zero.
    """

    name: str
    message: str
    stops: bool
    event: bool
    strict: bool


class Watch:
    """All that is watched of a model.

    Parameters
    ----------
    model : CompiledModel
    u : callable
        t -> inputs.
    p : tuple of float
    """

    def __init__(self, model: CompiledModel, u: Callable[[float], tuple[float, ...]], p: tuple[float, ...]) -> None:
        document = model.document
        self.model, self.u, self.p = model, u, p
        self.watched = [
            Watched(e.name, e.message or f"{e.name}: {e.when}", e.action == "stop", True, strict)
            for e, strict in zip(document.events, model.event_strict, strict=True)
        ]
        self.bounds: list[tuple[int, float, float]] = []
        for index, state in enumerate(document.states):
            for end, sign, word in ((state.min, -1.0, "lower"), (state.max, 1.0, "upper")):
                if end is not None:
                    self.bounds.append((index, sign, sign * end + _BOUND_SLACK * max(abs(end), 1e-3)))
                    message = f"{state.name} passes its {word} bound, {end:g} {state.unit}".rstrip()
                    self.watched.append(Watched(state.name, message, True, False, True))
        for state in document.states:
            message = f"{state.name} grows beyond {LARGEST_STATE:g}: it runs away"
            self.watched.append(Watched(state.name, message, True, False, True))
        self.strict = [each.strict for each in self.watched]
        self.largest = [0.0] * len(document.events)
        self.low, self.high = [-LARGEST_STATE] * len(document.states), [LARGEST_STATE] * len(document.states)
        for index, sign, end in self.bounds:
            if sign < 0:
                self.low[index] = max(-end, self.low[index])
            else:
                self.high[index] = min(end, self.high[index])
        self.inside = [False] * (len(self.watched) - len(document.events))

    def measure(self, t: float, x: FloatArray) -> list[float]:
        """Values of all that is watched, positive where it is on."""
        values = x.tolist()
        return [
            *self._events(t, values),
            *(sign * values[index] - end for index, sign, end in self.bounds),
            *(abs(value) - LARGEST_STATE for value in values),
        ]

    def on(self, t: float, x: FloatArray) -> list[bool]:
        """Which are on."""
        values = x.tolist()
        # Nearly always every state is within its bounds: seen at once, however many there are.
        if all(map(le, self.low, values)) and all(map(le, values, self.high)):
            events = self._events(t, values)
            self.largest = [max(abs(value), seen) for value, seen in zip(events, self.largest, strict=True)]
            return [*map(_is_on, events, self.strict), *self.inside]
        return [_is_on(value, strict) for value, strict in zip(self.measure(t, x), self.strict, strict=True)]

    def near(self, t: float, x: FloatArray, states: Sequence[FloatArray]) -> list[int]:
        """Those that stop a simulation and are off by no more than rounding, seen from where they have been.

        ``states`` are those that it has passed, each (n,).
        """
        passed = np.array([x, *states])
        bounds = [float(np.abs(sign * passed[:, index] - end).max()) for index, sign, end in self.bounds]
        largest = [*self.largest, *bounds, *[LARGEST_STATE] * passed.shape[1]]
        values = self.measure(t, x)
        return [
            index
            for index, each in enumerate(self.watched)
            if each.stops and abs(values[index]) <= _REACHED * largest[index]
        ]

    def _events(self, t: float, values: list[float]) -> tuple[float, ...]:
        return self.model.events(t, values, self.u(t), self.p) if self.model.document.events else ()


def _is_on(value: float, strict: bool) -> bool:
    return value > 0.0 or (value == 0.0 and not strict)


def crossing(state_at: Callable[[float], FloatArray], measure: Measure, index: int, span: tuple[float, float]) -> float:
    """When one of the watched turns on within a span in which it does.

    Parameters
    ----------
    state_at : callable
        t -> x.
    measure : callable
    index : int
        Which of the watched.
    span : (float, float)
        Off at the start, on at the end [time].

    Returns
    -------
    float
        [time]
    """

    def value(t: float) -> float:
        return measure(t, state_at(t))[index]

    first, last = value(span[0]), value(span[1])
    # Off at exactly zero (a strict comparison), or on by a hair that the repeated integration does not see.
    if first >= 0.0:
        return span[0]
    if last <= 0.0:
        return span[1]
    return float(brentq(value, *span, xtol=1e-13 * max(abs(span[1]), span[1] - span[0]), rtol=1e-14))
