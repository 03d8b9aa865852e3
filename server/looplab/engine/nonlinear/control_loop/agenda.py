"""When a controlled simulation has to stop, and what for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.control_loop.settings import ControlLoop
from looplab.engine.nonlinear.inputs import SAME_TIME, InputCourse
from looplab.engine.nonlinear.simulation.grid import breakpoints, looks, merged, snapped
from looplab.engine.systems.polynomial import FloatArray

MAX_EDGES = 10_000
# A jump that has gone round the loop this many times is smooth enough.
_ROUNDS = 4


class Deed(IntEnum):
    """What is done at a time, in the order in which it is done there."""

    MEASURE = 0
    CHANGE_MODE = 1
    SAMPLE = 2
    MOVE_VALVE = 3


@dataclass(frozen=True)
class Agenda:
    """The times of a simulation.

    Attributes
    ----------
    stops : ndarray
        All times at which it stops, sorted.
    edges : list of float
        Those at which something begins anew, start and end included.
    deeds : dict
        Time -> what is done then, and in which loop, in order.
    """

    stops: FloatArray
    edges: list[float]
    deeds: dict[float, list[tuple[Deed, int]]]


def sample_times(loop: ControlLoop, start: float, end: float) -> FloatArray:
    """Times of a sampled controller's samples."""
    h = loop.sampling_time or 0.0
    if (end - start) / h > MAX_EDGES:
        raise InvalidInput(
            f"there would be more than {MAX_EDGES} samples",
            field="sampling_time",
            hint=f"{(end - start) / MAX_EDGES:.3g} or longer, or a shorter horizon",
        )
    return np.asarray(start + h * np.arange(int((end - start) / h * (1.0 + 1e-12)) + 1))


def measuring_times(loop: ControlLoop, samples: FloatArray) -> FloatArray:
    """When the sensor is read for each sample; before the start for the first ones, where it has a dead time."""
    times = samples - loop.sensor.theta
    start, end = samples[0], samples[-1]
    return np.where(np.abs(times - start) <= SAME_TIME * (end - start), start, times)


def make_agenda(times: FloatArray, loops: Sequence[ControlLoop], courses: Sequence[InputCourse]) -> Agenda:
    """The agenda of a simulation.

    Raises
    ------
    InvalidInput
        There would be too much to do.
    """
    start, end = float(times[0]), float(times[-1])
    wanted: list[tuple[Deed, int, FloatArray]] = []
    jumps = [breakpoints(courses, start, end)]
    for index, loop in enumerate(loops):
        changes = np.array([change.t for change in loop.modes])
        changes = changes[(changes >= start) & (changes <= end)]
        wanted.append((Deed.CHANGE_MODE, index, changes))
        if loop.sampling_time is None:
            jumps.append(changes)
            continue
        samples = sample_times(loop, start, end)
        before = measuring_times(loop, samples)
        later = samples + loop.valve.theta
        wanted += [
            (Deed.MEASURE, index, before[before >= start]),
            (Deed.SAMPLE, index, samples),
            (Deed.MOVE_VALVE, index, later[later <= end]),
        ]
    delays = _delays(loops)
    again = [start, end, *_steps(np.concatenate(jumps), delays, start, end)]
    every = np.concatenate([*jumps, again, *(each for _, _, each in wanted)])
    stops = merged(np.concatenate([times, looks(times), every]), times)
    edges = np.unique(snapped(every, stops))
    if edges.size > MAX_EDGES:
        raise InvalidInput(
            f"the loops act more than {MAX_EDGES} times",
            field="horizon",
            hint="a shorter horizon, longer sampling times or longer dead times",
        )
    deeds: dict[float, list[tuple[Deed, int]]] = {}
    for deed, index, each in sorted(wanted, key=lambda item: item[:2]):
        for t in snapped(each, stops).tolist():
            deeds.setdefault(t, []).append((deed, index))
    return Agenda(stops, edges.tolist(), deeds)


def _delays(loops: Sequence[ControlLoop]) -> list[tuple[float, str]]:
    """Dead times of continuous loops, which need the past, and their places."""
    return [
        (part.theta, f"loops[{index}].{name}.theta")
        for index, loop in enumerate(loops)
        if loop.sampling_time is None
        for name, part in (("sensor", loop.sensor), ("valve", loop.valve))
        if part.theta > 0
    ]


def shortest_delay(loops: Sequence[ControlLoop]) -> float:
    """Of continuous loops; infinite where there is none [time]."""
    return min((theta for theta, _ in _delays(loops)), default=np.inf)


def _steps(jumps: FloatArray, delays: list[tuple[float, str]], start: float, end: float) -> list[float]:
    """The method of steps: no step is longer than half of a dead time, and jumps come back after each of them."""
    if not delays:
        return []
    shortest, place = min(delays)
    step = 0.5 * shortest
    if (end - start) / step > MAX_EDGES:
        raise InvalidInput(
            "the dead time is too short for this horizon",
            field=place,
            hint=f"{2 * (end - start) / MAX_EDGES:.3g} or longer, or a sampled controller",
        )
    echoes = np.unique(np.append(jumps, start))
    newest = echoes
    for _ in range(_ROUNDS):
        newest = np.unique(np.concatenate([newest + theta for theta, _ in delays]))
        newest = newest[newest < end]
        echoes = np.unique(np.append(echoes, newest))
        if echoes.size > MAX_EDGES:
            break
    return [*echoes.tolist(), *(start + step * np.arange(1, int((end - start) / step) + 1)).tolist()]
