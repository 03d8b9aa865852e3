"""Where the responses of a delayed system jump or have a kink: sums of its dead times, as long as it can be seen."""

from __future__ import annotations

from heapq import heappop, heappush

import numpy as np

from looplab.engine.delays.structure import Channels, step_events
from looplab.engine.delays.system import DelaySystem
from looplab.engine.errors import NoConvergence
from looplab.engine.systems.polynomial import FloatArray

MAX_BREAKPOINTS = 20_000
# A jump in a derivative of this order or above is beyond the degree of the pieces.
SMOOTH = 24
# A jump whose Taylor term is below this fraction of the first ones is rounding.
NEGLIGIBLE = 1e-17


class _Passage:
    """How a break of the input of states appears at the signals on their way into the delays."""

    def __init__(self, system: DelaySystem, into: FloatArray) -> None:
        """``into``: columns that drive the states, shape (n, c)."""
        rows, columns = system.tau.size, into.shape[1]
        self.order = np.full((rows, columns), SMOOTH + 1)
        self.size = np.zeros((rows, columns))
        moved = into
        for r in range(min(system.order, SMOOTH)):
            markov = np.abs(system.C2 @ moved)
            # What is left of a cancellation is no jump.
            new = (markov > 1e-13 * (np.abs(system.C2) @ np.abs(moved))) & (self.order > SMOOTH)
            self.order[new], self.size[new] = r + 1, markov[new]
            moved = system.A @ moved


def breakpoints(system: DelaySystem, parts: Channels, horizon: float) -> FloatArray:
    """Times in (0, horizon) at which a signal inside the system jumps or has a visible kink after steps at t = 0.

    Parameters
    ----------
    system : DelaySystem
    parts : Channels
        Its channels, sorted.
    horizon : float
        [time]

    Returns
    -------
    ndarray, strictly increasing [time]
        A break passes a delay as it is and a state one derivative smoother, so that it is gone after a few rounds;
        where delays follow each other without a state (a neutral system) it lasts as long as its size does.

    Raises
    ------
    NoConvergence
        There are more than 20000.
    """
    core = parts.core
    tau = system.tau
    length = min(float(tau[core].min(initial=horizon)), horizon)
    by_delay = _Passage(system, system.B2)
    by_input = _Passage(system, system.B1)
    grain = 1e-12 * horizon
    # Time at the delay's end in grains, channel, order, size, that time: sums of the same dead times are one time.
    heap: list[tuple[int, int, int, float, float]] = []

    factorial = np.cumprod(np.append(1.0, np.arange(1.0, SMOOTH + 2)))

    def weight(order: int, size: float) -> float:
        return size * length**order / float(factorial[order])

    def follow(at: float, direct: FloatArray, order: FloatArray, size: FloatArray, base: int, factor: float) -> None:
        """A break of order ``base`` and size ``factor`` acts on every core channel."""
        for i in core:
            end = float(at + tau[i])
            if direct[i]:
                heappush(heap, (round(end / grain), i, base, factor * abs(direct[i]), end))
            # A break that passes directly hides the smoother one behind it.
            elif order[i] <= SMOOTH and base + order[i] <= SMOOTH:
                heappush(heap, (round(end / grain), i, base + int(order[i]), factor * size[i], end))

    for j in range(system.inputs):
        follow(0.0, system.D21[:, j], by_input.order[:, j], by_input.size[:, j], 0, 1.0)
    times = set()
    for i, events in step_events(system, parts.inputs).items():
        for at, sizes in events:
            times.add(at)
            height = float(np.abs(sizes).max())
            follow(at, system.D22[:, i], by_delay.order[:, i], by_delay.size[:, i], 0, height)
    largest = max((weight(order, size) for _, _, order, size, _ in heap), default=0.0)
    while heap:
        grains, i, order, size, at = heappop(heap)
        while heap and heap[0][:2] == (grains, i):
            _, _, other, more, _ = heappop(heap)
            if weight(other, more) > weight(order, size):
                order, size = other, more
        if at >= horizon - 2 * grain:
            continue
        seen = weight(order, size)
        largest = max(largest, seen)
        if seen <= NEGLIGIBLE * largest:
            continue
        times.add(at)
        if len(times) > MAX_BREAKPOINTS:
            raise NoConvergence(
                "the dead times make more than 20000 kinks within the horizon",
                field="horizon",
                hint="shorten the horizon",
            )
        follow(at, system.D22[:, i], by_delay.order[:, i], by_delay.size[:, i], order, size)
    found = np.array(sorted(t for t in times if 0 < t < horizon - 2 * grain))
    return found[np.append(True, np.diff(found) > 2 * grain)] if found.size else found
