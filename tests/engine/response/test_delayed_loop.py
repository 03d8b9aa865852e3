"""A loop with dead time under any input: series in closed form, the frequency response, and its own parts."""

from math import factorial

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.loop.step_response import closed_loop_step
from looplab.engine.response import (
    convolution,
    held_samples,
    impulse,
    joined_samples,
    pulse,
    ramp,
    simulate,
    sine,
    step,
    superposition,
)
from looplab.engine.stability import setpoint_transfer
from looplab.engine.systems import parse_transfer_function

K = 0.7
INTEGRATOR = FeedbackLoop(parse_transfer_function("exp(-s)/s"), PID(Kc=K))
LAG = FeedbackLoop(parse_transfer_function("exp(-s)/(3s+1)"), PID(Kc=1.4, tau_I=2.2))


def series(t, start, order):
    """y of K exp(-s)/s after r = (t - start)^n/n!: the sum over k of -(-K)^k (t - start - k)^(n+k)/(n+k)!."""
    y = np.zeros(t.shape)
    for k in range(1, int(t[-1]) + 2):
        x = t - start - k
        y -= (-K) ** k * np.where(x >= 0, np.maximum(x, 0) ** (order + k) / factorial(order + k), 0)
    return y


@pytest.mark.parametrize(
    ("signal", "parts"),
    [
        (step(2.0, 0.37), [(2.0, 0.37, 0)]),
        (ramp(1.5, 0.37), [(1.5, 0.37, 1)]),
        (impulse(1.0, 0.21), [(1.0, 0.21, -1)]),
        (pulse(2.0, 1.23, 0.4), [(2.0, 0.4, 0), (-2.0, 1.63, 0)]),
        (held_samples([0, 1.1, 2.7], [1, 3, 2]), [(1, 0, 0), (2, 1.1, 0), (-1, 2.7, 0)]),
        (joined_samples([0, 2.2, 3.0], [0, 1.1, 1.1]), [(0.5, 0, 1), (-0.5, 2.2, 1)]),
    ],
)
def test_against_the_series_of_the_integrator(signal, parts):
    found = simulate(INTEGRATOR, signal, 12.0, 241)
    expected = sum(size * series(found.t, start, order) for size, start, order in parts)
    # Where the series jumps, at start + 1 of an impulse, both sides are right.
    away = np.abs(np.subtract.outer(found.t, [start + 1 for _, start, _ in parts])).min(axis=1) > 1e-9
    np.testing.assert_allclose(found.y[away], expected[away], atol=1e-11)


def test_a_sine_ends_in_the_frequency_response():
    omega = 1.3
    found = simulate(LAG, sine(1.0, omega, 20.0, 0.15), 90.0, 2001)
    L = LAG.open_loop.response(np.array([omega]))[0]
    T = L / (1 + L)
    late = found.t > 60
    phase = omega * (found.t - 0.15) + np.deg2rad(20.0)
    np.testing.assert_allclose(found.y[late], (T * np.exp(1j * phase)).imag[late], atol=1e-9)


def test_a_step_is_the_step_response_of_the_loop():
    found, known = simulate(LAG, step(), 30.0, 601), closed_loop_step(LAG, 30.0, 601)
    np.testing.assert_allclose(found.t, known.t, rtol=1e-12)
    np.testing.assert_allclose(found.y, known.setpoint.y, atol=1e-12)


@pytest.mark.parametrize("plant", ["exp(-0.02s)/(3s+1)", "exp(-s)(0.5s+1)/(3s+1)", "exp(-s)"])
def test_pieces_between_samples_fit_together(plant):
    """A pulse is a step less a later step; the sum of its steps has them on other offsets of the same grid."""
    loop = FeedbackLoop(parse_transfer_function(plant), PID(Kc=0.4, tau_I=2.2))
    assert superposition(loop, pulse(1.0, 1.234567, 0.1), 20.0, 401).error < 1e-11


def test_convolution_comes_nearer_with_more_slices():
    errors = [convolution(INTEGRATOR, sine(1.0, 1.3), 12.0, 241, slices).error for slices in (30, 60, 120)]
    # The midpoint rule: h has a jump, so the error halves at least.
    assert errors[1] < 0.6 * errors[0] and errors[2] < 0.6 * errors[1]


def test_a_loop_without_dead_time_is_its_transfer_function():
    loop = FeedbackLoop(parse_transfer_function("1/(s+1)^3"), PID(Kc=1.4, tau_I=2.2))
    signal = pulse(1.0, 2.0, 0.5)
    direct = simulate(setpoint_transfer(loop), signal, 20.0, 101)
    np.testing.assert_array_equal(simulate(loop, signal, 20.0, 101).y, direct.y)
    assert convolution(loop, signal, 20.0, 101).error == convolution(setpoint_transfer(loop), signal, 20.0, 101).error


def test_an_unstable_loop_is_cut_with_its_reason():
    found = simulate(FeedbackLoop(INTEGRATOR.plant, PID(Kc=9.0)), step(), 60.0, 601)
    assert found.truncated_at is not None and found.y.size < found.t.size
    assert "grows" in str(found.truncated_reason)


@pytest.mark.parametrize(
    ("signal", "horizon", "x0", "field"),
    [
        (step(), 12.0, [1.0], "initial"),
        (step(), 2e6, None, "loop.plant.theta"),
        (held_samples(np.arange(1500) * 0.0077 + 0.001, np.ones(1500)), 12.0, None, "input"),
    ],
)
def test_refusals(signal, horizon, x0, field):
    with pytest.raises(InvalidInput) as refused:
        simulate(INTEGRATOR, signal, horizon, 5000, x0)
    assert refused.value.field == field
