"""Two ways of doing one thing, timed in turn by bursts.

A slider that is dragged makes one move after another, not one now and then: a few moves of one side, then as many of
the other, so that each finds the processor's caches as its own moves leave them. What the machine does meanwhile falls
on both.
"""

from __future__ import annotations

import gc
import statistics
import time
from collections.abc import Callable, Sequence
from typing import Any

WARM_UP = 3
# Of what the peer takes seconds for.
WARM_UP_OF_SLOW = 1
BURST = 8


def _spread(seconds: list[float]) -> dict[str, float]:
    """Median and quartiles [ms]."""
    low, middle, high = statistics.quantiles(seconds, n=4, method="inclusive")
    return {"median_ms": 1e3 * middle, "q1_ms": 1e3 * low, "q3_ms": 1e3 * high}


def interleave(
    ours: Callable[[float], Any],
    peer: Callable[[float], Any],
    values: Sequence[float],
    tick: Callable[[], None],
    warm_up: int = WARM_UP,
) -> dict[str, Any]:
    """Time eight calls of ours, the same eight of the peer, and so on, after a few untimed calls of each.

    Every call is timed on its own. Processor time of this process is what is compared: both run on one thread, and
    other work on the machine does not enter it. Wall time is kept beside it.

    Returns
    -------
    dict
        Medians and quartiles of processor time [ms], their ratio peer/ours, the quartiles of the ratio of the
        two calls for one value, medians of wall time [ms].
    """
    for value in values[:warm_up]:
        ours(value), peer(value)
    rest = values[warm_up:]
    spent: dict[str, list[float]] = {"ours": [], "peer": []}
    wall: dict[str, list[float]] = {"ours": [], "peer": []}
    gc.collect()
    for start in range(0, len(rest), BURST):
        burst = rest[start : start + BURST]
        for name, work in (("ours", ours), ("peer", peer)):
            for value in burst:
                t, c = time.perf_counter(), time.process_time()
                work(value)
                spent[name].append(time.process_time() - c)
                wall[name].append(time.perf_counter() - t)
        for _ in burst:
            tick()
    pairs = [p / o for o, p in zip(spent["ours"], spent["peer"], strict=True)]
    low, _, high = statistics.quantiles(pairs, n=4, method="inclusive")
    ours_ms, peer_ms = _spread(spent["ours"]), _spread(spent["peer"])
    return {
        "ours": ours_ms,
        "peer": peer_ms,
        "ratio": peer_ms["median_ms"] / ours_ms["median_ms"],
        "ratio_q1": low,
        "ratio_q3": high,
        "wall_median_ms": {name: 1e3 * statistics.median(seconds) for name, seconds in wall.items()},
        "repetitions": len(rest),
    }
