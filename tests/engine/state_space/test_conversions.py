"""State space to transfer function and back, ODE coefficients, minimal forms, python-control."""

import control
import numpy as np
import pytest
import scipy.linalg
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.state_space import (
    StateSpaceModel,
    from_control,
    from_ode,
    initial_state,
    invariant_zeros,
    minimal,
    to_control,
    to_transfer_function,
)
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, numbers, systems

POINTS = (0.37 + 1.1j, 3.3 - 0.4j, 20.0 + 3.0j)


@effort(60)
@given(systems(order=(0, 6), stable=False, axis=True, excess=0))
def test_there_and_back(G: TransferFunction) -> None:
    H = to_transfer_function(StateSpaceModel.from_transfer_function(G))
    assert H.zeros.size == G.zeros.size and H.origin_order == G.origin_order
    assert H.gain == pytest.approx(G.gain, rel=1e-12)
    for s in POINTS:
        assert H(s) == pytest.approx(G(s), rel=1e-10)


@effort(40)
@given(systems(order=(1, 5), stable=False, excess=0), st.integers(0, 2**32 - 1))
def test_coordinates_do_not_matter(G: TransferFunction, seed: int) -> None:
    T = scipy.linalg.qr(np.random.default_rng(seed).normal(size=(G.order, G.order)))[0]
    model = StateSpaceModel.from_transfer_function(G).transformed(T)
    H = to_transfer_function(model)
    assert H.zeros.size == G.zeros.size
    for s in POINTS:
        assert H(s) == pytest.approx(G(s), rel=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_invariant_zeros_are_the_finite_generalised_eigenvalues(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = 4 + seed % 3
    model = StateSpaceModel(
        rng.normal(size=(n, n)), rng.normal(size=(n, 2)), rng.normal(size=(3, n)), rng.normal(size=(3, 2)) * (seed % 2)
    )
    channel = model.channel(2, 1)
    pencil = np.block([[model.A, channel.B[:, None]], [channel.C[None, :], np.array([[channel.D]])]])
    weight = np.diag([1.0] * n + [0.0])
    found = scipy.linalg.eigvals(pencil, weight)
    found = found[np.isfinite(found) & (np.abs(found) < 1e5)]
    zeros, _ = invariant_zeros(model, 2, 1)
    assert zeros.size == (n if seed % 2 else n - 1)
    for z in found:
        assert np.abs(zeros - z).min() <= 1e-8 * abs(z)
    for z in zeros:  # the definition: the system matrix loses rank there
        sigma = np.linalg.svd(pencil - z * weight, compute_uv=False)
        assert sigma[-1] < 1e-12 * sigma[0]


def test_a_channel_that_passes_nothing_is_zero() -> None:
    G = to_transfer_function(StateSpaceModel([[-1, 0], [0, -2]], [[1], [0]], [[0, 1]]))
    assert G.gain == 0
    assert G.zeros.size == 0
    assert sorted(G.poles.real) == [-2, -1]


def test_integrators_in_a_row_stay_at_the_origin_in_any_coordinates() -> None:
    T = np.random.default_rng(3).normal(size=(4, 4))
    G = to_transfer_function(StateSpaceModel.from_transfer_function(parse_transfer_function("1/s^4")).transformed(T))
    assert np.array_equal(G.poles, np.zeros(4))
    assert G.gain == pytest.approx(1, rel=1e-9)


@pytest.mark.parametrize("form", ["phase", "controllable", "observable"])
def test_companion_forms(form: str) -> None:
    """2 y''' + 12 y'' + 22 y' + 12 y = 4 u''' + 2 u' + 6 u."""
    model = from_ode([2, 12, 22, 12], [4, 0, 2, 6], form)  # type: ignore[arg-type]
    for s in POINTS:
        value = (4 * s**3 + 2 * s + 6) / (2 * s**3 + 12 * s**2 + 22 * s + 12)
        assert model(s)[0, 0] == pytest.approx(value, rel=1e-12)
        assert to_transfer_function(model)(s) == pytest.approx(value, rel=1e-12)
    assert sorted(model.poles.real) == pytest.approx([-3, -2, -1])


def test_phase_form_of_the_book() -> None:
    """Ogata, Modern Control Engineering, 5th ed., example A-2-4 (b2 = 25.04, b3 = 5.008): beta = 0, 25.04, -121.0."""
    model = from_ode([1, 5.03247, 25.1026, 5.008], [25.04, 5.008])
    np.testing.assert_array_equal(model.A, [[0, 1, 0], [0, 0, 1], [-5.008, -25.1026, -5.03247]])
    np.testing.assert_allclose(model.B[:, 0], [0, 25.04, 5.008 - 25.04 * 5.03247])
    np.testing.assert_array_equal(model.C, [[1, 0, 0]])


def test_without_input_derivatives_the_states_are_y_and_its_derivatives() -> None:
    model = from_ode([1, 3, 2], [5])
    np.testing.assert_array_equal(model.B, [[0], [5]])
    np.testing.assert_allclose(initial_state(model, [1, -2]), [1, -2], rtol=1e-14)


@effort(40)
@given(systems(order=(1, 5), stable=False), st.lists(numbers(-3, 3), min_size=5, max_size=5))
def test_initial_state_shows_the_initial_values(G: TransferFunction, y: list[float]) -> None:
    model = StateSpaceModel.from_transfer_function(G)
    if minimal(G, 1e-2).cancelled:
        return
    wanted = y[: G.order]
    x = initial_state(model, wanted)
    size = max(1.0, np.abs(G.poles).max()) ** G.order
    for value in wanted:
        assert float(model.C[0] @ x) == pytest.approx(value, abs=1e-6 * size)
        x = model.A @ x


def test_static_gain_and_first_order_ode() -> None:
    assert from_ode([2], [6]).D[0, 0] == 3
    assert to_transfer_function(from_ode([2], [6])).dc_gain == 3
    assert to_transfer_function(from_ode([5, 1], [1])).dc_gain == pytest.approx(1)


@pytest.mark.parametrize(
    ("a", "b", "field"), [([0, 0], [1], "a"), ([1, 2], [float("nan")], "b"), ([1] * 60, [1], "a"), ([[1]], [1], "a")]
)
def test_bad_coefficients_are_named(a: list, b: list, field: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        from_ode(a, b)
    assert caught.value.field == field


def test_improper_equation_is_named_as_such() -> None:
    with pytest.raises(ImproperSystem, match="differentiate"):
        from_ode([1, 1], [1, 0, 0])


@pytest.mark.parametrize(
    ("matrices", "field"),
    [
        (([[1, 2]], [[1]], [[1, 2]], [[0]]), "A"),
        (([[1, 2], [3, 4]], [[1]], [[1, 2]], [[0]]), "B"),
        (([[1, 2], [3, 4]], [[1], [1]], [[1]], [[0]]), "C"),
        (([[1, 2], [3, 4]], [[1], [1]], [[1, 1]], [[0, 1]]), "D"),
        (([[1, 2], [3]], [[1], [1]], [[1, 1]], [[0]]), "A"),
        (([[float("inf")]], [[1]], [[1]], [[0]]), "A"),
        (([["x"]], [[1]], [[1]], [[0]]), "A"),
        ((np.eye(51), np.ones((51, 1)), np.ones((1, 51)), [[0]]), "A"),
    ],
)
def test_bad_matrices_are_named(matrices: tuple, field: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        StateSpaceModel(*matrices)
    assert caught.value.field == field
    assert caught.value.message


def test_models_are_values() -> None:
    model, same = (StateSpaceModel([[-1]], [[1]], [[1]]) for _ in range(2))
    assert model == same and hash(model) == hash(same) and model.D[0, 0] == 0
    assert model != StateSpaceModel([[-2]], [[1]], [[1]])
    with pytest.raises(ValueError, match="read-only"):
        model.A[0, 0] = 3
    with pytest.raises(InvalidInput, match="no output 1"):
        model.channel(1, 0)
    two = StateSpaceModel([[-1]], [[1, 2]], [[1]])
    with pytest.raises(InvalidInput, match="2 inputs"):
        two.require_single()


def test_minimal_form_says_what_was_cancelled_and_how_far_the_next_pair_is() -> None:
    G = parse_transfer_function("(s-1)(s+3)(s^2+s+4)/((s-1)(s+3.001)(s^2+s+4)(s+7))")
    found = minimal(G, 1e-6)
    assert found.system.order == 2
    assert {c.pole.real for c in found.cancelled} == {1.0, -0.5}
    assert [c.stable for c in found.cancelled if c.pole.real == 1] == [False]
    assert found.closest_kept == pytest.approx(0.001 / 3.001)
    assert minimal(G, 1e-3).system.order == 1
    for s in POINTS:
        assert found.system(s) == pytest.approx(G(s), rel=1e-12)


def test_a_real_zero_is_not_cancelled_against_one_of_a_pair() -> None:
    G = TransferFunction([-1], [-1 + 1e-10j, -1 - 1e-10j])
    assert minimal(G, 1e-6).cancelled == ()


def test_zeros_at_the_origin_cancel_integrators_only() -> None:
    assert minimal(parse_transfer_function("s/(s^2 (s+1))")).system.origin_order == 1
    assert minimal(parse_transfer_function("s/((s+1e-3)(s+1))"), 1e-2).cancelled == ()
    with pytest.raises(InvalidInput, match="tolerance"):
        minimal(parse_transfer_function("1/s"), 0.5)


@effort(30)
@given(systems(order=(1, 5), stable=False, excess=0))
def test_control_and_back(G: TransferFunction) -> None:
    there = to_control(G)
    back = from_control(there)
    assert isinstance(back, StateSpaceModel)
    for s in POINTS:
        assert there(s) == pytest.approx(G(s), rel=1e-9)
        assert back(s)[0, 0] == pytest.approx(G(s), rel=1e-9)


def test_control_transfer_functions_and_what_is_refused() -> None:
    G = from_control(control.tf([1, 3], [1, 2, 0]))
    assert isinstance(G, TransferFunction) and G.to_text() == "(s + 3)/(s (s + 2))"
    for bad, word in (
        (control.tf([1], [1, 0.5], dt=0.1), "discrete"),
        (control.tf([[[1], [1]]], [[[1, 1], [1, 2]]]), "matrix"),
        (3.0, "float"),
    ):
        with pytest.raises(InvalidInput, match=word):
            from_control(bad)
    with pytest.raises(InvalidInput, match="dead time"):
        to_control(parse_transfer_function("exp(-s)/(s+1)"))
