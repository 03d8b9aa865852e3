"""The Routh array: textbook arrays entry by entry, both singular cases, counts against root sets known before."""

from decimal import Decimal
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.stability import characteristic_polynomial, closed_loop_verdict, routh_array
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import controllers, effort, systems

# Factors with small whole numbers, and how many roots they have right of, on and left of the axis.
FACTORS = st.one_of(
    st.integers(1, 4).map(lambda a: ([1, a], (0, 0, 1))),
    st.integers(1, 4).map(lambda a: ([1, -a], (1, 0, 0))),
    st.just(([1, 0], (0, 1, 0))),
    st.integers(1, 4).map(lambda a: ([1, 0, a], (0, 2, 0))),
    st.integers(1, 4).map(lambda a: ([1, 0, -a * a], (1, 0, 1))),
    st.tuples(st.integers(1, 3), st.integers(1, 3)).map(lambda t: ([1, 2 * t[0], t[0] ** 2 + t[1]], (0, 0, 2))),
    st.tuples(st.integers(1, 3), st.integers(1, 3)).map(lambda t: ([1, -2 * t[0], t[0] ** 2 + t[1]], (2, 0, 0))),
    # four roots symmetric to both axes
    st.integers(1, 3).map(lambda a: ([1, 0, 0, 0, 4 * a**4], (2, 0, 2))),
)


def product(factors: list[list[int]]) -> list[int]:
    out = [1]
    for f in factors:
        new = [0] * (len(out) + len(f) - 1)
        for i, a in enumerate(out):
            for j, b in enumerate(f):
                new[i + j] += a * b
        out = new
    return out


def counts(p: list) -> tuple[int, int, int]:
    r = routh_array(p)
    assert r.sign_changes == r.rhp_roots == sum(a * b < 0 for a, b in pairwise(row.entries[0] for row in r.rows))
    assert r.stable == (r.rhp_roots == r.imaginary_axis_roots == 0)
    return r.rhp_roots, r.imaginary_axis_roots, r.lhp_roots


@effort(400)
@given(st.lists(FACTORS, min_size=1, max_size=7), st.sampled_from([1, 2, -1, -3]))
def test_counts_are_those_of_the_factors(drawn: list, lead: int) -> None:
    """Zeros at the origin, repeated axis pairs, mirror images: in fractions every count is right, always."""
    p = [lead * c for c in product([f for f, _ in drawn])]
    expected = tuple(sum(c[i] for _, c in drawn) for i in range(3))
    assert routh_array(p).exact
    assert counts(p) == expected


@effort(200)
@given(st.lists(FACTORS, min_size=1, max_size=5))
def test_floats_find_the_same_symmetries(drawn: list) -> None:
    """s -> s/sqrt(2) and a factor pi leave no decimal in sight: the tolerance decides, and decides the same."""
    p = [np.pi * c * 2.0 ** (i / 2) for i, c in enumerate(product([f for f, _ in drawn]))]
    r = routh_array(p)
    expected = tuple(sum(c[i] for _, c in drawn) for i in range(3))
    assert (r.rhp_roots, r.imaginary_axis_roots, r.lhp_roots) == expected
    assert r.exact == (r.tolerance is None)


@effort(150)
@given(st.lists(st.integers(-9, 9), min_size=2, max_size=10).filter(lambda p: p[0] != 0))
def test_counts_are_those_of_the_computed_roots(p: list[int]) -> None:
    """Small whole coefficients, so that first-column zeros come often; roots next to the axis are left to the rest."""
    roots = np.roots(p)
    r = counts(p)
    doubt = np.count_nonzero(np.abs(roots.real) < 1e-5 * np.maximum(np.abs(roots), 1e-3))
    right = np.count_nonzero(roots.real > 0) if not doubt else None
    if right is not None:
        assert r == (right, 0, roots.size + (len(p) - 1 - roots.size) - right)
    assert sum(r) == len(p) - 1


@effort(60)
@given(systems(order=(1, 4), stable=False), controllers())
def test_loops_agree_with_the_verdict(P: TransferFunction, C: PID) -> None:
    loop = FeedbackLoop(P, C)
    verdict = closed_loop_verdict(loop)
    r = routh_array(characteristic_polynomial(loop))
    if verdict.verdict != "marginal" and not r.imaginary_axis_roots:
        assert r.rhp_roots == verdict.rhp_poles
        assert r.stable == verdict.closed_loop_stable


def table(p: list) -> list[list[Fraction]]:
    return [[Fraction(c) for c in row.entries] for row in routh_array(p).rows]


def test_a_regular_array() -> None:
    """s^4 + 2 s^3 + 3 s^2 + 4 s + 5: Ogata, Modern Control Engineering, 5th ed., sec. 5-6: two sign changes."""
    assert table([1, 2, 3, 4, 5]) == [[1, 3, 5], [2, 4], [1, 5], [-6], [5]]
    assert counts([1, 2, 3, 4, 5]) == (2, 0, 2)


def test_a_zero_row() -> None:
    """s^5 + 2 s^4 + 24 s^3 + 48 s^2 - 25 s - 50: Ogata, 5th ed., sec. 5-6: one root at +1, a pair at +-5j."""
    r = routh_array([1, 2, 24, 48, -25, -50])
    assert r.auxiliary_polynomials == ((4, (2, 0, 48, 0, -50)),)
    row = r.rows[2]
    assert (row.kind, row.label, row.computed, row.entries) == ("auxiliary", "s^3", (0, 0), (8, 96))
    assert "2 s^4 + 48 s^2 - 50" in str(row.note)
    assert [x.entries[0] for x in r.rows] == [1, 2, 8, 24, Fraction(338, 3), -50]
    assert (r.rhp_roots, r.imaginary_axis_roots, r.lhp_roots) == (1, 2, 2)


def test_a_first_column_zero() -> None:
    """s^5 + 2 s^4 + 2 s^3 + 4 s^2 + 11 s + 10: Dorf & Bishop, Modern Control Systems, sec. 6.2: two sign changes."""
    r = routh_array([1, 2, 2, 4, 11, 10])
    assert r.rows[2].kind == "multiplied"
    assert r.rows[2].computed == (0, 6)
    assert "1 - s^2" in str(r.rows[2].note)
    assert (r.rhp_roots, r.imaginary_axis_roots, r.lhp_roots) == (2, 0, 3)


def test_a_first_column_zero_with_roots_on_the_axis() -> None:
    """(s^2+1)^2 (s^2-s+1)-like cases, where the usual limit misleads, and a leading gap of two entries."""
    assert counts(product([[1, 0, 1], [1, -1, 1], [1, 1, 1]])) == (2, 2, 2)
    assert counts([1, 0, 0, 0, 0, 1]) == (2, 0, 3)
    assert counts([1, 0, 0, 1]) == (2, 0, 1)
    assert counts([1, 1, 0, 0, 0, 1, 1]) == tuple(
        np.count_nonzero(c) for c in (lambda r: (r.real > 1e-9, abs(r.real) <= 1e-9, r.real < -1e-9))(
            np.roots([1, 1, 0, 0, 0, 1, 1]))
    )  # fmt: skip


@pytest.mark.parametrize(
    ("p", "expected"),
    [
        ([3], (0, 0, 0)), ([1, 2], (0, 0, 1)), ([1, -2], (1, 0, 0)), ([1, 0], (0, 1, 0)), ([1, 0, 0], (0, 2, 0)),
        ([0, 0, 1, 2], (0, 0, 1)), ([1, 0, 2, 0, 1], (0, 4, 0)), ([1, 0, -2, 0, 1], (2, 0, 2)),
        ([-1, -3, -3, -1], (0, 0, 3)), ([1e-6, 1, 1e6], (0, 0, 2)), ([1] + [0] * 50, (0, 50, 0)),
    ],
)  # fmt: skip
def test_degenerate_polynomials(p: list, expected: tuple[int, int, int]) -> None:
    assert counts(p) == expected


def test_decimals_are_exact() -> None:
    """0.1, 0.2 and 0.3 are typed numbers: (s + 0.1)(s^2 + 0.2) has its pair on the axis, not beside it."""
    r = routh_array([1, 0.1, 0.2, 0.02])
    assert r.exact
    assert r.imaginary_axis_roots == 2
    assert routh_array([1, Decimal("0.1"), Fraction(1, 5), 0.02]).imaginary_axis_roots == 2
    r = routh_array([1, 1 / 3, 0.2, 0.2 / 3])
    assert not r.exact
    assert r.tolerance == 1e-13
    assert r.imaginary_axis_roots == 2
    assert routh_array([1, 1 / 3, 0.2, 0.2 / 3 * (1 + 1e-11)]).rhp_roots == 2
    assert routh_array([1, 1 / 3, 0.2, 0.2 / 3 * (1 - 1e-11)]).stable


def test_the_marginal_gain_of_three_lags_is_exact() -> None:
    polynomial = characteristic_polynomial(FeedbackLoop(parse_transfer_function("1/(s+1)^3"), PID(8.0)))
    r = routh_array(polynomial)
    assert r.exact
    assert r.auxiliary_polynomials == ((2, (3, 0, 9)),)  # +-sqrt(3) j
    assert (r.rhp_roots, r.imaginary_axis_roots, r.lhp_roots) == (0, 2, 1)


def test_order_fifty() -> None:
    p = [1]
    for _ in range(25):
        p = product([p, [1, 2, 5]])
    assert counts(p) == (0, 0, 50)
    assert counts(product([p[:], [1]])) == (0, 0, 50)


@pytest.mark.parametrize(
    ("p", "field"),
    [([], "polynomial"), ([0, 0], "polynomial"), ([1, np.nan], "polynomial"), ([1, np.inf], "polynomial"),
     (["a"], "polynomial"), ([1] * 52, "polynomial"), ([1e300, 1e-300, 1e300, 1e300], "polynomial")],
)  # fmt: skip
def test_refusals(p: list, field: str) -> None:
    with pytest.raises(InvalidInput) as error:
        routh_array(p)
    assert error.value.field == field
    with pytest.raises(InvalidInput):
        routh_array([1, 2], tolerance=0)
    with pytest.raises(InvalidInput):
        characteristic_polynomial(FeedbackLoop(parse_transfer_function("exp(-s)/s"), PID(1.0)))
