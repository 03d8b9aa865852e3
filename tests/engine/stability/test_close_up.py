"""The locus in a window: on the locus, nothing missing, no corner at the window's own scale."""

import numpy as np
import pytest
from scipy.special import lambertw

from looplab.engine.errors import InvalidInput
from looplab.engine.stability import root_locus
from looplab.engine.stability.locus.close_up import LocusCloseUp, locus_close_up
from looplab.engine.systems import TransferFunction, parse_transfer_function

Window = tuple[tuple[float, float], tuple[float, float]]


def around(s: complex, half: float) -> Window:
    return ((s.real - half, s.real + half), (s.imag - half, s.imag + half))


def in_units(view: Window, s: np.ndarray) -> np.ndarray:
    (left, right), (bottom, top) = view
    return (s.real - left) / (right - left) + 1j * (s.imag - bottom) / (top - bottom)


def distance(close_up: LocusCloseUp, s: complex) -> float:
    """From a point to the lines drawn, in widths of the window."""
    (at,) = in_units(close_up.view, np.array([s]))
    nearest = np.inf
    for piece in close_up.pieces:
        z = in_units(close_up.view, piece.s)
        along = np.diff(z)
        share = ((at - z[:-1]) * along.conj()).real / np.maximum(np.abs(along) ** 2, 1e-300)
        nearest = min(nearest, np.abs(at - z[:-1] - np.clip(share, 0, 1) * along).min())
    return float(nearest)


def inside(view: Window, s: np.ndarray) -> np.ndarray:
    z = in_units(view, s)
    return (z.real > 0) & (z.real < 1) & (z.imag > 0) & (z.imag < 1)


B = -1 + 3**-0.5  # 3 s^2 + 6 s + 2 = 0: where two branches of 1/(s(s+1)(s+2)) meet
COMPLEX = -1 + 1.5811388300841898j  # s^2 + 2 s + 3.5 = 0 for 1/(s(s+2)(s^2+2s+5)), off the real axis
CASES: list[tuple[str, Window]] = [
    ("1/(s(s+1)(s+2))", around(B, 0.01)),
    ("1/(s(s+1)(s+2))", around(B, 1e-4)),
    ("1/(s(s+1)(s+2))", ((-0.05, 0.05), (1.38, 1.44))),
    ("1/(s(s+2)(s^2+2s+5))", around(COMPLEX, 0.01)),
    ("(s+3)/(s(s+1))", around(-5.449489742783178, 0.003)),
    ("(s+3)/(s(s+1))", around(-3.0, 0.01)),
    ("-1/(s+1)^3", around(0.0, 0.05)),
    ("1/((s^2+0.2s+4)(s+1))", around(-0.1 + 1.99749843554382j, 0.01)),
]


@pytest.mark.parametrize(("text", "view"), CASES)
def test_points_solve_the_equation_and_no_root_is_missing(text: str, view: Window) -> None:
    L = parse_transfer_function(text)
    found = locus_close_up(L, view)
    assert found.complete
    gains = np.unique(np.concatenate([p.gains for p in found.pieces]))
    num, den = L.gain * np.poly(L.zeros), np.poly(L.poles)
    for K in np.linspace(gains[0], gains[-1], 60) if gains[-1] < 1e3 else np.geomspace(gains[1], gains[-1], 60):
        roots = np.roots(np.polyadd(den, K * num)).astype(complex)
        for s in roots[inside(view, roots)]:
            # Double roots are known to numpy to half the digits; the line is a chord of the curve.
            assert distance(found, s) < 2e-3
    for piece in found.pieces:
        positive = piece.gains > 0
        assert (np.diff(piece.gains) > 0).all()
        value = piece.gains[positive] * L(piece.s[positive])
        knowable = 1e-14 * np.abs(piece.s[positive] * L.log_derivative(piece.s[positive]))
        assert (np.abs(1 + value) < np.maximum(1e-8, knowable)).all()


@pytest.mark.parametrize(("text", "view"), CASES)
def test_it_is_smooth_at_the_scale_of_the_window(text: str, view: Window) -> None:
    L = parse_transfer_function(text)
    meetings = [b.s for b in root_locus(L).breakaways]
    pieces = locus_close_up(L, view).pieces
    assert pieces
    for piece in pieces:
        z = in_units(view, piece.s)
        step = np.diff(z)
        seen = inside(view, piece.s[1:-1])
        assert (np.abs(step[1:])[seen] < 0.041).all()
        turn = np.abs(np.angle(step[1:] / step[:-1]))
        corner = np.array([min(abs(s - m) for m in meetings) == 0.0 if meetings else False for s in piece.s[1:-1]])
        small = np.minimum(np.abs(step[1:]), np.abs(step[:-1])) < 0.0041
        assert (turn[seen & ~corner & ~small] < 0.11).all()


def test_two_branches_meet_in_the_breakaway_at_right_angles() -> None:
    found = locus_close_up(parse_transfer_function("1/(s(s+1)(s+2))"), around(B, 1e-4))
    on_it = [(p, int(np.flatnonzero(np.abs(p.s - B) < 1e-12)[0])) for p in found.pieces]
    assert len(on_it) == 2
    turns = sorted(np.degrees(np.angle((p.s[i + 1] - p.s[i]) / (p.s[i] - p.s[i - 1]))) for p, i in on_it)
    assert np.abs(turns) == pytest.approx([90, 90], abs=1)


def test_an_integrator_with_dead_time_is_lamberts_function() -> None:
    """exp(-s)/s: s = W(-K), two real branches that meet at -1 for K = 1/e."""
    view = around(-1.0, 0.01)
    found = locus_close_up(parse_transfer_function("exp(-s)/s"), view)
    assert found.complete
    for K in np.linspace(0.36785, 0.36791, 41):
        for branch in (0, -1):
            s = complex(lambertw(-K, branch))
            for root in (s, s.conjugate()):
                if inside(view, np.array([root]))[0]:
                    assert distance(found, root) < 2e-3
    for piece in found.pieces:
        assert np.abs(piece.s * np.exp(piece.s) + piece.gains).max() < 1e-14


def test_a_branch_is_followed_into_its_zero() -> None:
    found = locus_close_up(parse_transfer_function("(s+3)/(s(s+1))"), around(-3.0, 1e-4))
    assert min(abs(p.s[-1] + 3) for p in found.pieces) < 1e-6


def test_beside_the_locus_there_is_nothing() -> None:
    assert locus_close_up(parse_transfer_function("1/(s(s+1))"), around(-0.8 + 0.5j, 0.05)).pieces == ()


@pytest.mark.parametrize("view", [((1, 0), (0, 1)), ((0, 1), (0, 0)), ((-1 - 1e-9, -1), (-1, 1))])
def test_a_window_that_shows_nothing_is_refused(view: Window) -> None:
    with pytest.raises(InvalidInput) as refused:
        locus_close_up(TransferFunction([], [-1.0, -2.0], 1.0), view)
    assert refused.value.field == "view"
