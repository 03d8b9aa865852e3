"""Where a list is cut or a peak lies at an end of the frequency axis, the answer says so."""

from math import pi

import pytest

from looplab.engine.frequency import margins, nyquist_count
from looplab.engine.systems import parse_transfer_function


@pytest.mark.parametrize("text", ["4 exp(-0.1s)/(0.5s+1)", "0.5 exp(-s)"])
def test_crossovers_of_dead_time_tell_where_their_list_ends(text: str) -> None:
    result = margins(parse_transfer_function(text))
    said = result.reasons["phase_crossovers"]
    assert "infinitely many" in said
    end = float(said.rsplit("= ", 1)[1])
    assert max(c.omega for c in result.phase_crossovers) <= end * 1.001


def test_a_whole_list_needs_no_words() -> None:
    assert "phase_crossovers" not in margins(parse_transfer_function("4/(s+1)^3")).reasons


@pytest.mark.parametrize(
    ("text", "Ms", "omega_Ms", "Mt", "omega_Mt"),
    [
        # S = (s+1)/(3s+1): largest, 1, at rest; T = 2s/(3s+1) tends to 2/3
        ("2s/(s+1)", 1.0, 0.0, 2 / 3, None),
        # S = 1/9, T = 8/9 at every frequency
        ("8", 1 / 9, None, 8 / 9, None),
        # S = s/(s+1) tends to 1; T = 1/(s+1) is 1 at rest
        ("1/s", 1.0, None, 1.0, 0.0),
        # the curve runs around the circle of radius 2 for ever: 1/|1 + 2 e^{-jx}| is 1 at most
        ("2 exp(-s)", 1.0, pi, 2.0, pi),
        # |L| falls towards 1.5: S tends to 1/(1.5 - 1)
        ("1.5(s+2)exp(-s)/(s+1)", 2.0, None, 3.0, None),
        # the mode at +-j is hidden, and the curve that of 2/(s+1): S tends to 1, T is 2/3 at rest
        ("2(s^2+1)/((s^2+1)(s+1))", 1.0, None, 2 / 3, 0.0),
    ],
)
def test_peaks_at_the_ends(text: str, Ms: float, omega_Ms: float | None, Mt: float, omega_Mt: float | None) -> None:
    result = margins(parse_transfer_function(text))
    assert result.Ms == pytest.approx(Ms, rel=1e-9)
    assert result.Mt == pytest.approx(Mt, rel=1e-9)
    assert (result.omega_Ms, result.omega_Mt) == (
        omega_Ms if not omega_Ms else pytest.approx(omega_Ms),
        omega_Mt if not omega_Mt else pytest.approx(omega_Mt),
    )


@pytest.mark.parametrize("text", ["1/s^2", "3/(s^2+1)", "8/(s+1)^3", "exp(-s)", "-1/(s+1)"])
def test_through_minus_one_both_peaks_are_infinite(text: str) -> None:
    result = margins(parse_transfer_function(text))
    assert (result.Ms, result.Mt) == (None, None)
    assert "-1" in result.reasons["Ms"]
    assert "-1" in result.reasons["Mt"]


@pytest.mark.parametrize("text", ["2s(s+1)/(s(s+1)^2)", "2(s^2+1)/((s^2+1)(s+1))", "0/(s(s+1))"])
def test_a_hidden_mode_on_the_axis_leaves_no_delay_margin(text: str) -> None:
    """It does not decay, however good the curve looks."""
    result = margins(parse_transfer_function(text))
    assert not result.closed_loop_stable
    assert result.delay_margin is None


def test_a_hidden_mode_on_the_axis_is_no_crossover() -> None:
    """|2/(jw + 1)| = 1 at sqrt(3) alone; at w = 1 the factors are 0/0."""
    (crossover,) = margins(parse_transfer_function("2(s^2+1)/((s^2+1)(s+1))")).gain_crossovers
    assert crossover.omega == pytest.approx(3**0.5, rel=1e-12)


def test_a_gain_that_stays_above_1() -> None:
    assert "never falls to 1" in margins(parse_transfer_function("2 exp(-s)")).reasons["PM_deg"]
    assert "never reaches 1" in margins(parse_transfer_function("0.5 exp(-s)")).reasons["PM_deg"]


@pytest.mark.parametrize("text", ["1/s^2", "1/(s^2+1)"])
def test_a_phase_that_stands_at_the_limit_is_said_to_stand_there(text: str) -> None:
    """1/s^2 and, beyond its resonance, 1/(s^2+1) are real and negative: a gain margin would be any number."""
    result = margins(parse_transfer_function(text))
    assert result.GM is None
    assert "stands at -180 deg" in result.reasons["GM"]


@pytest.mark.parametrize("text", ["exp(-s)", "(s-1)/(s+1)", "(s^2-s+4)/(s^2+s+4) exp(-0.2 s)"])
def test_a_gain_of_1_at_every_frequency_crosses_nothing(text: str) -> None:
    """An all-pass: where it would cross 1 is rounding."""
    result = margins(parse_transfer_function(text))
    assert result.gain_crossovers == ()
    assert "is 1 at every frequency" in result.reasons["PM_deg"]


@pytest.mark.parametrize("text", ["-1", "-(s+1)/(s+2)"])
def test_an_open_loop_that_ends_in_minus_one_is_not_stable(text: str) -> None:
    """1 + L(inf) = 0: the loop has no solution."""
    L = parse_transfer_function(text)
    assert not margins(L).closed_loop_stable
    assert "no solution" in str(nyquist_count(L).reason)
