"""Closed-loop poles counted independently of the engine: the argument principle on the characteristic function.

F(s) = D(s) + N(s) e^{-theta s} is entire, so the turns of F along a closed path equal the zeros inside it. The path is
the imaginary axis from -iR to iR (moved by ``shift``) and the right half circle; R is taken so large that no zero lies
beyond it. Steps are halved until F turns by less than 0.35 rad in each, and once more to be sure.
"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

Function = Callable[[np.ndarray], np.ndarray]


def from_roots(roots: Sequence[complex], gain: complex = 1.0) -> Function:
    def value(s: np.ndarray) -> np.ndarray:
        out = np.full(s.shape, complex(gain))
        for r in roots:
            out = out * (s - r)
        return out

    return value


def _turn(F: Function, path: Function, a: float, b: float, step: float) -> float:
    """Change of arg F along path from a to b; neighbours are closer than ``step`` and turn by less than 0.35 rad."""
    v = np.linspace(a, b, 257)
    value = F(path(v))
    total = math.nan
    for _ in range(60):
        turns = np.angle(value[1:] / value[:-1])
        coarse = (np.abs(turns) > 0.35) | (np.abs(np.diff(path(v))) > step)
        if not coarse.any():
            if abs(turns.sum() - total) < 0.1:
                return float(turns.sum())
            total = float(turns.sum())
            coarse[:] = True  # once more, twice as fine
        middle = 0.5 * (v[1:] + v[:-1])[coarse]
        at = np.flatnonzero(coarse) + 1
        v, value = np.insert(v, at, middle), np.insert(value, at, F(path(middle)))
        if (value == 0).any() or v.size > 4_000_000:
            break
    raise ValueError("a root lies on the path")


def count_right_of(D: Function, N: Function, theta: float, radius: float, shift: float = 0.0) -> int:
    """Zeros of D + N e^{-theta s} with Re s > shift and |s - shift| < radius."""

    def F(s: np.ndarray) -> np.ndarray:
        return D(s) + N(s) * np.exp(-theta * s)

    step = 0.5 / theta if theta else math.inf  # e^{-theta s} turns unseen between two far points
    axis = _turn(F, lambda v: shift + 1j * np.sinh(v), math.asinh(radius), math.asinh(-radius), step)
    arc = _turn(F, lambda v: shift + radius * np.exp(1j * v), -math.pi / 2, math.pi / 2, step)
    return round((axis + arc) / (2 * math.pi))


def count_in_box(D: Function, N: Function, theta: float, left: float, right: float, top: float) -> int:
    """Zeros of D + N e^{-theta s} with left < Re s < right and |Im s| < top."""

    def F(s: np.ndarray) -> np.ndarray:
        # Divided by the larger term in size only: neither overflows, and the phase stays.
        a, b = D(s), N(s)
        grow = -theta * s.real
        size = np.maximum(np.log(np.abs(a) + 1e-300), np.log(np.abs(b) + 1e-300) + grow)
        return a * np.exp(-size) + b * np.exp(grow - size - 1j * theta * s.imag)

    step = 0.5 / theta if theta else math.inf
    corners = [left - 1j * top, right - 1j * top, right + 1j * top, left + 1j * top, left - 1j * top]
    turns = 0.0
    for a, b in pairwise(corners):
        turns += _turn(F, lambda v, a=a, b=b: a + (b - a) * v, 0.0, 1.0, step)  # type: ignore[misc]
    return round(turns / (2 * math.pi))


def proved_rhp_roots(zeros: Sequence[complex], poles: Sequence[complex], gain: float) -> int | None:
    """Roots of D + N right of the imaginary axis by inclusion discs, which hold all roots; None if one meets the axis.

    Around approximate roots z_i of a polynomial p of degree n and leading coefficient a the discs of radius
    n |p(z_i)| / |a prod(z_i - z_j)| together hold every root, each connected part as many as it has discs
    (B. T. Smith, J. ACM 17 (1970) 661-674).
    """
    lead = 1.0 + (gain if len(zeros) == len(poles) else 0.0)
    z = np.roots(np.polyadd(np.poly(poles), gain * np.atleast_1d(np.poly(zeros))))
    D, N = from_roots(poles)(z), from_roots(zeros, gain)(z)
    rounding = 8 * (len(zeros) + len(poles)) * np.finfo(float).eps
    apart = z[:, None] - z
    np.fill_diagonal(apart, 1.0)
    with np.errstate(divide="ignore"):
        radius = z.size * (np.abs(D + N) + rounding * (np.abs(D) + np.abs(N))) / np.abs(lead * apart.prod(axis=1))
    return None if (np.abs(z.real) <= radius).any() else int(np.count_nonzero(z.real > 0))


def _reach(roots: Sequence[complex], radius: float, side: int) -> float:
    """Bound on prod |s - r| for |s| = radius: the largest (+1) or the smallest (-1) it can be."""
    return math.prod(radius + side * abs(r) for r in roots)


def rhp_closed_loop_poles(
    zeros: Sequence[complex], poles: Sequence[complex], gain: float, theta: float = 0.0, shift: float = 0.0
) -> int:
    """Closed-loop poles right of ``shift`` of L = gain prod(s-z)/prod(s-p) e^{-theta s}, under unit negative feedback.

    Needs deg N < deg D, or with dead time |gain| < 1, so that they are finitely many.
    """
    size = max([abs(r) for r in [*zeros, *poles]], default=0.0) + abs(shift)
    excess = len(poles) - len(zeros)
    if excess == 0:
        room = 1 - abs(gain) if theta else abs(1 + gain)
        if room <= 0:
            raise ValueError("infinitely many, or a root at infinity")
        radius = 20.0 * (size + 1.0) * (1 + len(poles)) / room
    else:
        # From here on |N e^{-theta s}| < |D|.
        lift = math.exp(-theta * min(shift, 0.0))
        radius = 2.0 * (size + abs(shift)) + 1e-3
        while abs(gain) * lift * _reach(zeros, radius + abs(shift), 1) > 0.9 * _reach(poles, radius - abs(shift), -1):
            radius *= 1.5
    return count_right_of(from_roots(poles), from_roots(zeros, gain), theta, radius, shift)
