"""The price of robustness: the best a controller can do, for each limit of Ms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.loop import PID
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.loop_family import Aim, Criterion
from looplab.engine.tuning.optimal import OptimalTuning, optimal_tuning
from looplab.engine.tuning.settings import TypeName


@dataclass(frozen=True)
class TradeOff:
    """Best settings for increasing limits of Ms; None (with a reason) where a limit cannot be kept."""

    limits: tuple[float, ...]
    results: tuple[OptimalTuning | None, ...]
    reasons: dict[str, str]


def trade_off(
    plant: TransferFunction, type: TypeName, criterion: Criterion, aim: Aim, limits: Sequence[float]
) -> TradeOff:
    """The price of robustness: the best value of a criterion for each limit of Ms, and the settings that reach it.

    Parameters
    ----------
    plant, type, criterion, aim :
        As in optimal_tuning.
    limits : sequence of float
        Limits of Ms, 1.05 to 4 [-]; answered in increasing order.

    Returns
    -------
    TradeOff
        Each search starts where the one before it ended.

    Raises
    ------
    InvalidInput, ImproperSystem
        As optimal_tuning.
    """
    ordered = tuple(sorted(limits))
    results: list[OptimalTuning | None] = []
    reasons: dict[str, str] = {}
    near: PID | None = None
    for limit in ordered:
        try:
            found = optimal_tuning(plant, type, criterion, aim, limit, None, near)
        except RuleNotApplicable as refusal:
            reasons[f"{limit:g}"] = refusal.message
            results.append(None)
            continue
        near = found.controller
        results.append(found)
    return TradeOff(ordered, tuple(results), reasons)
