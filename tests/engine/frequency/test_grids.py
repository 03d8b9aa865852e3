"""Grids and curves over frequency: dense where the curve bends, sparse on asymptotes, and exact wherever sampled."""

import numpy as np
import pytest

from looplab.engine.frequency.response import frequency_grid, log_magnitude, phase_rad, rate
from looplab.engine.frequency.sampled import UnitCurve, search_curve
from looplab.engine.systems import parse_transfer_function

TEXTS = ["exp(-0.3 s)/(s+1)", "(s-2)(s^2+0.1s+4)/(s (s+1)^3 (s^2+s+9))", "s/(s+1)^2", "exp(-2 s)"]
OMEGA = np.logspace(-3, 3, 61)


def test_the_rate_of_a_lag_with_dead_time_is_its_closed_form() -> None:
    """G = exp(-theta s)/(tau s + 1): omega G'/G = -omega theta - omega tau/(1 + i omega tau)."""
    found = rate(parse_transfer_function("exp(-0.3 s)/(2 s+1)"), OMEGA)
    np.testing.assert_allclose(found, -0.3 * OMEGA - 2 * OMEGA / (1 + 2j * OMEGA), rtol=1e-14)


@pytest.mark.parametrize("text", TEXTS)
def test_the_rate_is_what_phase_and_magnitude_do(text: str) -> None:
    """Its parts are the slopes of the phase and of -ln|G| over ln omega, here by central differences."""
    G, h = parse_transfer_function(text).unit, 1e-5
    up, down = OMEGA * np.exp(h), OMEGA * np.exp(-h)
    found = rate(G, OMEGA)
    scale = 1.0 + np.abs(found).max()
    np.testing.assert_allclose(found.real, (phase_rad(G, up) - phase_rad(G, down)) / (2 * h), atol=1e-6 * scale)
    np.testing.assert_allclose(
        -found.imag, (log_magnitude(G, up) - log_magnitude(G, down)) / (2 * h), atol=1e-6 * scale
    )


@pytest.mark.parametrize("text", TEXTS)
def test_added_points_are_as_exact_as_the_others(text: str) -> None:
    G = parse_transfer_function(text).unit
    curve = UnitCurve(G, OMEGA)
    assert curve.phase.size == curve.rate.size == OMEGA.size
    more = [0.0123, 0.77, float(OMEGA[7]), 55.0]
    grown = curve.with_points(more)
    np.testing.assert_array_equal(grown.omega, np.unique([*OMEGA, *more]))
    assert {"phase", "rate"} <= set(vars(grown))
    np.testing.assert_allclose(grown.phase, phase_rad(G, grown.omega), rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(grown.rate, rate(G, grown.omega), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(grown.log_magnitude, log_magnitude(G, grown.omega), rtol=1e-12, atol=1e-12)


def test_a_grid_is_sparse_where_the_curve_follows_its_asymptotes() -> None:
    G = parse_transfer_function("1/((s+1)(s+3))")
    grid = frequency_grid(G, 1e-4, 1e5, on_asymptotes=10)
    assert grid[0] == 1e-4
    assert grid[-1] == 1e5
    steps = np.diff(np.log10(grid))
    near = (grid[1:] <= 30.0) & (grid[:-1] >= 0.1)
    assert steps[near].max() <= (1 + 1e-9) / 40
    assert 1 / 11 < steps[grid[1:] < 0.09].min() <= steps.max() <= (1 + 1e-9) / 10


@pytest.mark.parametrize("text", ["(s^2+0.02s+1)/(s^2+0.02s+1.1)/(s+1)", "(s+1)^2/(s (s+0.1) (s+10)^2)"])
def test_every_turn_of_magnitude_and_phase_is_on_the_search_grid(text: str) -> None:
    """Between neighbours both are monotone: no two crossings hide there."""
    curve = search_curve(parse_transfer_function(text).unit, 1e-4, 1e4)
    x = np.log(curve.omega)
    inside = np.exp(x[:-1, None] + np.linspace(0.02, 0.98, 25) * np.diff(x)[:, None])
    for part in (curve.unit.log_derivative(1j * inside).real, curve.unit.log_derivative(1j * inside).imag):
        significant = np.where(np.abs(part * inside) > 1e-9, np.sign(part), 0.0)
        assert (significant.max(axis=1) - significant.min(axis=1) < 2).all()
