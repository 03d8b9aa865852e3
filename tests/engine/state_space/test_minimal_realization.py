"""Minimal realisations: the same transfer matrix, the hidden modes named, and the tolerance that decided."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space import StateSpaceModel, minimal_realization
from looplab.engine.systems import TransferFunction
from strategies import effort, systems

S = np.array([0.3j, 1.0 + 2.0j, -0.2 + 5.0j, 20j])


def mixed(model: StateSpaceModel, seed: int) -> StateSpaceModel:
    """The same system in coordinates that hide nothing by zeros."""
    T = np.linalg.qr(np.random.default_rng(seed).standard_normal((model.states, model.states)))[0]
    return model.transformed(T)


def test_modes_hidden_from_input_and_output_are_named() -> None:
    A = np.diag([-1.0, -2.0, 3.0, -4.0])
    model = mixed(StateSpaceModel(A, [[1], [1], [0], [0]], [[1, 0, 1, 0]]), 1)
    found = minimal_realization(model)
    assert found.model.poles.real == pytest.approx([-1.0])
    assert sorted((round(m.pole.real), m.hidden_from, m.stable) for m in found.removed) == [
        (-4, "input", True),
        (-2, "output", True),
        (3, "input", False),
    ]
    assert found.tolerance == 1e-10
    assert found.smallest_kept is not None
    assert found.largest_removed is not None
    assert found.largest_removed < 1e-14
    assert found.smallest_kept > 0.1
    for s in S:
        np.testing.assert_allclose(found.model(s), [[1 / (s + 1)]], rtol=1e-12)


@effort(25)
@given(systems(order=(1, 4)), systems(order=(1, 2)), st.integers(0, 100))
def test_a_cancelling_factor_goes_and_the_response_stays(G: TransferFunction, H: TransferFunction, seed: int) -> None:
    """G (s-q)/(s-q) with q the poles of H, in mixed coordinates: at least as many states go as were added."""
    whole = TransferFunction(np.concatenate([G.zeros, H.poles]), np.concatenate([G.poles, H.poles]), G.gain)
    model = mixed(StateSpaceModel.from_transfer_function(whole), seed)
    found = minimal_realization(model, 1e-7)
    assert found.model.states + len(found.removed) == model.states
    assert found.model.states <= G.order
    for s in S:
        expected = G(complex(s))
        assert abs(found.model(s)[0, 0] - expected) <= 1e-6 * (abs(expected) + abs(G.gain))


def test_several_channels_keep_what_any_of_them_needs() -> None:
    model = StateSpaceModel(np.diag([-1.0, -2.0, -3.0]), [[1, 0], [0, 1], [0, 0]], [[1, 0, 0], [0, 1, 1]])
    found = minimal_realization(model)
    assert sorted(found.model.poles.real) == pytest.approx([-2, -1])
    assert [m.hidden_from for m in found.removed] == ["input"]


def test_a_minimal_model_is_returned_as_it_is() -> None:
    model = StateSpaceModel([[0, 1], [-2, -3]], [[0], [1]], [[1, 0]])
    found = minimal_realization(model)
    assert found.model is model
    assert found.removed == ()
    assert minimal_realization(StateSpaceModel.static([[2.0]])).model.states == 0


def test_the_tolerance_decides() -> None:
    """A mode that the input moves by 1e-6 only: kept, or taken out, and said either way."""
    model = StateSpaceModel(np.diag([-1.0, -2.0]), [[1], [1e-6]], [[1, 1]])
    kept, dropped = minimal_realization(model), minimal_realization(model, 1e-4)
    assert (kept.model.states, dropped.model.states) == (2, 1)
    assert kept.smallest_kept is not None
    assert kept.smallest_kept < 1e-4
    assert dropped.largest_removed == pytest.approx(kept.smallest_kept, rel=0.5)
    for tolerance in (0.0, 1.0, float("nan")):
        with pytest.raises(InvalidInput):
            minimal_realization(model, tolerance)
