"""Linear ODEs: the notes' example, closed forms, and the equation itself put to the test."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.laplace import (
    ExponentialSum,
    LaplaceInput,
    final_value,
    initial_value,
    inverse_transform,
    partial_fractions,
    solve_linear_ode,
)
from looplab.engine.systems import TransferFunction
from strategies import effort, magnitudes, numbers, root_sets

STEP = LaplaceInput("step")


def test_the_example_of_the_notes() -> None:
    """y'' + y = 1, y(0) = y'(0) = 0: y = 1 - cos t."""
    found = solve_linear_ode([1, 0, 1], [1], [0, 0], STEP)
    assert found.y.to_text() == "1 - cos(t)"
    t = np.linspace(0, 20, 101)
    assert np.abs(found.y(t) - (1 - np.cos(t))).max() < 1e-14
    assert found.free.to_text() == "0"


@pytest.mark.parametrize(
    ("a", "b", "initial", "signal", "expected"),
    [
        ([1, 3, 2], [1], [1, 0], None, "2 e^(-t) - e^(-2 t)"),
        ([1, 1], [1], [3], STEP, "1 + 2 e^(-t)"),
        ([1, 0, 4], [1], [0, 2], None, "sin(2 t)"),
        ([1, 2, 1], [1], [1, -1], None, "e^(-t)"),
        # The initial values excite only the stable mode of an unstable equation.
        ([1, -1, -2], [1], [1, -1], None, "e^(-t)"),
        ([2, 0], [1], [1], LaplaceInput("ramp", 4.0), "1 + t^2"),
        # An input derivative: y' + y = u', u a step, jumps to 1.
        ([1, 1], [1, 0], [], STEP, "e^(-t)"),
        ([1, 0, 1], [1], [], LaplaceInput("impulse"), "sin(t)"),
        ([1, 1], [1], [], LaplaceInput("exponential", rate=-1.0), "t e^(-t)"),
        ([1, 0, 1], [2], [], LaplaceInput("sine"), "sin(t) - t cos(t)"),
    ],
)
def test_closed_forms(a, b, initial, signal, expected: str) -> None:
    assert solve_linear_ode(a, b, initial, signal).y.to_text() == expected


def test_a_hidden_unstable_mode_has_a_final_value() -> None:
    found = solve_linear_ode([1, -1, -2], [1], [1, -1])
    assert found.fractions.cancelled == (2 + 0j,)
    assert final_value(found.fractions).value == 0.0


def test_the_jump_at_the_start() -> None:
    """y' + y = u': y(0-) = 0.5, and the step of u adds 1 at once."""
    found = solve_linear_ode([1, 1], [1, 0], [0.5], STEP)
    assert initial_value(found.fractions).value == pytest.approx(1.5)


def derivatives(y: ExponentialSum, n: int) -> list[ExponentialSum]:
    out = [y]
    for _ in range(n):
        out.append(out[-1].derivative())
    return out


@st.composite
def equations(draw: st.DrawFn):
    n = draw(st.integers(1, 5))
    a = draw(magnitudes) * np.poly(draw(root_sets(n, stable=False, axis=True))).real
    initial = [draw(numbers(-2, 2)) for _ in range(n)]
    type = draw(st.sampled_from(["step", "ramp", "sine", "exponential"]))
    return a.tolist(), draw(numbers(0.1, 3)), initial, LaplaceInput(type, 1.5, 1.3, -0.7)


@given(equations())
@effort(60)
def test_the_solution_satisfies_its_equation(case) -> None:
    a, b, initial, u = case
    n = len(a) - 1
    found = solve_linear_ode(a, [b], initial, u)
    t = np.linspace(0.0, 3.0, 40)
    chain = derivatives(found.y, n)
    values = [y(t) for y in chain]
    left = sum(c * v for c, v in zip(a, reversed(values), strict=True))
    right = b * inverse_transform(partial_fractions(u.transform()))(t)
    # Terms of nearly equal poles cancel: judged by their size.
    size = 0.0
    for mode in found.y.modes:
        for k, c in enumerate(mode.coefficients):
            power = np.polyval(np.abs(a), max(abs(mode.pole), 1.0))
            size += abs(c) * power * float((t**k * np.exp(mode.pole.real * t)).max())
    assert np.abs(left - right).max() < 1e-11 * size + 1e-12
    # Without input derivatives nothing jumps: the initial values are those given.
    for y0, v in zip(initial, values, strict=False):
        assert abs(v[0] - y0) < 1e-11 * size + 1e-12
    assert np.abs(found.forced(t) + found.free(t) - found.y(t)).max() < 1e-11 * size + 1e-12


def test_the_forced_part_is_the_step_of_the_transfer_function() -> None:
    G = TransferFunction.from_polynomials([2, 3], [1, 2, 5])
    found = solve_linear_ode([1, 2, 5], [2, 3], [1, 1], STEP)
    t = np.linspace(0, 5, 50)
    assert np.abs(found.forced(t) - inverse_transform(partial_fractions(G, STEP))(t)).max() < 1e-14


@pytest.mark.parametrize(
    ("arguments", "error", "field"),
    [
        (([0, 1], [1]), InvalidInput, "a"),
        (([1], [1]), InvalidInput, "a"),
        (([], [1]), InvalidInput, "a"),
        (([1, 1], [float("inf")]), InvalidInput, "b"),
        (([1, 1], [1], [1, 2]), InvalidInput, "initial"),
        (([1, 1], [1], [float("nan")]), InvalidInput, "initial"),
        (([1, 1], [1, 0, 0]), ImproperSystem, "b"),
    ],
)
def test_a_bad_equation_is_refused(arguments, error, field: str) -> None:
    with pytest.raises(error) as caught:
        solve_linear_ode(*arguments)
    assert caught.value.field == field
