"""What POST /loop can show: one function a panel, each with a key of what it truly depends on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from looplab.api.panels import frequency, stability, time
from looplab.api.panels.context import LoopContext


@dataclass(frozen=True)
class Panel:
    """How a panel is computed, and the content that its key is the hash of."""

    compute: Callable[[LoopContext], dict[str, Any]]
    depends_on: Callable[[LoopContext], tuple[Any, ...]]


PANELS: dict[str, Panel] = {
    "verdict": Panel(stability.verdict, LoopContext.loop_content),
    "step": Panel(time.step, LoopContext.step_content),
    "bode": Panel(frequency.bode_panel, LoopContext.frequency_content),
    "nyquist": Panel(frequency.nyquist, LoopContext.loop_content),
    "root_locus": Panel(stability.locus, LoopContext.locus_content),
    "poles": Panel(stability.poles, LoopContext.loop_content),
    "margins": Panel(frequency.margins_panel, LoopContext.loop_content),
    "metrics": Panel(time.metrics, LoopContext.step_content),
    "sensitivity": Panel(frequency.sensitivity, LoopContext.frequency_content),
    "asymptotes": Panel(frequency.asymptotes, LoopContext.frequency_content),
    "gang_steps": Panel(time.gang, LoopContext.step_content),
    "root_locus_negative": Panel(stability.negative_locus, LoopContext.locus_content),
}

__all__ = ["PANELS", "LoopContext", "Panel"]
