"""Approximate poles brought onto 1 + K L(s) = 0, against roots in closed form."""

import numpy as np
import pytest
from scipy.special import lambertw

from looplab.engine.stability.polish import polish_closed_loop_poles
from looplab.engine.systems import TransferFunction


@pytest.mark.parametrize("order", [1, 3, 12, 13, 50])
@pytest.mark.parametrize("miss", [1e-9, 1e-4, 1e-2])
def test_equal_lags(order: int, miss: float) -> None:
    """1/(s+1)^n: s = -1 + (-K)^(1/n)."""
    K = np.array([0.3, 2.0, 70.0])
    turns = np.exp(1j * np.pi * (2 * np.arange(order) + 1) / order)
    exact = -1 + K[:, None] ** (1 / order) * turns
    # Much nearer to its own root than to the next.
    away = miss / order * np.exp(2j * np.arange(order))
    found, good = polish_closed_loop_poles(TransferFunction((), [-1.0] * order), exact + away, K[:, None], steps=6)
    assert good.all()
    assert np.abs(found - exact).max() <= 2e-15 * np.abs(exact).max()


def test_an_integrator_with_dead_time() -> None:
    """exp(-s)/s: s = W_k(-K)."""
    K = np.array([0.1, 1.0, 20.0])[:, None]
    exact = lambertw(-K, np.array([-3, -1, 0, 2]))
    found, good = polish_closed_loop_poles(TransferFunction((), (0,), 1.0, 1.0), exact * (1 + 0.01j), K, steps=6)
    assert good.all()
    np.testing.assert_allclose(found, exact, rtol=1e-14)


@pytest.mark.parametrize("apart", [1e-2, 1e-5])
def test_beside_a_meeting_point(apart: float) -> None:
    """1/(s(s+2)): s = -1 +- sqrt(1 - K), so near each other that most digits of the distance are lost in 1 + K L."""
    K = 1 - apart**2
    exact = np.array([-1 - apart, -1 + apart], dtype=complex)
    found, good = polish_closed_loop_poles(TransferFunction((), (0, -2)), exact + 0.1 * apart, K, steps=6)
    assert good.all()
    assert np.abs(found - exact).max() <= 1e-15 / apart


def test_what_is_no_root_is_not_good() -> None:
    """No pole of 1/(s+1) is near s = 5 at K = 1; on an open-loop pole L is infinite."""
    found, good = polish_closed_loop_poles(TransferFunction((), (-1,)), np.array([5.0 + 0j, -1.0, -2.0]), 1.0)
    assert good.tolist() == [False, False, True]
    assert found[2] == -2.0
