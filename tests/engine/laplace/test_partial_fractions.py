"""Partial fractions: textbook values, an independent contour integral, and the sum itself."""

import mpmath
import numpy as np
import pytest
import scipy.signal
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import ImproperSystem
from looplab.engine.laplace import LaplaceInput, partial_fractions
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, magnitudes, root_sets, systems


def coefficients(text: str, signal: LaplaceInput | None = None) -> dict[tuple[complex, int], complex]:
    found = partial_fractions(parse_transfer_function(text), signal)
    return {(term.pole, term.power): term.coefficient for term in found.terms}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        # Ogata, Modern Control Engineering, 5th ed., examples B-1 and B-2 in the appendix on partial fractions.
        ("(s+3)/((s+1)(s+2))", {(-1, 1): 2, (-2, 1): -1}),
        ("(s^2+2s+3)/(s+1)^3", {(-1, 1): 1, (-1, 3): 2}),
        # The notes' y'' + y = 1.
        ("1/(s(s^2+1))", {(0, 1): 1, (1j, 1): -0.5, (-1j, 1): -0.5}),
        ("1/(s^2(s+1))", {(0, 1): -1, (0, 2): 1, (-1, 1): 1}),
        # 1/(s^2+1)^2 is (sin t - t cos t)/2.
        ("1/(s^2+1)^2", {(1j, 1): -0.25j, (1j, 2): -0.25, (-1j, 1): 0.25j, (-1j, 2): -0.25}),
        ("(s-1)/((s-1)(s+2))", {(-2, 1): 1}),
    ],
)
def test_closed_forms(text: str, expected: dict[tuple[complex, int], complex]) -> None:
    found = coefficients(text)
    assert set(found) == set(expected)
    for key, value in expected.items():
        assert found[key] == pytest.approx(value, abs=1e-14)


def test_ten_equal_poles() -> None:
    """1/(s (s+1)^10) = 1/s - sum (s+1)^-k: every coefficient is 1 in size, though the expanded roots lie 0.05 off."""
    for system in (
        parse_transfer_function("1/(s+1)^10"),
        TransferFunction.from_polynomials([1], np.poly(-np.ones(10))),
    ):
        found = partial_fractions(system, LaplaceInput("step"))
        assert [(term.power, term.pole != 0) for term in found.terms] == [(1, False)] + [
            (k, True) for k in range(1, 11)
        ]
        assert np.allclose([term.coefficient for term in found.terms], [1] + 10 * [-1], atol=1e-12)
        assert found.residual < 1e-13
    # The joining is told.
    assert found.cluster_tolerance > 0
    assert 0.01 < found.moved < 0.1


def test_equal_poles_are_joined_only_as_far_as_they_must() -> None:
    assert partial_fractions(parse_transfer_function("1/((s+1)(s+1.001))")).cluster_tolerance == 0
    close = partial_fractions(parse_transfer_function("1/((s+1)(s+1.00000000001))"))
    assert close.cluster_tolerance > 0
    assert close.residual < 1e-14


@given(systems(order=(1, 7), axis=True, stable=False))
@effort(40)
def test_it_agrees_with_scipy_where_poles_are_apart(G: TransferFunction) -> None:
    from hypothesis import assume

    gaps = np.abs(G.poles[:, None] - G.poles[None, :]) + 10 * np.eye(G.order)
    assume(gaps.min() > 0.2)
    r, p, _ = scipy.signal.residue(G.num, G.den)
    found = partial_fractions(G)
    size = np.abs(r).max()
    for term in found.terms:
        assert abs(r[np.argmin(np.abs(p - term.pole))] - term.coefficient) < 1e-6 * size


def contour_residues(G: TransferFunction, pole: complex, times: int) -> list[complex]:
    """(2 pi j)^-1 of the integral of (s - p)^(k-1) G(s) ds around p, k = 1 ... times, 30 digits, trapezoidal rule."""
    others = [q for q in G.poles if abs(q - pole) > 1e-9]
    with mpmath.workdps(30):
        radius = mpmath.mpf(min((abs(q - pole) for q in others), default=1.0)) / 2
        n = 128
        totals = [mpmath.mpc(0)] * times
        for k in range(n):
            x = radius * mpmath.expjpi(mpmath.mpf(2 * k) / n)
            s = mpmath.mpc(pole) + x
            value = mpmath.mpf(G.gain)
            for z in G.zeros:
                value *= s - mpmath.mpc(z)
            for q in G.poles:
                value /= s - mpmath.mpc(q)
            for power in range(times):
                value *= x
                totals[power] += value
        return [complex(total / n) for total in totals]


@st.composite
def repeated(draw: st.DrawFn) -> TransferFunction:
    """Poles from a coarse set, each up to four times; complex ones and the axis included."""
    poles: list[complex] = []
    for base in draw(st.lists(st.sampled_from([0.0, -0.5, -1.0, -3.0, 0.7, -1 + 1j, 2j]), min_size=1, max_size=4)):
        pair = [base] if not complex(base).imag else [base, complex(base).conjugate()]
        poles += pair * draw(st.integers(1, 2))
    zeros = draw(root_sets(draw(st.integers(0, max(0, len(poles) - 1))), stable=False))
    return TransferFunction(zeros, poles, draw(magnitudes))


@given(repeated())
@effort(25)
def test_every_coefficient_is_a_contour_integral(G: TransferFunction) -> None:
    found = partial_fractions(G)
    by_key = {(term.pole, term.power): term.coefficient for term in found.terms}
    for pole in dict.fromkeys(complex(p) for p in G.poles if p.imag >= 0):
        times = int(np.count_nonzero(np.abs(G.poles - pole) < 1e-12))
        exact = contour_residues(G, pole, times)
        # A hidden pole: the contour gives the rounding of 30 digits.
        size = max(max(map(abs, exact)), 1e-18)
        for k, value in enumerate(exact, start=1):
            assert abs(by_key.get((pole, k), 0.0) - value) < 1e-11 * size


@given(repeated(), st.lists(st.tuples(st.floats(0.1, 8.0), st.floats(-8.0, 8.0)), min_size=5, max_size=5))
@effort(60)
def test_the_sum_is_the_function(G: TransferFunction, points: list[tuple[float, float]]) -> None:
    """At random s in the right half-plane, away from the poles."""
    found = partial_fractions(G)
    s = np.array([complex(x, y) for x, y in points])
    s = s[np.abs(s[:, None] - G.poles).min(axis=1) > 0.1]
    terms = sum((np.abs(t.coefficient / (s - t.pole) ** t.power) for t in found.terms), np.zeros(s.size))
    assert np.all(np.abs(found(s) - G(s)) <= 1e-13 * len(found.terms) * terms + 1e-300)
    assert found.residual < 1e-9


@given(systems(order=(1, 8), excess=0, stable=False, axis=True, theta=True), st.sampled_from(["step", "ramp", "sine"]))
@effort(60)
def test_inputs_and_dead_time_are_carried(G: TransferFunction, type: str) -> None:
    u = LaplaceInput(type, 2.0, 1.7)  # type: ignore[arg-type]
    found = partial_fractions(G, u)
    s = np.array([0.3 + 2j, 1.0 + 0.2j, 4.0 - 1j])
    exact = G(s) * u.transform()(s)
    terms = sum((np.abs(t.coefficient / (s - t.pole) ** t.power) for t in found.terms), np.zeros(s.size))
    assert np.all(np.abs(found(s) - exact) <= 1e-9 * terms * np.exp(-G.theta * s.real))


def test_resonance_makes_a_double_pole() -> None:
    found = partial_fractions(parse_transfer_function("1/(s^2+4)"), LaplaceInput("sine", omega=2.0))
    assert {(t.pole, t.power) for t in found.terms} == {(2j, 2), (-2j, 2), (2j, 1), (-2j, 1)}


def test_a_biproper_system_has_a_polynomial_part() -> None:
    found = partial_fractions(parse_transfer_function("(s+3)/(s+1)"))
    assert (found.direct, [t.coefficient for t in found.terms]) == (1.0, [2.0])
    assert partial_fractions(parse_transfer_function("3")).direct == 3.0


@pytest.mark.parametrize("text", ["s", "1+s", "(s^2+1)/(s+1)"])
def test_an_improper_system_is_refused(text: str) -> None:
    for signal in (None, LaplaceInput("ramp")):
        with pytest.raises(ImproperSystem):
            partial_fractions(parse_transfer_function(text), signal)


def test_order_fifty() -> None:
    G = TransferFunction((), -(1.3 ** np.arange(50)) * 1e-3, 1e80)
    found = partial_fractions(G, LaplaceInput("step"))
    assert len(found.terms) == 51
    assert found.residual < 1e-9
    assert partial_fractions(TransferFunction((), [-1.0] * 50, 1.0), LaplaceInput("step")).residual < 1e-12


def test_zero_gain() -> None:
    assert partial_fractions(TransferFunction((), (-1.0,), 0.0)).terms == ()
