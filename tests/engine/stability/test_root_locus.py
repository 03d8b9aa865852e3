"""Each point of the locus solves 1 + K L0(s) = 0; branches are continuous, begin at the poles and end at the zeros."""

import numpy as np
import pytest
from hypothesis import assume, given

from looplab.engine.errors import InvalidInput
from looplab.engine.stability import breakaway_points, root_locus
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems

TEXTS = [
    "1/(s+1)^3",
    "1/((s+1)(s+2)(s+3))",
    "(s+3)/(s^2*(s+2)*(s+4)*(s^2+2s+9)*(s^3+5))",
    "2(s+1)/(s(s-4))",
    "1/(s^2+0.02s+1)",
    "(s+2)/(s^2+2s+10)",
    "(s+1)/s^2",
    "1/s^2",
    "(1-2s)/((5s+1)(10s+1))",
    "(s^2+s+4)/((s+1)(s+2)(s+3))",
    "1/(s+1)^10",
    "(s+1)^2/s^3",
    "(s+3)(s+1)/((s-1)(s+5))",
    "1/(s(s+4)(s^2+4s+20))",
    "(s+0.1)/(s(s+0.11)(s+5)^2)",
    "1/(s+1)",
    "(4 s^2 + 2.1 s + 1)/(s (0.1 s + 1)(s + 1)^3)",
    "(s+1)/(s(s+2)(s^2+12))",
    "1/((s+1)^5(s+3)^5)",
    "-1/((s+1)(s+2))",
]


def relative_residual(L: TransferFunction, K: np.ndarray, s: np.ndarray) -> np.ndarray:
    """|D + K N| over the size its terms can have at s: 1e-16 times the condition is as good as it gets."""
    D, N = np.ones(s.shape, complex), np.full(s.shape, complex(L.gain))
    for p in L.poles:
        D = D * (s - p)
    for z in L.zeros:
        N = N * (s - z)
    return np.abs(D + K * N) / (np.abs(D) + np.abs(K * N) + 1e-300)


def distance_of_sets(a: np.ndarray, b: np.ndarray) -> float:
    gap = np.abs(a[:, None] - b[None, :])
    return max(gap.min(axis=0).max(), gap.min(axis=1).max())


@pytest.mark.parametrize("text", TEXTS)
def test_points_lie_on_the_locus(text: str) -> None:
    L = parse_transfer_function(text)
    locus = root_locus(L)
    K, s = locus.gains[1:], locus.branches[:, 1:]
    assert locus.branches.shape == (L.order, locus.gains.size)
    assert (np.diff(locus.gains) > 0).all()
    lone = np.ones(s.shape, bool)  # at a multiple root only half the digits are to be had
    for b in locus.breakaways:
        lone &= np.abs(s - b.s) > 0.02 * max(1.0, abs(b.s))
    near_pole = np.abs(s[:, :, None] - L.poles).min(axis=2) < 1e-3 * np.abs(L.poles).max(initial=1.0)
    residual = relative_residual(L, K, s)
    assert residual[lone & ~near_pole].max(initial=0) <= 1e-7
    assert residual[~near_pole].max(initial=0) <= 1e-4


@effort(30)
@given(systems(order=(1, 5), stable=False, axis=True))
def test_points_lie_on_random_loci(L: TransferFunction) -> None:
    assume(L.gain > 0)
    locus = root_locus(L)
    for i in np.linspace(1, locus.gains.size - 1, 25).astype(int):
        K, s = locus.gains[i], locus.branches[:, i]
        exact = np.roots(np.polyadd(np.poly(L.poles), K * L.gain * np.poly(L.zeros)))
        size = np.abs(exact).max()
        apart = np.abs(exact[:, None] - exact[None, :]) + np.eye(exact.size) * size
        assume(apart.min() > 1e-3 * size)
        assert distance_of_sets(s, exact) <= 1e-6 * size


@pytest.mark.parametrize("text", TEXTS)
def test_branches_begin_at_poles_and_end_at_zeros_or_far_away(text: str) -> None:
    L = parse_transfer_function(text)
    locus = root_locus(L)
    assert locus.gains[0] == 0
    np.testing.assert_array_equal(np.sort_complex(locus.branches[:, 0]), np.sort_complex(L.poles))
    end = locus.branches[:, -1]
    reach = max(1.0, np.abs(L.poles).max(), np.abs(L.zeros).max(initial=0))
    arrived = set()
    for z in L.zeros:
        i = int(np.argmin(np.abs(end - z) + 1e9 * np.isin(np.arange(end.size), list(arrived))))
        assert abs(end[i] - z) < 0.25 * reach, (z, end)
        arrived.add(i)
    away = np.delete(end, list(arrived))
    assert away.size == L.relative_degree
    if away.size > 1:
        # the far ends leave along the asymptotes
        angles = np.degrees(np.angle(away - locus.asymptotes.centroid))
        gap = np.abs((angles[:, None] - locus.asymptotes.angles_deg[None, :] + 180) % 360 - 180)
        assert gap.min(axis=1).max() < 20
        assert len(set(gap.argmin(axis=1))) == away.size


def clearance(points: np.ndarray) -> float:
    gap = np.abs(points[:, None] - points[None, :])
    gap[np.arange(points.size), np.arange(points.size)] = np.inf
    return float(gap.min(initial=np.inf))


@pytest.mark.parametrize("text", TEXTS)
def test_branches_are_continuous_and_joined_right(text: str) -> None:
    """Inside the view no step is long; away from meeting points each point is nearest to its own continuation."""
    L = parse_transfer_function(text)
    locus = root_locus(L)
    (re0, re1), (im0, im1) = locus.view
    size = max(re1 - re0, im1 - im0)
    b = locus.branches
    inside = (np.minimum(np.abs(b[:, 1:]), np.abs(b[:, :-1])) < size) & (
        np.maximum(np.abs(b[:, 1:]), np.abs(b[:, :-1])) < 2 * size
    )
    step = np.abs(np.diff(b, axis=1))
    assert step[inside].max(initial=0) <= 0.12 * size
    for i in range(b.shape[1] - 1):
        near, room = b[:, i], clearance(b[:, i])
        if room < 4 * step[:, i].max() or room < 1e-3 * size:
            continue  # branches meet here: no one can tell them apart
        # every point is nearer to its own continuation than to any other branch's
        gap = np.abs(near[:, None] - b[:, i + 1][None, :])
        assert (gap.argmin(axis=1) == np.arange(near.size)).all(), (i, locus.gains[i])


@pytest.mark.parametrize("text", TEXTS)
def test_the_locus_is_symmetric(text: str) -> None:
    locus = root_locus(parse_transfer_function(text))
    for i in range(0, locus.gains.size, 7):
        s = locus.branches[:, i]
        assert distance_of_sets(s, s.conj()) <= 1e-6 * max(1.0, np.abs(s).max())


@pytest.mark.parametrize(
    ("text", "breakaways"),
    [
        ("2(s+1)/(s(s-4))", [(5**0.5 - 1, 0.7639320225002103), (-(5**0.5) - 1, 5.23606797749979)]),
        ("1/(s(s+2))", [(-1, 1.0)]),
        ("1/(s(s+1)(s+2))", [(-1 + 3**-0.5, 2 / 27**0.5)]),
        ("(s+2)/(s(s+1))", [(-2 + 2**0.5, 3 - 8**0.5), (-2 - 2**0.5, 3 + 8**0.5)]),
        ("1/((s+1)(s+2)(s+3))", [(-2 + 3**-0.5, 2 / 27**0.5)]),
        ("(s+1)/s^2", [(-2, 4.0)]),
        ("1/(s^2+0.02s+1)", []),
        ("1/(s(s+4)(s^2+4s+20))", [(-2, 64.0), (-2 + 6**0.5 * 1j, 100.0), (-2 - 6**0.5 * 1j, 100.0)]),
    ],
)
def test_breakaways_in_closed_form(text: str, breakaways: list[tuple[complex, float]]) -> None:
    found = root_locus(parse_transfer_function(text)).breakaways
    assert len(found) == len(breakaways)
    for s, K in breakaways:
        assert any(abs(b.s - s) < 1e-9 and abs(b.K - K) < 1e-8 * K for b in found), (s, K, found)
        L = parse_transfer_function(text)
        assert abs(1 + K * L(s)) < 1e-9


@pytest.mark.parametrize(
    ("m", "n", "a", "b"), [(5, 5, 1, 3), (5, 2, 1, 3), (7, 3, 1, 2), (9, 6, 0.5, 2), (-3, 7, 1, 3), (3, -7, 2, 0.25)]
)
def test_repeated_roots_are_no_breakaways(m: int, n: int, a: float, b: float) -> None:
    """1/((s+a)^m (s+b)^n): m/(s+a) + n/(s+b) = 0 at s = -(m b + n a)/(m+n) and nowhere else; -m: a zero."""
    s = -(m * b + n * a) / (m + n)
    K = -((s + a) ** m) * (s + b) ** n
    power = {True: lambda r, k: f"(s+{r})^{k}", False: lambda r, k: "1"}
    num = "*".join(power[k < 0](r, -k) for r, k in ((a, m), (b, n)))
    den = "*".join(power[k > 0](r, k) for r, k in ((a, m), (b, n)))
    found = breakaway_points(parse_transfer_function(f"{num}/({den})"))
    assert [(x.s, x.K) for x in found] == (
        [(pytest.approx(s, rel=1e-12), pytest.approx(K, rel=1e-12))] if K > 0 else []
    )


@pytest.mark.parametrize("n", [9, 30, 50])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_between_many_real_poles_there_is_a_breakaway_each(n: int, sign: float) -> None:
    """L = +-1/((s+1)(s+2)...(s+n)): by Rolle one turning point in each gap, on the locus in every other."""
    breaks = breakaway_points(TransferFunction((), -np.arange(1.0, n + 1), sign))
    gaps = [k for k in range(1, n) if (k % 2 == 1) == (sign > 0)]
    assert sorted(int(-b.s.real) for b in breaks) == gaps
    for b in breaks:
        away = 1 / (b.s + np.arange(1, n + 1))
        assert b.s.imag == 0
        assert abs(away.sum()) <= 1e-11 * np.abs(away).sum()
        assert np.log(b.K) == pytest.approx(-np.log(np.abs(away)).sum(), abs=1e-11)


@pytest.mark.parametrize("rate", [1e-9, 1e6])
def test_breakaways_in_any_time_unit(rate: float) -> None:
    """(s+3)/(s(s+1)) meets at s = -3 +- sqrt(6), K = 5 +- sqrt(24)."""
    L = TransferFunction([-3 * rate], [0, -rate])
    found = [(b.s / rate, b.K / rate) for b in breakaway_points(L)]
    x = 6**0.5
    assert found == [
        (pytest.approx(-3 + x, rel=1e-12), pytest.approx(5 - 2 * x, rel=1e-12)),
        (pytest.approx(-3 - x, rel=1e-12), pytest.approx(5 + 2 * x, rel=1e-12)),
    ]


@pytest.mark.parametrize(
    ("text", "crossings"),
    [
        ("1/(s+1)^3", [(3**0.5, 8.0)]),
        ("1/(s(s+1)(s+2))", [(2**0.5, 6.0)]),
        ("2(s+1)/(s(s-4))", [(2.0, 2.0)]),
        ("1/(s-1)", [(0.0, 1.0)]),
        ("(s+1)^2/s^3", [(1.0, 0.5)]),
        ("1/((s+1)(s+2))", []),
        ("(1-s)/(s+1)^2", [(3**0.5, 2.0)]),
    ],
)
def test_crossings_of_the_axis_in_closed_form(text: str, crossings: list[tuple[float, float]]) -> None:
    found = [(c.omega, c.K) for c in root_locus(parse_transfer_function(text)).imaginary_axis_crossings]
    assert found == [pytest.approx(c, rel=1e-11, abs=1e-12) for c in crossings]


def test_asymptotes() -> None:
    locus = root_locus(parse_transfer_function("(s+3)/(s(s+1)(s+2)(s+5))"))
    assert locus.asymptotes.centroid == pytest.approx((0 - 1 - 2 - 5 + 3) / 3)
    assert sorted(a % 360 for a in locus.asymptotes.angles_deg) == pytest.approx([60, 180, 300])
    assert root_locus(parse_transfer_function("(s+3)/(s+1)")).asymptotes.centroid is None


@effort(25)
@given(systems(order=(2, 5), stable=False))
def test_random_breakaways_are_double_roots(L: TransferFunction) -> None:
    assume(L.gain > 0)
    for b in root_locus(L).breakaways:
        p = np.polyadd(np.poly(L.poles), b.K * L.gain * np.poly(L.zeros))
        dp = np.polyder(p)
        size = np.polyval(np.abs(p), abs(b.s))
        assert abs(np.polyval(p, b.s)) <= 1e-8 * size
        assert abs(np.polyval(dp, b.s)) <= 1e-6 * np.polyval(np.abs(dp), abs(b.s))


@pytest.mark.parametrize(
    "L",
    [TransferFunction((), (), 2.0), TransferFunction((), (-1,), 0.0), TransferFunction((), [-1e7] * 50)],
)
def test_what_has_no_locus(L: TransferFunction) -> None:
    with pytest.raises(InvalidInput) as caught:
        root_locus(L)
    assert caught.value.message


def test_the_window_is_not_drawn_around_a_slow_pole_that_a_zero_makes_up_for() -> None:
    """1/(s+1)^3 with a slow integral action: the three lags and the crossing matter, not the pair at 0 and -0.1."""
    locus = root_locus(parse_transfer_function("(s+0.1)/(s (s+1)^3)"))
    (left, _), (_, top) = locus.view
    assert left < -1.0
    assert top > min(c.omega for c in locus.imaginary_axis_crossings if c.omega > 0)
