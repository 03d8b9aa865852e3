"""Verdicts of delayed systems against independent counts, known boundaries, and chains of poles."""

from math import acos, pi, sqrt

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from independent import rhp_closed_loop_poles
from looplab.engine.delays import (
    DelaySystem,
    control_loop,
    count_right_of,
    delay_verdict,
    feedback,
    parallel,
    rightmost_poles,
    series,
    smith_predictor,
)
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, magnitudes, systems

made = DelaySystem.from_transfer_function


def block(text: str) -> DelaySystem:
    return made(parse_transfer_function(text))


@effort(15)
@given(systems(order=(1, 3), stable=False, theta=True), st.floats(0.1, 0.9), magnitudes)
def test_the_count_is_the_independent_one_wherever_the_dead_time_sits(
    L: TransferFunction, share: float, gain: float
) -> None:
    L = L * gain
    try:
        expected = rhp_closed_loop_poles(L.zeros, L.poles, L.gain, L.theta)
        assume(rhp_closed_loop_poles(L.zeros, L.poles, L.gain, L.theta, 1e-4) == expected)
    except ValueError:
        assume(False)
    front = made(TransferFunction(L.zeros, L.poles, L.gain, share * L.theta))
    loop = feedback(front, made(TransferFunction((), (), 1.0, (1 - share) * L.theta)))
    assert count_right_of(loop) == expected
    assert delay_verdict(loop).rhp_poles == expected


@pytest.mark.parametrize(("a", "b"), [(0.0, 1.0), (0.5, 2.0), (-0.5, 1.3), (1.0, 1.01)])
def test_the_boundary_of_hayes(a: float, b: float) -> None:
    """x' = -a x - b x(t - tau) loses its stability at tau = arccos(-a/b)/sqrt(b^2 - a^2)."""
    tau = acos(-a / b) / sqrt(b * b - a * a)
    for factor, stable in ((1 - 1e-6, True), (1 + 1e-6, False)):
        plant = TransferFunction((), [-a] if a else [0.0], b, factor * tau)
        verdict = delay_verdict(feedback(made(plant)))
        assert verdict.closed_loop_stable is stable
        assert verdict.rhp_poles == (0 if stable else 2)
    on_it = delay_verdict(feedback(made(TransferFunction((), [-a] if a else [0.0], b, tau))))
    assert on_it.verdict == "marginal"
    assert f"{sqrt(b * b - a * a):.3g}j" in on_it.because


def test_two_dead_times_on_an_integrator_at_a_known_boundary() -> None:
    """y' = -k (y(t-1) + y(t-3)): at s = jw, -k 2 cos(w) e^{-2jw} = jw, so w = pi/4 and k = w/(2 cos w)."""
    omega = pi / 4
    k = omega / (2 * np.cos(omega))
    both = parallel(block("exp(-s)"), block("exp(-3s)"))
    for factor, verdict in ((0.999, "stable"), (1.0, "marginal"), (1.001, "unstable")):
        loop = feedback(series(block("1/s"), made(TransferFunction((), (), factor * k))), both)
        assert delay_verdict(loop).verdict == verdict
    loop = feedback(series(block("1/s"), made(TransferFunction((), (), k))), both)
    assert rightmost_poles(loop).poles[0] == pytest.approx(1j * omega, abs=1e-12)


def test_poles_are_zeros_of_the_characteristic_equation() -> None:
    """s + a e^{-s} + b e^{-1.7 s} = 0, each root by substitution; the rightmost ones are all there."""
    loop = feedback(block("1/s"), parallel(block("0.9 exp(-s)"), block("0.6 exp(-1.7s)")))
    found = rightmost_poles(loop)
    assert not found.complete
    s = found.poles
    assert s.size >= 10
    residual = np.abs(s + 0.9 * np.exp(-s) + 0.6 * np.exp(-1.7 * s))
    assert (residual <= 1e-10 * np.maximum(1, np.abs(0.9 * np.exp(-s)))).all()
    assert (np.diff(s.real) <= 1e-9).all()
    # Counted right of lines between neighbours (only lines right of the axis can be asked for: shift the gain up).
    high = feedback(block("1/s"), parallel(block("9 exp(-s)"), block("6 exp(-1.7s)")))
    right = rightmost_poles(high).poles
    for line in (0.0, 0.2, 0.5, 1.0):
        assert count_right_of(high, line) == np.count_nonzero(right.real > line)


@pytest.mark.parametrize(
    ("first", "second", "verdict"), [(0.4, 0.5, "stable"), (0.6, 0.5, "unstable"), (0.5, 0.5, "unstable")]
)
def test_jumps_that_come_back_through_two_delays(first: float, second: float, verdict: str) -> None:
    """1 + a e^{-s} + b e^{-sqrt 2 s}: stable however the dead times are, exactly where |a| + |b| < 1."""
    late = (made(TransferFunction((), (), first, 1.0)), made(TransferFunction((), (), second, 2**0.5)))
    found = delay_verdict(feedback(block("1"), parallel(*late)))
    assert found.verdict == verdict
    if verdict == "unstable":
        assert found.rhp_poles is None
        assert "infinitely many" in found.because
        assert f"{first + second:.4g} times" in found.because


def test_a_neutral_loop_within_its_limit_is_counted() -> None:
    """PI on (2s+1)/(s+1) with dead times in plant and sensor: |Dc Dp| = 0.6 and 0.94 stable, 1.2 not."""
    for Kc, expected in ((0.3, 0), (0.47, 0), (0.6, None)):
        C = TransferFunction([-0.5], [0], Kc)
        loop = feedback(series(made(C), block("(2s+1)/(s+1) exp(-0.4s)")), block("exp(-0.6s)"))
        assert delay_verdict(loop).rhp_poles == expected
        if expected is not None:
            L = C * parse_transfer_function("(2s+1)/(s+1) exp(-s)")
            assert rhp_closed_loop_poles(L.zeros, L.poles, L.gain, 1.0) == expected


def test_a_smith_predictor_is_as_good_as_its_model() -> None:
    """Tight control of exp(-s)/(s+1) by prediction: stable for the model itself, not for 40 % more dead time."""
    predictor = smith_predictor(parse_transfer_function("8 (s+1)/s"), parse_transfer_function("exp(-s)/(s+1)"))
    for theta, stable in ((1.0, True), (1.4, False)):
        verdict = delay_verdict(control_loop(made(TransferFunction((), [-1.0], 1.0, theta)), predictor))
        assert verdict.closed_loop_stable is stable, verdict.because


def test_open_systems_and_hidden_modes() -> None:
    """Delays outside loops make no poles; a mode that cancels is still counted."""
    assert delay_verdict(block("exp(-s)/(s+1)")).because.startswith("the pole lies in the left half-plane")
    assert delay_verdict(block("exp(-s)/s")).verdict == "marginal"
    assert delay_verdict(block("exp(-s)/s^2")).verdict == "unstable"
    assert delay_verdict(series(block("exp(-s)/(s-1)"), block("(s-1)/(s+2)^2"))).rhp_poles == 1
    hidden = feedback(series(block("exp(-s)/(s-1)"), block("0.1 (s-1)/(s+2)^2")))
    assert delay_verdict(hidden).rhp_poles == 1
    on_axis = delay_verdict(feedback(series(block("exp(-s)/s"), block("0.3 s/(s+2)^2"))))
    assert on_axis.verdict == "marginal"
    assert "origin" in on_axis.because
