"""Frequency-domain panels: Bode, Nyquist, margins and the sensitivity functions."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from looplab.api.open_loop import nyquist_words
from looplab.api.panels.context import LoopContext
from looplab.engine.frequency import Bode, bode, margins, nyquist_count, nyquist_curve


def _curve(data: Bode) -> dict[str, Any] | None:
    """Magnitude and phase; None for a system that is zero."""
    if not np.isfinite(data.mag_dB).any():
        return None
    # On a zero of the imaginary axis the magnitude is -inf: the plot goes to its floor there.
    return {"mag_dB": np.nan_to_num(data.mag_dB, neginf=-400.0, posinf=400.0), "phase_deg": data.phase_deg}


def bode_panel(context: LoopContext) -> dict[str, Any]:
    """Bode data of L, P and C over one frequency axis."""
    loop, omega = context.loop, context.omega
    return {
        "omega": omega,
        "L": _curve(context.open_loop_bode),
        "P": _curve(bode(loop.plant, omega)),
        "C": _curve(bode(loop.C, omega)),
    }


def nyquist(context: LoopContext) -> dict[str, Any]:
    """The Nyquist curve with N, P and Z = N + P written out."""
    L = context.loop.open_loop
    curve, count = nyquist_curve(L), nyquist_count(L)
    return {
        "omega": curve.omega,
        "re": curve.re,
        "im": curve.im,
        "N": count.N,
        "P": count.P,
        "Z": count.Z,
        "closed_loop_stable": context.verdict.closed_loop_stable,
        "explanation": nyquist_words(L),
    }


def margins_panel(context: LoopContext) -> dict[str, Any]:
    """Margins and peaks; infinite or undefined ones are null with a reason."""
    # The list of phase crossovers of a loop with dead time is long; the nearest ones matter.
    result = asdict(margins(context.loop.open_loop))
    result["closed_loop_stable"] = context.verdict.closed_loop_stable
    result["gain_crossovers"] = list(result["gain_crossovers"])[:50]
    result["phase_crossovers"] = list(result["phase_crossovers"])[:50]
    return result


def sensitivity(context: LoopContext) -> dict[str, Any]:
    """Magnitudes of S, T, PS and CS."""
    loop, omega = context.loop, context.omega
    L = loop.open_loop.response(omega)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        S = 1.0 / (1.0 + L)
        curves = {"S": S, "T": L * S, "PS": loop.plant.response(omega) * S, "CS": loop.C.response(omega) * S}
        decibels = {f"{name}_dB": 20.0 * np.log10(np.abs(value)) for name, value in curves.items()}
    whole = np.all([np.isfinite(value) for value in decibels.values()], axis=0)
    # Exactly on a pole or zero of the imaginary axis a product is 0 * inf: such a point is left out.
    return {"omega": omega[whole], **{name: value[whole] for name, value in decibels.items()}}
