"""The DFT by its definition, Parseval, the inverse, aliases and leakage in closed form; signals of a loop."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from looplab.engine.errors import InvalidInput
from looplab.engine.frequency.sines import Sine, sum_of_sines
from looplab.engine.frequency.spectrum import (
    alias,
    dft,
    inverse_dft,
    leakage_pct,
    noise_amplitude,
    spectrum,
    window_values,
)
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.loop.sampled_signals import loop_signals
from looplab.engine.response import held_samples, simulate
from looplab.engine.systems import parse_transfer_function

samples = st.lists(st.floats(-1e3, 1e3, width=32), min_size=2, max_size=64)


@settings(max_examples=60, deadline=None)
@given(samples, st.sampled_from(["rectangular", "hann"]))
def test_definition_parseval_and_inverse(values: list[float], window: str) -> None:
    u = np.array(values)
    N = u.size
    n = np.arange(N)
    U = dft(u)
    by_definition = np.exp(-2j * np.pi * np.outer(n, n) / N) @ u / np.sqrt(N)
    scale = np.abs(u).max() * np.sqrt(N) + 1e-30
    assert np.abs(U - by_definition).max() <= 1e-12 * scale
    assert np.abs(inverse_dft(U) - u).max() <= 1e-13 * scale
    found = spectrum(u, 5.0, window)
    assert found.parseval_residual <= 1e-12
    assert found.inverse_error <= 1e-13 * scale
    assert found.energy == pytest.approx(float(((u * window_values(window, N)) ** 2).sum()), rel=1e-12)
    assert found.frequency[1] == pytest.approx(5.0 / N)
    assert found.omega == pytest.approx(2 * np.pi * found.frequency)


@settings(max_examples=60, deadline=None)
@given(st.floats(0, 1000), st.floats(0.5, 50), st.floats(-3, 3))
def test_the_alias_has_the_same_samples(frequency: float, rate: float, phase: float) -> None:
    t = np.arange(30) / rate
    sine = Sine(1.0, frequency, phase)
    seen, k = alias(frequency, rate)
    assert 0 <= seen <= rate / 2 * (1 + 1e-12)
    assert seen == pytest.approx(abs(frequency - k * rate))
    assert sine.aliased(rate)(t) == pytest.approx(sine(t), abs=1e-9 * (1 + frequency * 30 / rate))
    assert (k == 0) == (frequency <= rate / 2)


def test_amplitudes_are_those_of_the_sines() -> None:
    """Whole periods: no leakage, and the amplitude scale reads what was put in, in both windows."""
    t = np.arange(64) / 32.0
    u = sum_of_sines([Sine(3.0, 4.0, 0.3), Sine(0.5, 11.0)], t, offset=1.5)
    for window in ("rectangular", "hann"):
        found = spectrum(u, 32.0, window)
        assert found.amplitude[[0, 8, 22]] == pytest.approx([1.5, 3.0, 0.5], rel=1e-12)
        assert leakage_pct(found, [0.0, 4.0, 11.0], window) < 1e-20
    # 29 above half the rate of 32 is seen at 3.
    assert int(spectrum(Sine(1.0, 29.0)(t), 32.0).amplitude.argmax()) * 0.5 == 3.0


def test_leakage_of_a_half_bin() -> None:
    """A complex line half way between bins has sinc(1/2)^2 = 40.5 % in either; N large, so that its mirror is far."""
    N = 4096
    u = Sine(1.0, 1000.5)(np.arange(N) / N)
    rectangular = leakage_pct(spectrum(u, N), [1000.5], "rectangular")
    assert rectangular == pytest.approx(100 * (1 - (2 / np.pi) ** 2), abs=0.1)
    # Hann: the bins at +-1/2, 3/2 ...: (H(1/2)^2 + H(1/2)^2 + H(3/2)^2) over 3/8, H(x) = sinc(x)/(2 (1 - x^2)).
    hann = leakage_pct(spectrum(u, N, "hann"), [1000.5], "hann")
    H = np.sinc([0.5, -0.5, 1.5]) / (2 * (1 - np.array([0.5, -0.5, 1.5]) ** 2)) * np.array([1, 1, 1])
    assert hann == pytest.approx(100 * (1 - (H**2).sum() * 8 / 3), abs=0.1)


@pytest.mark.parametrize("text", ["1/(s+1)^2", "exp(-0.5s)/(2s+1)"])
def test_noise_in_a_loop_is_a_setpoint_of_the_other_sign(text: str) -> None:
    """y and u against the simulation of T and the controller's balance under held samples."""
    loop = FeedbackLoop(parse_transfer_function(text), PID(1.2, 2.0))
    found = loop_signals(loop, 20.0, 201, setpoint=2.0, noise=0.3, seed=5)
    assert found.n.std() == pytest.approx(0.3, rel=0.2)
    held = held_samples(found.t, 2.0 - found.n)
    direct = simulate(loop, held, float(found.t[-1]), found.t.size)
    y = np.interp(found.t, direct.t, direct.y)
    assert found.y == pytest.approx(y, abs=1e-9 if not loop.theta else 2e-3)
    assert found.e == pytest.approx(2.0 - found.y)
    # The proportional part jumps with the noise.
    assert found.u[0] == pytest.approx(1.2 * (2.0 - found.n[0]))


@pytest.mark.parametrize("window", ["rectangular", "hann"])
def test_noise_has_the_expected_spectrum(window: str) -> None:
    """Mean squares over 80 seeds and over the bins; bin by bin the line |H| itself is that of the pulse."""
    loop = FeedbackLoop(parse_transfer_function("1/(s+1)"), PID(2.0))
    expected = noise_amplitude(loop_signals(loop, 40.0, 128, noise=0.3).pulse_u, 0.3, window)
    power = np.zeros(65)
    for seed in range(80):
        found = loop_signals(loop, 40.0, 128, setpoint=0.0, noise=0.3, seed=seed)
        power += spectrum(found.u, 1.0 / float(found.t[1]), window).amplitude ** 2 / 80
    ratio = power[3:-1] / expected[3:-1] ** 2
    assert ratio.mean() == pytest.approx(1.0, abs=0.06)
    # T sampled with held noise: 2/3 (1 - q)/(z - q), q = e^{-3 Delta}; u = -2 (1 - that).
    q, z = np.exp(-3 * 40 / 127), np.exp(2j * np.pi * np.arange(65) / 128)
    w = window_values(window, 128)
    exact = 2 * 0.3 * np.abs(2 * (1 - 2 / 3 * (1 - q) / (z - q))) * np.sqrt((w**2).sum()) / w.sum()
    assert expected[1:-1] == pytest.approx(exact[1:-1], rel=1e-9)


def test_a_loop_with_a_load_and_a_weight() -> None:
    loop = FeedbackLoop(parse_transfer_function("1/(s+1)^2"), PID(1.2, 2.0, beta=0.5))
    found = loop_signals(loop, 60.0, 400, setpoint=1.0, load=0.7)
    assert found.y[-1] == pytest.approx(1.0, abs=1e-6)
    assert found.u[-1] == pytest.approx(0.3, abs=1e-6)
    assert found.u[0] == pytest.approx(0.6)
    with pytest.raises(InvalidInput):
        loop_signals(FeedbackLoop(parse_transfer_function("1/(s-1)"), PID(0.5)), 60.0, 400)


def test_bad_input() -> None:
    for call in (lambda: spectrum([1.0], 1.0), lambda: spectrum([1.0, np.nan], 1.0), lambda: spectrum([1.0, 2.0], 0.0)):
        with pytest.raises(InvalidInput):
            call()
    with pytest.raises(InvalidInput):
        spectrum([1.0, 2.0], 1.0, "hamming")  # type: ignore[arg-type]
