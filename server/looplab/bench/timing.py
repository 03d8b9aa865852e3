"""Two ways of doing one thing, timed in turn."""

from __future__ import annotations

import gc
import statistics
import time
from collections.abc import Callable, Sequence
from typing import Any


def _spread(seconds: list[float]) -> dict[str, float]:
    """Median and quartiles [ms]."""
    low, middle, high = statistics.quantiles(seconds, n=4, method="inclusive")
    return {"median_ms": 1e3 * middle, "q1_ms": 1e3 * low, "q3_ms": 1e3 * high}


def interleave(
    ours: Callable[[float], Any], peer: Callable[[float], Any], values: Sequence[float], tick: Callable[[], None]
) -> dict[str, Any]:
    """Time ours, peer, ours, peer ... over the values, each after one untimed call.

    Returns
    -------
    dict
        Medians and quartiles of wall time [ms], their ratio peer/ours, the quartiles of the ratio of neighbours, and
        the ratio of the processor times.
    """
    first, *rest = values
    ours(first), peer(first)
    wall: dict[str, list[float]] = {"ours": [], "peer": []}
    cpu = {"ours": 0.0, "peer": 0.0}
    gc.collect()
    for value in rest:
        for name, work in (("ours", ours), ("peer", peer)):
            c, t = time.process_time(), time.perf_counter()
            work(value)
            wall[name].append(time.perf_counter() - t)
            cpu[name] += time.process_time() - c
        tick()
    pairs = [p / o for o, p in zip(wall["ours"], wall["peer"], strict=True)]
    low, _, high = statistics.quantiles(pairs, n=4, method="inclusive")
    ours_ms, peer_ms = _spread(wall["ours"]), _spread(wall["peer"])
    return {
        "ours": ours_ms,
        "peer": peer_ms,
        "ratio": peer_ms["median_ms"] / ours_ms["median_ms"],
        "ratio_q1": low,
        "ratio_q3": high,
        "ratio_cpu": cpu["peer"] / cpu["ours"],
        "repetitions": len(rest),
    }
