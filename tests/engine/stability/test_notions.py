"""Lyapunov, asymptotic, marginal, unstable, BIBO: Jordan blocks decide, whatever the coordinates."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import block_diag, expm

from looplab.engine.errors import InvalidInput
from looplab.engine.loop import FeedbackLoop
from looplab.engine.stability import (
    axis_poles_are_simple,
    bibo,
    matrix_stability,
    state_space_bibo,
    system_stability,
)
from looplab.engine.systems import TransferFunction, parse_transfer_function, realize
from strategies import effort, systems


def jordan(eigenvalue: complex, size: int) -> np.ndarray:
    """Real Jordan block."""
    if eigenvalue.imag == 0:
        return eigenvalue.real * np.eye(size) + np.eye(size, k=1)
    a, w = eigenvalue.real, eigenvalue.imag
    return np.kron(np.eye(size), [[a, w], [-w, a]]) + np.kron(np.eye(size, k=1), np.eye(2))


BLOCKS = st.lists(
    st.tuples(st.sampled_from([0j, 0j, 1j, 2j, -1 + 0j, -2 + 1j, -0.5 + 0j]), st.integers(1, 2)), min_size=1, max_size=3
)


@effort(150)
@given(BLOCKS, st.integers(0, 10**6), st.booleans())
def test_the_structure_decides_in_any_coordinates(blocks: list[tuple[complex, int]], seed: int, grows: bool) -> None:
    blocks = [*blocks, (0.3 + 1j, 1)] if grows else blocks
    A = block_diag(*[jordan(e, m) for e, m in blocks])
    rng = np.random.default_rng(seed)
    Q, _ = np.linalg.qr(rng.normal(size=A.shape))
    T = Q @ np.diag(rng.uniform(0.5, 2.0, A.shape[0]))
    found = matrix_stability(T @ A @ np.linalg.inv(T))
    axis = [(e, m) for e, m in blocks if e.real == 0]
    if grows or any(m > 1 for _, m in axis):
        assert found.verdict == "unstable"
    else:
        assert found.verdict == ("marginal" if axis else "stable")
    assert found.lyapunov_stable == (found.verdict != "unstable")
    assert found.asymptotically_stable == (found.verdict == "stable")
    for mode in found.axis_modes:
        same = [m for e, m in axis if abs(e - mode.eigenvalue) < 1e-6]
        assert mode.algebraic == sum(same)
        assert mode.geometric == len(same)
        assert mode.largest_block == max(same)
        assert len(mode.singular_values) == A.shape[0]
        assert sum(s <= mode.threshold for s in mode.singular_values) == len(same)


@pytest.mark.parametrize(
    ("A", "verdict", "bounded"),
    [
        ([[0, 1], [0, 0]], "unstable", False),  # double integrator: one Jordan block
        ([[0, 0], [0, 0]], "marginal", True),  # two separate integrators
        ([[0, 1], [-4, 0]], "marginal", True),
        ([[-1, 100], [0, -1]], "stable", True),
        ([[-1, -2], [1, 1]], "marginal", True),  # section 9 of the notes
        ([[1e-3]], "unstable", False),
    ],
)
def test_verdict_is_what_the_exponential_does(A: list, verdict: str, bounded: bool) -> None:
    found = matrix_stability(A)
    assert found.verdict == verdict
    far = np.linalg.norm(expm(np.array(A, dtype=float) * 1e4), 2)
    assert (far < 100) == bounded
    if verdict == "stable":
        assert far < 1e-9


def test_the_reason_names_the_block() -> None:
    found = matrix_stability([[0, 1, 0], [0, 0, 1], [0, 0, 0]])
    assert "Jordan block of size 3" in found.because
    assert "t^2" in found.because
    assert found.axis_modes[0].singular_values == pytest.approx((1, 1, 0))


@effort(60)
@given(systems(order=(1, 5), stable=False, axis=True))
def test_a_system_and_its_realisation_agree(G: TransferFunction) -> None:
    assert system_stability(G).verdict == matrix_stability(realize(G).A).verdict


@pytest.mark.parametrize(
    ("text", "verdict", "stable", "u", "growth"),
    [
        ("1/(s+1)", "stable", True, None, None),
        ("1/s", "marginal", False, "1", "t"),
        ("1/s^2", "unstable", False, "1", "t^2"),
        ("s/s^2", "unstable", False, "1", "t"),
        ("1/(s^2+1)", "marginal", False, "sin(t)", "t cos(t + phi)"),
        ("exp(-s)/(s^2+4)", "marginal", False, "sin(2 t)", "t cos(2 t + phi)"),
        ("1/(s^2+1)^2", "unstable", False, "sin(t)", "t^2 cos(t + phi)"),
        ("s/s", "marginal", True, None, None),
        ("(s-1)/((s-1)(s+1))", "unstable", True, None, None),
        ("1/(s-2)", "unstable", False, "1", "exp(2 t)"),
        ("s", "stable", False, "sin(t^2)", "t cos(t^2)"),
        ("3", "stable", True, None, None),
        ("0/(s-1)", "unstable", True, None, None),
    ],
)
def test_bibo(text: str, verdict: str, stable: bool, u: str | None, growth: str | None) -> None:
    G = parse_transfer_function(text)
    assert system_stability(G).verdict == verdict
    found = bibo(G)
    assert found.stable == stable
    assert found.because
    if found.unbounded is None:
        assert u is None
    else:
        assert (found.unbounded.u, found.unbounded.output) == (u, growth)


def test_resonance_of_the_notes() -> None:
    """Section 9: A = [[-1, -2], [1, 1]], B = (1, 1): sin(t) is bounded, the state is not."""
    found = state_space_bibo([[-1, -2], [1, 1]], [[1], [1]], np.eye(2))
    assert not found.stable
    assert found.unbounded is not None
    assert found.unbounded.u == "sin(t)"
    # x' = A x + B sin(t), sin(t) from its own oscillator
    M = np.array([[-1, -2, 1, 0], [1, 1, 1, 0], [0, 0, 0, 1], [0, 0, -1, 0]])
    size = [np.abs(expm(M * t)[:2, 3]).max() for t in (2 * np.pi * 10, 2 * np.pi * 100)]
    assert size[1] / size[0] == pytest.approx(10, rel=0.05)


@effort(60)
@given(systems(order=(1, 4), stable=False), st.integers(0, 10**6))
def test_what_is_not_reached_or_not_seen_does_not_count(G: TransferFunction, seed: int) -> None:
    ss = realize(G)
    n = ss.B.size
    A = block_diag(ss.A, [[3.0]], [[4.0]])
    B = np.concatenate([ss.B, [0.0, 1.0]])[:, None]
    C = np.concatenate([ss.C, [1.0, 0.0]])[None, :]
    Q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=A.shape))
    found = state_space_bibo(Q @ A @ Q.T, Q @ B, C @ Q.T)
    assert found.poles.size + found.cancelled.size == n + 2
    assert np.abs(found.cancelled - 3).min() < 1e-6
    assert np.abs(found.cancelled - 4).min() < 1e-6
    assert found.stable == bibo(G).stable


@pytest.mark.parametrize(
    ("L", "simple"),
    [
        ("1/s^2", True),
        ("1.5707963267948966 exp(-s)/s", True),
        # s = 0 solves (s + 1)^2 = (3 s + 1) exp(-s), and so does its derivative: 2 = 3 - 1.
        ("-(3s+1) exp(-s)/(s+1)^2", False),
        ("s exp(-s)/(s (s+1))", True),
        ("s^2 exp(-s)/(s^2 (s+1))", False),
    ],
)
def test_repeated_closed_loop_poles_on_the_axis(L: str, simple: bool) -> None:
    loop = FeedbackLoop(plant=parse_transfer_function(L), controller=TransferFunction([], [], 1.0))
    assert axis_poles_are_simple(loop) is simple


@pytest.mark.parametrize("A", [[[1, 2]], [[np.nan]], [["a"]], [[1, 2], [3]], np.zeros((51, 51))])
def test_refusals(A: object) -> None:
    with pytest.raises(InvalidInput) as error:
        matrix_stability(A)  # type: ignore[arg-type]
    assert error.value.field == "A"
    with pytest.raises(InvalidInput):
        state_space_bibo([[1]], [[1], [2]], [[1]])
