"""Phase planes of systems whose picture is known, and zero lines of known curves."""

import math

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import compile_model
from looplab.engine.nonlinear.steady_states import PhasePlane, phase_plane, trajectories
from looplab.engine.nonlinear.steady_states.nullclines import zero_lines
from models import model

WINDOW = np.array([[-1.0, 1.0], [-2.0, 2.0]])


def linear(a: float, b: float, c: float, d: float) -> PhasePlane:
    compiled = compile_model(model([f"{a}*x1 + ({b})*x2", f"({c})*x1 + ({d})*x2"], [0.1, 0.1]))
    return phase_plane(compiled, compiled.x0, (), (), (0, 1), WINDOW, 9)


@pytest.mark.parametrize(
    ("matrix", "kind"),
    [
        ((-1, 0, 0, -2), "stable node"),
        ((1, 0.5, 0, 2), "unstable node"),
        ((1, 0, 0, -2), "saddle"),
        ((-0.2, 1, -1, -0.2), "stable focus"),
        ((0.2, 1, -1, 0.2), "unstable focus"),
        ((0, 1, -4, 0), "centre"),
        ((-1, 1, 0, -1), "stable node"),
    ],
)
def test_linear_systems_by_name(matrix: tuple[float, float, float, float], kind: str) -> None:
    """Trace and determinant decide (Strogatz, Nonlinear Dynamics and Chaos, section 5.2)."""
    (state,) = linear(*matrix).steady_states
    assert state.kind == kind
    assert state.x == pytest.approx((0, 0), abs=1e-9)


def test_the_field_and_the_nullclines_of_a_linear_system() -> None:
    plane = linear(-1, 2, 3, 1)
    h, v = np.meshgrid(plane.horizontal, plane.vertical)
    np.testing.assert_allclose(plane.d_horizontal, -h + 2 * v, atol=1e-14)
    np.testing.assert_allclose(plane.d_vertical, 3 * h + v, atol=1e-14)
    for lines, row in zip(plane.nullclines, ([-1, 2], [3, 1]), strict=True):
        (line,) = lines
        assert not line.closed
        assert np.abs(row[0] * line.horizontal + row[1] * line.vertical).max() < 1e-12
        # It crosses the whole window.
        assert max(np.ptp(line.horizontal) / 2, np.ptp(line.vertical) / 4) == pytest.approx(1, abs=0.04)


def test_a_circle_is_one_closed_line() -> None:
    def f(a: float, b: float) -> float:
        return a * a + b * b - 0.5

    h = np.linspace(-1, 1, 41)
    (line,) = zero_lines(f, np.array([[f(a, b) for a in h] for b in h]), h, h)
    assert line.closed
    assert (line.horizontal[0], line.vertical[0]) == (line.horizontal[-1], line.vertical[-1])
    np.testing.assert_allclose(np.hypot(line.horizontal, line.vertical), math.sqrt(0.5), rtol=1e-12)
    length = np.hypot(np.diff(line.horizontal), np.diff(line.vertical)).sum()
    assert length == pytest.approx(2 * math.pi * math.sqrt(0.5), rel=0.003)


def test_a_pole_is_no_zero_and_a_gap_is_left_out() -> None:
    h = np.linspace(-1, 1, 20)

    def pole(a: float, b: float) -> float:
        return 1 / (a - 0.01)

    assert zero_lines(pole, np.array([[pole(a, b) for a in h] for b in h]), h, h) == ()

    def half(a: float, b: float) -> float:
        return math.nan if b < 0 else a - 0.013

    (line,) = zero_lines(half, np.array([[half(a, b) for a in h] for b in h]), h, h)
    assert line.vertical.min() >= 0
    np.testing.assert_allclose(line.horizontal, 0.013, atol=1e-12)


def test_crossing_lines_both_show() -> None:
    """x y = 0 between grid points: two lines, however they are joined where they cross."""
    h = np.linspace(-1, 1, 20)

    def f(a: float, b: float) -> float:
        return a * b

    lines = zero_lines(f, np.array([[f(a, b) for a in h] for b in h]), h, h)
    assert sum(line.horizontal.size for line in lines) == 2 * 20
    for line in lines:
        assert np.abs(line.horizontal * line.vertical).max() < 1e-12


def test_trajectories_of_a_centre_and_their_errors() -> None:
    compiled = compile_model(model(["x2", "-4*x1"], [1, 0]))
    t = np.linspace(0, 5, 101)
    (path,) = trajectories(compiled, compiled.x0, (), (), (0, 1), [{"x1": 0.5, "x2": 1}], t)
    np.testing.assert_allclose(path.horizontal, 0.5 * np.cos(2 * t) + 0.5 * np.sin(2 * t), atol=1e-6)
    np.testing.assert_allclose(path.vertical, np.cos(2 * t) - np.sin(2 * t), atol=1e-6)
    assert path.truncated_at is None
    with pytest.raises(InvalidInput) as caught:
        trajectories(compiled, compiled.x0, (), (), (0, 1), [{}, {"y": 1}], t)
    assert caught.value.field == "starts[1].y"


def test_others_are_held() -> None:
    """x3 is no steady state at 2: the plane of the first two is at rest where they are, given it."""
    compiled = compile_model(model(["x3 - x1", "x1 - x2", "1 - x3"], [0, 0, 0]))
    plane = phase_plane(compiled, (0.0, 0.0, 2.0), (), (), (0, 1), np.array([[0.0, 5.0], [0.0, 5.0]]), 5)
    (state,) = plane.steady_states
    assert state.x == pytest.approx((2, 2, 2), rel=1e-12)
    assert len(state.eigenvalues) == 2
    for change, field in (({"states": (1, 1)}, "vertical"), ({"grid": 4}, "grid")):
        with pytest.raises(InvalidInput) as caught:
            phase_plane(compiled, (0.0, 0.0, 2.0), (), (), change.get("states", (0, 1)), WINDOW, change.get("grid", 9))
        assert caught.value.field == field
