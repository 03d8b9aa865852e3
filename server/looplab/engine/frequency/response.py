"""Frequency response of factored systems: adaptive grids, magnitude, and phase without unwrapping."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from functools import lru_cache
from math import ceil, floor, isfinite, log, log10, pi

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
Columns = tuple[FloatArray, FloatArray, FloatArray]

POINTS_PER_DECADE = 40
AXIS_GAP = 1e-9
# Around a resonance, in units of the distance from the axis; beside a root on the axis, relative to its size.
_AROUND = (-30.0, -10.0, -4.0, -2.0, -1.2, -0.7, -0.3, 0.0, 0.3, 0.7, 1.2, 2.0, 4.0, 10.0, 30.0)
_HAIRS = (-1e-2, -1e-3, -1e-5, -AXIS_GAP, AXIS_GAP, 1e-5, 1e-3, 1e-2)
# Squares of so many roots and frequencies within 1e-18 ... 1e18 can be multiplied.
FEW_SQUARES = 8
MAX_DELAY_POINTS = 4000


def phase_rad(system: TransferFunction, omega: FloatArray) -> FloatArray:
    r"""Phase of G(j omega), continuous in omega and anchored at omega -> 0, shape of omega [rad].

    .. math:: \varphi(0^+) = -\tfrac{\pi}{2} m - \pi\,[k_0 < 0]

    with m integrators and k0 the limit of s^m G(s). Each root adds its own angle, so nothing is unwrapped. Roots on
    the imaginary axis are passed on the right (the usual Nyquist indentation): the phase drops by pi at such a pole.

    Parameters
    ----------
    system : TransferFunction
    omega : ndarray
        Frequencies, > 0 [rad/time].

    Returns
    -------
    ndarray
        Shape of omega [rad].

    References
    ----------
    .. [1] K. J. Åström, R. M. Murray, Feedback Systems, 2nd ed., Princeton University Press (2021), ch. 10.
    """
    imag, real, sense = _turning_roots(system.unit)
    # atan2 of the pair's parts at omega = 0 cancels; of a real root it is zero.
    phase = sense @ np.arctan2(omega - imag, real)
    phase += phase_at_start(system)
    return phase - system.theta * omega if system.theta else np.asarray(phase)


def phase_at_start(system: TransferFunction) -> float:
    """Phase that is approached for omega to 0 [rad]."""
    return -0.5 * pi * system.origin_order - (pi if system.origin_gain < 0 else 0.0)


@lru_cache(maxsize=64)
def _turning_roots(unit: TransferFunction) -> Columns:
    """Of the roots off the origin imaginary part, size of the real part and turns of phase."""
    turns: dict[complex, float] = {}
    for roots, sense in ((unit.zeros.tolist(), 1.0), (unit.poles.tolist(), -1.0)):
        for r in roots:
            if r:
                at = complex(abs(r.real), r.imag)
                turns[at] = turns.get(at, 0.0) + (-sense if r.real > 0 else sense)
    return _columns(turns)


def _columns(weights: Mapping[complex, float]) -> Columns:
    """Imaginary and real part of the points with a weight, shape (k, 1) each, and the weights, shape (k,)."""
    used = [(r.imag, r.real, weight) for r, weight in weights.items() if weight]
    imag, real, weight = np.array(used).reshape(-1, 3).T.copy()
    return imag[:, None], real[:, None], weight


def log_magnitude(system: TransferFunction, omega: FloatArray) -> FloatArray:
    """ln |G(j omega)|, shape of omega; -inf at a zero, +inf at a pole on the axis."""
    if system.gain == 0.0:
        return np.full(omega.shape, -np.inf)
    with np.errstate(divide="ignore", over="ignore", under="ignore"):
        out = np.full(omega.shape, np.log(abs(system.gain)))
        for roots, sign in ((system.zeros, 0.5), (system.poles, -0.5)):
            if roots.size:
                squares = (omega - roots.imag[:, None]) ** 2 + roots.real[:, None] ** 2
                # One logarithm where the product stays in double precision.
                few = roots.size <= FEW_SQUARES
                out += sign * (np.log(squares.prod(axis=0)) if few else np.log(squares).sum(axis=0))
    return out


def rate(system: TransferFunction, omega: FloatArray) -> ComplexArray:
    r"""How fast ln G turns and shrinks over ln omega, shape of omega.

    .. math:: \omega\, \frac{G'(i\omega)}{G(i\omega)} = \frac{d\varphi}{d\ln\omega} - i\,\frac{d\ln|G|}{d\ln\omega}

    Parameters
    ----------
    system : TransferFunction
    omega : ndarray
        Frequencies, > 0 [rad/time].

    Returns
    -------
    ndarray of complex
        Not finite on a root of the axis.

    References
    ----------
    .. [1] H. W. Bode, Network Analysis and Feedback Amplifier Design, Van Nostrand 1945, ch. 14.
    """
    imag, real, weights = _weighted_roots(system.unit)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        rise = omega - imag
        inverse = np.square(rise)
        inverse += real * real
        np.reciprocal(inverse, out=inverse)
        rise *= inverse
        out = np.empty(omega.shape, dtype=complex)
        out.real = -(weights * real[:, 0]) @ inverse
        out.real -= system.theta
        out.imag = -weights @ rise
        out *= omega
    return out


@lru_cache(maxsize=64)
def _weighted_roots(unit: TransferFunction) -> Columns:
    """Of the distinct roots imaginary and real part, and multiplicity, negative for poles."""
    return _columns(unit.multiplicities)


@lru_cache(maxsize=64)
def corners(unit: TransferFunction) -> tuple[float, float]:
    """The slowest and the fastest corner, the dead time's included [rad/time]; 1 where there is none."""
    found = [abs(r) for r in unit.zeros.tolist() + unit.poles.tolist() if r]
    if unit.theta > 0:
        found.append(1.0 / unit.theta)
    return (min(found), max(found)) if found else (1.0, 1.0)


def unit_asymptotes(system: TransferFunction) -> list[float]:
    """Frequencies at which the low- and the high-frequency asymptote of |G| reach 1."""
    out = []
    for gain, order in ((system.gain, system.relative_degree), (system.origin_gain, system.origin_order)):
        if system.gain and order:
            with suppress(OverflowError, ZeroDivisionError):
                out.append(abs(gain) ** (1.0 / order))
    return [w for w in out if isfinite(w) and w > 0]


def frequency_range(system: TransferFunction) -> tuple[float, float]:
    """Decades that hold every corner, the dead time and the crossings of the asymptotes, one to spare each side."""
    marks = [*corners(system.unit), *unit_asymptotes(system)]
    return 10.0 ** (floor(log10(min(marks)) + 1e-9) - 1), 10.0 ** (ceil(log10(max(marks)) - 1e-9) + 1)


def _resonances(system: TransferFunction) -> list[float]:
    """Points around lightly damped roots, and a hair on either side of roots on the axis."""
    points: list[float] = []
    for r in system.zeros.tolist() + system.poles.tolist():
        if r.imag > 0.0 and abs(r.real) < 0.4 * abs(r):
            points += [r.imag + abs(r.real) * spread for spread in _AROUND]
            if abs(r.real) <= AXIS_GAP * abs(r):
                points += [r.imag * (1.0 + hair) for hair in _HAIRS]
    return points


def frequency_grid(
    system: TransferFunction,
    low: float | None = None,
    high: float | None = None,
    *,
    on_asymptotes: int = POINTS_PER_DECADE,
) -> FloatArray:
    """A grid fine enough for curves and for bracketing: 40 a decade, denser at resonances and where dead time turns.

    Parameters
    ----------
    system : TransferFunction
    low, high : float or None
        Ends of the grid [rad/time]; None takes frequency_range.
    on_asymptotes : int
        Points a decade where the curve follows its asymptotes: a decade below the slowest corner and beyond the
        fastest.

    Returns
    -------
    ndarray, strictly increasing [rad/time]

    Raises
    ------
    InvalidInput
        low and high are not positive and increasing.
    """
    if low is None or high is None:
        auto_low, auto_high = frequency_range(system)
        low, high = auto_low if low is None else low, auto_high if high is None else high
    if not (isfinite(low) and isfinite(high) and 0 < low < high):
        raise InvalidInput("the frequency range must be two positive numbers, the smaller first", field="omega")
    slowest, fastest = corners(system.unit)
    # With dead time the curve turns for ever: there are no asymptotes above its corner.
    ends = (low, min(max(0.1 * slowest, low), high), high if system.theta > 0 else max(min(10.0 * fastest, high), low))
    densities = (on_asymptotes, POINTS_PER_DECADE, on_asymptotes)
    even = [np.array([log(low)])]
    for start, stop, density in zip(ends, (*ends[1:], high), densities, strict=True):
        if stop > start:
            x, span = log(start), log(stop / start)
            count = max(ceil(span * density / log(10.0) - 1e-9), 1)
            even.append(x + span / count * np.arange(1, count + 1))
    points = [np.exp(np.concatenate(even))]
    points[0][0], points[0][-1] = low, high
    extra = [w for w in _resonances(system) if low < w < high]
    if extra:
        points.append(np.array(extra))
    if system.theta > 0:
        # The phase must not turn by more than pi/8 between neighbours.
        step = np.pi / (8.0 * system.theta)
        start = step / (10 ** (1.0 / POINTS_PER_DECADE) - 1.0)
        if start < high:
            points.append(np.arange(start, min(high, start + MAX_DELAY_POINTS * step), step))
    if len(points) == 1:
        return points[0]
    grid = np.sort(np.concatenate(points))
    keep = np.ones(grid.size, dtype=bool)
    np.greater(grid[1:] - grid[:-1], 1e-13 * grid[1:], out=keep[1:])
    return grid[keep]


@lru_cache(maxsize=64)
def default_grid(system: TransferFunction) -> FloatArray:
    """frequency_grid over the automatic range, cached and read-only."""
    grid = frequency_grid(system)
    grid.setflags(write=False)
    return grid
