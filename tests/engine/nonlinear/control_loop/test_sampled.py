"""Sampled PID against exact discretisation, with dead times that are no multiples of the sampling time; noise."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from control_loops import THIRD_ORDER, compiled, unit_step
from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID
from looplab.engine.nonlinear.control_loop import (
    ControlLoop,
    Instrument,
    Lag,
    MeasurementNoise,
)
from looplab.engine.nonlinear.control_loop.simulation import simulate_control
from looplab.engine.nonlinear.inputs import InputCourse
from models import CSTR

A = np.array([[-1.0, 0, 0], [1, -1, 0], [0, 1, -1]])
B = np.array([1.0, 0, 0])


def held(x, u, time):
    """x after ``time`` with u held: exp of the augmented matrix."""
    M = np.zeros((4, 4))
    M[:3, :3], M[:3, 3] = A, B
    return (expm(M * time) @ np.append(x, u))[:3]


def difference_equation(kind, h, Kc, tau_I, tau_D, T_f):
    """u(z)/e(z) as (num, den) in z^-1: s replaced by (1 - 1/z)/h, or by 2/h (1 - 1/z)/(1 + 1/z)."""
    if kind == "backward":
        s_num, s_den = np.array([1.0, -1.0]) / h, np.array([1.0, 0.0])
    else:
        s_num, s_den = 2.0 / h * np.array([1.0, -1.0]), np.array([1.0, 1.0])
    filtered = T_f * s_num + s_den
    # Kc (1 + s_den/(tau_I s_num) + tau_D s_num/filtered) over the common denominator
    den = np.polymul(tau_I * s_num, filtered)
    num = den + np.polymul(s_den, filtered) + np.polymul(tau_D * tau_I * s_num, s_num)
    return Kc * num / den[0], den / den[0]


def linear_loop(kind, h, count, before, after):
    """y and u at samples, e measured ``before`` ago, u moved ``after`` later: both less than h here."""
    num, den = difference_equation(kind, h, 2.0, 2.5, 0.4, 0.04)
    e_past, u_past = [0.0, 0.0], [0.0, 0.0]
    x, u, y, us = np.zeros(3), 0.0, [], []
    measured = 0.0
    for _ in range(count):
        y.append(x[2])
        e = 1.0 - measured
        new = num @ [e, *e_past] - den[1:] @ u_past
        e_past, u_past = [e, e_past[0]], [new, u_past[0]]
        us.append(new)
        # Until the valve moves the old u holds; the next measurement is taken h - before after this sample.
        looked = h - before
        measured = (held(x, u, looked) if looked <= after else held(held(x, u, after), new, looked - after))[2]
        x, u = held(held(x, u, after), new, h - after), new
    return np.array(y), np.array(us)


@pytest.mark.parametrize("kind", ["backward", "tustin"])
@pytest.mark.parametrize(("before", "after"), [(0.0, 0.0), (0.07, 0.0), (0.0, 0.13), (0.11, 0.05), (0.04, 0.18)])
def test_exact_discretisation_of_a_linear_plant(kind, before, after):
    h, count = 0.2, 61
    loop = ControlLoop(
        "y", "u", unit_step(), PID(2.0, 2.5, 0.4, 0.1), sampling_time=h, discretization=kind,
        sensor=Instrument(theta=before), valve=Instrument(theta=after),
    )  # fmt: skip
    found = simulate_control(compiled(THIRD_ORDER), h * np.arange(count), [loop], rtol=1e-10)
    y, u = linear_loop(kind, h, count, before, after)
    np.testing.assert_allclose(found.y[:, 0], y, atol=2e-9)
    np.testing.assert_allclose(found.loops[0].u, u, atol=1e-8)
    assert found.loops[0].history_error is None


def test_a_dead_time_of_many_samples_shifts_what_is_measured():
    """The sensor's dead time, a multiple of h: y_m is y of so many samples ago."""
    h = 0.1
    loop = ControlLoop("y", "u", unit_step(), PID(1.0, 3.0), sampling_time=h, sensor=Instrument(theta=0.7))
    found = simulate_control(compiled(THIRD_ORDER), h * np.arange(100), [loop])
    np.testing.assert_array_equal(found.loops[0].y_m[7:], found.y[:-7, 0])
    assert not found.loops[0].y_m[:7].any()


def test_short_samples_tend_to_the_continuous_controller():
    t = np.linspace(0, 6, 13)
    continuous = simulate_control(compiled(THIRD_ORDER), t, [ControlLoop("y", "u", unit_step(), PID(2.0, 2.0))])
    errors = [
        np.abs(
            simulate_control(
                compiled(THIRD_ORDER), t, [ControlLoop("y", "u", unit_step(), PID(2.0, 2.0), sampling_time=h)]
            ).y
            - continuous.y
        ).max()
        for h in (0.1, 0.05, 0.025)
    ]
    # The hold costs half a sample: the error is of first order in h.
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.15)
    assert errors[1] / errors[2] == pytest.approx(2.0, abs=0.1)


def test_the_reactor_by_hand():
    """Sensor lag, saturation and sampled PI, each sample an integration of its own."""
    h, count = 0.05, 61
    loop = ControlLoop(
        "T", "Q", InputCourse(390.0), PID(8e5, 0.6, action="direct"), u_min=0.0, u_max=3e6, sampling_time=h,
        sensor=Instrument(Lag(0.1)),
    )  # fmt: skip
    t = h * np.arange(count)
    found = simulate_control(compiled(CSTR), t, [loop], initial={"cA": 0.72, "T": 386.0}, rtol=1e-11)
    x, integral, states, us = [0.72, 386.0, 386.0], 2e6, [], []
    for _ in range(count):
        states.append(x[:2])
        e = 390.0 - x[2]
        integral += -8e5 * h / 0.6 * e
        Q = min(max(-8e5 * e + integral, 0.0), 3e6)
        us.append(Q)

        def f(_, x, Q=Q):
            r = 7.2e10 * math.exp(-1e4 / x[1]) * x[0]
            return [1 - x[0] - r, 350 - x[1] + 200 * r - Q / 1e5, (x[1] - x[2]) / 0.1]

        x = solve_ivp(f, (0, h), x, "DOP853", rtol=1e-12, atol=1e-12).y[:, -1].tolist()
    # cA falls to a hundredth of where it starts
    np.testing.assert_allclose(found.x, states, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(found.loops[0].u, us, rtol=1e-7)
    assert min(us) == 0.0
    assert max(us) == 3e6


def noisy(seed, **more):
    loop = ControlLoop(
        "y", "u", unit_step(), PID(1.0, 3.0), noise=MeasurementNoise(0.2, seed=seed, **more), sampling_time=0.1
    )
    return simulate_control(compiled(THIRD_ORDER), 0.1 * np.arange(200), [loop])


def test_noise_comes_from_its_seed():
    first, again, other = noisy(3), noisy(3), noisy(4)
    assert np.array_equal(first.loops[0].y_m, again.loops[0].y_m)
    assert np.array_equal(first.x, again.x)
    assert not np.array_equal(first.loops[0].y_m, other.loops[0].y_m)
    added = first.loops[0].y_m - first.y[:, 0]
    np.testing.assert_allclose(added, 0.2 * np.random.default_rng(3).standard_normal(200), atol=1e-12)


def test_noise_may_be_slower_than_the_samples():
    found = noisy(3, interval=0.4)
    added = (found.loops[0].y_m - found.y[:, 0]).reshape(-1, 4)
    np.testing.assert_allclose(added, added[:, :1] @ np.ones((1, 4)), atol=1e-12)
    assert np.unique(added[:, 0]).size == 50


def test_noise_of_a_continuous_controller_is_held_too():
    loop = ControlLoop("y", "u", unit_step(), PID(1.0, 3.0), noise=MeasurementNoise(0.2, 0.5, seed=1))
    found = simulate_control(compiled(THIRD_ORDER), np.linspace(0, 10, 41), [loop])
    added = found.loops[0].y_m - found.y[:, 0]
    np.testing.assert_allclose(added[:-1:2], added[1::2], atol=1e-12)
    with pytest.raises(InvalidInput, match="interval"):
        ControlLoop("y", "u", unit_step(), PID(1.0), noise=MeasurementNoise(0.2))
