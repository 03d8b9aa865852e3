"""What students construct by hand on a root locus: meeting points, axis crossings, angles, segments, the window."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.crossings import crossings
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.polynomial import roots
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
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
    centroid = float((L.poles.sum() - L.zeros.sum()).real / excess)
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
    out = []
    for r in dict.fromkeys(at[at.imag != 0].tolist()):
        same = int(np.count_nonzero(at == r))
        zeros, poles = L.zeros[L.zeros != r], L.poles[L.poles != r]
        if zeros.size + poles.size + same < L.zeros.size + L.poles.size:
            continue  # a pole on a zero: the branch is a point
        phase = np.angle(r - zeros).sum() - np.angle(r - poles).sum() - L.theta * r.imag
        phase += 0.0 if L.gain > 0 else np.pi
        total = sign * (180.0 + np.degrees(phase))
        out += [Angle(complex(r), _wrapped((total + 360.0 * k) / same)) for k in range(same)]
    return tuple(out)


def real_axis_segments(L: TransferFunction) -> tuple[tuple[float | None, float | None], ...]:
    """Parts of the real axis on the locus, right to left: an odd number of real roots lies to the right (K L(0) > 0).

    An end that is None is infinite.
    """
    marks = np.sort(np.concatenate([L.poles[L.poles.imag == 0].real, L.zeros[L.zeros.imag == 0].real]))[::-1]
    edges = [None, *marks.tolist(), None]
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
    roots_, weights = _distinct_roots(L)
    points = _turning_points(roots_, weights, L.theta)
    with np.errstate(all="ignore"):
        points = _newton_on_turning(points, roots_, weights, L.theta)
        terms = weights / (points[:, None] - roots_)
        turning = np.abs(terms.sum(axis=1) - L.theta) <= 1e-9 * (np.abs(terms).sum(axis=1) + L.theta)
        gains = -1.0 / L(points)
    found = turning & np.isfinite(gains) & (gains.real > 0) & (np.abs(gains.imag) < 1e-7 * np.abs(gains))
    out: list[Breakaway] = []
    for s, K in zip(points[found].tolist(), gains[found].real.tolist(), strict=True):
        if all(abs(b.s - s) > 1e-6 * max(1.0, abs(s)) for b in out):
            out.append(Breakaway(complex(s.real, 0.0 if abs(s.imag) < 1e-9 * abs(s) else s.imag), K))
    return tuple(sorted(out, key=lambda b: b.K))


def _distinct_roots(L: TransferFunction) -> tuple[ComplexArray, FloatArray]:
    """The roots of L, each once, and their multiplicities: positive for zeros, negative for poles."""
    weights = Counter(L.zeros.tolist())
    weights.subtract(L.poles.tolist())
    return np.array(list(weights), dtype=complex), np.array(list(weights.values()), dtype=float)


def _turning_points(roots_: ComplexArray, weights: FloatArray, theta: float) -> ComplexArray:
    """Approximate zeros of sum w/(s - r) - theta: multiplied out with each root once, so that none stays multiple."""
    # In units of a typical root: expanded in other units the coefficients spread over hundreds of decades.
    sizes = np.abs(roots_)
    unit = float(np.exp(np.mean(np.log(sizes[sizes > 0])))) if (sizes > 0).any() else 1.0
    # prod(s - r) and sum w prod(s - other r), highest power first, grown by one factor after the other.
    product, turning = [1.0 + 0j], [0j]
    for r, w in zip((roots_ / unit).tolist(), weights.tolist(), strict=True):
        turning = [a - r * b + w * c for a, b, c in zip([*turning, 0j], [0j, *turning], [0j, *product], strict=True)]
        product = [a - r * b for a, b in zip([*product, 0j], [0j, *product], strict=True)]
    coefficients = np.array(turning) - theta * unit * np.array(product)
    return unit * roots(coefficients.real)


def _newton_on_turning(s: ComplexArray, roots_: ComplexArray, weights: FloatArray, theta: float) -> ComplexArray:
    """Newton on (L'/L) prod(s - r), which has no poles, in factored form."""
    for _ in range(6):
        inverse = 1.0 / (s[:, None] - roots_)
        f = inverse @ weights - theta
        step = f / (f * inverse.sum(axis=1) - inverse**2 @ weights)
        size = np.abs(step)
        taken = size <= 0.1 * np.abs(s) + 1e-7
        s = s - np.where(taken, step, 0.0)
        if not (taken & (size > 1e-15 * np.abs(s))).any():
            break
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


def window(
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
    reach = 40.0 if L.theta else 8.0
    first = sorted(c.omega for c in crossed if 0 < c.omega <= reach * slow)[:1]
    points = np.array([*shown, *(1j * w for w in first)])
    half = 1.4 * max(float(np.abs(points.imag).max(initial=0.0)), 0.8 * slow)
    if L.theta:
        # Roots much faster than the dead time are left outside, or its endless chain of poles would fill the picture.
        half = min(half, WIDEST_IN_DEAD_TIMES / L.theta)
        points = points[np.abs(points) <= 1.5 * half]
    left, right = min(float(points.real.min(initial=0.0)), 0.0), max(float(points.real.max(initial=0.0)), 0.0)
    pad = 0.35 * half
    return (min(left - pad, -0.9 * half), right + pad), (-half, half)
