"""Stability panels: the verdict, the closed-loop poles and the root locus."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from looplab.api.encode import complex_pairs
from looplab.api.panels.context import LoopContext
from looplab.engine.errors import EngineError
from looplab.engine.stability import closed_loop_poles, root_locus


def verdict(context: LoopContext) -> dict[str, Any]:
    """Stable, marginal or unstable, in a sentence."""
    return asdict(context.verdict)


def poles(context: LoopContext) -> dict[str, Any]:
    """Closed-loop poles at the present gain."""
    found = closed_loop_poles(context.loop)
    return {
        "K": abs(context.loop.gain),
        "poles": complex_pairs(found.poles),
        "complete": found.complete,
        "reason": found.reason,
    }


def locus(context: LoopContext) -> dict[str, Any]:
    """The root locus over the controller's gain; unavailable with the reason where it cannot be drawn."""
    try:
        result = root_locus(context.locus_system)
    except EngineError as error:
        return {"available": False, "reason": error.message}
    return {
        "available": True,
        "reason": None,
        "gains": result.gains,
        "branches": [{"re": b.real.copy(), "im": b.imag.copy()} for b in result.branches],
        "open_loop_poles": complex_pairs(result.open_loop_poles),
        "open_loop_zeros": complex_pairs(result.open_loop_zeros),
        "asymptotes": {"centroid": result.centroid, "angles_deg": result.angles_deg.tolist()},
        "breakaways": [{"s": [b.s.real, b.s.imag], "K": b.K} for b in result.breakaways],
        "imaginary_axis_crossings": [{"omega": c.omega, "K": c.K} for c in result.imaginary_axis_crossings],
        "view": {"re": list(result.view[0]), "im": list(result.view[1])},
    }
