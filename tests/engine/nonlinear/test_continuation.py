"""Curves of steady states: folds, Hopf points and crossings where mathematics puts them."""

import math
from typing import Any

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import compile_model
from looplab.engine.nonlinear.steady_states import SteadyStateCurves, balance_curve, continue_steady_states
from looplab.plants import load_plant
from models import model, parameters


def curves(document: dict[str, Any], over: str, **more: Any) -> SteadyStateCurves:
    compiled = compile_model(document)
    return continue_steady_states(compiled, compiled.u0, compiled.p0, over, **more)


def setting(name: str, value: float, low: float, high: float) -> list[dict[str, Any]]:
    return [{"name": name, "value": value, "min": low, "max": high}]


def test_the_folds_of_a_cubic() -> None:
    """x' = u + x - x^3 turns at x = +-1/sqrt(3), u = -+2/(3 sqrt(3))."""
    found = curves(model("u + x - x^3", 0, inputs=setting("u", 0, -1, 1)), "u", box={"x": (-3, 3)})
    (curve,) = found.curves
    fold = 2 / (3 * math.sqrt(3))
    assert [point.kind for point in found.special] == ["turning", "turning"]
    assert sorted(point.value for point in found.special) == pytest.approx([-fold, fold], rel=1e-12)
    assert sorted(point.x[0] for point in found.special) == pytest.approx([-(3**-0.5), 3**-0.5], rel=1e-8)
    # Stable, unstable between the folds, stable; from end to end of the range.
    changes = [count for i, count in enumerate(curve.unstable) if i == 0 or count != curve.unstable[i - 1]]
    assert changes == [0, 1, 0]
    assert sorted(curve.points[end].y[-1] for end in (0, -1)) == [-1, 1]
    for point in curve.points:
        x, u = point.y
        assert abs(u + x - x**3) < 1e-12


@pytest.mark.parametrize("over", ["Ti", "Q"])
def test_the_folds_of_the_reactor_by_their_definition(over: str) -> None:
    """det A = 0, and the balance in closed form: u as a function of T along the curve has a stationary value there."""
    reactor = load_plant("cstr")
    found = continue_steady_states(reactor, reactor.u0, reactor.p0, over)
    assert len(found.curves) == 1
    folds = [point for point in found.special if point.kind == "turning"]
    assert len(folds) == len(found.special) == 2

    def k_and_slope(T: float) -> tuple[float, float]:
        k = 7.2e10 * math.exp(-1e4 / T)
        return k, k * 1e4 / T**2

    for fold in folds:
        cA, T = fold.x
        k, slope = k_and_slope(T)
        A = np.array([[-1 - k, -slope * cA], [200 * k, -1 + 200 * slope * cA]])
        assert abs(np.linalg.det(A)) < 1e-10 * abs(A[0, 0] * A[1, 1])
        assert abs(fold.determinant) < 1e-10
        # heat: Ti - T - Q/1e5 + 200 k/(1 + k) = 0; its slope by T is zero at a fold.
        assert abs(-1 + 200 * slope / (1 + k) ** 2) < 1e-9
        Ti, Q = (fold.value, 2e6) if over == "Ti" else (350.0, fold.value)
        assert pytest.approx(0, abs=1e-9) == Ti - T - Q / 1e5 + 200 * k / (1 + k)
    # The reactor of the notes lies on the curve, on all three parts.
    at_own = 350.0 if over == "Ti" else 2e6
    values = np.array([point.y[-1] for point in found.curves[0].points])
    sides = np.sign(values - at_own)
    assert np.count_nonzero(np.diff(sides[sides != 0])) == 3


def test_the_hopf_point_of_the_brusselator() -> None:
    """B = 1 + A^2, with omega = A (Nicolis and Prigogine 1977)."""
    document = model(
        ["A + x1^2*x2 - (B + 1)*x1", "B*x1 - x1^2*x2"],
        [1.3, 1],
        parameters=[*parameters(A=1.3), *setting("B", 1, 0.1, 5)],
    )
    found = curves(document, "B", box={"x1": (0, 5), "x2": (0, 8)})
    (hopf,) = found.special
    assert hopf.kind == "hopf"
    assert hopf.value == pytest.approx(2.69, rel=1e-10)
    assert hopf.omega == pytest.approx(1.3, rel=1e-8)
    assert hopf.x == pytest.approx((1.3, 2.69 / 1.3), rel=1e-10)
    assert set(found.curves[0].unstable) == {0, 2}


def test_a_pitchfork_has_two_curves() -> None:
    found = curves(model("u*x - x^3", 0.1, inputs=setting("u", 0.3, -1, 1)), "u", box={"x": (-2, 2)})
    assert len(found.curves) == 2
    straight = min(found.curves, key=lambda curve: max(abs(point.y[0]) for point in curve.points))
    assert max(abs(point.y[0]) for point in straight.points) < 1e-9
    kinds = {point.kind: point.value for point in found.special}
    assert kinds["turning"] == pytest.approx(0, abs=1e-12)


def test_a_transcritical_crossing_changes_stability() -> None:
    """x' = x (u - x): on x = 0 stability is lost at u = 0."""
    found = curves(model("x*(u - x)", 0.5, inputs=setting("u", 0.5, -1, 1.1)), "u", box={"x": (-3, 3)})
    assert len(found.curves) == 2
    assert [point.kind for point in found.special] == ["branch", "branch"]
    assert [point.value for point in found.special] == pytest.approx([0, 0], abs=1e-9)
    assert [point.determinant for point in found.special] == pytest.approx([0, 0], abs=1e-8)


def test_a_closed_curve_closes() -> None:
    """x' = 0.09 - u^2 - (x - 1)^2: a circle of radius 0.3."""
    found = curves(model("0.09 - u^2 - (x - 1)^2", 1.2, inputs=setting("u", 0.1, -1, 1)), "u", box={"x": (-2, 3)})
    (curve,) = found.curves
    assert curve.closed
    np.testing.assert_array_equal(curve.points[0].y, curve.points[-1].y)
    assert sorted(point.value for point in found.special) == pytest.approx([-0.3, 0.3], rel=1e-12)
    radius = [math.hypot(point.y[1], point.y[0] - 1) for point in curve.points]
    assert radius == pytest.approx([0.3] * len(radius), rel=1e-9)


def test_branches_that_do_not_meet() -> None:
    """x^2 = 1 + u^2: two branches."""
    found = curves(model("1 + u^2 - x^2", 1, inputs=setting("u", 0, -1, 1)), "u", box={"x": (-3, 3)})
    assert len(found.curves) == 2
    assert found.special == ()
    assert sorted(set(curve.unstable) == {0} for curve in found.curves) == [False, True]


def test_ranges_are_kept() -> None:
    document = model("u - x", 0, inputs=setting("u", 0, -1, 1))
    found = curves(document, "u", low=-0.5, high=0.25)
    ends = sorted(found.curves[0].points[end].y[-1] for end in (0, -1))
    assert ends == [-0.5, 0.25]
    # A state's bounds end the curve too.
    bounded = curves(document, "u", box={"x": (-0.2, 0.1)})
    assert sorted(bounded.curves[0].points[end].y[0] for end in (0, -1)) == pytest.approx([-0.2, 0.1], abs=1e-12)
    for more, field in (({"low": -2}, "low"), ({"high": 3}, "high"), ({"low": 0.5, "high": 0.2}, "high")):
        with pytest.raises(InvalidInput) as caught:
            curves(document, "u", **more)
        assert caught.value.field == field
    with pytest.raises(InvalidInput) as caught:
        curves(document, "x")
    assert caught.value.field == "over"


def test_no_steady_state_and_a_continuum() -> None:
    assert curves(model("1 + x^2 + u^2", 0, inputs=setting("u", 0, -1, 1)), "u").curves == ()
    with pytest.raises(InvalidInput, match="x1 may have any value"):
        curves(model(["x2", "-k*x2"], 1, parameters=setting("k", 1, 0.5, 2)), "k")


def test_the_heat_balance_of_the_reactor() -> None:
    """Heat generated and removed in closed form, with cA at rest: cA = 1/(1 + k)."""
    reactor = load_plant("cstr")
    curves_ = ["heat_generated", "heat_removed"]
    found = balance_curve(reactor, reactor.u0, reactor.p0, "T", 300, 600, curves_)
    (branch,) = found.branches
    cA, T = branch.states.T
    assert T.min() == 300
    assert T.max() == 600
    k = 7.2e10 * np.exp(-1e4 / T)
    np.testing.assert_allclose(cA, 1 / (1 + k), rtol=1e-9)
    generated = 200000 * 100 * k / (1 + k)
    removed = 1e5 * (T - 350) + 2e6
    np.testing.assert_allclose(branch.curves["heat_generated"], generated, rtol=1e-9)
    np.testing.assert_allclose(branch.curves["heat_removed"], removed, rtol=1e-9, atol=1e-3)
    np.testing.assert_allclose(branch.rate, (generated - removed) / 1e5, rtol=1e-7, atol=1e-7)
    before = np.flatnonzero(np.diff(np.sign(branch.rate)))
    slopes = np.diff(branch.rate)[before] / np.diff(T)[before]
    assert np.sort(T[before] - branch.rate[before] / slopes) == pytest.approx([331.1, 385.1, 529.6], abs=0.5)


def test_the_balance_of_one_state_and_its_errors() -> None:
    compiled = compile_model(
        model("u - x^2", 1, inputs=parameters(u=2), variables=[{"name": "out", "expression": "x^2"}])
    )
    (branch,) = balance_curve(compiled, compiled.u0, (), "x", 0, 2, ["out"]).branches
    x = branch.states[:, 0]
    np.testing.assert_allclose(branch.rate, 2 - x**2)
    np.testing.assert_allclose(branch.curves["out"], x**2)
    for arguments, field in ((("y",), "state"), (("x", 0, 1, ["in"]), "curves[0]"), (("x", 1, 0), "high")):
        with pytest.raises(InvalidInput) as caught:
            balance_curve(compiled, compiled.u0, (), *arguments)
        assert caught.value.field == field


def test_a_corner_is_passed() -> None:
    """u = max(x, 4 x) + x: the slope jumps at the origin."""
    found = curves(model("u - max(x, 4*x) - x", 0.1, inputs=setting("u", 0.3, -1, 1)), "u", box={"x": (-2, 2)})
    (curve,) = found.curves
    assert sorted(curve.points[end].y[-1] for end in (0, -1)) == [-1, 1]
    assert sorted(curve.points[end].y[0] for end in (0, -1)) == pytest.approx([-0.5, 0.2], abs=1e-12)
