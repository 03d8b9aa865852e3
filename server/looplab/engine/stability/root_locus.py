"""The root locus of a rational open loop: branches joined right, with the points that students construct by hand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.frequency.crossings import crossings
from looplab.engine.stability.polish import polish_closed_loop_poles
from looplab.engine.systems.polynomial import from_roots, pair_conjugates, roots
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

MAX_GAINS = 700


@dataclass(frozen=True)
class Breakaway:
    """Two or more branches meet at s [rad/time] for the gain K."""

    s: complex
    K: float


@dataclass(frozen=True)
class AxisCrossing:
    """A branch crosses the imaginary axis at j omega [rad/time] for the gain K."""

    omega: float
    K: float


@dataclass(frozen=True)
class RootLocus:
    """Closed-loop poles over the gain.

    Attributes
    ----------
    gains : ndarray, shape (m,)
        Increasing from 0, closer where branches turn.
    branches : ndarray of complex, shape (n, m)
        Row i is one branch from the open-loop pole i [rad/time].
    centroid : float or None
        Where the asymptotes meet; None without asymptotes.
    angles_deg : ndarray
        Directions of the asymptotes, (2k+1) 180/(n-m) for K > 0 [deg].
    breakaways, imaginary_axis_crossings : tuple
    view : ((float, float), (float, float))
        A window (re, im) that shows what matters [rad/time].
    """

    gains: FloatArray
    branches: ComplexArray
    open_loop_poles: ComplexArray
    open_loop_zeros: ComplexArray
    centroid: float | None
    angles_deg: FloatArray
    breakaways: tuple[Breakaway, ...]
    imaginary_axis_crossings: tuple[AxisCrossing, ...]
    view: tuple[tuple[float, float], tuple[float, float]]


def breakaway_points(L: TransferFunction) -> tuple[Breakaway, ...]:
    r"""Points where branches meet for a positive gain: roots of N'D - ND' = 0 with K = -D/N real and positive.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, sec. 6-2.
    """
    if not L.order:
        return ()
    # In units of a typical root: expanded in other units the coefficients spread over hundreds of decades.
    sizes = np.abs(np.concatenate([L.zeros, L.poles]))
    unit = float(np.exp(np.mean(np.log(sizes[sizes > 0])))) if (sizes > 0).any() else 1.0
    N, D = from_roots(L.zeros / unit), from_roots(L.poles / unit)
    left, right = np.polymul(np.polyder(N), D), np.polymul(N, np.polyder(D))
    candidates = unit * roots(np.polysub(left, right))
    out: list[Breakaway] = []
    repeated = L.poles[[np.count_nonzero(L.poles == p) > 1 for p in L.poles]]
    for s in candidates:
        s = _newton_on_log_derivative(L, s)
        if repeated.size and np.min(np.abs(repeated - s)) < 1e-5 * max(1.0, abs(s)):
            continue
        value = L(s)
        if not (np.isfinite(value) and value != 0):
            continue
        K = -1.0 / value
        fresh = all(abs(b.s - s) > 1e-6 * max(1.0, abs(s)) for b in out)
        if K.real > 0 and abs(K.imag) < 1e-7 * abs(K) and fresh:
            out.append(Breakaway(complex(s.real, 0.0 if abs(s.imag) < 1e-9 * abs(s) else s.imag), float(K.real)))
    return tuple(sorted(out, key=lambda b: b.K))


def _newton_on_log_derivative(L: TransferFunction, s: complex) -> complex:
    for _ in range(4):
        with np.errstate(all="ignore"):
            f = complex(L.log_derivative(np.array([s]))[0])
            slope = (-1.0 / (s - L.zeros) ** 2).sum() + (1.0 / (s - L.poles) ** 2).sum()
            step = np.divide(f, slope)
        if not np.isfinite(step) or abs(step) > 0.1 * max(abs(s), 1e-6):
            break
        s = s - step
    return s


def axis_crossings(L: TransferFunction) -> tuple[AxisCrossing, ...]:
    """Gains at which a branch crosses the imaginary axis: the phase crossovers, with K = 1/|L|; and s = 0."""
    found = crossings(L)
    out = [
        AxisCrossing(float(w), float(np.exp(-m)))
        for w, m in zip(found.phase_omega, found.phase_log_magnitude, strict=True)
        if np.isfinite(m)
    ]
    if L.origin_order == 0 and L.origin_gain < 0:
        out.append(AxisCrossing(0.0, -1.0 / L.origin_gain))
    return tuple(sorted(out, key=lambda c: c.K))


def _poles_at(L: TransferFunction, gains: FloatArray) -> ComplexArray:
    """Closed-loop poles for each gain, unsorted, shape (m, n)."""
    ss = realize(L)
    effective = gains / (1.0 + gains * ss.D)
    found = np.linalg.eigvals(ss.A - effective[:, None, None] * np.outer(ss.B, ss.C)).astype(complex)
    polished, good = polish_closed_loop_poles(L, found, gains[:, None], steps=3)
    # Near a break-away Newton may pull two roots into one: keep the eigenvalues there.
    good &= np.abs(polished - found) < 0.2 * _nearest_neighbour(found)
    out = np.where(good, polished, found)
    out[gains == 0.0] = L.poles
    return out


def _nearest_neighbour(points: ComplexArray) -> FloatArray:
    n = points.shape[-1]
    if n == 1:
        return np.full(points.shape, np.inf)
    gap = np.abs(points[:, :, None] - points[:, None, :])
    gap[:, np.arange(n), np.arange(n)] = np.inf
    return gap.min(axis=-1)


def _join(L: TransferFunction, gains: FloatArray, poles: ComplexArray) -> ComplexArray:
    """Order each row so that columns are continuous branches: nearest to the predicted pole, assigned where unclear."""
    out = poles.copy()
    for i in range(1, len(gains)):
        guess = out[i - 1]
        if i > 1 and gains[i - 1] > gains[i - 2]:
            guess = guess + (out[i - 1] - out[i - 2]) * _ratio(gains[i - 2 : i + 1])
        gap = np.abs(guess[:, None] - out[i][None, :])
        nearest = gap.argmin(axis=1)
        if np.unique(nearest).size != nearest.size:
            from scipy.optimize import linear_sum_assignment

            nearest = linear_sum_assignment(np.abs(out[i - 1][:, None] - out[i][None, :]) ** 2)[1]
        out[i] = out[i][nearest]
    return out.T


def _ratio(g: FloatArray) -> float:
    if g[0] <= 0:
        return 0.0
    return float(min(np.log(g[2] / g[1]) / np.log(g[1] / g[0]), 2.0))


def _view(
    L: TransferFunction, breaks: tuple[Breakaway, ...], crossed: tuple[AxisCrossing, ...]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """A window on what matters: the slow roots, the meeting points and the first crossing of the imaginary axis.

    A root much faster than the rest (a filter pole) is left outside.
    """
    every = np.concatenate([L.poles, L.zeros])
    size = np.sort(np.abs(every[every != 0]))
    slow = float(size[-1]) if size.size else 1.0
    for small, large in pairwise(size):
        if large > 6.0 * small and np.count_nonzero(np.abs(every) <= small) >= 2:
            slow = float(small)
            break
    shown = [r for r in every if abs(r) <= 1.001 * slow]
    shown += [b.s for b in breaks if abs(b.s) <= 3.0 * slow]
    first = [c.omega for c in crossed if 0 < c.omega <= 8.0 * slow][:1]
    points = np.array([*shown, *(1j * w for w in first)])
    half = 1.4 * max(float(np.abs(points.imag).max(initial=0.0)), 0.8 * slow)
    left, right = min(float(points.real.min(initial=0.0)), 0.0), max(float(points.real.max(initial=0.0)), 0.0)
    pad = 0.35 * half
    return (min(left - pad, -0.9 * half), right + pad), (-half, half)


def _refine(L: TransferFunction, gains: FloatArray, size: float) -> tuple[FloatArray, ComplexArray]:
    """Add gains where a branch jumps or turns, until it looks smooth in a window of the given size."""
    poles = _poles_at(L, gains)
    coarse: npt.NDArray[np.bool_]
    for _ in range(5):
        branches = _join(L, gains, poles)
        step = np.abs(np.diff(branches, axis=1))
        inside = np.minimum(np.abs(branches[:, 1:]), np.abs(branches[:, :-1])) < 3.0 * size
        coarse = np.asarray(((step > 0.04 * size) & inside).any(axis=0))
        middle = branches[:, 1:-1]
        a, b = middle - branches[:, :-2], branches[:, 2:] - middle
        with np.errstate(all="ignore"):
            turn = np.abs(np.angle(b / a))
        # A right-angled break-away is a true corner; elsewhere a turn wants more points.
        bend = (turn > 0.15) & (np.minimum(np.abs(a), np.abs(b)) > 0.004 * size) & inside[:, 1:]
        coarse[:-1] |= bend.any(axis=0)
        coarse[1:] |= bend.any(axis=0)
        if not coarse.any() or gains.size > MAX_GAINS:
            break
        low, high = gains[:-1][coarse], gains[1:][coarse]
        extra = np.where(low > 0, np.sqrt(low * high), high / 4.0)
        new = _poles_at(L, extra)
        gains = np.concatenate([gains, extra])
        poles = np.concatenate([poles, new])
        order = np.argsort(gains, kind="stable")
        gains, poles = gains[order], poles[order]
    return gains, _join(L, gains, poles)


@lru_cache(maxsize=128)
def root_locus(L: TransferFunction) -> RootLocus:
    r"""Closed-loop poles for a gain K from 0 upwards.

    .. math:: 1 + K L(s) = 0

    Parameters
    ----------
    L : TransferFunction
        Proper open loop for K = 1, without dead time, of order 1 at least.

    Returns
    -------
    RootLocus
        Each point satisfies the characteristic equation in factored form; break-away gains are on the grid, so that
        corners are sharp, and the grid is closer where a branch turns.

    Raises
    ------
    InvalidInput
        L has a dead time, no poles, or zero gain.

    References
    ----------
    .. [1] W. R. Evans, Trans. AIEE 69 (1950) 66-69.
    """
    if L.theta:
        raise InvalidInput("the rational root locus takes no dead time", field="theta")
    if not L.order or L.gain == 0.0:
        raise InvalidInput("the loop has no poles that could move", field="plant")
    breaks, crossed = breakaway_points(L), axis_crossings(L)
    view = _view(L, breaks, crossed)
    size = max(view[0][1] - view[0][0], view[1][1])
    # Gains that matter: from where poles barely move to where the asymptotes have left the window.
    marks = [b.K for b in breaks] + [c.K for c in crossed if c.K > 0]
    excess = max(L.relative_degree, 1)
    leave = (1.5 * size) ** excess / abs(L.gain) if L.relative_degree else 10.0 / abs(L.gain)
    low = min([*marks, leave]) * 1e-3
    high = max([10.0 * m for m in marks] + [100.0 * leave])
    start = np.concatenate([[0.0], np.logspace(np.log10(low), np.log10(high), 90), marks])
    gains, branches = _refine(L, np.unique(start), size)
    n_minus_m = L.relative_degree
    centroid, angles = None, np.zeros(0)
    if n_minus_m > 0:
        centroid = float((L.poles.sum() - L.zeros.sum()).real / n_minus_m)
        first = 180.0 if L.gain > 0 else 0.0
        angles = (first + 360.0 * np.arange(n_minus_m)) / n_minus_m
    return RootLocus(gains, branches, L.poles, L.zeros, centroid, angles, breaks, crossed, view)


def poles_at_gain(L: TransferFunction, K: float) -> ComplexArray:
    """Closed-loop poles of 1 + K L(s) = 0 for one gain, conjugates paired, shape (n,)."""
    return pair_conjugates(_poles_at(L, np.array([K]))[0])
