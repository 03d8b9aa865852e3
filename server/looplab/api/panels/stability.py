"""Stability panels: the verdict, the closed-loop poles and the root locus."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from looplab.api.encode import complex_pairs
from looplab.api.panels.context import LoopContext
from looplab.engine.errors import EngineError
from looplab.engine.stability import closed_loop_poles, root_locus
from looplab.engine.stability.locus import Angle
from looplab.engine.stability.locus.close_up import locus_close_up
from looplab.engine.stability.locus.construction import Window
from looplab.engine.systems import TransferFunction


def verdict(context: LoopContext) -> dict[str, Any]:
    """Stable, marginal or unstable, in a sentence."""
    return dict(vars(context.verdict))


def poles(context: LoopContext) -> dict[str, Any]:
    """Closed-loop poles at the present gain."""
    found = closed_loop_poles(context.loop)
    return {
        "K": abs(context.loop.gain),
        "poles": complex_pairs(found.poles),
        "complete": found.complete,
        "reason": found.reason,
    }


def _branch(branch: npt.NDArray[np.complex128]) -> dict[str, Any]:
    """The part of a branch inside the picture, with the index of its first gain."""
    there = np.flatnonzero(np.isfinite(branch))
    part = branch[there[0] : there[-1] + 1]
    return {"first": int(there[0]), "re": part.real.copy(), "im": part.imag.copy()}


def _angle(angle: Angle) -> dict[str, Any]:
    return {"s": [angle.s.real, angle.s.imag], "angle_deg": angle.angle_deg}


def locus(context: LoopContext) -> dict[str, Any]:
    """The root locus over the controller's gain; unavailable with the reason where it cannot be drawn."""
    return locus_answer(context.locus_system)


def negative_locus(context: LoopContext) -> dict[str, Any]:
    """The same for gains of the other sign: the complementary locus."""
    return locus_answer(context.locus_system * -1.0)


def locus_answer(L: TransferFunction, view: Window | None = None) -> dict[str, Any]:
    """The root locus of an open loop as it is sent; in a window (re, im) only what passes it, as close as it asks."""
    try:
        result = root_locus(L)
    except EngineError as error:
        return {"available": False, "reason": error.message}
    drawn: dict[str, Any]
    if view is None:
        shown = result.view
        drawn = {"gains": result.gains, "branches": [_branch(b) for b in result.branches], "complete": result.complete}
    else:
        shown, close_up = view, locus_close_up(L, view)
        pieces = [{"first": 0, "re": p.s.real.copy(), "im": p.s.imag.copy(), "gains": p.gains} for p in close_up.pieces]
        drawn = {"gains": None, "branches": pieces, "complete": close_up.complete}
    return {
        "available": True,
        "reason": None,
        **drawn,
        "open_loop_poles": complex_pairs(result.open_loop_poles),
        "open_loop_zeros": complex_pairs(result.open_loop_zeros),
        "asymptotes": {
            "centroid": result.asymptotes.centroid,
            "angles_deg": result.asymptotes.angles_deg.tolist(),
            "horizontal": result.asymptotes.horizontal.tolist(),
        },
        "breakaways": [{"s": [b.s.real, b.s.imag], "K": b.K} for b in result.breakaways],
        "imaginary_axis_crossings": [{"omega": c.omega, "K": c.K} for c in result.imaginary_axis_crossings],
        "departure_angles": [_angle(a) for a in result.departure_angles],
        "arrival_angles": [_angle(a) for a in result.arrival_angles],
        "real_axis_segments": [list(segment) for segment in result.real_axis_segments],
        "view": {"re": list(shown[0]), "im": list(shown[1])},
    }
