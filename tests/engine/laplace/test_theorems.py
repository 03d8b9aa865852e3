"""Initial and final value: right where the theorems hold, refused with the pole where they do not."""

import numpy as np
import pytest
from hypothesis import given

from looplab.engine.laplace import LaplaceInput, final_value, initial_value, inverse_transform, partial_fractions
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems

STEP = LaplaceInput("step")


def fractions(text: str, signal: LaplaceInput | None = STEP):
    return partial_fractions(parse_transfer_function(text), signal)


@pytest.mark.parametrize(
    ("text", "word", "blind"),
    [
        ("1/(s^2+3)", "no final value: pole at ±1.73j", 1 / 3),
        ("1/(s-1)", "no final value: pole at +1,", -1.0),
        ("1/s", "no final value: pole of order 2 at 0", None),
        ("1/s^2", "grows like t^2", None),
        ("1/(s^2+1)^2", "repeated pole at ±j", 1.0),
        ("1/(s^2-s+1)", "no final value: pole at 0.5 ± 0.866j", 1.0),
    ],
)
def test_no_final_value(text: str, word: str, blind: float | None) -> None:
    found = final_value(fractions(text))
    assert found.value is None
    assert word in (found.reason or "")
    # What the theorem claims when its condition is not looked at.
    assert found.formula == pytest.approx(blind)


def test_final_values() -> None:
    assert final_value(fractions("2/(s+1)^3")).value == pytest.approx(2.0, rel=1e-14)
    assert final_value(fractions("s/(s+1)")).value == 0.0
    # A zero hides the unstable pole: y settles (and the system is not internally stable).
    assert final_value(fractions("(s-1)/((s-1)(s+2))")).value == pytest.approx(0.5)
    assert final_value(fractions("s/(s+1)", LaplaceInput("ramp"))).value == pytest.approx(1.0)
    assert final_value(fractions("exp(-s)/s", None)).value == 1.0


def test_initial_values() -> None:
    assert initial_value(fractions("(2s+1)/(s+1)")).value == pytest.approx(2.0, rel=1e-14)
    assert initial_value(fractions("3/(s+1)", None)).value == 3.0
    assert initial_value(fractions("1/((s+1)(s+2)(s+3))")).value == 0.0
    assert initial_value(fractions("3exp(-s)/(s+1)", None)).value == 0.0
    nothing = initial_value(fractions("(s+3)/(s+1)", None))
    assert nothing.value is None
    assert "not strictly proper" in (nothing.reason or "")


@given(systems(order=(1, 5), excess=0, stable=True, theta=True))
@effort(60)
def test_the_limits_are_those_of_the_response(G: TransferFunction) -> None:
    found = partial_fractions(G, STEP)
    y = inverse_transform(found)
    late = G.theta + 60.0 / float(-G.poles.real.max())
    scale = sum(abs(t.coefficient) for t in found.terms) + 1e-300
    last, first = final_value(found).value, initial_value(found).value
    assert last is not None
    assert first is not None
    assert abs(last - G.dc_gain) < 1e-12 * scale
    assert abs(float(y(late)) - last) < 1e-9 * scale
    expected = G.high_frequency_gain if not G.theta else 0.0
    assert abs(first - expected) < 1e-9 * scale
    if G.theta:
        assert np.all(y(np.array([0.0, 0.99 * G.theta])) == 0)
