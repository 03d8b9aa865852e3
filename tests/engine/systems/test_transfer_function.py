"""Zeros, poles and gain: values against direct evaluation, products, limits, and what is refused."""

import numpy as np
import pytest
from hypothesis import given

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.systems import FOPDT, SOPDT, TransferFunction, realize
from strategies import effort, systems

OMEGA = np.logspace(-2, 2, 41)


def test_response_is_the_product_of_the_factors_with_exact_dead_time() -> None:
    G = TransferFunction([-3], [0, 0, -2, -1 + 2j, -1 - 2j], 4.5, 0.1)
    s = 1j * OMEGA
    expected = 4.5 * (s + 3) / (s**2 * (s + 2) * (s**2 + 2 * s + 5)) * np.exp(-0.1 * s)
    np.testing.assert_allclose(G.response(OMEGA), expected, rtol=1e-13)


@effort(40)
@given(systems(stable=False, axis=True, theta=True, excess=0), systems(stable=False, theta=True))
def test_series_connection_multiplies(G: TransferFunction, H: TransferFunction) -> None:
    s = np.array([0.37 + 1.1j, 3.3 - 0.4j])
    np.testing.assert_allclose((G * H)(s), G(s) * H(s), rtol=1e-12)
    assert (G * H).theta == pytest.approx(G.theta + H.theta)
    assert (G * H).order == G.order + H.order


@effort(40)
@given(systems(order=(1, 6), stable=False, excess=0))
def test_state_space_has_the_same_transfer_function(G: TransferFunction) -> None:
    ss = realize(G)
    for s in (0.4 + 1.7j, 12.0 + 0j, 0.03j):
        if min(abs(s - p) for p in G.poles) < 1e-3:
            continue
        value = ss.C @ np.linalg.solve(s * np.eye(ss.B.size) - ss.A, ss.B.astype(complex)) + ss.D
        assert value == pytest.approx(G(s), rel=1e-9, abs=1e-12)
    eig = np.sort_complex(np.linalg.eigvals(ss.A))
    assert np.abs(np.poly(eig) - np.poly(G.poles)).max() <= 1e-6 * np.abs(np.poly(G.poles)).max()


def test_order_fifty_neither_overflows_nor_loses_digits() -> None:
    G = TransferFunction((), [-1.0] * 50, 1.0)
    assert abs(G(1j)) == pytest.approx(2.0**-25, rel=1e-13)
    big = TransferFunction((), [-1e7] * 50, 1e308, 0.0)
    assert np.isfinite(big(1j))


def test_clusters_are_not_expanded() -> None:
    """Expanded to coefficients, ten roots at -1 come back up to 0.05 away; here they are kept."""
    G = TransferFunction((), [-1.0] * 10, 1.0)
    assert (G.poles == -1).all()
    assert np.abs(np.roots(np.poly(G.poles)) + 1).max() > 0.02


@pytest.mark.parametrize(
    ("zeros", "poles", "gain", "dc"),
    [([], [-2], 4, 2.0), ([0], [-1], 1, 0.0), ([], [0], 1, np.inf), ([], [0], -1, -np.inf), ([1], [-2, -3], 6, -1.0),
     ([], [1], 2, -2.0), ([], [], 3, 3.0), ([0], [0, -2], 5, 2.5), ([], [-1 + 1j, -1 - 1j], 2, 1.0)],
)  # fmt: skip
def test_dc_gain(zeros: list[complex], poles: list[complex], gain: float, dc: float) -> None:
    assert TransferFunction(zeros, poles, gain).dc_gain == pytest.approx(dc)


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        (dict(theta=-0.1), "theta"),
        (dict(theta=np.nan), "theta"),
        (dict(theta=np.inf), "theta"),
        (dict(gain=np.nan), "gain"),
        (dict(gain=np.inf), "gain"),
        (dict(poles=[np.nan]), "poles"),
        (dict(poles=[1j]), "poles"),
        (dict(zeros=[1 + 1j, 1 + 1j], poles=[-1, -2]), "zeros"),
        (dict(poles=[-1.0] * 201), "poles"),
    ],
)
def test_what_is_refused(arguments: dict, field: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        TransferFunction(**arguments)
    assert caught.value.field == field
    assert caught.value.message


@pytest.mark.parametrize(
    ("num", "den", "field"),
    [([1], [0, 0], "den"), ([1], [], "den"), ([], [1], "num"), ([np.nan], [1, 1], "num"), ([1], [1, np.inf], "den"),
     ([1], [1.0] * 52, "den"), ([[1, 2]], [1], "num")],
)  # fmt: skip
def test_polynomials_that_are_refused(num: list, den: list, field: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        TransferFunction.from_polynomials(num, den)
    assert caught.value.field == field


def test_leading_zeros_and_roots_at_the_origin() -> None:
    G = TransferFunction.from_polynomials([0, 0, 2, 0], [0, 1, 3, 2, 0, 0])
    assert G.gain == 2
    assert G.zeros.tolist() == [0]
    assert sorted(G.poles.real) == pytest.approx([-2, -1, 0, 0])
    assert np.count_nonzero(G.poles == 0) == 2


def test_improper_systems_are_allowed_until_they_must_be_simulated() -> None:
    D = TransferFunction([0], [], 1.0)
    assert not D.is_proper
    with pytest.raises(ImproperSystem) as caught:
        D.require_proper("controller")
    assert caught.value.field == "controller"
    assert "0.01 s + 1" in caught.value.hint


def test_systems_are_values() -> None:
    a, b = TransferFunction((), (-1,), 2.0, 0.5), TransferFunction((), (-1,), 2.0, 0.5)
    assert a == b
    assert hash(a) == hash(b)
    assert a != TransferFunction((), (-1,), 2.0, 0.6)
    with pytest.raises(AttributeError):
        a.gain = 3.0
    with pytest.raises(ValueError, match="read-only"):
        a.poles[0] = 0


@pytest.mark.parametrize("theta", [0.0, 0.7])
def test_first_and_second_order_models(theta: float) -> None:
    s = 1j * OMEGA
    G = FOPDT(2.0, 5.0, theta).to_transfer_function()
    np.testing.assert_allclose(G(s), 2 / (5 * s + 1) * np.exp(-theta * s), rtol=1e-13)
    for zeta in (0.0, 0.3, 1.0, 2.5, -0.2):
        G = SOPDT(2.0, 3.0, zeta, theta).to_transfer_function()
        np.testing.assert_allclose(G(s), 2 / (9 * s**2 + 6 * zeta * s + 1) * np.exp(-theta * s), rtol=1e-12)


@pytest.mark.parametrize(
    ("model", "field"),
    [(lambda: FOPDT(1, 0, 0), "tau"), (lambda: FOPDT(1, -1, 0), "tau"), (lambda: FOPDT(0, 1, 0), "K"),
     (lambda: FOPDT(1, 1, -1), "theta"), (lambda: FOPDT(np.inf, 1, 0), "K"), (lambda: SOPDT(1, 1, np.nan), "zeta"),
     (lambda: SOPDT(1, 0, 0.5), "tau")],
)  # fmt: skip
def test_models_say_what_is_wrong(model, field: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        model()
    assert caught.value.field == field
