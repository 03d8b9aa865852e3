"""Closed-loop poles and the verdict: exact equation, independent counts, hidden modes, poles on the axis."""

from math import comb

import numpy as np
import pytest
from hypothesis import assume, given, note

from independent import rhp_closed_loop_poles
from looplab.engine.frequency import margins, nyquist_count
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.stability import closed_loop_poles, closed_loop_verdict, count_in_rectangle, gain_ranges
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import controllers, effort, systems


def loop(plant: str, C: PID | TransferFunction | float) -> FeedbackLoop:
    return FeedbackLoop(parse_transfer_function(plant), PID(C) if isinstance(C, float) else C)


@effort(60)
@given(systems(order=(1, 4), stable=False), controllers())
def test_delay_free_poles_are_the_roots(P: TransferFunction, C: PID) -> None:
    closed = FeedbackLoop(P, C)
    L = closed.open_loop
    exact = np.roots(np.polyadd(np.poly(L.poles), L.gain * np.poly(L.zeros)))
    size = max(1.0, np.abs(exact).max())
    apart = np.abs(exact[:, None] - exact[None, :]) + np.eye(exact.size) * size
    assume(apart.min() > 1e-3 * size)
    assume(np.abs(exact).min() > 1e-3)
    found = closed_loop_poles(closed)
    assert found.complete
    assert found.poles.size == L.order
    gap = np.abs(found.poles[:, None] - exact[None, :])
    assert gap.min(axis=1).max() <= 1e-7 * size
    assume(np.abs(exact.real).min() > 1e-5 * size)
    verdict = closed_loop_verdict(closed)
    assert verdict.rhp_poles == np.count_nonzero(exact.real > 0)
    assert verdict.closed_loop_stable == (verdict.rhp_poles == 0) == (verdict.verdict == "stable")
    assert (found.poles.real[:-1] >= found.poles.real[1:] - 1e-8 * size).all()


@effort(40)
@given(systems(order=(1, 3), stable=False, theta=True), controllers())
def test_dead_time_poles_solve_the_exact_equation_and_none_is_missed(P: TransferFunction, C: PID) -> None:
    closed = FeedbackLoop(P, C)
    L = closed.open_loop
    note(f"{P!r} {C!r}")
    omega = np.append(1e-9, np.logspace(-3, 3, 2001))
    assume(np.abs(1 + L.response(omega)).min() > 1e-3)
    poles = closed_loop_poles(closed).poles
    # Hidden modes (a pole on a zero of L), and poles that feedback moves by less than a digit, are listed too.
    moved = np.abs(poles[:, None] - L.poles).min(axis=1) > 1e-8 * np.abs(poles)
    assert (np.abs(1 + L(poles[moved & ~np.isin(poles, L.zeros)])) < 1e-6).all()
    Z = rhp_closed_loop_poles(list(L.zeros), list(L.poles), L.gain, L.theta)
    verdict = closed_loop_verdict(closed)
    assert verdict.rhp_poles == nyquist_count(L).Z
    if verdict.rhp_poles is None:  # the dead time turns L too often to count
        assert Z > 100
        assert verdict.verdict == "unstable"
        return
    assert verdict.rhp_poles == Z
    assert verdict.closed_loop_stable == (Z == 0)
    if Z <= 10:
        assert np.count_nonzero(poles.real > 0) == Z
    # the rightmost pole is the rightmost: nothing lies to the right of it
    edge = poles[0].real + 1e-4 * (1 + abs(poles[0].real))
    if abs(edge) * L.theta < 20:
        try:
            beyond = rhp_closed_loop_poles(list(L.zeros), list(L.poles), L.gain, L.theta, shift=edge)
        except ValueError:  # an open-loop pole may sit on that very line
            return
        assert beyond == 0


@pytest.mark.parametrize(
    ("plant", "Kc", "rightmost"),
    [
        ("exp(-s)/s", 1 / np.e, -1.0),  # double pole: s e^s = -1/e
        ("exp(-s)/s", np.pi / 2, 1j * np.pi / 2),
        ("exp(-s)/s", 0.2, -0.2591711018190737),  # W0(-0.2), Corless et al., Adv. Comput. Math. 5 (1996) 329
        ("exp(-s)/s", 1.0, -0.3181315052047641 + 1.3372357014306894j),  # W(-1), known to 16 digits there
    ],
)
def test_integrator_with_dead_time_is_lambert_w(plant: str, Kc: float, rightmost: complex) -> None:
    pole = closed_loop_poles(loop(plant, float(Kc))).poles[0]
    digits = 1e-6 if Kc == 1 / np.e else 1e-12
    assert min(abs(pole - rightmost), abs(pole.conjugate() - rightmost)) < digits


@pytest.mark.parametrize(
    ("plant", "pole"),
    [("exp(-10 s)/(s-10)", 10.0), ("exp(-5.62 s)/((s+1)(s-3.16))", 3.16), ("exp(-2 s)/(s-3)", 2.99752)],
)
def test_an_unstable_pole_that_feedback_hardly_moves_is_listed(plant: str, pole: float) -> None:
    """The first is at 10 - e^{-100}, the open-loop one to every digit; the second moves by 5e-9, the third by 2e-3."""
    closed = loop(plant, 1.0)
    assert closed_loop_poles(closed).poles[0] == pytest.approx(pole, abs=2e-5)
    assert closed_loop_verdict(closed).rhp_poles == 1


def test_hidden_unstable_mode_is_counted() -> None:
    """G = 3/((s+4)(s-4)), C = (s-4)/s: T looks stable (-1, -3), the load response does not (+4)."""
    closed = loop("3/((s+4)(s-4))", parse_transfer_function("(s-4)/s"))
    assert np.sort(closed_loop_poles(closed).poles.real) == pytest.approx([-3, -1, 4])
    verdict = closed_loop_verdict(closed)
    assert verdict.verdict == "unstable"
    assert verdict.rhp_poles == 1


@pytest.mark.parametrize(
    ("plant", "C", "verdict"),
    [
        ("1/(s+1)^3", 7.99, "stable"),
        ("1/(s+1)^3", 8.0, "marginal"),
        ("1/(s+1)^3", 8.01, "unstable"),
        ("exp(-s)/s", 1.57, "stable"),
        ("exp(-s)/s", np.pi / 2, "marginal"),
        ("exp(-s)/s", 1.58, "unstable"),
        ("1/s^2", 1.0, "marginal"),
        ("1/s^3", 1.0, "unstable"),
        ("1/s", 0.0, "marginal"),
        ("1/s^2", 0.0, "unstable"),
        ("1/(s-1)", 0.0, "unstable"),
        ("1/(s-1)", 1.0, "marginal"),
        ("1/(s-1)", 1.001, "stable"),
        ("2", 0.7, "stable"),
        ("exp(-s)", 0.9, "stable"),
        ("exp(-s)", 1.1, "unstable"),
        ("exp(-s)/(s+1)", 0.0, "stable"),
        ("exp(-s)/(s-1)", 0.0, "unstable"),
        ("1/(s+1)^50", 0.5, "stable"),
        ("1/(s+1)^50", 1.2, "unstable"),
        ("s/(s^2+1)", 1.0, "stable"),
    ],
)
def test_verdicts(plant: str, C: float, verdict: str) -> None:
    answer = closed_loop_verdict(loop(plant, float(C)))
    assert answer.verdict == verdict
    assert answer.because
    assert answer.closed_loop_stable == (verdict == "stable")


@pytest.mark.parametrize(("tau_I", "limit"), [(0.1, 0.5), (0.25, 2.0), (0.4, 8.0)])
def test_limit_of_a_PI_loop_in_closed_form(tau_I: float, limit: float) -> None:
    """PI on 1/(s^2+2s+2): stable below Kc = 4/(1/tau_I - 2) (Routh by hand), for every gain from tau_I = 0.5 on."""
    for factor, stable in ((0.999, True), (1.001, False)):
        assert closed_loop_verdict(loop("1/(s^2+2s+2)", PID(limit * factor, tau_I))).closed_loop_stable == stable
    assert closed_loop_verdict(loop("1/(s^2+2s+2)", PID(1e4, 0.5))).closed_loop_stable


@pytest.mark.parametrize("K", [1e-3, 0.3, 1.0, 10.0, 300.0, 1e5])
def test_never_stable(K: float) -> None:
    answer = closed_loop_verdict(loop("(s+3)/(s^2*(s+2)*(s+4)*(s^2+2s+9)*(s^3+5))", K))
    assert answer.verdict == "unstable"
    assert answer.rhp_poles >= 2


@pytest.mark.parametrize("expanded", [False, True])
@pytest.mark.parametrize("n", [3, 6, 10, 20, 35, 50])
def test_the_limit_of_n_equal_lags(n: int, expanded: bool) -> None:
    """(s+1)^n + K = 0: s = -1 + K^(1/n) e^{j pi (2k+1)/n}, and two cross the axis at K = sec(pi/n)^n.

    Multiplied out the coefficients are whole numbers, exact up to n = 50: their roots scatter by 1.3, the loop not.
    """
    limit = np.cos(np.pi / n) ** -n
    plant = TransferFunction.from_polynomials([1.0], [float(comb(n, k)) for k in range(n + 1)])
    plant = plant if expanded else TransferFunction((), [-1.0] * n)
    (stable,) = gain_ranges(plant).ranges
    assert stable.high.K == pytest.approx(limit, rel=1e-9 if expanded else 1e-12)
    assert stable.high.omega == pytest.approx((np.tan(np.pi / n),), rel=1e-9 if expanded else 1e-12)
    for factor, right in ((0.5, 0), (1 - 1e-3, 0), (1 - 1e-6, 0), (1 + 1e-6, 2), (1 + 1e-3, 2)):
        K = limit * factor
        loop = FeedbackLoop(plant, PID(K))
        verdict = closed_loop_verdict(loop)
        assert (verdict.verdict, verdict.rhp_poles) == (("unstable" if right else "stable"), right)
        assert margins(loop.open_loop).closed_loop_stable == (right == 0)
        if not expanded:
            exact = -1 + K ** (1 / n) * np.exp(1j * np.pi * (2 * np.arange(n) + 1) / n)
            gap = np.abs(closed_loop_poles(loop).poles[:, None] - exact)
            assert max(gap.min(axis=0).max(), gap.min(axis=1).max()) < 1e-13


@pytest.mark.parametrize(
    ("plant", "C", "poles", "verdict"),
    [
        ("1/(s+2)", PID(0.0), [-2], "stable"),
        ("1/(s+2)", PID(0.0, 1.0), [0, -2], "marginal"),
        ("exp(-s)/(s-1)", PID(0.0), [1], "unstable"),
        ("0/(s-1)", PID(3.0), [1], "unstable"),
    ],
)
def test_a_loop_that_is_cut_keeps_its_poles(plant: str, C: PID, poles: list[float], verdict: str) -> None:
    cut = loop(plant, C)
    assert closed_loop_poles(cut).poles.tolist() == poles
    assert closed_loop_verdict(cut).verdict == verdict
    assert margins(cut.open_loop).closed_loop_stable == (verdict == "stable")


def test_of_poles_above_one_another_the_slowest_is_named() -> None:
    """0.5 e^{-s} = -1: s = ln 0.5 + j pi (2k+1)."""
    found = closed_loop_poles(loop("exp(-s)", 0.5)).poles
    assert found[:4] == pytest.approx(np.log(0.5) + 1j * np.pi * np.array([1, -1, 3, -3]), abs=1e-10)


@pytest.mark.parametrize(
    ("plant", "C"),
    [
        ("exp(-0.5 s)/(s+1)^3", PID(1.6, 2.0, 0.5)),
        ("exp(-0.1 s)/(0.5s+1)", PID(4.0, 0.4)),
        ("exp(-s)/(s+1)", PID(0.5, 1.5)),
        # Far left of the axis, where few nodes do not reach; beside a resonance; more than are listed on the right.
        ("exp(-0.06 s)/((s+0.5)(s+1)(s+1.5)(s+2)(s+3)(s+4)(s+5))", PID(2.0, 3.0, 0.5)),
        ("exp(-0.3 s)/((s+1)(s^2+0.2s+400))", PID(100.0, 2.0)),
        ("exp(-3 s)/(s^2+0.1s+4)", PID(2.0, 5.0)),
        ("exp(-20 s)/((s+1)(s+2))", PID(30.0, 1.0)),
    ],
)
def test_the_chain_of_dead_time_poles_has_no_gap(plant: str, C: PID) -> None:
    """As many as the argument principle counts lie right of the last one listed, up to its height."""
    closed = loop(plant, C)
    poles = closed_loop_poles(closed).poles
    assert poles.size == 24
    left = 0.5 * (poles.real[-1] + poles.real[-3])  # the last are a pair
    listed = poles[poles.real > left]
    top = 1.05 * np.abs(listed.imag).max()
    count = count_in_rectangle(closed.open_loop, 1.0, left, 10.0, -top, top)
    assert count == listed.size
    assert count > 6


def test_a_double_pole_on_the_axis_is_not_taken_for_two_beside_it() -> None:
    """D + N = (s^2+1)^2 (s+1) over D = (s+1)^5: rounding puts the pair at +-j beside the axis, its mean stays on it."""
    D = np.poly([-1.0] * 5)
    wanted = np.polymul(np.polymul([1.0, 0.0, 1.0], [1.0, 0.0, 1.0]), [1.0, 1.0])
    L = TransferFunction.from_polynomials(np.polysub(wanted, D), D)
    verdict = closed_loop_verdict(FeedbackLoop(L, PID(1.0)))
    assert (verdict.verdict, verdict.rhp_poles) == ("unstable", 0)
    assert "repeated" in verdict.because
