"""Frequency-domain panels: Bode, Nyquist, margins and the sensitivity functions."""

from __future__ import annotations

from typing import Any

import numpy as np

from looplab.api.open_loop import nyquist_answer
from looplab.api.panels.context import LoopContext
from looplab.engine.frequency import margins
from looplab.engine.frequency.sampled import Sampled, sampled

DECIBELS = 20.0 / np.log(10.0)


def _curve(data: Sampled) -> dict[str, Any] | None:
    """Magnitude and phase; None for a system that is zero."""
    if not np.isfinite(data.log_magnitude).any():
        return None
    # On a zero of the imaginary axis the magnitude is -inf: the plot goes to its floor there.
    decibels = np.clip(data.log_magnitude * DECIBELS, -400.0, 400.0)
    return {"mag_dB": decibels, "phase_deg": np.degrees(data.phase)}


def bode_panel(context: LoopContext) -> dict[str, Any]:
    """Bode data of L, P and C over one frequency axis."""
    loop, L = context.loop, context.open_loop
    P, C = (sampled(system, *context.omega_range, loop.open_loop) for system in (loop.plant, loop.C))
    return {"omega": L.omega, "L": _curve(L), "P": _curve(P), "C": _curve(C)}


def nyquist(context: LoopContext) -> dict[str, Any]:
    """The Nyquist curve with N, P and Z = N + P written out."""
    return nyquist_answer(context.loop.open_loop, context.verdict.closed_loop_stable)


def margins_panel(context: LoopContext) -> dict[str, Any]:
    """Margins and peaks; infinite or undefined ones are null with a reason."""
    return vars(margins(context.loop.open_loop)) | {"closed_loop_stable": context.verdict.closed_loop_stable}


def sensitivity(context: LoopContext) -> dict[str, Any]:
    """Magnitudes of S, T, PS and CS."""
    loop, L = context.loop, context.open_loop
    P, C = (sampled(system, *context.omega_range, loop.open_loop) for system in (loop.plant, loop.C))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        S = -np.log(np.abs(1.0 + np.exp(L.log_magnitude + 1j * L.phase)))
        curves = {"S": S, "T": S + L.log_magnitude, "PS": S + P.log_magnitude, "CS": S + C.log_magnitude}
    # Exactly on a pole or zero of the imaginary axis a product is 0 * inf, and a system that is zero has no decibels:
    # such points are left out.
    whole = np.all([np.isfinite(value) for value in curves.values()], axis=0)
    return {"omega": L.omega[whole], **{f"{name}_dB": value[whole] * DECIBELS for name, value in curves.items()}}
