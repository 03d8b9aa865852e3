"""Numbers that an exercise may ask of a tuning rule, or of the loop of its bench."""

import math

import pytest

from looplab.engine.errors import EngineError
from looplab.labs import Lab
from looplab.labs.grading.design import grade_design
from looplab.labs.grading.expected import expected_value
from looplab.labs.schema import Bench, DesignExercise, FromEngine, FromRule


@pytest.mark.parametrize(
    ("rule", "type", "setting", "value"),
    [
        # The bench's plant is 1/(s+1)^3: Ku = 8, Pu = 2 pi/sqrt(3); half rule tau = theta = 1.5.
        ("ziegler_nichols", "PI", "Kc", 3.6),
        ("tyreus_luyben", "PI", "tau_I", 2.2 * 3.6275987),
        ("simc", "PI", "Kc", 0.5),
        ("simc", "PI", "tau_I", 1.5),
    ],
)
def test_any_rule_can_be_asked(lab: Lab, rule: str, type: str, setting: str, value: float) -> None:
    asked = FromRule.model_validate({"rule": rule, "type": type, "setting": setting})
    assert lab.bench is not None
    assert expected_value(asked, lab.bench) == pytest.approx(value, rel=1e-6)


@pytest.mark.parametrize(("type", "setting"), [("P", "tau_I"), ("PD", "Kc")])
def test_what_a_rule_does_not_give_is_an_error(lab: Lab, type: str, setting: str) -> None:
    asked = FromRule.model_validate({"rule": "ziegler_nichols", "type": type, "setting": setting})
    with pytest.raises(EngineError):
        expected_value(asked, lab.bench)


@pytest.fixture
def bench_with_instruments(lab: Lab) -> Bench:
    """exp(-s)/s, its dead time in parts in valve and sensor: Ku = pi/2, Pu = 4."""
    systems = {"plant": "1/s", "actuator": "exp(-0.6s)", "sensor": "exp(-0.4s)"}
    assert lab.bench is not None
    given = {name: {"type": "expr", "text": text} for name, text in systems.items()}
    return Bench.model_validate({**lab.bench.model_dump(), **given})


def test_the_instruments_of_the_bench_count(bench_with_instruments: Bench) -> None:
    def value(**asked: object) -> float:
        return expected_value(FromEngine.model_validate(asked), bench_with_instruments)

    assert value(quantity="Ku") == pytest.approx(math.pi / 2, rel=1e-12)
    assert value(quantity="Pu") == pytest.approx(4, rel=1e-12)
    # |L| = 1 at omega = 1, where the dead times have turned the phase by 1 rad.
    assert value(quantity="PM_deg", controller={"type": "pid", "Kc": 1}) == pytest.approx(90 - math.degrees(1))
    asked = FromRule.model_validate({"rule": "ziegler_nichols", "type": "P", "setting": "Kc"})
    assert expected_value(asked, bench_with_instruments) == pytest.approx(math.pi / 4)
    other = {"type": "expr", "text": "exp(-2s)/s"}
    assert value(quantity="Ku", plant=other) == pytest.approx(math.pi / 4, rel=1e-12)


@pytest.mark.parametrize(("Kc", "stable"), [(1.57, True), (1.58, False)])
def test_a_design_is_simulated_with_the_instruments(
    lab: Lab, bench_with_instruments: Bench, Kc: float, stable: bool
) -> None:
    exercise = next(block for block in lab.parts[0].blocks if isinstance(block, DesignExercise))
    found = grade_design(exercise, {"Kc": Kc, "tau_I": None, "tau_D": None}, bench_with_instruments)
    assert found.checks[0].passed is stable
