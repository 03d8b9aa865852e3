"""The locus with exact dead time: points on it, closed forms, and none missed."""

from math import e, pi

import numpy as np
import pytest
from scipy.special import lambertw

from independent import count_in_box
from looplab.engine.stability import breakaway_points, count_in_rectangle, root_locus
from looplab.engine.systems import TransferFunction, parse_transfer_function

LOOPS = [
    "exp(-0.1s)/(0.5s+1)",
    "exp(-0.1s)(0.5s+1)/(0.5s(0.5s+1)^2)",
    "exp(-s)/s",
    "exp(-s)(s+2)/s^2",
    "exp(-0.5s)/(s-1)",
    "exp(-0.2s)(s+1)/(s(s+1)(s^2+s+4))",
    "exp(-s)",
    "exp(-2s)/(s+1)^3",
    "exp(-0.05s)/(s^2+0.2s+1)",
    "(2s+1)exp(-s)/(s+1)",
    "-exp(-s)/(s+2)",
    "(1-s)exp(-0.3s)/(s+1)^2",
    "exp(-0.01s)/((s+1)(0.05s+1))",
]

# High orders over many decades of gain: eigenvalues lose poles next to the roots that they leave or reach.
WIDE = [
    "1e5(s+4.6)(s+3.6)exp(-2s)/(s(s+23)(s+4.7)((s+0.46)^2+0.33)((s+0.3)^2+0.01)((s+0.27)^2+0.04))",
    "-2e7(s+5.7)(s-0.37)exp(-0.08s)/(s(s+1.7)(s+0.57)(s+0.54)(s+0.22)((s+0.4)^2+6.1)((s+0.26)^2+0.04)(s^2+0.2s+0.05))",
    "0.02(s+2.4)(s+1.74)^2(s+1.1)(s+0.4)((s+0.5)^2+9)exp(-0.3s)/(s^3(s+4)(s+3.6)(s+3.1)(s+1.2)(s+0.7))",
    "(s+0.7)exp(-0.24s)/((s+14)(s+2.6)(s+1.7)(s+1.3)(s+0.93)(s+0.45)(s+0.44)((s+1.2)^2+0.4)((s+0.5)^2+0.1))",
]


def points(L: TransferFunction) -> tuple[np.ndarray, np.ndarray]:
    """Gains and poles of all points for K > 0 that are not hidden modes."""
    locus = root_locus(L)
    K = np.broadcast_to(locus.gains, locus.branches.shape)
    hidden = np.isin(locus.branches, L.zeros[np.isin(L.zeros, L.poles)])
    there = np.isfinite(locus.branches) & (K > 0) & ~hidden
    return K[there], locus.branches[there]


@pytest.mark.parametrize("text", LOOPS)
def test_points_solve_the_exact_equation(text: str) -> None:
    L = parse_transfer_function(text)
    K, s = points(L)
    assert K.size > 100
    assert np.abs(1 + K * L(s)).max() < 1e-9


@pytest.mark.parametrize("text", [*LOOPS, *WIDE])
def test_no_branch_is_missed(text: str) -> None:
    """The argument principle finds as many poles in a rectangle as the locus has there, at other gains than its own."""
    L = parse_transfer_function(text)
    locus = root_locus(L)
    assert locus.complete
    (left, right), (_, top) = locus.view
    for k in np.linspace(3, locus.gains.size - 4, 9).astype(int):
        # A pole may cross the edge between two gains: count where both neighbours agree.
        here, there = locus.branches[:, k], locus.branches[:, k + 1]
        inside = [np.count_nonzero((b.real > left) & (b.real < right) & (np.abs(b.imag) < top)) for b in (here, there)]
        if inside[0] != inside[1]:
            continue
        K = float(np.sqrt(locus.gains[k] * locus.gains[k + 1]))
        counted = count_in_rectangle(L, K, left, right, -top, top)
        if counted is not None:
            assert counted == inside[0]


@pytest.mark.parametrize("text", [t for t in [*LOOPS, *WIDE] if breakaway_points(parse_transfer_function(t))])
def test_two_branches_meet_in_each_meeting_point(text: str) -> None:
    """At its gain both branches pass exactly through it: the corner is sharp and neither has a hole there."""
    locus = root_locus(parse_transfer_function(text))
    (left, right), (_, top) = locus.view
    for b in locus.breakaways:
        if left < b.s.real < right and abs(b.s.imag) < top:
            (i,) = np.flatnonzero(locus.gains == b.K)
            assert np.count_nonzero(locus.branches[:, i] == b.s) == 2


@pytest.mark.parametrize("text", LOOPS)
def test_branches_are_continuous(text: str) -> None:
    locus = root_locus(parse_transfer_function(text))
    (left, right), (_, top) = locus.view
    size = max(right - left, top)
    with np.errstate(invalid="ignore"):
        step = np.abs(np.diff(locus.branches, axis=1))
        seen = (locus.branches[:, :-1].real > left) & (np.abs(locus.branches[:, :-1].imag) < top)
    assert np.nanmax(np.where(seen, step, 0.0)) < 0.15 * size


def test_twenty_equal_poles() -> None:
    """Eigenvalues scatter around them, so that they cannot be followed from a few gains only: that is said."""
    L = parse_transfer_function("exp(-s)/(s+1)^20")
    locus = root_locus(L)
    K, s = points(L)
    assert np.abs(1 + K * L(s)).max() < 2e-8
    (left, right), (_, top) = locus.view
    missing = 0
    for k in np.linspace(1, locus.gains.size - 1, 8).astype(int):
        s = locus.branches[:, k]
        inside = np.count_nonzero((s.real > left) & (s.real < right) & (np.abs(s.imag) < top))
        gain = locus.gains[k]
        missing += inside != count_in_box(
            lambda s: (s + 1) ** 20, lambda s, gain=gain: gain + 0 * s, 1.0, left, right, top
        )  # type: ignore[misc]
    assert missing == 0 or not locus.complete


def test_integrator_with_dead_time_is_lamberts_function() -> None:
    """s e^{s} = -K, so s = W_k(-K): e^{-s}/s; they meet at s = -1 for K = 1/e and cross at j pi/2 for K = pi/2."""
    L = parse_transfer_function("exp(-s)/s")
    locus = root_locus(L)
    (meeting,) = locus.breakaways
    assert meeting.s == pytest.approx(-1, abs=1e-12)
    assert meeting.K == pytest.approx(1 / e, rel=1e-12)
    first = locus.imaginary_axis_crossings[0]
    assert (first.omega, first.K) == (pytest.approx(pi / 2, rel=1e-12), pytest.approx(pi / 2, rel=1e-12))
    K, s = points(L)
    exact = np.array([lambertw(-K, k) for k in range(-4, 4)])
    # Next to the double point the root moves as the square root of rounding.
    away = np.abs(K - 1 / e) > 1e-3
    assert np.abs(exact[:, away] - s[away]).min(axis=0).max() < 1e-9


def test_first_order_with_dead_time_is_lamberts_function() -> None:
    """(tau s + 1) e^{theta s} = -K: theta s + theta/tau = W_k(-K theta/tau e^{theta/tau})."""
    tau, theta = 0.5, 0.1
    L = parse_transfer_function("exp(-0.1s)/(0.5s+1)")
    K, s = points(L)
    exact = np.array(
        [(lambertw(-K * theta / tau * np.exp(theta / tau), k) - theta / tau) / theta for k in range(-4, 4)]
    )
    meeting = root_locus(L).breakaways[0].K
    away = np.abs(K / meeting - 1) > 1e-3
    assert np.abs(exact[:, away] - s[away]).min(axis=0).max() < 1e-7


def test_pure_dead_time_moves_on_straight_lines() -> None:
    """K e^{-theta s} = -1: s = (ln K + j pi (2k+1))/theta."""
    K, s = points(parse_transfer_function("exp(-2s)"))
    assert np.abs(s.real - np.log(K) / 2).max() < 1e-9
    odd = s.imag * 2 / pi
    assert np.abs(odd - np.round(odd)).max() < 1e-9
    assert (np.round(odd).astype(int) % 2 == 1).all()


def test_without_dead_time_it_is_the_rational_locus() -> None:
    """A very short dead time hardly moves the branches near the origin."""
    short, none = parse_transfer_function("exp(-0.0001s)/(s(s+1)(s+2))"), parse_transfer_function("1/(s(s+1)(s+2))")
    a, b = root_locus(short), root_locus(none)
    assert a.imaginary_axis_crossings[0].K == pytest.approx(b.imaginary_axis_crossings[0].K, rel=1e-3)
    assert a.breakaways[0].K == pytest.approx(b.breakaways[0].K, rel=1e-3)


def test_departure_angle_of_a_textbook_loop() -> None:
    """K (s+2)/(s^2+2s+3): 145 deg at the upper pole (K. Ogata, Modern Control Engineering, 5th ed., example 6-2)."""
    locus = root_locus(parse_transfer_function("(s+2)/(s^2+2s+3)"))
    up = next(a for a in locus.departure_angles if a.s.imag > 0)
    assert up.angle_deg == pytest.approx(180 - 90 + np.degrees(np.arctan(2**0.5)), abs=1e-9)
    assert round(up.angle_deg) == 145


@pytest.mark.parametrize("text", ["(s+2)/(s^2+2s+3)", "exp(-0.4s)/((s+1)(s^2+s+4))", "(s^2+s+2)/(s(s+1)(s+3)^2)"])
def test_angles_are_the_directions_of_the_branches(text: str) -> None:
    L = parse_transfer_function(text)
    locus = root_locus(L)
    for angle in locus.departure_angles:
        K = 1e-5 / abs(L(angle.s + 1e-5 * np.exp(1j * np.radians(angle.angle_deg)))) / 1e-5
        ahead = angle.s + 1e-5 * np.exp(1j * np.radians(angle.angle_deg))
        assert abs(1 + K * L(ahead)) < 1e-4
    for angle in locus.arrival_angles:
        before = angle.s + 1e-5 * np.exp(1j * np.radians(angle.angle_deg))
        value = -1 / L(before)
        assert abs(value.imag) < 1e-4 * abs(value)
        assert value.real > 0


@pytest.mark.parametrize(
    ("text", "segments"),
    [
        ("1/(s+1)^3", ((None, -1.0),)),
        ("2(s+1)/(s(s-4))", ((0.0, 4.0), (None, -1.0))),
        ("(s+3)/(s(s+1)(s+2))", ((-1.0, 0.0), (-3.0, -2.0))),
        ("1/(s+1)^2", ()),
        ("-1/(s+1)", ((-1.0, None),)),
        ("exp(-s)/s", ((None, 0.0),)),
    ],
)
def test_real_axis_segments(text: str, segments: tuple) -> None:
    assert root_locus(parse_transfer_function(text)).real_axis_segments == segments


@pytest.mark.parametrize("theta", [1e-2, 1.0, 300.0])
def test_the_window_of_a_pure_dead_time_shows_its_first_crossing(theta: float) -> None:
    """K exp(-theta s) = -1 has roots at ln K/theta + j (2k+1) pi/theta, all on the axis for K = 1."""
    locus = root_locus(TransferFunction((), (), 1.0, theta))
    (left, right), (_, top) = locus.view
    assert left < 0 < right
    assert top > np.pi / theta
    assert locus.complete
    K, s = (np.broadcast_to(locus.gains, locus.branches.shape), locus.branches)
    there = np.isfinite(s)
    assert there.any()
    np.testing.assert_allclose(s[there].real * theta, np.log(K[there]), atol=1e-9)
