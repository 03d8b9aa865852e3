"""Bandwidth by its definition and in closed form; straight lines far from the corners."""

import numpy as np
import pytest

from looplab.engine.frequency import bandwidth, bode, bode_asymptotes, closed_loop_bandwidth
from looplab.engine.systems import parse_transfer_function


@pytest.mark.parametrize(
    ("text", "omega"),
    [
        ("3/(2s+1)", 0.5),
        ("1/(s+1)^3", (2 ** (1 / 3) - 1) ** 0.5),
        ("exp(-s)/(0.1s+1)", 10.0),
        # omega_n sqrt(1 - 2 zeta^2 + sqrt((1 - 2 zeta^2)^2 + 1)), zeta = 0.6, omega_n = 10
        ("100/(s^2+12s+100)", 10 * (0.28 + (0.28**2 + 1) ** 0.5) ** 0.5),
    ],
)
def test_bandwidth_in_closed_form(text: str, omega: float) -> None:
    assert bandwidth(parse_transfer_function(text)).omega == pytest.approx(omega, rel=1e-12)


def test_bandwidths_of_the_actuator_example() -> None:
    """Plant 10/((s+10)(s+1)) and T = 100/(s^2+12 s+100): 0.990 and 11.48 rad/time (lecture notes, section 22.2)."""
    plant = bandwidth(parse_transfer_function("10/((s+10)(s+1))")).omega
    loop = closed_loop_bandwidth(parse_transfer_function("100/(s(s+12))")).omega
    assert plant is not None
    assert loop is not None
    assert round(plant, 3) == 0.990
    assert round(loop, 2) == 11.48


@pytest.mark.parametrize(("text", "word"), [("1/s", "infinite"), ("s/(s+1)", "zero"), ("2", "never falls")])
def test_no_bandwidth_has_a_reason(text: str, word: str) -> None:
    result = bandwidth(parse_transfer_function(text))
    assert result.omega is None
    assert result.reason is not None
    assert word in result.reason


@pytest.mark.parametrize("text", ["1/(2s+1)", "10(s+1)/(s(0.01s+1))", "s/((s+1)(s+100)^2)", "1000/(s^2+2s+100)"])
def test_asymptotes_are_exact_far_from_the_corners(text: str) -> None:
    G = parse_transfer_function(text)
    lines = bode_asymptotes(G, 1e-5, 1e7)
    for i in (0, -1):
        exact = bode(G, lines.omega[[i]]).mag_dB[0]
        assert lines.mag_dB[i] == pytest.approx(exact, abs=1e-3)
    assert (np.diff(lines.omega) >= 0).all()


def test_a_first_order_corner_is_three_decibels_off() -> None:
    G = parse_transfer_function("5/(0.1s+1)")
    lines = bode_asymptotes(G)
    (corner,) = lines.corners
    assert (corner.omega, corner.slope_change, corner.kind) == (10.0, -1, "pole")
    at = float(np.interp(1.0, np.log10(lines.omega), lines.mag_dB))
    assert at - bode(G, np.array([10.0])).mag_dB[0] == pytest.approx(20 * np.log10(2**0.5), abs=1e-9)
