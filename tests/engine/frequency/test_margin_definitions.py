"""What the margins mean, on random loops: each stated number put back into the exact L(i omega)."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from independent import rhp_closed_loop_poles
from looplab.engine.frequency import margins
from looplab.engine.systems import TransferFunction
from strategies import effort, systems

loops = (
    systems(order=(1, 5), stable=True, axis=False)
    | systems(order=(1, 4), theta=True)
    | systems(order=(2, 4), stable=False)
)


@effort(60)
@given(loops)
def test_crossovers_are_where_they_say(L: TransferFunction) -> None:
    found = margins(L)
    for c in found.phase_crossovers:
        value = L(1j * c.omega)
        assert value.real < 0
        assert abs(value.imag) <= 1e-9 * abs(value)
        assert c.GM * abs(value) == pytest.approx(1.0, rel=1e-10)
    for c in found.gain_crossovers:
        value = L(1j * c.omega)
        assert abs(value) == pytest.approx(1.0, rel=1e-10)
        assert -180 < c.PM_deg <= 180
        assert np.exp(1j * np.radians(c.PM_deg)) == pytest.approx(-value, abs=1e-8)


@effort(60)
@given(loops)
def test_no_crossover_is_missed(L: TransferFunction) -> None:
    """Changes of sign on a dense grid are all listed (dead time: as far as GM = 20)."""
    found = margins(L)
    omega = np.logspace(-4, 3, 30001)
    if L.theta:
        omega = omega[omega < 20 / L.theta]
    value = L.response(omega)
    size = np.log(np.abs(value))
    for i in np.flatnonzero(size[1:] * size[:-1] < 0):
        assert any(
            omega[i] <= c.omega * (1 + 1e-9) and c.omega <= omega[i + 1] * (1 + 1e-9) for c in found.gain_crossovers
        )
    value = np.where(np.abs(value.imag) > 1e-9 * np.abs(value), value, np.nan)  # neither on the axis all along
    left = (value.real[1:] < 0) & (value.real[:-1] < 0) & (np.abs(value[1:]) > 0.051) & (np.abs(value[1:]) < 1e6)
    for i in np.flatnonzero((value.imag[1:] * value.imag[:-1] < 0) & left):
        assert any(
            omega[i] <= c.omega * (1 + 1e-9) and c.omega <= omega[i + 1] * (1 + 1e-9) for c in found.phase_crossovers
        )


@effort(40)
@given(loops)
def test_peaks_bound_the_sensitivities(L: TransferFunction) -> None:
    found = margins(L)
    omega = np.logspace(-3, 3, 8001)
    value = L.response(omega)
    for name, size in (("Ms", np.abs(1 / (1 + value))), ("Mt", np.abs(value / (1 + value)))):
        peak, at = getattr(found, name), getattr(found, f"omega_{name}")
        if peak is None:
            continue
        assert size.max() <= peak * (1 + 1e-9)
        if at:
            there = L(1j * at)
            assert abs((1 if name == "Ms" else there) / (1 + there)) == pytest.approx(peak, rel=1e-9)


@effort(40)
@given(systems(order=(1, 4)) | systems(order=(1, 3), theta=True))
def test_gain_margin_is_the_limit_of_the_gain(L: TransferFunction) -> None:
    """With a single phase crossover the loop changes its count of unstable poles exactly at K = GM."""
    found = margins(L)
    assume(found.GM is not None)
    assume(sum(abs(np.log(c.GM / found.GM)) < 0.02 for c in found.phase_crossovers) == 1)
    poles, zeros = list(L.poles), list(L.zeros)
    below, above = (rhp_closed_loop_poles(zeros, poles, L.gain * found.GM * k, L.theta) for k in (1 - 1e-4, 1 + 1e-4))
    assert abs(above - below) == (1 if found.omega_180 == 0 else 2)


@effort(40)
@given(systems(order=(1, 4)) | systems(order=(1, 3), theta=True))
def test_delay_margin_is_the_limit_of_the_dead_time(L: TransferFunction) -> None:
    found = margins(L)
    assume(found.closed_loop_stable)
    assume(found.delay_margin is not None)
    assume(all(abs(c.PM_deg) > 0.1 for c in found.gain_crossovers))
    poles, zeros, dm = list(L.poles), list(L.zeros), found.delay_margin
    assert rhp_closed_loop_poles(zeros, poles, L.gain, L.theta + dm * (1 - 1e-3)) == 0
    assert rhp_closed_loop_poles(zeros, poles, L.gain, L.theta + dm * (1 + 1e-3)) >= 2


@pytest.mark.parametrize("excess", [1e-2, 1e-3, 1e-5, 1e-7])
def test_two_crossovers_between_grid_points(excess: float) -> None:
    """A resonance that reaches just over 1: K/(s^2 + 2 zeta s + 1) peaks at 1/(2 zeta sqrt(1 - zeta^2)).

    |L| = 1 where (1 - w^2)^2 + (2 zeta w)^2 = K^2, a quadratic in w^2.
    """
    zeta = 0.3
    K = 2 * zeta * np.sqrt(1 - zeta**2) * (1 + excess)
    found = margins(TransferFunction.from_polynomials([K], [1, 2 * zeta, 1]))
    b, c = 2 * zeta**2 - 1, 1 - K**2
    expected = [np.sqrt(-b - np.sqrt(b * b - c)), np.sqrt(-b + np.sqrt(b * b - c))]
    assert [x.omega for x in found.gain_crossovers] == pytest.approx(expected, rel=1e-15 / excess + 1e-12)
    assert found.PM_deg is not None
    assert found.delay_margin is not None


@pytest.mark.parametrize("gain", [0.0])
def test_a_loop_without_gain(gain: float) -> None:
    found = margins(TransferFunction((), (-1.0,), gain))
    assert found.closed_loop_stable
    assert found.GM is None
    assert found.Ms == 1.0
    assert found.reasons["GM"]


@given(st.sampled_from([0.2, 1.0, 5.0]))
@effort(3)
def test_closed_form_integrator_with_dead_time(theta: float) -> None:
    """K e^{-theta s}/s: omega_c = K, omega_180 = pi/(2 theta), GM = pi/(2 K theta), PM = 90 deg - K theta."""
    K = 0.7 / theta
    found = margins(TransferFunction((), (0.0,), K, theta))
    assert found.omega_c == pytest.approx(K, rel=1e-14)
    assert found.omega_180 == pytest.approx(np.pi / (2 * theta), rel=1e-14)
    assert found.GM == pytest.approx(np.pi / (2 * K * theta), rel=1e-14)
    assert found.PM_deg == pytest.approx(90 - np.degrees(0.7), abs=1e-12)
    assert found.delay_margin == pytest.approx((np.pi / 2 - 0.7) / K, rel=1e-13)
