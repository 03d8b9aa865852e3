"""Works out the number that an exercise expects."""

from dataclasses import replace

from looplab.engine.errors import EngineError, RuleNotApplicable
from looplab.engine.loop import FeedbackLoop
from looplab.engine.systems import TransferFunction
from looplab.engine.tuning import RULES, KnownPlant, ultimate_point
from looplab.labs.measures import LoopMeasures
from looplab.labs.schema import Bench, Expected, FromEngine, FromRule, Stated
from looplab.schemas import ExpressionSystem, Loop

UNIT_GAIN = ExpressionSystem(type="expr", text="1")


def expected_value(expected: Expected, bench: Bench) -> float:
    """The number itself.

    Raises
    ------
    EngineError
        It does not exist for this loop: no phase crossover, a rule outside its range, an unstable step response.
    """
    if isinstance(expected, Stated):
        return expected.value
    # A plant of its own comes without the instruments of the bench.
    loop = Loop(plant=expected.plant, controller=UNIT_GAIN) if expected.plant else bench.loop_of(UNIT_GAIN)
    engine = loop.to_engine()
    value = _by_rule(expected, engine.path) if isinstance(expected, FromRule) else _measured(expected, engine)
    return value * expected.times


def _measured(expected: FromEngine, loop: FeedbackLoop) -> float:
    if expected.quantity in ("Ku", "Pu"):
        point = ultimate_point(loop.path)
        return point.Ku if expected.quantity == "Ku" else point.Pu
    if expected.controller:
        loop = replace(loop, controller=expected.controller.to_engine())
    measured = LoopMeasures(loop).measure(expected.quantity)
    if measured.value is None:
        raise EngineError(f"{expected.quantity} is undefined here: {measured.reason}", field="quantity")
    return measured.value


def _by_rule(expected: FromRule, plant: TransferFunction) -> float:
    settings = KnownPlant.of(plant).tune(RULES[expected.rule], expected.type)
    value: float | None = getattr(settings, expected.setting)
    if value is None:
        raise RuleNotApplicable(f"{expected.rule} gives a {expected.type} controller no {expected.setting}")
    return value
