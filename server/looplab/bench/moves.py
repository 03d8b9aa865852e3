"""Gain moves and full recomputes, with and without dead time, with and without the root locus."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from looplab.bench import ours, peer
from looplab.bench.scenarios import DEAD_TIME, DELAY_FREE, PADE_ORDER, Scenario
from looplab.bench.timing import WARM_UP, interleave


@dataclass(frozen=True)
class Comparison:
    """One line of the table; ``goal`` is the ratio the project set itself."""

    name: str
    scenario: Scenario
    locus: bool
    new_plant: bool
    goal: float | None
    note: str = ""
    polynomials: bool = False


CACHED = "the locus does not depend on the gain: looplab keeps it, python-control has no memory"
USUAL = "python-control by transfer functions, as its examples go; else its fastest way, state space"
COMPARISONS = (
    Comparison("gain move, no locus", DELAY_FREE, False, False, 15.0),
    Comparison("gain move, with locus", DELAY_FREE, True, False, 30.0, CACHED),
    Comparison("the same, usual way", DELAY_FREE, True, False, None, USUAL, polynomials=True),
    Comparison("new plant, with locus", DELAY_FREE, True, True, 10.0),
    Comparison("gain move, no locus", DEAD_TIME, False, False, 15.0),
    Comparison("new plant, no locus", DEAD_TIME, False, True, 5.0),
)


def measure(rounds: int, tick: Callable[[str], None]) -> list[dict[str, Any]]:
    """Time every comparison."""
    results = []
    for series, c in enumerate(COMPARISONS):
        pick = "full_recompute" if c.new_plant else "gain_move"
        usual = {"polynomials": True} if c.polynomials else {}
        a, b = getattr(ours, pick)(c.scenario, c.locus), getattr(peer, pick)(c.scenario, c.locus, **usual)

        def advance(name: str = f"{c.scenario.name}: {c.name}") -> None:
            tick(name)

        timed = interleave(a, b, c.scenario.gains(rounds + WARM_UP, series), advance)
        results.append(
            {
                "loop": c.scenario.name,
                "what": c.name,
                "goal": c.goal,
                "note": c.note,
                "pade_order": PADE_ORDER if c.scenario.theta else None,
                **timed,
            }
        )
    return results
