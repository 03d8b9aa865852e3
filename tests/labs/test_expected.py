"""Numbers that an exercise may ask of a tuning rule."""

import pytest

from looplab.engine.errors import EngineError
from looplab.labs import Lab
from looplab.labs.grading.expected import expected_value
from looplab.labs.schema import FromRule


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
