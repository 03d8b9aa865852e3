"""Gain moves and new plants, with and without dead time and the root locus, against two ways of python-control."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import Any

from looplab.bench import ours, peer
from looplab.bench.scenarios import DEAD_TIME, DELAY_FREE, PADE_ORDER, Scenario
from looplab.bench.timing import WARM_UP, interleave


@dataclass(frozen=True)
class Move:
    """What is asked of both. ``goals`` are the ratios the project set itself, without and with dead time."""

    name: str
    locus: bool
    new_plant: bool
    goals: tuple[float | None, float | None]
    note: str = ""


CACHED = "the locus does not depend on the gain: looplab keeps it, python-control has no memory"
MOVES = (
    Move("gain move, no locus", False, False, (15.0, None)),
    Move("gain move, with locus", True, False, (30.0, None), CACHED),
    Move("new plant, no locus", False, True, (None, None)),
    Move("new plant, with locus", True, True, (10.0, 5.0)),
)
TRANSFER_FUNCTIONS, STATE_SPACE = "transfer functions", "state space"
# The goals were set against the first, by which a move without dead time and with the locus takes 36 to 43 ms; the
# second is python-control at its fastest.
WAYS = {
    TRANSFER_FUNCTIONS: "four transfer functions closed and stepped, as its examples do",
    STATE_SPACE: "one state space for all four steps, its fastest way",
}
SCENARIOS = (DELAY_FREE, DEAD_TIME)
COMPARISONS = tuple(product(WAYS, SCENARIOS, MOVES))


def _compare(way: str, scenario: Scenario, move: Move, rounds: int, series: int, tick: Callable[[str], None]) -> Any:
    pick = "full_recompute" if move.new_plant else "gain_move"
    polynomials = way == TRANSFER_FUNCTIONS
    a = getattr(ours, pick)(scenario, move.locus)
    b = getattr(peer, pick)(scenario, move.locus, polynomials)
    label = f"{scenario.name}: {move.name}, python-control by {way}"
    timed = interleave(a, b, scenario.gains(rounds + WARM_UP, series), lambda: tick(label))
    return {
        "way": way,
        "loop": scenario.name,
        "what": move.name,
        "goal": move.goals[SCENARIOS.index(scenario)] if polynomials else None,
        "note": move.note,
        "pade_order": PADE_ORDER if scenario.theta else None,
        **timed,
    }


def measure(rounds: int, tick: Callable[[str], None]) -> list[dict[str, Any]]:
    """Time every comparison."""
    return [_compare(*one, rounds, series, tick) for series, one in enumerate(COMPARISONS)]
