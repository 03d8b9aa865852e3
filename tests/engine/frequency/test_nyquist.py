"""Z = N + P against counts that do not look at the imaginary axis' crossings: roots, or the argument principle."""

import numpy as np
import pytest
from hypothesis import assume, given

from independent import rhp_closed_loop_poles
from looplab.engine.frequency import nyquist_count, nyquist_curve
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems


def closed_loop_roots(L: TransferFunction) -> np.ndarray:
    num, den = L.gain * np.poly(L.zeros), np.poly(L.poles)
    return np.roots(np.polyadd(den, num))


def distance_from_minus_one(L: TransferFunction) -> float:
    omega = np.append(1e-9, np.logspace(-3, 3, 4001))
    return float(np.abs(1 + L.response(omega)).min())


@effort(150)
@given(systems(order=(1, 5), stable=False, axis=True, excess=1) | systems(order=(1, 4), stable=False, excess=0))
def test_count_equals_the_roots(L: TransferFunction) -> None:
    assume(L.relative_degree > 0 or abs(1 + L.gain) > 0.05)
    roots = closed_loop_roots(L)
    assume(np.abs(roots.real).min() > 1e-3)
    count = nyquist_count(L)
    assert count.P == np.count_nonzero(L.poles.real > 0)
    assert count.Z == np.count_nonzero(roots.real > 0)
    assert count.N == count.Z - count.P
    assert not count.through_minus_one


@effort(80)
@given(systems(order=(1, 4), stable=False, theta=True, excess=1))
def test_count_with_dead_time_equals_the_argument_principle(L: TransferFunction) -> None:
    assume(distance_from_minus_one(L) > 1e-3)
    assert nyquist_count(L).Z == rhp_closed_loop_poles(list(L.zeros), list(L.poles), L.gain, L.theta)


@effort(40)
@given(systems(order=(1, 4), stable=False, axis=True, theta=True))
def test_poles_on_the_axis_with_dead_time(L: TransferFunction) -> None:
    """Characteristic function moved a hair to the right: nothing on the path, the same count."""
    assume(distance_from_minus_one(L) > 1e-2)
    right = rhp_closed_loop_poles(list(L.zeros), list(L.poles), L.gain, L.theta, shift=1e-6)
    assume(right == rhp_closed_loop_poles(list(L.zeros), list(L.poles), L.gain, L.theta, shift=-1e-6))
    assert nyquist_count(L).Z == right


@pytest.mark.parametrize(
    ("text", "N", "P", "Z"),
    [
        ("4/(s+1)^3", 0, 0, 0),
        ("12/(s+1)^3", 2, 0, 2),
        ("2/(s-1)", -1, 1, 0),
        ("0.5/(s-1)", 0, 1, 1),
        ("6(s+1)/(s(s-4))", -1, 1, 0),
        ("3(s+1)/(s(s-4))", 1, 1, 2),
        ("2(s+1)^2/s^3", 0, 0, 0),
        ("0.4(s+1)^2/s^3", 2, 0, 2),
        ("-0.5", 0, 0, 0),
        ("-2/(s+1)", 1, 0, 1),
        ("-2 exp(-s)/(s+1)", 1, 0, 1),
        ("5 exp(-s)/s", 2, 0, 2),
        ("s^2/(s-1)^3", 0, 3, 3),
        ("(0.5s+1) exp(-0.5 s)/s^2", 2, 0, 2),
        ("(s+1)(s-0.1) exp(-s)/(s^2 (s-0.1))", 2, 1, 3),
        ("-10(s^2+s+1)/(s^2+s+1)", 0, 0, 0),
        ("-10/(s^2+1)", 1, 0, 1),
        ("-3/(s-1)", 0, 1, 1),
        ("-10(s+1)/(s^2+4)", 1, 0, 1),
        ("-1/(s(s+1))", 1, 0, 1),
        ("-1/s^2", 1, 0, 1),
        ("-1/s^3", 1, 0, 1),
        ("-4/((s^2+1)(s+1))", 1, 0, 1),
    ],
)
def test_textbook_counts(text: str, N: int, P: int, Z: int) -> None:
    """Z from the roots of D + N; with dead time by hand: s + 1 = 2 e^{-s} has one positive root."""
    count = nyquist_count(parse_transfer_function(text))
    assert (count.N, count.P, count.Z) == (N, P, Z)


@pytest.mark.parametrize("text", ["8/(s+1)^3", "-1/(s+1)", "1/s^2", "1/(s^2+1)", "1.5707963267948966 exp(-s)/s"])
def test_a_curve_through_minus_one_is_said_to_be_one(text: str) -> None:
    count = nyquist_count(parse_transfer_function(text))
    assert count.through_minus_one
    assert "-1" in count.reason


def test_a_neutral_loop_past_its_limit_has_infinitely_many() -> None:
    count = nyquist_count(parse_transfer_function("1.2 (s+1)/(s+2) exp(-s)"))
    assert count.N is None
    assert count.Z is None
    assert "without end" in count.reason


@pytest.mark.parametrize("text", ["4/(s+1)^3", "exp(-0.1 s)/(0.5s+1)", "1/(s^2+0.02s+1)", "0.5 exp(-s)/s"])
def test_curve_is_the_response_and_has_no_corners_near_minus_one(text: str) -> None:
    L = parse_transfer_function(text)
    curve = nyquist_curve(L)
    np.testing.assert_allclose(curve.re + 1j * curve.im, L.response(curve.omega), rtol=1e-12)
    assert (np.diff(curve.omega) > 0).all()
    z = curve.re + 1j * curve.im
    near = np.minimum(np.abs(z[1:] + 1), np.abs(z[:-1] + 1)) < 2
    assert np.abs(np.diff(z))[near].max() < 0.25


@pytest.mark.parametrize(
    "text",
    ["2 exp(-0.5 s)/(s+1)^3", "4.781 exp(-0.1 s)/(0.5s+1)", "0.9 exp(-5 s)/(s+1)", "0.5 exp(-s)", "exp(-s) (s+1)/s"],
)
def test_a_curve_with_dead_time_is_smooth_with_some_hundred_points(text: str) -> None:
    """A chord is seen by its distance from the curve: half-way between two points, against the size of the picture."""
    L = parse_transfer_function(text)
    curve = nyquist_curve(L)
    assert curve.omega.size < 1200
    z = curve.re + 1j * curve.im
    half = L.response(np.sqrt(curve.omega[1:] * curve.omega[:-1]))
    chord = z[1:] - z[:-1]
    away = np.abs(((half - z[:-1]) / chord).imag) * np.abs(chord)
    seen = np.maximum(np.abs(z[1:]), np.abs(z[:-1])) < 10
    assert away[seen].max() < 0.01
