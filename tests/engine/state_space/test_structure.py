"""Controllability, observability and Gramians: definitions, values, Kalman's test against the test of each mode."""

import control
import numpy as np
import pytest
import scipy.linalg
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space import (
    StateSpaceModel,
    analyse_structure,
    controllability_matrix,
    from_ode,
    gramians,
    observability_matrix,
)
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems


def test_matrices_of_a_second_order_model() -> None:
    model = StateSpaceModel([[0, 1], [-2, -3]], [[0], [1]], [[1, 1]])
    np.testing.assert_array_equal(controllability_matrix(model), [[0, 1], [1, -3]])
    np.testing.assert_array_equal(observability_matrix(model), [[1, 1], [-2, -2]])


@pytest.mark.parametrize("seed", range(3))
def test_matrices_are_those_of_python_control(seed: int) -> None:
    rng = np.random.default_rng(seed)
    A, B, C = rng.normal(size=(4, 4)), rng.normal(size=(4, 2)), rng.normal(size=(3, 4))
    model = StateSpaceModel(A, B, C)
    np.testing.assert_allclose(controllability_matrix(model), control.ctrb(A, B), rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(observability_matrix(model), control.obsv(A, C), rtol=1e-10, atol=1e-12)


def test_a_hidden_mode_is_found_and_named() -> None:
    """(s+1)/((s+1)(s+2)) in controllable form: the mode at -1 cannot be seen; in observable form it cannot be moved."""
    a, b = [1, 3, 2], [1, 1]
    unseen = analyse_structure(from_ode(a, b, "controllable"))
    assert (unseen.controllability.rank, unseen.observability.rank) == (2, 1)
    assert [m.pole.real for m in unseen.modes if not m.observable] == pytest.approx([-1])
    assert not unseen.minimal and unseen.detectable and unseen.stabilizable
    unmoved = analyse_structure(from_ode(a, b, "observable"))
    assert [m.pole.real for m in unmoved.modes if not m.controllable] == pytest.approx([-1])
    assert unmoved.observability.full and not unmoved.controllability.full


def test_an_unstable_hidden_mode_cannot_be_stabilised() -> None:
    found = analyse_structure(StateSpaceModel(np.diag([1.0, -2.0]), [[0], [1]], [[1, 1]]))
    assert not found.stabilizable and found.detectable
    assert not analyse_structure(StateSpaceModel(np.diag([1.0, -2.0]), [[1], [1]], [[0, 1]])).detectable


def test_two_equal_modes_need_two_inputs() -> None:
    one = analyse_structure(StateSpaceModel(-np.eye(2), [[1], [2]], [[1, 0]]))
    assert one.controllability.rank == 1 and not one.controllability.full
    assert analyse_structure(StateSpaceModel(-np.eye(2), np.eye(2), [[1, 0]])).controllability.full


@effort(60)
@given(systems(order=(1, 5), stable=False, axis=True), st.integers(0, 2), st.integers(0, 2**32 - 1))
def test_the_test_of_each_mode_is_the_rank_test(G: TransferFunction, hidden: int, seed: int) -> None:
    """A model with known hidden modes, in random orthogonal coordinates."""
    rng = np.random.default_rng(seed)
    poles = np.unique(np.round(G.poles, 6))
    if poles.size < G.order or np.abs(poles[:, None] - poles)[~np.eye(G.order, dtype=bool)].min(initial=1) < 0.05:
        return
    base = StateSpaceModel.from_transfer_function(TransferFunction([], G.poles, 1.0))
    extra = -11.0 - np.arange(hidden)
    n = G.order + hidden
    A = scipy.linalg.block_diag(base.A, np.diag(extra))
    B = np.vstack([base.B, np.zeros((hidden, 1))])
    C = np.hstack([base.C, np.ones((1, hidden))])
    T = scipy.linalg.qr(rng.normal(size=(n, n)))[0]
    model = StateSpaceModel(A, B, C).transformed(T)
    found = analyse_structure(model)
    assert found.controllability.full == (hidden == 0)
    assert found.controllability.rank == G.order == n - hidden
    assert sorted(m.pole.real for m in found.modes if not m.controllable) == pytest.approx(sorted(extra), rel=1e-6)
    dual = analyse_structure(model.dual())
    assert dual.observability.rank == found.controllability.rank
    assert [m.observable for m in dual.modes].count(False) == hidden


@pytest.mark.parametrize("unit", [1e-6, 1.0, 3600.0])
def test_units_do_not_change_the_verdict(unit: float) -> None:
    model = StateSpaceModel.from_transfer_function(parse_transfer_function("(s+3)/((s+1)(s+2)(s+4)(s+5))"))
    same = StateSpaceModel(model.A / unit, model.B * 1e3, model.C / unit)
    found, reference = analyse_structure(same), analyse_structure(model)
    assert found.minimal and reference.minimal
    for ours, theirs in (
        (found.controllability, reference.controllability), (found.observability, reference.observability),
    ):  # fmt: skip
        np.testing.assert_allclose(ours.singular_values, theirs.singular_values, rtol=1e-6)


def test_high_order_where_the_matrix_loses_its_digits() -> None:
    model = StateSpaceModel.from_transfer_function(TransferFunction([], -np.geomspace(0.1, 10, 20), 1.0))
    found = analyse_structure(model)
    assert found.controllability.full
    assert found.controllability.rank < 20
    assert "lose digits" in str(found.controllability.reason)


def test_repeated_poles_of_the_notes_are_controllable_and_observable() -> None:
    found = analyse_structure(StateSpaceModel.from_transfer_function(parse_transfer_function("1/(s+1)^3")))
    assert found.minimal and found.controllability.rank == found.observability.rank == 3


def test_static_gain() -> None:
    found = analyse_structure(StateSpaceModel(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), [[2]]))
    assert found.minimal and found.modes == () and found.controllability.rank == 0


def test_gramians_of_a_first_order_lag() -> None:
    """x' = -a x + b u: Wc = b^2/(2a), Wo = c^2/(2a), Hankel value |b c|/(2a)."""
    found = gramians(StateSpaceModel([[-4]], [[3]], [[2]]))
    assert found.controllability[0, 0] == pytest.approx(9 / 8, rel=1e-14)
    assert found.observability[0, 0] == pytest.approx(4 / 8, rel=1e-14)
    assert found.hankel_singular_values[0] == pytest.approx(6 / 8, rel=1e-14)


@effort(60)
@given(systems(order=(1, 6), stable=True))
def test_gramians_solve_lyapunovs_equations(G: TransferFunction) -> None:
    model = StateSpaceModel.from_transfer_function(G)
    found = gramians(model)
    A, B, C = model.A, model.B, model.C
    for W, a, q in ((found.controllability, A, B @ B.T), (found.observability, A.T, C.T @ C)):
        residual = a @ W + W @ a.T + q
        scale = np.abs(a).max() * np.abs(W).max() + np.abs(q).max()
        assert np.abs(residual).max() <= 1e-12 * scale
        assert np.linalg.eigvalsh(W).min() >= -1e-12 * np.abs(W).max()
    squares = np.sort(np.linalg.eigvals(found.controllability @ found.observability).real)[::-1]
    assert found.hankel_singular_values[0] ** 2 == pytest.approx(squares[0], rel=1e-8)


def test_gramian_is_the_integral_it_is_defined_by() -> None:
    model = StateSpaceModel.from_transfer_function(parse_transfer_function("(s+3)/((s+1)(s^2+s+4))"))
    t, weights = np.polynomial.legendre.leggauss(400)
    t, weights = 30 * (t + 1), 30 * weights
    x = np.stack([scipy.linalg.expm(model.A * s) @ model.B[:, 0] for s in t])
    integral = np.einsum("k,ki,kj->ij", weights, x, x)
    np.testing.assert_allclose(gramians(model).controllability, integral, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize(("text", "at"), [("1/s", "at 0 "), ("1/(s-2)", "at 2 "), ("1/(s^2+9)", "± 3j")])
def test_no_gramian_without_decay(text: str, at: str) -> None:
    found = gramians(StateSpaceModel.from_transfer_function(parse_transfer_function(text)))
    assert found.controllability is None and found.observability is None and found.hankel_singular_values is None
    assert at in str(found.reason)


def test_tolerance_out_of_range() -> None:
    with pytest.raises(InvalidInput, match="tolerance"):
        analyse_structure(from_ode([1, 1], [1]), 0.5)
