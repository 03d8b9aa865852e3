"""First and second order: the formulas of the notes against what the exact response does."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.laplace import LaplaceInput, inverse_transform, partial_fractions
from looplab.engine.low_order import characterize
from looplab.engine.systems import FOPDT, SOPDT, parse_transfer_function
from strategies import effort, magnitudes, numbers


@given(K=magnitudes, tau=magnitudes, theta=st.just(0.0) | magnitudes)
@effort(40)
def test_first_order(K: float, tau: float, theta: float) -> None:
    """63.2 % one time constant after the dead time, starting with the slope K/tau."""
    G = FOPDT(K, tau, theta).to_transfer_function()
    found = characterize(G)
    y = inverse_transform(partial_fractions(G, LaplaceInput("step")))
    assert (found.order, found.classification) == (1, "stable")
    assert found.tau == pytest.approx(tau, rel=1e-14)
    assert found.K == pytest.approx(K, rel=1e-14)
    assert found.initial_slope == pytest.approx(K / tau, rel=1e-14)
    assert "one time constant" in found.reasons["tau_2"]
    assert found.t_63 == pytest.approx(theta + tau, rel=1e-14)
    assert found.t_63 is not None
    assert float(y(found.t_63)) == pytest.approx((1 - math.exp(-1)) * K, rel=1e-11)


@given(K=magnitudes, tau=magnitudes, zeta=numbers(0.05, 0.95), theta=st.just(0.0) | magnitudes)
@effort(40)
def test_an_underdamped_response_does_what_the_formulas_say(K: float, tau: float, zeta: float, theta: float) -> None:
    G = SOPDT(K, tau, zeta, theta).to_transfer_function()
    found = characterize(G)
    assert found.classification == "underdamped"
    assert found.zeta == pytest.approx(zeta, rel=1e-12)
    assert found.tau == pytest.approx(tau, rel=1e-12)
    root = math.sqrt(1 - zeta**2)
    assert found.overshoot_pct == pytest.approx(100 * math.exp(-math.pi * zeta / root), rel=1e-12)
    assert found.decay_ratio == pytest.approx(math.exp(-2 * math.pi * zeta / root), rel=1e-12)
    assert found.period == pytest.approx(2 * math.pi * tau / root, rel=1e-12)
    # The response: flat at its first two summits, one period apart.
    y = inverse_transform(partial_fractions(G, LaplaceInput("step")))
    assert found.t_peak is not None
    assert found.period is not None
    summits = np.array([found.t_peak, found.t_peak + found.period])
    assert np.abs(y.derivative()(summits)).max() < 1e-11 * abs(K) / tau
    over = y(summits) / K - 1
    assert 100 * over[0] == pytest.approx(found.overshoot_pct, rel=1e-9)
    assert over[1] == pytest.approx(found.decay_ratio * over[0], rel=1e-6, abs=1e-13)
    assert found.t_63 is not None
    assert float(y(found.t_63)) == pytest.approx((1 - math.exp(-1)) * K, rel=1e-11)
    assert found.t_63 < found.t_peak


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("1/(s^2+2s+1)", "critically damped"),
        ("1/((s+1)(2s+1))", "overdamped"),
        ("1/(s^2+s+1)", "underdamped"),
        ("1/(s^2+4)", "undamped"),
        ("1/(s(s+1))", "integrating"),
        ("1/s", "integrating"),
        # A double pole at the origin is unstable, a single one is not.
        ("1/s^2", "unstable"),
        ("1/(s(s-1))", "unstable"),
        ("1/(s-1)", "unstable"),
        ("1/((s-1)(s+2))", "unstable"),
        ("1/(s^2-s+1)", "unstable"),
        ("1/(s-1)^2", "unstable"),
    ],
)
def test_classification(text: str, kind: str) -> None:
    found = characterize(parse_transfer_function(text))
    assert found.classification == kind
    for name in ("K", "tau", "tau_1", "tau_2", "zeta", "period", "t_63", "t_peak", "overshoot_pct", "decay_ratio"):
        assert (getattr(found, name) is None) == (name in found.reasons), name


def test_real_lags() -> None:
    found = characterize(parse_transfer_function("3/((5s+1)(0.2s+1))"))
    assert (found.tau_1, found.tau_2) == (pytest.approx(5), pytest.approx(0.2))
    assert found.zeta == pytest.approx(5.2 / 2)
    assert found.overshoot_pct == 0


def test_a_zero_takes_the_formulas_away() -> None:
    found = characterize(parse_transfer_function("(s+2)/(s^2+s+1)"))
    assert found.overshoot_pct is None
    assert "zero" in found.reasons["overshoot_pct"]
    assert found.zeta == pytest.approx(0.5)
    assert found.initial_slope == pytest.approx(1.0)


def test_other_orders_are_refused() -> None:
    for text in ("1/(s+1)^3", "2"):
        with pytest.raises(InvalidInput):
            characterize(parse_transfer_function(text))
    with pytest.raises(ImproperSystem):
        characterize(parse_transfer_function("s"))


@pytest.mark.parametrize("text", ["2/(9s^2+9s+1)", "1/((3s+1)(7s+1))", "2 exp(-s)/(9s^2+1.8s+1)"])
def test_two_lags_start_flat(text: str) -> None:
    assert characterize(parse_transfer_function(text)).initial_slope == 0.0
