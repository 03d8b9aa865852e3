"""Tuning rules, one a file: each says its source and its range, and refuses outside it."""

from looplab.engine.tuning.cohen_coon_rule import cohen_coon
from looplab.engine.tuning.rules import RULES, Rule
from looplab.engine.tuning.settings import TYPES, Settings
from looplab.engine.tuning.ultimate_point import UltimatePoint, ultimate_point
from looplab.engine.tuning.ziegler_nichols import ziegler_nichols_ultimate

__all__ = [
    "RULES",
    "TYPES",
    "Rule",
    "Settings",
    "UltimatePoint",
    "cohen_coon",
    "ultimate_point",
    "ziegler_nichols_ultimate",
]
