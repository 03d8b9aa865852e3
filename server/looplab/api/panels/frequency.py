"""Frequency-domain panels: Bode with its asymptotes, Nyquist, margins and the sensitivity functions."""

from __future__ import annotations

from typing import Any

import numpy as np

from looplab.api.open_loop import asymptotes_answer, nyquist_answer
from looplab.api.panels.context import LoopContext
from looplab.engine.frequency import margins
from looplab.engine.frequency.sampled import Sampled, sampled
from looplab.engine.loop.gang_of_six import GANG, gang_of_six

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


def asymptotes(context: LoopContext) -> dict[str, Any]:
    """Straight lines of the Bode diagram of L over the same frequency axis."""
    return asymptotes_answer(context.loop.open_loop, *context.omega_range)


def nyquist(context: LoopContext) -> dict[str, Any]:
    """The Nyquist curve with N, P and Z = N + P written out."""
    return nyquist_answer(context.loop.open_loop, context.verdict.closed_loop_stable)


def margins_panel(context: LoopContext) -> dict[str, Any]:
    """Margins and peaks; infinite or undefined ones are null with a reason."""
    return vars(margins(context.loop.open_loop)) | {"closed_loop_stable": context.verdict.closed_loop_stable}


def sensitivity(context: LoopContext) -> dict[str, Any]:
    """Magnitudes of the gang of six; None for one that is zero."""
    gang = gang_of_six(context.loop, context.open_loop.omega)
    curves = {name: getattr(gang, name) for name in GANG}
    # Exactly on a pole or zero of the imaginary axis a product is 0 * inf: such points are left out.
    there = {name: value for name, value in curves.items() if np.isfinite(value).any()}
    whole = np.all([np.isfinite(value) for value in there.values()], axis=0)
    decibels = {f"{name}_dB": value[whole] * DECIBELS if name in there else None for name, value in curves.items()}
    return {"omega": gang.omega[whole], **decibels, "feedforward": context.loop.feedforward}
