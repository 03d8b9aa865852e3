"""What a lab can measure on a loop, under one name each: margins, the setpoint step, the load step."""

from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import get_args

from looplab.engine.frequency import Margins, margins
from looplab.engine.loop import (
    ClosedLoopStep,
    FeedbackLoop,
    StepMetrics,
    closed_loop_step,
    default_horizon,
    step_metrics,
)
from looplab.engine.nomenclature import NOMENCLATURE
from looplab.labs.schema import LoopMeasure

POINTS = 1000
MARGINS = ("GM", "GM_dB", "omega_180", "PM_deg", "omega_c", "delay_margin", "Ms", "omega_Ms", "Mt", "omega_Mt")
CAN_BE_INFINITE = ("GM", "GM_dB", "PM_deg", "delay_margin", "Ms", "Mt")
NAMES: tuple[str, ...] = get_args(LoopMeasure)
WORDS = {
    "GM": "gain margin",
    "GM_dB": "gain margin",
    "PM_deg": "phase margin",
    "Ms": "sensitivity peak Ms",
    "Mt": "peak of T, Mt",
    "omega_180": "phase crossover frequency",
    "omega_c": "gain crossover frequency",
    "delay_margin": "delay margin",
    "offset": "offset",
    "overshoot_pct": "overshoot",
    "t_rise": "rise time",
    "t_settle": "settling time",
    "t_peak": "time of the peak",
    "decay_ratio": "decay ratio",
    "final_value": "final value",
    "IAE": "IAE",
    "ISE": "ISE",
    "ITAE": "ITAE",
    "TV": "total variation of u",
}


@dataclass(frozen=True)
class Measured:
    """A value, or None and the reason why there is none; an infinite margin is ``inf``."""

    value: float | None
    reason: str = ""


class LoopMeasures:
    """Measures one loop; each simulation and analysis runs once, and only if something asks for it."""

    def __init__(self, loop: FeedbackLoop, horizon: float | None = None) -> None:
        self.loop = loop
        self.horizon = horizon

    @property
    def stable(self) -> bool:
        return self._margins.closed_loop_stable

    def measure(self, name: str) -> Measured:
        """One of `NAMES`."""
        if name in MARGINS:
            return _field(self._margins, name)
        if name.startswith("load_"):
            return _field(self._load, name.removeprefix("load_"))
        return _field(self._setpoint, name)

    @cached_property
    def _margins(self) -> Margins:
        return margins(self.loop.open_loop)

    @cached_property
    def _step(self) -> ClosedLoopStep:
        # A bench may show less than the loop needs to come to rest; the measures must not.
        horizon = max(self.horizon or 0.0, default_horizon(self.loop))
        return closed_loop_step(self.loop, horizon=horizon, points=POINTS)

    @cached_property
    def _setpoint(self) -> StepMetrics:
        return step_metrics(self._step.setpoint, setpoint=1.0, stable=self.stable)

    @cached_property
    def _load(self) -> StepMetrics:
        return step_metrics(self._step.load, setpoint=0.0, stable=self.stable)


def _field(result: Margins | StepMetrics, name: str) -> Measured:
    value = getattr(result, name)
    if value is None:
        reason = result.reasons.get(name, "it is not defined for this loop")
        return Measured(inf if name in CAN_BE_INFINITE and reason.startswith("infinite") else None, reason)
    return Measured(float(value))


def words(name: str) -> str:
    """What a measure is called in a sentence."""
    load = name.startswith("load_")
    name = name.removeprefix("load_")
    text = WORDS.get(name, NOMENCLATURE[name].meaning if name in NOMENCLATURE else name)
    return f"{text} after a load step" if load else text


def unit(name: str, time_unit: str) -> str:
    """Its unit for a person: %, dB, degrees or the bench's time unit; nothing for a ratio or a signal's own unit."""
    symbol = NOMENCLATURE.get(name.removeprefix("load_"))
    known = {"%": "%", "dB": "dB", "deg": "°", "time": time_unit, "rad/time": f"rad/{time_unit}"}
    return known.get(symbol.unit, "") if symbol else ""
