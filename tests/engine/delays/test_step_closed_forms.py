r"""An integrator with two dead times in its loop: a piecewise polynomial, in exact fractions.

y' = 1 - a y(t - tau_1) - b y(t - tau_2) has y = sum over i, j of (i+j choose i) (-a)^i (-b)^j s^{i+j+1}/(i+j+1)!, with
s = t - i tau_1 - j tau_2 where that is positive.
"""

from fractions import Fraction
from math import comb, factorial

import numpy as np
import pytest

from looplab.engine.delays import DelaySystem, append, connect, feedback, parallel, series, step_response
from looplab.engine.errors import InvalidInput, NoConvergence
from looplab.engine.systems import TransferFunction, parse_transfer_function


def block(text: str) -> DelaySystem:
    return DelaySystem.from_transfer_function(parse_transfer_function(text))


def exact(a: float, b: float, first: float, second: float, t: float) -> float:
    a_, b_, f, s, t_ = (Fraction(v) for v in (a, b, first, second, t))
    total = Fraction(0)
    for i in range(int(t_ / f) + 1):
        for j in range(int((t_ - i * f) / s) + 1):
            n = i + j
            total += comb(n, i) * (-a_) ** i * (-b_) ** j * (t_ - i * f - j * s) ** (n + 1) / factorial(n + 1)
    return float(total)


@pytest.mark.parametrize(
    ("a", "b", "first", "second"),
    [
        (0.5, 0.25, 1.0, 0.5),
        (0.4, 0.3, 1.0, 1.4142135623730951),
        (0.8, -0.5, 0.3, 3.141592653589793),
        (1.5, 0.5, 1.0, 0.9),
    ],
)
def test_two_dead_times_around_an_integrator(a: float, b: float, first: float, second: float) -> None:
    late = [
        DelaySystem.from_transfer_function(TransferFunction((), (), k, tau)) for k, tau in ((a, first), (b, second))
    ]
    loop = feedback(block("1/s"), parallel(*late))
    found = step_response(loop, 12.0, 61)
    expected = np.array([exact(a, b, first, second, float(t)) for t in found.t])
    size = np.maximum(1.0, np.maximum.accumulate(np.abs(expected)))
    assert (np.abs(found.y[:, 0, 0] - expected) / size).max() <= 1e-11
    # y' by its own equation, from exact values of y.
    slope = [
        1 - a * exact(a, b, first, second, max(t - first, 0)) - b * exact(a, b, first, second, max(t - second, 0))
        for t in found.t.tolist()
    ]
    assert (np.abs(found.dy[:, 0, 0] - slope) / size).max() <= 1e-10
    sums = {i * first + j * second for i in range(15) for j in range(15)} - {0.0}
    assert all(min(abs(at - s) for s in sums) < 1e-9 for at in found.breakpoints)


def test_echoes_between_two_dead_times_jump_for_ever() -> None:
    """y = u - 0.5 y(t-1) - 0.3 y(t-0.7), nothing but delays: a staircase summed in closed form."""
    echo = parallel(block("0.5 exp(-s)"), block("0.3 exp(-0.7s)"))
    found = step_response(feedback(block("1"), echo), 10.0, 201)
    expected = [
        sum(
            comb(i + j, i) * (-0.5) ** i * (-0.3) ** j
            for i in range(11)
            for j in range(15)
            if i * 1.0 + j * 0.7 <= t + 1e-9
        )
        for t in found.t
    ]
    np.testing.assert_allclose(found.y[:, 0, 0], expected, rtol=0, atol=1e-12)


def test_delays_outside_every_loop_only_shift() -> None:
    """exp(-0.3s) 1/(s+1) exp(-1.7s): the step response of the lag, 2 later; two outputs of one system."""
    chain = series(series(block("exp(-0.3s)"), block("1/(s+1)")), block("exp(-1.7s)"))
    both = connect(append(chain, block("2 exp(-0.5s)")), np.zeros((2, 2)), [[1.0], [1.0]], np.eye(2))
    found = step_response(both, 8.0, 161)
    lag = np.where(found.t > 2 - 1e-9, -np.expm1(-(found.t - 2)), 0.0)
    np.testing.assert_allclose(found.y[:, 0, 0], lag, rtol=0, atol=1e-13)
    np.testing.assert_array_equal(found.y[:, 1, 0], np.where(found.t > 0.5 - 1e-9, 2.0, 0.0))
    # The slope jumps with the lag's input: right-hand limits.
    assert found.dy[np.searchsorted(found.t, 2 - 1e-9), 0, 0] == pytest.approx(1.0, abs=1e-11)


def test_a_delay_between_two_lags() -> None:
    """1/(s+1) e^{-s} 1/(s+1), the delay between states: 1 - (1 + s) e^{-s} with s = t - 1."""
    found = step_response(series(series(block("1/(s+1)"), block("exp(-s)")), block("1/(s+1)")), 9.0, 91)
    s = np.maximum(found.t - 1, 0)
    np.testing.assert_allclose(found.y[:, 0, 0], 1 - (1 + s) * np.exp(-s), rtol=0, atol=1e-13)


def test_an_unstable_response_is_cut_where_it_leaves_all_bounds() -> None:
    found = step_response(feedback(block("20 exp(-s)/s"), block("exp(-0.3s)")), 60.0, 301)
    assert found.truncated_at is not None
    assert "grows" in (found.truncated_reason or "")
    assert np.abs(found.y).max() < 1e9
    assert found.y.shape[0] < 301


def test_what_is_too_fine_or_outside_is_refused() -> None:
    loop = feedback(block("exp(-0.0005s)/(s+1)"), block("0.5 exp(-0.7s)"))
    with pytest.raises(NoConvergence, match="too short"):
        step_response(loop, 30.0)
    with pytest.raises(InvalidInput, match="millionth"):
        step_response(loop, 1e4)
    for horizon, points in ((-1.0, 100), (float("nan"), 100), (1.0, 5), (1.0, 10**6)):
        with pytest.raises(InvalidInput):
            step_response(block("1/(s+1)"), horizon, points)
