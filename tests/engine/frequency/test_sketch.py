"""The hand-drawn Bode diagram: exact far from the corners, known errors at them, corners named by their roots."""

import numpy as np
import pytest
from hypothesis import given

from looplab.engine.frequency import bode
from looplab.engine.frequency.sketch import bode_sketch, corner_meanings
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems


def phase_at(system: TransferFunction, omega: float) -> float:
    lines = bode_sketch(system, 1e-6, 1e8)
    return float(np.interp(np.log10(omega), np.log10(lines.phase_omega), lines.phase_deg))


@effort(60)
@given(systems(order=(1, 5), stable=False, axis=True))
def test_lines_meet_the_curve_far_from_all_corners(system: TransferFunction) -> None:
    """Roots are 0.1 to 10 in size: five decades away what is left is arctan(1e-5) each."""
    lines = bode_sketch(system, 1e-6, 1e6)
    exact = bode(system, np.array([1e-6, 1e6]))
    assert lines.phase_deg[[0, -1]] == pytest.approx(exact.phase_deg, abs=0.02)
    assert lines.mag_dB[[0, -1]] == pytest.approx(exact.mag_dB, abs=1e-6)


def test_the_phase_line_of_a_lag_is_off_by_arctan_one_tenth() -> None:
    lag = parse_transfer_function("1/(0.5s+1)")
    omega = np.geomspace(2e-3, 2e3, 2401)
    lines = bode_sketch(lag, 1e-4, 1e4)
    error = np.interp(np.log(omega), np.log(lines.phase_omega), lines.phase_deg) - bode(lag, omega).phase_deg
    assert np.abs(error).max() == pytest.approx(np.degrees(np.arctan(0.1)), abs=1e-3)
    assert phase_at(lag, 2.0) == pytest.approx(-45.0, abs=1e-9)


def test_a_pair_at_full_damping_is_two_real_roots() -> None:
    pair, two = parse_transfer_function("1/(s^2+1.99999999s+1)"), parse_transfer_function("1/(s+1)^2")
    for omega in (0.05, 0.2, 1.0, 7.0, 30.0):
        assert phase_at(pair, omega) == pytest.approx(phase_at(two, omega), abs=1e-3)


def test_an_undamped_pair_jumps() -> None:
    oscillator = parse_transfer_function("4/(s^2+4)")
    assert phase_at(oscillator, 1.999) == pytest.approx(0.0, abs=1e-9)
    assert phase_at(oscillator, 2.001) == pytest.approx(-180.0, abs=1e-9)


def test_dead_time_bends_the_line_by_its_own_phase() -> None:
    lines, plain = (bode_sketch(parse_transfer_function(f"2/(s+1){d}"), 0.01, 100.0) for d in (" exp(-0.3s)", ""))
    expected = np.interp(np.log(lines.phase_omega), np.log(plain.phase_omega), plain.phase_deg)
    assert lines.phase_deg == pytest.approx(expected - np.degrees(0.3 * lines.phase_omega), abs=1e-9)
    assert lines.phase_omega.size > 50


def test_corners_say_what_they_are() -> None:
    zero, pair, triple = corner_meanings(parse_transfer_function("(1-s)/(s(s^2+0.4s+4)(0.1s+1)^3)"))
    assert (zero.kind, zero.s, zero.slope_change, zero.phase_change_deg) == ("zero", 1, 1, -90)
    assert (pair.omega, pair.multiplicity, pair.slope_change, pair.phase_change_deg) == (pytest.approx(2), 1, -2, -180)
    assert pair.zeta == pytest.approx(0.1)
    assert pair.phase_from == pytest.approx(2 * 10**-0.1)
    assert pair.phase_to == pytest.approx(2 * 10**0.1)
    assert (triple.multiplicity, triple.slope_change, triple.phase_change_deg) == (3, -3, -270)


def test_an_unstable_pole_turns_the_phase_up() -> None:
    lines = bode_sketch(parse_transfer_function("2/(s-1)"))
    assert lines.initial_phase_deg == -180
    assert lines.corners[0].phase_change_deg == 90
    assert lines.phase_deg[-1] == pytest.approx(-90)
