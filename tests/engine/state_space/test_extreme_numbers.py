"""Numbers at the edge of double precision are refused by name or answered with a reason, never with nan."""

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space import StateSpaceModel, analyse_structure, from_ode, gramians, initial_state


@pytest.mark.parametrize("value", [1e13, 5e-324, 1e-300])
def test_entries_out_of_range(value: float) -> None:
    with pytest.raises(InvalidInput) as caught:
        StateSpaceModel([[-1, value], [0, -2]], [[1], [1]], [[1, 1]])
    assert caught.value.field == "A"


@pytest.mark.parametrize(
    ("a", "b", "field"), [([5e-324, 1], [1], "a"), ([1e-300, 1], [1e-300], "a"), ([1], [1e13], "b")]
)
def test_coefficients_too_far_apart(a: list[float], b: list[float], field: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        from_ode(a, b)
    assert caught.value.field == field


def test_an_initial_value_out_of_range() -> None:
    with pytest.raises(InvalidInput, match="initial values"):
        initial_state(from_ode([1, 1], [1]), [1e300])


def test_a_gramian_that_rounding_would_decide_has_a_reason() -> None:
    found = gramians(StateSpaceModel([[-1e-6, 1e12], [0, -1]], [[1], [1]], [[1, 1]]))
    assert found.controllability is None
    assert "too slow" in str(found.reason)


def test_powers_that_overflow_leave_the_verdict_to_the_modes() -> None:
    n = 40
    model = StateSpaceModel(1e10 * np.diag(np.arange(1.0, n + 1)), np.ones((n, 1)), np.ones((1, n)))
    found = analyse_structure(model, 1e-15)
    assert not np.isfinite(found.controllability.matrix).all()
    assert found.controllability.full
