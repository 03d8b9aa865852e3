"""Bode's criterion: a proof where its conditions hold, and textbook loops where it misleads."""

import numpy as np
import pytest
from hypothesis import assume, given

from independent import rhp_closed_loop_poles
from looplab.engine.frequency.bode_criterion import bode_criterion
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems


def distance_from_minus_one(L: TransferFunction) -> float:
    return float(np.abs(1 + L.response(np.append(1e-9, np.logspace(-3, 3, 4001)))).min())


@effort(150)
@given(systems(order=(1, 5), stable=False, axis=True, excess=1) | systems(order=(1, 5), excess=1))
def test_where_it_applies_it_tells_what_the_roots_tell(L: TransferFunction) -> None:
    roots = np.roots(np.polyadd(np.poly(L.poles), L.gain * np.poly(L.zeros)))
    assume(np.abs(roots.real).min() > 1e-3)
    verdict = bode_criterion(L)
    assert verdict.nyquist_stable is bool((roots.real < 0).all())
    if verdict.applies:
        assert verdict.stable is verdict.nyquist_stable
        assert (L.poles.real <= 0).all()


@effort(60)
@given(systems(order=(1, 4), theta=True, excess=1))
def test_where_it_applies_with_dead_time_it_tells_what_the_argument_principle_tells(L: TransferFunction) -> None:
    assume(distance_from_minus_one(L) > 1e-3)
    verdict = bode_criterion(L)
    stable = rhp_closed_loop_poles(list(L.zeros), list(L.poles), L.gain, L.theta) == 0
    assert verdict.nyquist_stable is stable
    if verdict.applies:
        assert verdict.stable is stable


def test_a_usual_loop_with_dead_time_applies() -> None:
    """exp(-s)/(s+1) has w + arctan w = pi at 2.0288 and its limit at K = sqrt(1 + w^2) = 2.2618 (Seborg, ch. 14)."""
    below, above = (bode_criterion(parse_transfer_function(f"{K} exp(-s)/(s+1)")) for K in (2.2617, 2.2619))
    assert below.applies
    assert above.applies
    assert (below.stable, above.stable) == (True, False)
    assert below.omega_180 == pytest.approx(2.02875783811043, abs=1e-12)


def test_a_conditionally_stable_loop() -> None:
    """Astrom & Murray, Feedback Systems, 2nd ed., sec. 10.2: L = 3(s+6)^2/(s(s+1)^2) crosses at -12 and -4.5."""
    verdict = bode_criterion(parse_transfer_function("3(s+6)^2/(s(s+1)^2)"))
    assert verdict.magnitude == pytest.approx(12, rel=1e-12)
    assert verdict.omega_180 == pytest.approx(2, rel=1e-12)
    assert (verdict.stable, verdict.nyquist_stable, verdict.agrees) == (False, True, False)
    assert verdict.unmet == ("there are 2 phase crossovers",)


def test_an_unstable_plant_that_feedback_stabilises() -> None:
    """2(s+1)/(s(s-4)) is stable for K > 2 (s^2 + (2K-4)s + 2K), and crosses -180 deg at 2 rad/time with |L| = K/2."""
    verdict = bode_criterion(parse_transfer_function("6(s+1)/(s(s-4))"))
    assert (verdict.stable, verdict.nyquist_stable, verdict.agrees, verdict.applies) == (False, True, False, False)
    assert (verdict.omega_180, verdict.magnitude) == (pytest.approx(2), pytest.approx(1.5))
    assert verdict.unmet[0] == "L has one pole in the right half-plane"
    # With too little gain both fail, and Bode's criterion says stable: the other way round.
    low = bode_criterion(parse_transfer_function("2(s+1)/(s(s-4))"))
    assert (low.stable, low.nyquist_stable, low.agrees) == (True, False, False)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("1/(s^2(s+1))", "at the origin"),
        ("1/((s^2+4)(s+1))", "+-2i"),
        ("-0.5/(s+1)", "positive"),
        ("(s+2)/(s+1)", "strictly proper"),
        ("0.2(s^2+0.1s+1)/(s(s^2+0.01s+2))", "gain crossovers"),
    ],
)
def test_conditions_that_are_not_met_are_named(text: str, word: str) -> None:
    verdict = bode_criterion(parse_transfer_function(text))
    assert not verdict.applies
    assert any(word in reason for reason in verdict.unmet), verdict.unmet


def test_on_the_limit_there_is_no_verdict() -> None:
    verdict = bode_criterion(parse_transfer_function("8/(s+1)^3"))
    assert (verdict.stable, verdict.nyquist_stable, verdict.agrees) == (None, None, None)


def test_no_loop_at_all_is_stable() -> None:
    verdict = bode_criterion(parse_transfer_function("0"))
    assert (verdict.stable, verdict.applies, verdict.omega_180) == (True, True, None)


@pytest.mark.parametrize("text", ["0/(s(s+1))", "s(s+2)/(s(s+1)^2)", "(s^2+4)/((s^2+4)(s+1))"])
def test_a_mode_on_the_axis_that_the_loop_does_not_reach_is_no_proof_of_stability(text: str) -> None:
    """Z = 0, but the integrator or the oscillator goes on by itself: its pole stays at 0 or +-2j for every gain."""
    found = bode_criterion(parse_transfer_function(text))
    assert (found.applies, found.nyquist_stable, found.agrees) == (False, None, None)
    assert any("does not decay" in why for why in found.unmet)
