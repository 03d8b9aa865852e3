"""What students construct by hand on a root locus: meeting points, axis crossings, angles, segments, the window."""

from __future__ import annotations

from cmath import phase
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import degrees, exp, inf, isfinite, log
from operator import attrgetter

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.crossings import crossings
from looplab.engine.frequency.scalar import TINY, scalar_loop
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.polynomial import eigenvalues
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
# Each root once, with its multiplicity.
Weights = Sequence[tuple[complex, int]]
TURNING_STEPS = 6
# Of a gain that is a number, and so is a hundred times as much.
LARGEST_LOG = 690.0
# Half height of the picture in units of 1/theta.
WIDEST_IN_DEAD_TIMES = 10.0
Window = tuple[tuple[float, float], tuple[float, float]]


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
class Angle:
    """Direction in which a branch leaves the open-loop pole s, or arrives at the zero s [deg, in (-180, 180]]."""

    s: complex
    angle_deg: float


@dataclass(frozen=True)
class Asymptotes:
    """Where branches go for K to infinity.

    Attributes
    ----------
    centroid : float or None
        Where straight asymptotes meet [rad/time]; None without them.
    angles_deg : ndarray
        Their directions, (2k+1) 180/(n-m) for K > 0 and a positive leading gain [deg].
    horizontal : ndarray
        With dead time: heights Im s that branches tend to on the far right, within the window [rad/time].
    """

    centroid: float | None
    angles_deg: FloatArray
    horizontal: FloatArray


def asymptotes(L: TransferFunction, top: float) -> Asymptotes:
    r"""Asymptotes of 1 + K L = 0 for K from 0 to infinity.

    .. math::

        \sigma = \frac{\sum p - \sum z}{n - m}, \quad \phi_k = \frac{(2k+1)\pi}{n-m}; \qquad
        \text{with dead time}\quad \mathrm{Im}\, s \to \frac{(2k+1)\pi}{\theta}

    Parameters
    ----------
    L : TransferFunction
    top : float
        Largest height of interest [rad/time].

    Returns
    -------
    Asymptotes

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, sec. 6-2.
    """
    none = np.zeros(0)
    turn = 1.0 if L.gain > 0 else 0.0
    if L.theta:
        last = int(np.floor(top * L.theta / (2 * np.pi))) + 1
        heights = (2.0 * np.arange(-last, last + 1) + turn) * np.pi / L.theta
        return Asymptotes(None, none, heights[np.abs(heights) <= top])
    excess = L.relative_degree
    if excess <= 0:
        return Asymptotes(None, none, none)
    centroid = (sum(L.poles.tolist()) - sum(L.zeros.tolist())).real / excess
    return Asymptotes(centroid, (180.0 * turn + 360.0 * np.arange(excess)) / excess, none)


def _wrapped(degrees: float) -> float:
    return float(180.0 - (180.0 - degrees) % 360.0)


def departure_angles(L: TransferFunction) -> tuple[Angle, ...]:
    r"""Directions in which branches leave the complex open-loop poles (every branch of a repeated one).

    .. math:: m\,\phi = 180^\circ + \arg L_{-p}(p) + 360^\circ k

    with m the multiplicity of p and L_{-p} the open loop without the factors of p.

    Parameters
    ----------
    L : TransferFunction
        Dead time adds -theta Im p.

    Returns
    -------
    tuple of Angle
        Poles that cancel against a zero are left out: their branch is a point.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, sec. 6-2.
    """
    return _angles(L, L.poles, 1.0)


def arrival_angles(L: TransferFunction) -> tuple[Angle, ...]:
    """Directions from which branches arrive at the complex zeros."""
    return _angles(L, L.zeros, -1.0)


def _angles(L: TransferFunction, at: ComplexArray, sign: float) -> tuple[Angle, ...]:
    out: list[Angle] = []
    every, zeros, poles = at.tolist(), L.zeros.tolist(), L.poles.tolist()
    for r in dict.fromkeys(r for r in every if r.imag):
        same = every.count(r)
        if zeros.count(r) + poles.count(r) > same:
            continue  # a pole on a zero: the branch is a point
        turns = sum(phase(r - z) for z in zeros if z != r) - sum(phase(r - p) for p in poles if p != r)
        total = sign * (180.0 + degrees(turns - L.theta * r.imag) + (0.0 if L.gain > 0 else 180.0))
        out += [Angle(r, _wrapped((total + 360.0 * k) / same)) for k in range(same)]
    return tuple(out)


def real_axis_segments(L: TransferFunction) -> tuple[tuple[float | None, float | None], ...]:
    """Parts of the real axis on the locus, right to left: an odd number of real roots lies to the right (K L(0) > 0).

    An end that is None is infinite.
    """
    marks = sorted((r.real for r in (*L.poles.tolist(), *L.zeros.tolist()) if not r.imag), reverse=True)
    edges = [None, *marks, None]
    out: list[tuple[float | None, float | None]] = []
    for i, (right, left) in enumerate(pairwise(edges)):
        odd = i % 2 == 1
        if odd == (L.gain > 0) and right != left:
            if out and out[-1][0] == right and right is not None:
                out[-1] = (left, out[-1][1])
            else:
                out.append((left, right))
        elif right == left:
            continue
    return tuple(out)


def breakaway_points(L: TransferFunction) -> tuple[Breakaway, ...]:
    r"""Points where branches meet for a positive gain.

    .. math:: \frac{d}{ds} \ln L = 0 \iff \theta N D + D'N - N'D = 0, \qquad K = -\frac{1}{L(s)} > 0

    Parameters
    ----------
    L : TransferFunction
        Open loop for K = 1, dead time allowed.

    Returns
    -------
    tuple of Breakaway
        By increasing gain; complex ones with their conjugates. Open-loop poles that are repeated (K = 0) are left out.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, sec. 6-2.
    """
    L, _ = split_hidden_modes(L)
    if not L.order:
        return ()
    weights = list(L.multiplicities.items())
    sizes = [abs(r) for r, _ in weights if r]
    unit = exp(sum(map(log, sizes)) / len(sizes)) if sizes else 1.0
    loop = scalar_loop(L.unit)
    out: list[Breakaway] = []
    for start in _turning_points(weights, L.theta):
        s = _newton_on_turning(start, weights, L.theta, 1e-7 * unit)
        if s is None or -L.theta * s.real > LARGEST_LOG:
            continue  # not a meeting point, or one at a gain below double precision
        value, _ = loop.value_and_rate(s, abs(L.gain))
        K = -1.0 / value if value else complex(inf)
        if not (isfinite(K.real) and K.real > 0.0 and abs(K.imag) < 1e-7 * K.real):
            continue
        if abs(s.imag) < 1e-9 * abs(s):
            s = complex(s.real)
        if all(abs(b.s - s) > 1e-6 * max(0.1 * unit, abs(s)) for b in out):
            out += [Breakaway(at, K.real) for at in ((s, s.conjugate()) if s.imag else (s,))]
    return tuple(sorted(out, key=attrgetter("K")))


def _turning_points(weights: Weights, theta: float) -> list[complex]:
    """Approximate zeros of sum w/(s - r) - theta = c (s - A)^-1 b - theta, upper half, some that are none among them.

    They are eigenvalues: of A + b c/theta; without dead time of A - b c A^(k+1)/(c A^k b) with the first k for which
    that can be divided by, since the first derivatives of the output of A, b, c are then kept at zero. A polynomial of
    the same zeros has none of their digits left from order 30 on.
    """
    upper = [(r, w) for r, w in weights if r.imag >= 0.0]
    A = np.zeros((len(weights), len(weights)))
    b, c = np.zeros(len(weights)), np.zeros(len(weights))
    at = 0
    for r, w in upper:
        A[at, at], b[at], c[at] = r.real, 1.0, w
        if r.imag:
            # w/(s - r) and its conjugate as one block of two real states.
            A[at, at + 1], A[at + 1, at], A[at + 1, at + 1], c[at] = r.imag, -r.imag, r.real, 2.0 * w
            at += 1
        at += 1
    row, divisor = c, -theta
    if not theta:
        # Hardly different from zero where the terms cancel.
        divisor, size, large = 0.0, np.abs(c), np.abs(A)
        for _ in weights:
            divisor = float(row @ b)
            row = row @ A
            if abs(divisor) > 1e-12 * float(size @ b):
                break
            size = size @ large
        else:
            return []
    return [s for s in eigenvalues(A - np.outer(b, row / divisor)).tolist() if s.imag >= 0.0]


def _newton_on_turning(s: complex, weights: Weights, theta: float, short: float) -> complex | None:
    """Newton on (L'/L) prod(s - r), which has no poles, in factored form; None where it finds no zero of L'/L.

    Steps longer than a tenth of s are not taken unless they are ``short``.
    """
    for _ in range(TURNING_STEPS):
        f, size, slope, inverses = complex(-theta), theta, 0j, 0j
        for r, w in weights:
            inverse = 1.0 / ((s - r) or TINY)
            term = w * inverse
            f += term
            size += abs(term)
            slope += term * inverse
            inverses += inverse
        step = f / ((f * inverses - slope) or TINY)
        if not abs(step) <= 0.1 * abs(s) + short:
            break
        s -= step
        if abs(step) <= 1e-11 * abs(s):
            break
    return s if abs(f) <= 1e-9 * size else None


def axis_crossings(L: TransferFunction) -> tuple[AxisCrossing, ...]:
    """Gains at which a branch crosses the imaginary axis: the phase crossovers, with K = 1/|L|; and s = 0."""
    found = crossings(L)
    # What lies on a root of L, or crosses at a gain beyond double precision, is left out.
    out = [
        AxisCrossing(w, exp(-m))
        for w, m in zip(found.phase_omega.tolist(), found.phase_log_magnitude.tolist(), strict=True)
        if abs(m) < LARGEST_LOG
    ]
    if L.origin_order == 0 and L.origin_gain < 0:
        out.append(AxisCrossing(0.0, -1.0 / L.origin_gain))
    return tuple(sorted(out, key=lambda c: c.K))


def window(
    L: TransferFunction, breaks: tuple[Breakaway, ...], crossed: tuple[AxisCrossing, ...]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """A window on what matters: the slow roots, the meeting points and the first crossing of the imaginary axis.

    A root much faster than the rest (a filter pole) is left outside.
    """
    roots_ = [(abs(p), 1) for p in L.poles.tolist()] + [(abs(z), -1) for z in L.zeros.tolist()]
    sizes = sorted(size for size, _ in roots_)
    slow = sizes[-1] if sizes and sizes[-1] else np.pi / L.theta if L.theta else 1.0
    reach = 40.0 if L.theta else 8.0
    first = min((c.omega for c in crossed if c.omega > 0), default=0.0)
    for i, (small, large) in enumerate(pairwise(sizes), 1):
        # The slow ones must have something to say: poles that zeros do not make up for, and the first crossing.
        own = sum(sense for size, sense in roots_ if size <= small)
        if large > 6.0 * small > 0.0 and i >= 2 and own > 0 and first <= reach * small:
            slow = small
            break
    shown = [r for r in [*L.poles.tolist(), *L.zeros.tolist()] if abs(r) <= 1.001 * slow]
    shown += [b.s for b in breaks if abs(b.s) <= 3.0 * slow]
    if 0 < first <= reach * slow:
        shown.append(complex(0.0, first))
    half = 1.4 * max([0.8 * slow, *(abs(s.imag) for s in shown)])
    if L.theta:
        # Roots much faster than the dead time are left outside, or its endless chain of poles would fill the picture.
        half = min(half, WIDEST_IN_DEAD_TIMES / L.theta)
        shown = [s for s in shown if abs(s) <= 1.5 * half]
    left, right = min([0.0, *(s.real for s in shown)]), max([0.0, *(s.real for s in shown)])
    pad = 0.35 * half
    return (min(left - pad, -0.9 * half), right + pad), (-half, half)
