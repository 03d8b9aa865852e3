"""Works out the number that an exercise expects."""

from looplab.engine.errors import EngineError, RuleNotApplicable
from looplab.engine.loop import FeedbackLoop
from looplab.engine.systems import TransferFunction
from looplab.engine.tuning import RULES, KnownPlant, ultimate_point
from looplab.labs.measures import LoopMeasures
from looplab.labs.schema import Bench, Expected, FromEngine, FromRule, Stated
from looplab.schemas import System

UNIT_GAIN = TransferFunction()


def expected_value(expected: Expected, bench: Bench) -> float:
    """The number itself.

    Raises
    ------
    EngineError
        It does not exist for this loop: no phase crossover, a rule outside its range, an unstable step response.
    """
    if isinstance(expected, Stated):
        return expected.value
    plant = expected.plant or bench.plant
    value = _by_rule(expected, plant) if isinstance(expected, FromRule) else _measured(expected, plant.to_engine())
    return value * expected.times


def _measured(expected: FromEngine, plant: TransferFunction) -> float:
    if expected.quantity in ("Ku", "Pu"):
        point = ultimate_point(plant)
        return point.Ku if expected.quantity == "Ku" else point.Pu
    controller = expected.controller.to_engine() if expected.controller else UNIT_GAIN
    measured = LoopMeasures(FeedbackLoop(plant=plant, controller=controller)).measure(expected.quantity)
    if measured.value is None:
        raise EngineError(f"{expected.quantity} is undefined here: {measured.reason}", field="quantity")
    return measured.value


def _by_rule(expected: FromRule, plant: System) -> float:
    settings = KnownPlant.of(plant.to_engine()).tune(RULES[expected.rule], expected.type)
    value: float | None = getattr(settings, expected.setting)
    if value is None:
        raise RuleNotApplicable(f"{expected.rule} gives a {expected.type} controller no {expected.setting}")
    return value
