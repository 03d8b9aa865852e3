"""Responses of one system: closed forms, scipy's lsim, linearity, time invariance, cuts."""

import numpy as np
import pytest
import scipy.linalg
import scipy.signal
import scipy.special
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.loop import step_response
from looplab.engine.response import (
    InputSignal,
    final_value,
    held_samples,
    impulse,
    joined_samples,
    pulse,
    ramp,
    response_horizon,
    simulate,
    sine,
    step,
)
from looplab.engine.state_space import StateSpaceModel, from_ode, initial_state
from looplab.engine.systems import TransferFunction, parse_transfer_function, realize
from strategies import effort, numbers, systems

LAG = parse_transfer_function("2/(3s+1)")


def close(actual: np.ndarray, expected: np.ndarray, tolerance: float = 1e-12) -> None:
    assert np.abs(actual - expected).max() <= tolerance * max(1.0, np.abs(expected).max())


def lag(t: np.ndarray) -> np.ndarray:
    return np.where(t > 0, 1 - np.exp(-np.maximum(t, 0) / 3), 0.0)


@pytest.mark.parametrize("theta", [0.0, 0.37, 1.0])
@pytest.mark.parametrize("start", [0.0, 0.5, 1.234567])
def test_a_lag_answers_each_input_in_closed_form(theta: float, start: float) -> None:
    """K/(tau s + 1), K = 2, tau = 3: step, impulse, ramp, pulse and sine."""
    G = LAG * TransferFunction(theta=theta)
    s = np.linspace(0, 20, 401) - start - theta
    on = np.where(s >= -1e-12, 1.0, 0.0)
    d = np.maximum(s, 0.0)
    w, p = 1.7, 0.4
    steady = 1 / (1j * w * 3 + 1)
    sinus = 1.5 * 2 * ((steady * np.exp(1j * (w * d + p))).imag - (steady * np.exp(1j * p)).imag * np.exp(-d / 3))
    for signal, expected in (
        (step(1.5, start), 3 * lag(s)),
        (impulse(0.5, start), on * 1.0 / 3 * np.exp(-d / 3)),
        (ramp(0.2, start), 0.4 * (d - 3 * lag(s))),
        (pulse(2.0, 4.0, start), 4 * (lag(s) - lag(s - 4.0))),
        (sine(1.5, w, np.rad2deg(p), start), on * sinus),
    ):
        found = simulate(G, signal, 20.0, 401)
        close(found.y, expected)
        assert found.truncated_at is None


def test_the_input_is_shown_as_it_is_applied() -> None:
    t = np.linspace(0, 10, 11)
    close(simulate(LAG, pulse(2, 3, 1), 10, 11).u, np.where((t >= 1) & (t < 4), 2.0, 0.0))
    close(simulate(LAG, joined_samples([1, 3, 7], [1, 5, -3]), 10, 11).u, [0, 1, 3, 5, 3, 1, -1, -3, -3, -3, -3])
    close(simulate(LAG, held_samples([0, 2.5], [1, -1]), 10, 11).u, [1, 1, 1, *[-1] * 8])
    close(simulate(LAG, sine(2, np.pi / 2, 90, 3), 10, 11).u[:6], [0, 0, 0, 2, 0, -2])


@effort(40)
@given(systems(order=(1, 6), stable=True, excess=0), st.integers(0, 2**32 - 1))
def test_joined_samples_against_lsim(G: TransferFunction, seed: int) -> None:
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 8, 41)
    u = rng.normal(size=41)
    ss = realize(G)
    x0 = rng.normal(size=G.order)
    found = simulate(G, joined_samples(t, u), 8.0, 41, x0)
    _, y, x = scipy.signal.lsim((ss.A, ss.B[:, None], ss.C[None, :], ss.D), u, t, X0=x0)
    close(found.y, np.atleast_1d(y), 1e-10)
    close(found.x, x.reshape(41, -1), 1e-10)


@effort(30)
@given(systems(order=(1, 6), stable=True, excess=0), st.integers(0, 2**32 - 1))
def test_held_samples_at_odd_times_against_the_matrix_exponential(G: TransferFunction, seed: int) -> None:
    """Each piece by its own exponential, from breakpoint or sample to the next."""
    rng = np.random.default_rng(seed)
    times = np.sort(rng.uniform(0, 5, size=7))
    values = rng.normal(size=7)
    ss, n = realize(G), G.order
    samples = np.linspace(0, 6, 31)
    x, at, u, y = np.zeros(n), 0.0, 0.0, []
    events = sorted([(float(t), 0, float(v)) for t, v in zip(times, values, strict=True)]
                    + [(float(t), 1, 0.0) for t in samples])  # fmt: skip
    for t, kind, value in events:
        M = np.zeros((n + 1, n + 1))
        M[:n, :n], M[:n, n] = ss.A, ss.B * u
        x = (scipy.linalg.expm(M * (t - at)) @ np.append(x, 1.0))[:n]
        at = t
        if kind == 0:
            u = value
        else:
            y.append(ss.C @ x + ss.D * u)
    close(simulate(G, held_samples(times, values), 6.0, 31).y, np.array(y), 1e-11)


@effort(40)
@given(systems(order=(1, 5), stable=True, excess=0, theta=True), numbers(-3, 3), numbers(-3, 3), numbers(0.1, 2))
def test_linearity(G: TransferFunction, a: float, b: float, start: float) -> None:
    one, other = step(a, start), held_samples([start], [b])
    both = step(a + b, start)
    x = np.linspace(-1, 1, G.order)
    parts = simulate(G, one, 10, 101, x).y + simulate(G, other, 10, 101, 2 * x).y
    close(simulate(G, both, 10, 101, 3 * x).y, parts, 1e-11)


@effort(40)
@given(
    systems(order=(1, 5), stable=True, theta=True),
    st.sampled_from([step(), impulse(), ramp(), sine(omega=2.3, phase_deg=30), pulse(width=1.3)]),
    st.integers(1, 40),
)
def test_time_invariance(G: TransferFunction, signal: InputSignal, k: int) -> None:
    """Later input, later output; both are sampled at the same instants."""
    whole = simulate(G, signal, 10, 101)
    later = simulate(G, signal.shifted(0.1 * k), 10, 101)
    close(later.y[k:], whole.y[:-k], 1e-10)
    assert np.abs(later.y[:k]).max() <= 1e-12 * max(1.0, np.abs(whole.y).max())


@effort(30)
@given(systems(order=(1, 5), stable=True, theta=True))
def test_the_step_is_the_one_of_the_loop_package(G: TransferFunction) -> None:
    found = step_response(G, 10.0, 200)
    ours = simulate(G, step(), found.t[-1], found.t.size)
    close(ours.y, found.y, 1e-10)


def test_free_response_from_initial_values() -> None:
    """y'' + 3 y' + 2 y = 0, y(0) = 1, y'(0) = 2: y = 4 exp(-t) - 3 exp(-2t)."""
    model = from_ode([1, 3, 2], [1])
    found = simulate(model.channel(), step(0.0), 8.0, 161, initial_state(model, [1, 2]))
    close(found.y, 4 * np.exp(-found.t) - 3 * np.exp(-2 * found.t))
    close(found.x[:, 1], -4 * np.exp(-found.t) + 6 * np.exp(-2 * found.t))


def test_resonance_a_bounded_input_with_an_unbounded_output() -> None:
    """1/(s^2 + 4) driven by sin(2 t): y = (sin 2t - 2t cos 2t)/8 grows without end; at 3 rad it stays bounded."""
    G = parse_transfer_function("1/(s^2+4)")
    found = simulate(G, sine(1, 2), 100, 2001)
    t = found.t
    close(found.y, (np.sin(2 * t) - 2 * t * np.cos(2 * t)) / 8, 1e-12)
    beside = simulate(G, sine(1, 3), 100, 2001)
    close(beside.y, (1.5 * np.sin(2 * t) - np.sin(3 * t)) / 5)
    assert np.abs(beside.y).max() < 0.5 < 20 < np.abs(found.y).max()


def test_an_integrator_turns_a_bounded_step_into_a_ramp() -> None:
    found = simulate(parse_transfer_function("1/s^2"), step(2), 10, 11)
    close(found.y, found.t**2)
    close(simulate(parse_transfer_function("1/s"), impulse(3), 4, 5).y, np.full(5, 3.0))


def test_an_unstable_response_is_cut_with_its_reason() -> None:
    found = simulate(parse_transfer_function("1/(s-1)"), step(), 100, 1001)
    assert found.truncated_at == pytest.approx(np.log(1e9), abs=0.11)
    assert "1e+09" in str(found.truncated_reason)
    assert found.y.size == round(found.truncated_at / 0.1) and np.isfinite(found.y).all()
    assert found.t.size == found.u.size == 1001
    far = simulate(parse_transfer_function("1/(s-1e6)"), held_samples(np.arange(5.0), np.ones(5)), 10, 50)
    assert far.y.size <= 1 and far.truncated_reason


def test_direct_feedthrough_and_the_impulse_in_y() -> None:
    G = parse_transfer_function("(2s+1)/(s+1) exp(-0.5 s)")
    found = simulate(G, impulse(3, 1), 5, 51)
    assert found.impulses == ((1.5, pytest.approx(6.0)),)
    s = found.t - 1.5
    close(found.y, np.where(s > -1e-9, -3 * np.exp(-s), 0.0))
    assert simulate(G, step(), 5, 51).impulses == ()


def test_a_pure_gain_and_a_pure_dead_time() -> None:
    assert simulate(TransferFunction(gain=2.0), ramp(1), 4, 5).y == pytest.approx([0, 2, 4, 6, 8])
    assert simulate(TransferFunction(gain=2.0, theta=1.5), step(1), 4, 5).y == pytest.approx([0, 0, 2, 2, 2])


@pytest.mark.parametrize("tau", [1e-8, 1e-3, 1.0, 1e3, 1e8])
def test_any_time_unit(tau: float) -> None:
    G = TransferFunction([], [-1 / tau, -3 / tau], 3 / tau**2)
    found = simulate(G, joined_samples([0, tau, 2.5 * tau], [0, 1, -1]), 10 * tau, 101)
    unit = simulate(parse_transfer_function("3/((s+1)(s+3))"), joined_samples([0, 1, 2.5], [0, 1, -1]), 10, 101)
    close(found.y, unit.y, 1e-11)


def test_fifty_lags() -> None:
    """1/(s+1)^50: the step response is the incomplete gamma function."""
    found = simulate(TransferFunction([], [-1.0] * 50, 1.0), step(), 100, 201)
    close(found.y, scipy.special.gammainc(50, found.t), 1e-11)


def test_a_stiff_system_keeps_its_digits() -> None:
    G = TransferFunction([], [-1e5, -1.0], 1e5)
    found = simulate(G, step(), 10, 101)
    close(found.y, 1 + (np.exp(-1e5 * found.t) - 1e5 * np.exp(-found.t)) / (1e5 - 1), 1e-11)


def test_a_state_space_channel_with_dead_time() -> None:
    model = StateSpaceModel([[-1]], [[1]], [[1]])
    found = simulate(model.channel(), step(), 5, 51, [2.0], theta=1.0)
    s = found.t - 1
    close(found.y, 2 * np.exp(-found.t) + np.where(s > 0, 1 - np.exp(-s), 0.0))


@pytest.mark.parametrize(
    ("text", "signal", "value", "word"),
    [
        ("2/(3s+1) exp(-s)", step(1.5), 3.0, None),
        ("2/(3s+1)", held_samples([0, 1], [1, -1]), -2.0, None),
        ("2/(3s+1)", pulse(), 0.0, None),
        ("2/(3s+1)", impulse(), 0.0, None),
        ("s/(3s+1)", ramp(), None, "does not settle"),
        ("2/(3s+1)", sine(), None, "does not settle"),
        ("2/(3s+1)", sine(0), 0.0, None),
        ("1/s", step(), None, "pole at 0"),
        ("1/(s^2+4)", step(), None, "pole at 0 ± 2j"),
        ("1/(s-1)", step(), None, "pole at 1"),
    ],
)
def test_final_values(text: str, signal: InputSignal, value: float | None, word: str | None) -> None:
    G = parse_transfer_function(text)
    found = final_value(G.poles, G.dc_gain, signal)
    assert found.value == (None if value is None else pytest.approx(value))
    assert (word or "") in str(found.reason)
    if value is not None:
        assert simulate(G, signal, 200, 50).y[-1] == pytest.approx(value, abs=1e-12)


def test_many_breakpoints_between_samples() -> None:
    """Forty pieces a sample apart and off the grid: the ladder of halved exponentials."""
    times = np.sort(np.random.default_rng(5).uniform(0, 6, 60))
    values = np.cos(times)
    found = simulate(parse_transfer_function("3/((s+1)(s+3))"), held_samples(times, values), 8.0, 33)
    expected = np.zeros(33)
    for at, jump in zip(times, np.diff(values, prepend=0.0), strict=True):
        s = np.maximum(found.t - at, 0.0)
        expected += jump * (1 - 1.5 * np.exp(-s) + 0.5 * np.exp(-3 * s))
    close(found.y, expected, 1e-13)


def test_horizons() -> None:
    assert response_horizon(np.array([-1 + 0j]), step()) == 8
    assert response_horizon(np.array([-1 + 0j]), step(start=2), 3.0) == 13
    assert response_horizon(np.zeros(0, dtype=complex), step()) == 10
    for count in (3, 20, 50):
        # The step of so many lags, 1 - sum e^(-t) t^k/k!, is within 0.2 % of its end by then.
        end = response_horizon(-np.ones(count, dtype=complex), step())
        assert 0.998 < scipy.special.gammainc(count, end) < 0.9999999
    assert response_horizon(np.array([2j, -2j]), sine(omega=2.0)) == pytest.approx(26)
    assert 0 < response_horizon(np.array([5 + 0j, -1e-12 + 0j]), step()) <= 1e9


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: step(float("nan")), "amplitude"), (lambda: step(1, -1), "start"), (lambda: sine(1, 0), "omega"),
        (lambda: pulse(1, 0), "width"), (lambda: pulse(1, 1e-9, 1e9), "width"), (lambda: ramp(1e30), "slope"),
        (lambda: held_samples([], []), "times"), (lambda: held_samples([0, 0], [1, 2]), "times"),
        (lambda: held_samples([0, 1], [1]), "values"), (lambda: joined_samples([0], [1]), "times"),
        (lambda: held_samples([-1, 1], [1, 2]), "times"), (lambda: held_samples([0, 1], [1, np.inf]), "values"),
        (lambda: simulate(LAG, step(), -1), "horizon"), (lambda: simulate(LAG, step(), 1, 1), "points"),
        (lambda: simulate(LAG, step(), 1, 50, [1, 2]), "x0"), (lambda: simulate(LAG, step(), 1, 50, [np.nan]), "x0"),
        (lambda: simulate(realize(LAG), step(), 1, 50, theta=-1), "theta"),
    ],
)  # fmt: skip
def test_bad_inputs_are_named(make, field: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        make()
    assert caught.value.field == field


def test_an_improper_system_is_named_as_such() -> None:
    with pytest.raises(ImproperSystem, match="differentiates"):
        simulate(parse_transfer_function("s+1"), step(), 1)
