"""Stable gain ranges: against a dense eigenvalue sweep, closed forms with dead time, and ends that are marginal."""

import sys

import numpy as np
import pytest
from hypothesis import assume, given
from scipy.optimize import brentq

from independent import rhp_closed_loop_poles
from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.stability import GainRanges, gain_ranges, pi_boundary, pi_gain_ranges, pi_region
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems


def ranges(text: str, negative: bool = False) -> list[tuple[float | None, float | None]]:
    return [(r.low.K, r.high.K) for r in gain_ranges(parse_transfer_function(text), negative).ranges]


def ends_are_marginal(L: TransferFunction, found: GainRanges) -> None:
    for r in found.ranges:
        for end in (r.low, r.high):
            assert end.reason
            for w in end.omega:
                assert end.K is not None
                s = np.array([1j * w])
                value = end.K * L(s)[0] if w or L.origin_order == 0 else -1.0
                assert abs(1 + value) < 1e-9


def test_a_stable_mode_that_cancels_changes_no_range() -> None:
    """1 + K (s+1)/(s+1): the pole at -1 stays, and K = -1 alone is ill-posed."""
    found = gain_ranges(TransferFunction([-1.0], [-1.0]), negative=True)
    assert 1e-4 in found and -1e-4 in found and -2.0 in found
    assert -1.0 not in found


@effort(60)
@given(systems(order=(1, 6), stable=False, axis=True, excess=0))
def test_ranges_agree_with_a_dense_sweep_of_eigenvalues(L: TransferFunction) -> None:
    found = gain_ranges(L, negative=True)
    ends_are_marginal(L, found)
    D, N = np.poly(L.poles), L.gain * np.poly(L.zeros)
    grid = np.logspace(-4, 4, 81)
    marks = [e.K for r in found.ranges for e in (r.low, r.high) if e.K]
    near = [m * (1 + d) for m in marks for d in (-1e-4, 1e-4)]
    for K in [*-grid, *grid, *near]:
        p = np.polyadd(D, K * N)
        if abs(p[0]) < 1e-9:
            continue
        right = np.roots(p).real.max()
        if abs(right) > 1e-6 * max(1.0, abs(K)):
            assert (right < 0) == (K in found), (K, right, found)


@effort(30)
@given(systems(order=(1, 3), stable=False, axis=True, theta=True))
def test_ranges_with_dead_time_agree_with_the_argument_principle(L: TransferFunction) -> None:
    found = gain_ranges(L, negative=True)
    ends_are_marginal(L, found)
    marks = [e.K for r in found.ranges for e in (r.low, r.high) if e.K]
    for K in [-20.0, -2.0, -0.2, -0.01, 0.01, 0.2, 2.0, 20.0, *[m * (1 + d) for m in marks for d in (-1e-3, 1e-3)]]:
        try:
            Z = rhp_closed_loop_poles(list(L.zeros), list(L.poles), K * L.gain, L.theta)
        except ValueError:  # a root lies on the path
            continue
        assert (Z == 0) == (K in found), (K, Z, found)


@effort(60)
@given(systems(order=(1, 5), stable=True))
def test_positive_ranges_are_the_positive_part(L: TransferFunction) -> None:
    both, positive = gain_ranges(L, negative=True), gain_ranges(L)
    for K in np.logspace(-3, 3, 61):
        assume(all(e.K is None or abs(K - e.K) > 1e-9 for r in both.ranges for e in (r.low, r.high)))
        assert (K in both) == (K in positive)
    assert -1.0 not in positive


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1/(s+1)^3", [(0, 8)]),
        ("1/(s+1)", [(0, None)]),
        ("1/s", [(0, None)]),
        ("2(s+1)/(s(s-4))", [(2, None)]),
        ("(s+3)/(s^2*(s+2)*(s+4)*(s^2+2s+9)*(s^3+5))", []),
        ("(s+2)^2/s^3", [(1, None)]),  # s^3 + K (s+2)^2: 4 K^2 > 4 K
        ("1/s^2", []),
        ("1/(s^2+1)", []),
        ("(s-1)/(s+1)", [(0, 1)]),
        ("1/(s-1)^2", []),
        ("(s-1)/((s-1)(s+1))", []),
        ("(s+1)/((s-1)(s+1))", [(1, None)]),
        ("s/(s^2+1)", [(0, None)]),
        ("s/s", []),
        ("3", [(0, None)]),
        ("-0.5", [(0, 2), (2, None)]),
        ("exp(-s)", [(0, 1)]),
        ("(s+1)exp(-3s)/(s+2)", [(0, 1)]),
    ],
)
def test_closed_forms(text: str, expected: list[tuple[float | None, float | None]]) -> None:
    found = ranges(text)
    assert len(found) == len(expected)
    for got, want in zip(found, expected, strict=True):
        for a, b in zip(got, want, strict=True):
            assert a is b is None or a == pytest.approx(b, rel=1e-11)
    if not expected:
        assert gain_ranges(parse_transfer_function(text)).reason


def test_negative_gains() -> None:
    """s^3 + (1+K) s^2 + s + 1 + 4K: (1+K) - (1+4K) = -3K > 0 and 1 + 4K > 0."""
    assert ranges("1/(s+1)^3", True)[0] == pytest.approx((-1, 8), rel=1e-12)
    assert ranges("(s^2+4)/((s^2+1)(s+1))", True)[0] == pytest.approx((-0.25, 0), rel=1e-12)
    assert ranges("(s^2+4)/((s^2+1)(s+1))") == []
    assert ranges("2", True) == [(None, -0.5), (-0.5, None)]


def test_a_conditionally_stable_loop_has_two_ranges() -> None:
    """Three slow lags and two faster leads: stable for small and for large gains, not between."""
    text = "(s+1)^2/(s+0.01)^3"
    L = parse_transfer_function(text)
    found = gain_ranges(L)
    assert len(found.ranges) == 2
    D, N = np.poly(L.poles), L.gain * np.poly(L.zeros)

    def rightmost(K: float) -> float:
        return float(np.roots(np.polyadd(D, K * N)).real.max())

    for end in (found.ranges[0].high, found.ranges[1].low):
        assert brentq(rightmost, end.K * 0.999, end.K * 1.001, xtol=1e-13) == pytest.approx(end.K, rel=1e-8)


@pytest.mark.parametrize("theta", [0.01, 1.0, 50.0])
def test_integrator_with_dead_time(theta: float) -> None:
    """e^{-theta s}/s: 0 < K < pi/(2 theta)."""
    (low, high), = ranges(f"exp(-{theta} s)/s")  # fmt: skip
    assert low == 0
    assert high == pytest.approx(np.pi / 2 / theta, rel=1e-12)


@pytest.mark.parametrize(("K", "tau", "theta"), [(1, 0.5, 0.1), (2, 5, 1), (1, 1, 3), (1, 1, 1e-3)])
def test_first_order_with_dead_time(K: float, tau: float, theta: float) -> None:
    """tan(omega theta) = -omega tau in (pi/2, pi)/theta; then |K_c K| = sqrt(1 + (omega tau)^2)."""
    w = brentq(lambda w: np.pi - w * theta - np.arctan(w * tau), 0.5 * np.pi / theta, np.pi / theta, xtol=1e-15)
    (low, high), = ranges(f"{K} exp(-{theta} s)/({tau} s+1)", True)  # fmt: skip
    assert low == pytest.approx(-1 / K, rel=1e-12)
    assert high == pytest.approx(np.hypot(1, w * tau) / K, rel=1e-10)


def test_unstable_lag_with_dead_time() -> None:
    """e^{-theta s}/(s-1) can be stabilised by a gain only for theta < 1."""
    (low, high), = ranges("exp(-0.5s)/(s-1)")  # fmt: skip
    w = brentq(lambda w: np.arctan(w) - 0.5 * w, 1.0, 3.0, xtol=1e-15)
    assert low == pytest.approx(1, rel=1e-12)
    assert high == pytest.approx(np.hypot(1, w), rel=1e-12)
    for theta in (1, 1.2, 5):
        found = gain_ranges(parse_transfer_function(f"exp(-{theta}s)/(s-1)"), True)
        assert not found.ranges
        assert found.reason == "no gain stabilises the loop"


@effort(40)
@given(systems(order=(1, 4), stable=False, theta=True))
def test_adding_up_the_crossings_finds_the_same_ranges(L: TransferFunction) -> None:
    """Many pieces are told apart by the direction of each crossing: the same ranges as counting in every piece."""
    module = sys.modules["looplab.engine.stability.gain_ranges"]
    found = []
    for limit in (0, 10**9):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(module, "MANY_PIECES", limit)
            found.append(gain_ranges.__wrapped__(L, True))
    assert found[0] == found[1]


def test_a_long_dead_time_is_answered() -> None:
    """A lightly damped plant under 1000 s of dead time: thousands of crossings, two ends, and a note."""
    found = gain_ranges(parse_transfer_function("exp(-1000s)/(s^2+0.001s+1)"), True)
    r, = found.ranges  # fmt: skip
    ends_are_marginal(parse_transfer_function("exp(-1000s)/(s^2+0.001s+1)"), found)
    assert r.low.K is not None and r.low.K < 0
    assert "may be missing" in str(found.reason)


def test_reasons_of_the_ends() -> None:
    r, = gain_ranges(parse_transfer_function("1/(s+1)^3")).ranges  # fmt: skip
    assert r.high.omega == pytest.approx((3**0.5,), rel=1e-12)
    assert "imaginary axis" in r.high.reason
    assert "stable without feedback" in r.low.reason
    r, = gain_ranges(parse_transfer_function("1/s")).ranges  # fmt: skip
    assert "however large" in r.high.reason
    assert 5.0 in r and 0.0 not in r
    assert "cancels the pole at 1" in str(gain_ranges(parse_transfer_function("(s-1)/(s-1)")).reason)
    assert gain_ranges(parse_transfer_function("0/(s+1)")).ranges
    with pytest.raises(ImproperSystem):
        gain_ranges(parse_transfer_function("s"))


@pytest.mark.parametrize("tau_I", [0.1, 0.25, 0.4, 0.49, 0.4999, 0.5, 0.7, 3.0])
def test_PI_on_the_second_order_plant(tau_I: float) -> None:
    """Section 15: 1/(s^2+2s+2) is stable for every Kc > 0 if tau_I >= 0.5, else for Kc < 4/(1/tau_I - 2)."""
    r, = pi_gain_ranges(parse_transfer_function("1/(s^2+2s+2)"), tau_I).ranges  # fmt: skip
    assert r.low.K == 0
    if tau_I >= 0.5:
        assert r.high.K is None
    else:
        assert r.high.K == pytest.approx(4 / (1 / tau_I - 2), rel=1e-9)


@pytest.mark.parametrize("text", ["1/(s^2+2s+2)", "exp(-0.1s)/(0.5s+1)", "1/(s+1)^3", "(1-s)/(s+1)^3"])
def test_the_boundary_meets_the_ranges(text: str) -> None:
    plant = parse_transfer_function(text)
    curve = pi_boundary(plant)
    C = curve.Kc + curve.Ki / (1j * curve.omega)
    there = np.isfinite(curve.tau_I)
    assert there.any()
    assert np.abs(1 + C * plant.response(curve.omega))[there].max() < 1e-9
    for i in np.flatnonzero(there)[:: max(1, there.sum() // 6)]:
        found = pi_gain_ranges(plant, float(curve.tau_I[i]), negative=True)
        ends = [e.K for r in found.ranges for e in (r.low, r.high) if e.K]
        stable_side = any(abs(K - curve.Kc[i]) < 1e-7 * abs(curve.Kc[i]) for K in ends)
        assert stable_side or curve.Kc[i] not in found
    region = pi_region(plant, [0.3, 1.0])
    assert region.tau_I == (0.3, 1.0)
    assert region.ranges[1] == pi_gain_ranges(plant, 1.0)


def test_refusals_of_the_PI_region() -> None:
    plant = parse_transfer_function("1/(s+1)")
    with pytest.raises(InvalidInput):
        pi_gain_ranges(plant, 0.0)
    with pytest.raises(InvalidInput):
        pi_boundary(plant, [-1.0])
    with pytest.raises(InvalidInput):
        pi_boundary(parse_transfer_function("0"))
