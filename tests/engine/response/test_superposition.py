"""Sums of shifted steps and of shifted impulses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import InvalidInput
from looplab.engine.response import convolution, held_samples, impulse, pulse, ramp, simulate, sine, step, superposition
from looplab.engine.systems import TransferFunction, parse_transfer_function, realize
from strategies import effort, numbers, systems


@effort(40)
@given(systems(order=(1, 5), stable=True, excess=0, theta=True), st.lists(numbers(-3, 3), min_size=1, max_size=8))
def test_a_staircase_is_the_sum_of_its_steps(G: TransferFunction, values: list[float]) -> None:
    signal = held_samples(np.arange(len(values)) * 0.73 + 0.2, values)
    x0 = np.linspace(1, -1, G.order)
    found = superposition(G, signal, 12.0, 121, x0)
    assert found.error < 1e-11
    assert sum(term.amplitude for term in found.terms) == pytest.approx(values[-1], abs=1e-12)
    np.testing.assert_allclose(
        found.total, simulate(G, signal, 12.0, 121, x0).y, rtol=0, atol=1e-10 * max(1, np.abs(found.total).max())
    )


def test_terms_of_a_pulse_are_one_step_and_its_opposite() -> None:
    """A rectangle through 1/(s+1): s(t - 1) - s(t - 3)."""
    found = superposition(parse_transfer_function("1/(s+1)"), pulse(2, 2, 1), 8, 81)
    assert [(term.amplitude, term.start) for term in found.terms] == [(2, 1), (-2, 3)]
    for term in found.terms:
        s = np.maximum(found.t - term.start, 0)
        np.testing.assert_allclose(term.y, term.amplitude * -np.expm1(-s), atol=1e-14)
    assert not found.free.any() and found.truncated_at is None


def test_an_unstable_sum_stops_where_its_first_part_is_cut() -> None:
    found = superposition(parse_transfer_function("1/(s-1)"), pulse(1, 1), 100, 1001)
    assert found.truncated_at is not None
    assert found.total.size == found.terms[0].y.size < 1001


def test_what_is_no_staircase_is_refused() -> None:
    G = parse_transfer_function("1/(s+1)")
    for signal in (ramp(), sine(), impulse()):
        with pytest.raises(InvalidInput, match="staircase"):
            superposition(G, signal, 5)
    with pytest.raises(InvalidInput, match="more than can be shown"):
        superposition(G, held_samples(np.arange(60.0), np.arange(60.0) + 1), 5)
    with pytest.raises(InvalidInput, match="numbers"):
        superposition(G, held_samples(np.arange(40.0), np.arange(40.0) + 1), 5, 2000)


def test_the_convolution_sum_comes_closer_with_the_square_of_the_slices() -> None:
    """Where u is smooth and h starts at zero, the midpoint rule has an error of second order."""
    G = parse_transfer_function("1/((s+1)(s+2)^2)")
    errors = [convolution(G, sine(1, 1.3), 10, 201, n).error for n in (50, 100, 200)]
    assert errors[0] < 1e-2
    assert 3 < errors[0] / errors[1] < 6
    assert 3 < errors[1] / errors[2] < 6


def test_the_convolution_sum_is_what_it_says() -> None:
    G = parse_transfer_function("(s+3)/(s+1) exp(-0.4 s)")
    found = convolution(G, step(2), 5, 51, 10)
    assert found.times == pytest.approx(np.arange(10) * 0.5 + 0.25)
    assert found.weights == pytest.approx(np.ones(10))
    by_hand = sum(
        w * np.where(found.t - at >= 0.4 - 1e-12, 2 * np.exp(-(found.t - at - 0.4)), 0.0)
        for at, w in zip(found.times, found.weights, strict=True)
    )
    np.testing.assert_allclose(found.total, by_hand + 2.0 * (found.t >= 0.4 - 1e-12), atol=1e-12)
    again = convolution(realize(G), step(2), 5, 51, 10, theta=0.4)
    np.testing.assert_allclose(again.total, found.total, atol=1e-12)


def test_what_cannot_be_convolved_is_refused() -> None:
    G = parse_transfer_function("1/(s+1)")
    with pytest.raises(InvalidInput, match="h itself"):
        convolution(G, impulse(), 5)
    with pytest.raises(InvalidInput, match="slices"):
        convolution(G, step(), 5, slices=0)
