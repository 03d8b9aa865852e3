"""Tuning rules, one a file, each with its source and range; the best settings under a limit; and what comes of them.

The rules say what they need and refuse outside their range. ``optimal_tuning`` searches, ``compare`` and
``sensitivity`` judge on the true plant, ``gain_map`` shows the whole plane of a PI controller.
"""

from looplab.engine.tuning.cohen_coon_rule import cohen_coon
from looplab.engine.tuning.comparison import ComparedLoop, compare, plant_horizon
from looplab.engine.tuning.forms import (
    Gains,
    ParallelGains,
    ideal_to_parallel,
    ideal_to_series,
    parallel_to_ideal,
    proportional_band,
    series_to_ideal,
)
from looplab.engine.tuning.gain_map import GainMap, gain_map
from looplab.engine.tuning.known_plant import KnownPlant
from looplab.engine.tuning.loop_family import Aim, Criterion
from looplab.engine.tuning.optimal import OptimalTuning, optimal_tuning
from looplab.engine.tuning.rules import RULES, RuleName
from looplab.engine.tuning.sensitivity import Band, Case, Sensitivity, perturbed_plant, sensitivity
from looplab.engine.tuning.settings import TYPES, Options, PlantData, Rule, Settings, TypeName
from looplab.engine.tuning.trade_off import TradeOff, trade_off
from looplab.engine.tuning.ultimate_point import UltimatePoint, relay_point, ultimate_point
from looplab.engine.tuning.ziegler_nichols import ziegler_nichols_ultimate

__all__ = [
    "RULES",
    "TYPES",
    "Aim",
    "Band",
    "Case",
    "ComparedLoop",
    "Criterion",
    "GainMap",
    "Gains",
    "KnownPlant",
    "OptimalTuning",
    "Options",
    "ParallelGains",
    "PlantData",
    "Rule",
    "RuleName",
    "Sensitivity",
    "Settings",
    "TradeOff",
    "TypeName",
    "UltimatePoint",
    "cohen_coon",
    "compare",
    "gain_map",
    "ideal_to_parallel",
    "ideal_to_series",
    "optimal_tuning",
    "parallel_to_ideal",
    "perturbed_plant",
    "plant_horizon",
    "proportional_band",
    "relay_point",
    "sensitivity",
    "series_to_ideal",
    "trade_off",
    "ultimate_point",
    "ziegler_nichols_ultimate",
]
