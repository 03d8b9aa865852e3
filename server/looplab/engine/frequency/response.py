"""Frequency response of factored systems: adaptive grids, magnitude, and phase without unwrapping."""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from functools import lru_cache
from math import ceil, floor, isfinite, log10, pi

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

POINTS_PER_DECADE = 40
AXIS_GAP = 1e-9
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
def _turning_roots(unit: TransferFunction) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of the roots off the origin imaginary part and size of the real part, (k, 1) each, and turns of phase, (k,)."""
    turns: Counter[complex] = Counter()
    for roots, sense in ((unit.zeros.tolist(), 1), (unit.poles.tolist(), -1)):
        for r in roots:
            if r:
                turns[complex(abs(r.real), r.imag)] += -sense if r.real > 0 else sense
    at = np.array([r for r, sense in turns.items() if sense], dtype=complex)[:, None]
    return at.imag.copy(), at.real.copy(), np.array([float(sense) for sense in turns.values() if sense])


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


@lru_cache(maxsize=64)
def corners(unit: TransferFunction) -> tuple[float, float]:
    """The slowest and the fastest corner, the dead time's included [rad/time]; 1 where there is none."""
    sizes = np.abs(np.concatenate([unit.zeros, unit.poles])).tolist()
    found = [r for r in sizes if r] + ([1.0 / unit.theta] if unit.theta > 0 else [])
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


def _resonances(system: TransferFunction) -> FloatArray:
    """Points around lightly damped roots, and a hair on either side of roots on the axis."""
    roots = np.concatenate([system.zeros, system.poles])
    upper = roots[(roots.imag > 0) & (np.abs(roots.real) < 0.4 * np.abs(roots))]
    if not upper.size:
        return upper.real
    spread = np.array([0.0, 0.3, 0.7, 1.2, 2.0, 4.0, 10.0, 30.0])
    spread = np.concatenate([-spread[:0:-1], spread])
    points = [upper.imag[:, None] + np.abs(upper.real)[:, None] * spread]
    on_axis = upper[np.abs(upper.real) <= AXIS_GAP * np.abs(upper)].imag
    hair = np.array([-1e-2, -1e-3, -1e-5, -AXIS_GAP, AXIS_GAP, 1e-5, 1e-3, 1e-2])
    points.append(on_axis[:, None] * (1.0 + hair))
    return np.concatenate([p.ravel() for p in points])


def frequency_grid(system: TransferFunction, low: float | None = None, high: float | None = None) -> FloatArray:
    """A grid fine enough for curves and for bracketing: 40 a decade, denser at resonances and where dead time turns.

    Parameters
    ----------
    system : TransferFunction
    low, high : float or None
        Ends of the grid [rad/time]; None takes frequency_range.

    Returns
    -------
    ndarray, strictly increasing [rad/time]

    Raises
    ------
    InvalidInput
        low and high are not positive and increasing.
    """
    auto_low, auto_high = frequency_range(system)
    low, high = auto_low if low is None else low, auto_high if high is None else high
    if not (np.isfinite(low) and np.isfinite(high) and 0 < low < high):
        raise InvalidInput("the frequency range must be two positive numbers, the smaller first", field="omega")
    decades = np.log10(high / low)
    points = [10.0 ** np.linspace(np.log10(low), np.log10(high), int(np.ceil(decades * POINTS_PER_DECADE)) + 1)]
    extra = _resonances(system)
    points.append(extra[(extra > low) & (extra < high)])
    if system.theta > 0:
        # The phase must not turn by more than pi/8 between neighbours.
        step = np.pi / (8.0 * system.theta)
        start = step / (10 ** (1.0 / POINTS_PER_DECADE) - 1.0)
        if start < high:
            points.append(np.arange(start, min(high, start + MAX_DELAY_POINTS * step), step))
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
