"""The ultimate point: at Ku the loop has a pole pair on the axis at omega_180, below it is stable, above it is not."""

import numpy as np
import pytest
from hypothesis import assume, given

from independent import rhp_closed_loop_poles
from looplab.engine.errors import RuleNotApplicable
from looplab.engine.systems import TransferFunction, parse_transfer_function
from looplab.engine.tuning import ultimate_point
from strategies import effort, systems


@effort(50)
@given(systems(order=(3, 5), excess=2) | systems(order=(1, 3), theta=True))
def test_ku_is_the_limit(P: TransferFunction) -> None:
    try:
        u = ultimate_point(P)
    except RuleNotApplicable as refusal:
        assert refusal.hint
        return
    assert u.Ku * P(1j * u.omega_180) == pytest.approx(-1, abs=1e-9)
    assert u.Pu * u.omega_180 == pytest.approx(2 * np.pi, rel=1e-14)
    poles, zeros = list(P.poles), list(P.zeros)

    def Z(K: float) -> int:
        return rhp_closed_loop_poles(zeros, poles, P.gain * K, P.theta)

    assert Z(u.Ku * (1 - 1e-4)) == 0
    assert Z(u.Ku * (1 + 1e-4)) == 2


@effort(30)
@given(systems(order=(3, 5), excess=2) | systems(order=(1, 3), theta=True))
def test_time_and_gain_scale(P: TransferFunction) -> None:
    """P(s/a) b has omega_180 a times and Ku 1/b times as large."""
    a, b = 3.0, 0.25
    scaled = TransferFunction(P.zeros * a, P.poles * a, b * P.gain * a**P.relative_degree, P.theta / a)
    try:
        u = ultimate_point(P)
    except RuleNotApplicable:
        with pytest.raises(RuleNotApplicable):
            ultimate_point(scaled)
        return
    v = ultimate_point(scaled)
    assert v.omega_180 == pytest.approx(a * u.omega_180, rel=1e-9)
    assert v.Ku == pytest.approx(u.Ku / b, rel=1e-9)


def test_negative_gain_gives_a_negative_ultimate_gain() -> None:
    a = ultimate_point(parse_transfer_function("1/(s+1)^3"))
    b = ultimate_point(parse_transfer_function("-1/(s+1)^3"))
    assert b.Ku == pytest.approx(-a.Ku, rel=1e-14)
    assert b.Pu == pytest.approx(a.Pu, rel=1e-14)


@pytest.mark.parametrize("text", ["1/(s+1)", "1/(s+1)^2", "1/s", "2", "1/s^2", "1/s^3", "(s+1)^2/s^3", "1/(s-1)"])
def test_refusals_say_why(text: str) -> None:
    with pytest.raises(RuleNotApplicable) as caught:
        ultimate_point(parse_transfer_function(text))
    assert caught.value.message
    assert caught.value.hint


def test_a_plant_without_gain_is_refused() -> None:
    with pytest.raises(RuleNotApplicable):
        ultimate_point(TransferFunction((), (-1,), 0.0))


@effort(20)
@given(systems(order=(2, 3), theta=True))
def test_dead_time_makes_the_limit_lower(P: TransferFunction) -> None:
    assume(P.zeros.size == 0 and P.gain > 0)
    later = TransferFunction(P.zeros, P.poles, P.gain, P.theta * 1.3)
    assume((P.poles.imag == 0).all())
    assert ultimate_point(later).omega_180 < ultimate_point(P).omega_180
    assert ultimate_point(later).Ku < ultimate_point(P).Ku
