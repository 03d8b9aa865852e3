"""Experiments on linear plants against closed forms and the exact ultimate point."""

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.experiments.linear_relay import linear_relay
from looplab.engine.experiments.relay import Relay
from looplab.engine.experiments.step_test import StepTest, linear_step_test
from looplab.engine.experiments.ultimate_cycle import ring, ultimate_cycle
from looplab.engine.systems import parse_transfer_function

# Ku in closed form, or by the frequency response written out with mpmath where there is none.
PLANTS = {
    "1/(s+1)^3": 8.0,
    "exp(-0.1s)/(0.5s+1)": 8.50242498844502,
    "exp(-5s)/(s+1)": 1.13211172824653,
    "-2exp(-s)/s": -np.pi / 4,
    "exp(-s)/s": np.pi / 2,
    "1/(s(s+1)(0.2s+1))": 6.0,
    "(1-s)/(s+1)^2": 2.0,
    "1/((s+1)(s^2+0.2s+1))": 0.44,
    "1/(s+1)^8": 1 / np.cos(np.pi / 8) ** 8,
    "1/((s-1)(0.1s+1)^2)": 16.2,
}
# 1/(s+1)^n: Ku = cos(pi/n)^-n.
PLANTS["1/(s+1)^8"] = np.cos(np.pi / 8) ** -8


@pytest.mark.parametrize("plant", PLANTS)
def test_the_search_finds_the_ultimate_gain(plant):
    found = ultimate_cycle(parse_transfer_function(plant))
    assert found.found.Ku == pytest.approx(PLANTS[plant], rel=0.01)
    assert found.found.Pu == pytest.approx(found.exact.Pu, rel=0.01)
    assert found.ringing.oscillation.decay_ratio == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ("plant", "reason"),
    [
        ("1/(s+1)", "never reaches -180"),
        ("2(s+1)/(s(s-4))", "stable for gains above 2"),
        ("exp(-s)", "passes its input on at once"),
    ],
)
def test_no_ultimate_gain_is_refused(plant, reason):
    with pytest.raises(RuleNotApplicable, match=reason):
        ultimate_cycle(parse_transfer_function(plant))


def test_the_window_of_an_unstable_plant():
    window = ultimate_cycle(parse_transfer_function("1/((s-1)(0.1s+1)^2)")).window
    assert (window.low.K, window.high.K) == pytest.approx((1.0, 16.2), rel=1e-9)


def test_decay_of_a_ringing_run():
    """K/(s(s+1)): poles -1/2 +- i w, so a period shrinks the swings by exp(-pi/w)."""
    w = np.sqrt(25.0 - 0.25)
    seen = ring(parse_transfer_function("1/(s(s+1))"), 25.0, 8.0).oscillation
    assert seen.decay_ratio == pytest.approx(np.exp(-np.pi / w), rel=1e-6)
    assert seen.Pu == pytest.approx(2 * np.pi / w, rel=1e-6)


@pytest.mark.parametrize("eps", [0.0, 0.1])
@pytest.mark.parametrize("theta", [0.1, 1.0, 5.0])
def test_a_relay_on_a_lag_with_dead_time(theta, eps):
    """Closed form: y turns theta after it passes epsilon, at a = d - (d - eps) e^{-theta/tau}."""
    a = 2.0 - (2.0 - eps) * np.exp(-theta / 3.0)
    half = theta + 3.0 * np.log((2.0 + a) / (2.0 - eps))
    run = linear_relay(parse_transfer_function(f"exp(-{theta}s)/(3s+1)"), Relay(2.0, eps))
    assert run.swing == pytest.approx(a, rel=1e-9)
    assert run.Pu == pytest.approx(2 * half, rel=1e-9)
    assert run.point.Ku == pytest.approx(8.0 / (np.pi * np.sqrt(a * a - eps * eps)), rel=1e-9)


def test_the_bias_of_the_describing_function():
    """Little for eight lags, which pass the first harmonic alone; 13 % too high where dead time rules."""
    smooth = linear_relay(parse_transfer_function("1/(s+1)^8"), Relay(1.0)).point
    assert smooth.Ku == pytest.approx(PLANTS["1/(s+1)^8"], rel=0.01)
    square = linear_relay(parse_transfer_function("exp(-5s)/(s+1)"), Relay(1.0)).point
    assert square.Ku / PLANTS["exp(-5s)/(s+1)"] == pytest.approx(1.13, abs=0.01)


def test_relays_that_do_not_cycle():
    with pytest.raises(RuleNotApplicable, match="switch without end"):
        linear_relay(parse_transfer_function("1/(s+1)"), Relay(1.0))
    with pytest.raises(InvalidInput, match="at once"):
        linear_relay(parse_transfer_function("(s+2)/(s+1)"), Relay(1.0, 0.1))
    assert "runs away" in linear_relay(parse_transfer_function("1/(s-1)^2"), Relay(1.0, 0.05)).reason


def test_a_step_test():
    plant = parse_transfer_function("2exp(-0.5s)/(s+1)")
    test = StepTest(3.0, 1.0, 11.0, 111, std=0.1, seed=4, drift=0.2, u_max=6.0)
    found = linear_step_test(plant, test, u0=5.0, y0=7.0)
    assert found.y_true == pytest.approx(7.0 - 2.0 * np.expm1(-np.maximum(found.t - 1.5, 0.0)), abs=1e-12)
    assert found.u[9:11].tolist() == [5.0, 6.0]
    assert "stepped by 1 instead of 3" in found.notes[0]
    noise = found.y - found.y_true - 0.2 * found.t
    assert noise.std() == pytest.approx(0.1, rel=0.25)
    assert (linear_step_test(plant, test, 5.0, 7.0).y == found.y).all()
    with pytest.raises(InvalidInput, match="at its limit"):
        linear_step_test(plant, test, u0=6.0)
    # 0.5 + 0.1 - 0.5 is not 0.1 in binary fractions: nothing has cut this step short.
    assert linear_step_test(plant, StepTest(0.1, 1.0, 11.0), u0=0.5).notes == ()
