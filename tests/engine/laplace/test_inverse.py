"""y(t): expressions to the letter, mpmath's numerical inversion, and the simulation."""

import math
import re

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from looplab.engine.errors import InvalidInput
from looplab.engine.laplace import (
    LATEX,
    TEXT,
    LaplaceInput,
    Rational,
    check_by_simulation,
    fractions_sum,
    inverse_transform,
    partial_fractions,
    suggested_horizon,
)
from looplab.engine.loop import step_response
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems

STEP = LaplaceInput("step")


def time_function(text: str, signal: LaplaceInput | None = STEP):
    return inverse_transform(partial_fractions(parse_transfer_function(text), signal))


@pytest.mark.parametrize(
    ("text", "signal", "expected"),
    [
        ("1/(s+1)^2", STEP, "1 - e^(-t) (1 + t)"),
        ("1/(s^2+1)", STEP, "1 - cos(t)"),
        ("2/(s^2+2s+5)", STEP, "0.4 - e^(-t) (0.4 cos(2 t) + 0.2 sin(2 t))"),
        ("1/(s^2+1)", LaplaceInput("sine"), "0.5 sin(t) - 0.5 t cos(t)"),
        ("1/(s+1)^3", None, "0.5 t^2 e^(-t)"),
        ("2/(s^2+2s+5)", None, "e^(-t) sin(2 t)"),
        ("(s+3)/(s+1)", STEP, "3 - 2 e^(-t)"),
        ("(s+3)/(s+1)", LaplaceInput("impulse"), "delta(t) + 2 e^(-t)"),
        ("(3-s)/(s+1)", LaplaceInput("impulse"), "-delta(t) + 4 e^(-t)"),
        ("1/s", STEP, "t"),
        ("1/(s+1)", LaplaceInput("ramp"), "-1 + t + e^(-t)"),
        ("1/(s+1)", LaplaceInput("exponential", rate=-1.0), "t e^(-t)"),
        ("exp(-0.5s)/(2s+1)", STEP, "(1 - e^(-0.5 (t - 0.5))) 1(t - 0.5)"),
        ("exp(-2s)/(s+1)", None, "e^(-(t - 2)) 1(t - 2)"),
        ("exp(-s)", STEP, "1(t - 1)"),
        ("3exp(-s)", None, "3 delta(t - 1)"),
        ("1/(s-1)", STEP, "-1 + e^(t)"),
    ],
)
def test_expressions(text: str, signal: LaplaceInput | None, expected: str) -> None:
    assert time_function(text, signal).to_text() == expected


def test_no_power_that_matters_is_left_out() -> None:
    """20 lags: 1 - e^(-t) sum t^k/k!, and at t = 20 the largest of them is t^19/19!, whose factor is 8e-18."""
    text = time_function("1/(s+1)^20", STEP).to_text()
    powers = [1.0] + [float(c) for c in re.findall(r"([0-9.e-]+) t\^", text)]
    assert powers == pytest.approx([1.0] + [1 / math.factorial(k) for k in range(2, 20)], rel=1e-5)
    slow = time_function("1/(1e4s+1)^6", STEP).to_text()
    assert slow.endswith(f" + {1e-20 / math.factorial(5):.6g} t^5)")


def test_a_slow_repeated_pair_keeps_every_fraction() -> None:
    """1/(s q^3) = (1/s - s/q)/w^6 - s/(w^4 q^2) - s/(w^2 q^3) with q = s^2 + w^2, here w^2 = 1e-8."""
    found = partial_fractions(parse_transfer_function("1/(s^2+1e-8)^3"), STEP)
    expected = "1e+24/s - 1e+24 s/(s^2 + 1e-08) - 1e+16 s/(s^2 + 1e-08)^2 - 1e+08 s/(s^2 + 1e-08)^3"
    assert fractions_sum(found, TEXT, 6) == expected


def test_latex() -> None:
    assert time_function("1/(s+1)^2").to_latex() == r"1 - e^{-t} \left(1 + t\right)"
    assert time_function("exp(-0.5s)/(2s+1)^2", None).to_latex() == (
        r"0.25\,\left(t - 0.5\right) e^{-0.5\,\left(t - 0.5\right)}\,1(t - 0.5)"
    )
    found = partial_fractions(parse_transfer_function("1/((s+1)^2(s^2+1))"), STEP)
    assert fractions_sum(found, TEXT, 6) == "1/s - 0.5/(s^2 + 1) - 1/(s + 1) - 0.5/(s + 1)^2"
    assert fractions_sum(found, LATEX, 4) == (
        r"\frac{1}{s} - \frac{0.5}{s^{2} + 1} - \frac{1}{s + 1} - \frac{0.5}{\left(s + 1\right)^{2}}"
    )


def test_a_repeated_pair_as_real_fractions() -> None:
    found = partial_fractions(parse_transfer_function("s/((s^2+s+1)^2(s+1))"))
    assert fractions_sum(found, TEXT, 6) == "s/(s^2 + s + 1) + (s + 1)/(s^2 + s + 1)^2 - 1/(s + 1)"


@pytest.mark.parametrize(
    "text",
    ["1/(s(s+1)^3)", "(s+2)/(s(s^2+s+1)^2)", "5(s+2)/(s^2(s+1)(s+3))", "(1-2s)/(s(s+1)(s^2+0.2s+4))", "1/(s^2+2)^2"],
)
def test_against_numerical_inversion(text: str) -> None:
    """mpmath.invertlaplace (de Hoog) with 40 digits: a way that knows no poles."""
    Y = parse_transfer_function(text)
    y = time_function(text, None)

    def transform(s):
        value = mpmath.mpf(Y.gain)
        for z in Y.zeros:
            value *= s - mpmath.mpc(z)
        for p in Y.poles:
            value /= s - mpmath.mpc(p)
        return value

    with mpmath.workdps(40):
        for t in (0.3, 1.7, 6.0):
            exact = float(mpmath.re(mpmath.invertlaplace(transform, t, method="dehoog", degree=60)))
            assert float(y(t)) == pytest.approx(exact, rel=1e-10, abs=1e-10)


@given(systems(order=(1, 6), excess=0, stable=True, axis=True, theta=True))
@effort(60)
def test_a_step_is_what_the_simulation_gives(G: TransferFunction) -> None:
    gaps = np.abs(G.poles[:, None] - G.poles[None, :]) / np.maximum(np.abs(G.poles[:, None]), 0.1) + 10 * np.eye(
        G.order
    )
    assume(gaps.min() > 1e-3)
    y = inverse_transform(partial_fractions(G, STEP))
    r = step_response(G, G.theta + 20.0, 300)
    # At the dead time itself rounding of the grid decides which side is meant.
    away = np.abs(r.t - G.theta) > 1e-9
    size = max(np.abs(r.y).max(), 1e-300)
    assert np.abs(y(r.t) - r.y)[away].max() < 1e-9 * size
    assert np.abs(y.derivative()(r.t) - r.dy)[away].max() < 1e-9 * max(np.abs(r.dy).max(), size)


@given(
    systems(order=(1, 5), stable=False, axis=True),
    st.sampled_from(["impulse", "step", "ramp", "sine", "exponential"]),
)
@effort(60)
def test_every_input_is_checked_by_simulation(G: TransferFunction, type: str) -> None:
    gaps = np.abs(G.poles[:, None] - G.poles[None, :]) / np.maximum(np.abs(G.poles[:, None]), 0.1) + 10 * np.eye(
        G.order
    )
    assume(gaps.min() > 1e-2)
    u = LaplaceInput(type, 1.5, 1.3, -0.4)  # type: ignore[arg-type]
    y = inverse_transform(partial_fractions(G, u))
    check = check_by_simulation(Rational.of(G * u.transform()), y, suggested_horizon(y))
    assert check.difference is not None
    assert check.difference < 1e-9


def test_what_cannot_be_simulated_says_so() -> None:
    G = parse_transfer_function("(s+2)/(s+1)")
    y = inverse_transform(partial_fractions(G))
    check = check_by_simulation(Rational.of(G), y, 5.0)
    assert check.difference is None
    assert "impulse" in (check.reason or "")


def test_cancelling_digits_are_told() -> None:
    """Ten poles 2 % apart: residues of 1e10 leave six digits, and the answer says so."""
    G = TransferFunction((), [-1 - 0.02 * k for k in range(10)], 1.0)
    found = partial_fractions(G, STEP)
    check = check_by_simulation(Rational.of(G * STEP.transform()), inverse_transform(found), 20.0)
    assert check.difference is not None
    assert check.difference > 1e-9
    assert "cancel" in (check.reason or "")
    assert found.residual > 1e-9


def test_a_step_twice_as_high_is_twice_as_high() -> None:
    t = np.linspace(0, 10, 50)
    one, two = (time_function("exp(-s)/(s^2+s+1)", LaplaceInput("step", a)) for a in (1.0, 2.0))
    assert np.allclose(two(t), 2 * one(t), rtol=1e-14)


@pytest.mark.parametrize(
    "settings", [{"type": "sawtooth"}, {"type": "sine", "omega": 0.0}, {"type": "step", "amplitude": float("nan")}]
)
def test_a_bad_input_is_refused(settings) -> None:
    with pytest.raises(InvalidInput):
        LaplaceInput(**settings)
