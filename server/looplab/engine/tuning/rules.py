"""The list of tuning rules: what each is called, what it needs to know of the plant, and how to apply it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from looplab.engine.systems.first_second_order import FOPDT
from looplab.engine.tuning import cohen_coon_rule as _cc
from looplab.engine.tuning import ziegler_nichols as _zn
from looplab.engine.tuning.settings import Settings
from looplab.engine.tuning.ultimate_point import UltimatePoint


@dataclass(frozen=True)
class Rule:
    """A tuning rule.

    Attributes
    ----------
    name, source : str
        Full name and publication.
    needs : {"ultimate", "model"}
        Whether it starts from the ultimate point or from a FOPDT model.
    formulas : dict
        LaTeX of the settings by controller type.
    apply : callable
        (UltimatePoint or FOPDT, type) -> Settings; raises RuleNotApplicable outside its range.
    """

    name: str
    source: str
    needs: Literal["ultimate", "model"]
    formulas: dict[str, str]
    apply: Callable[[Any, str], Settings]


def _ultimate_cycle(point: UltimatePoint, type: str) -> Settings:
    return _zn.ziegler_nichols_ultimate(point.Ku, point.Pu, type)


def _reaction_curve(model: FOPDT, type: str) -> Settings:
    return _cc.cohen_coon(model, type)


RULES: dict[str, Rule] = {
    _zn.RULE: Rule(_zn.NAME, _zn.SOURCE, "ultimate", _zn.FORMULAS, _ultimate_cycle),
    _cc.RULE: Rule(_cc.NAME, _cc.SOURCE, "model", _cc.FORMULAS, _reaction_curve),
}
