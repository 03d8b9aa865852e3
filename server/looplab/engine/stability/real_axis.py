"""Every frequency at which L(j omega) is real: where a gain can put a closed-loop pole on the imaginary axis."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.frequency.response import (
    AXIS_GAP,
    MAX_DELAY_POINTS,
    frequency_grid,
    frequency_range,
    log_magnitude,
    phase_rad,
)
from looplab.engine.systems.polynomial import from_roots, roots
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

# A phase that turns back this close to the real axis [rad] touches it.
TOUCH = 1e-10


def odd_part(L: TransferFunction) -> FloatArray:
    """Coefficients in x = omega^2 / unit^2 of Im(N D*)/omega, highest power first, in units of a typical root."""
    unit = typical_size(L)
    N, D = (from_roots(r / unit) for r in (L.zeros, L.poles))
    # N(s) D(-s) has the odd powers that make L(j omega) complex.
    product = np.polymul(N, D * (-1.0) ** np.arange(D.size)[::-1])
    size = np.polymul(np.abs(N), np.abs(D))
    odd = product[::-1][1::2]
    odd[np.abs(odd) <= 1e-13 * size[::-1][1::2]] = 0.0
    return (odd * (-1.0) ** np.arange(odd.size))[::-1]


def typical_size(L: TransferFunction) -> float:
    """Geometric mean of the roots of L that are not zero [rad/time]; 1 where there is none."""
    sizes = np.abs(np.concatenate([L.zeros, L.poles]))
    sizes = sizes[sizes > 0]
    return float(np.exp(np.mean(np.log(sizes)))) if sizes.size else 1.0


def always_real(L: TransferFunction) -> bool:
    """L(j omega) is real at every omega: only even powers of s, no dead time."""
    return L.theta == 0.0 and not odd_part(L).any()


def _delay_free_grid(L: TransferFunction) -> FloatArray:
    low, high = frequency_range(L)
    x = roots(odd_part(L))
    omega = np.sqrt(np.abs(x[np.abs(x) > 0])) * typical_size(L)
    # A crossing may lie far beyond every corner where the leading terms nearly cancel.
    low = min([low * 1e-2, *(omega / 10.0)])
    high = max([high * 1e2, *(omega * 10.0)])
    return frequency_grid(L, max(low, 1e-14), min(high, 1e16))


def _settled_frequency(L: TransferFunction) -> float:
    """Beyond this the phase of L falls and, if L is strictly proper, |L| too."""
    every = np.concatenate([L.zeros, L.poles])
    largest = float(np.abs(every).max(initial=0.0))
    falls = np.sqrt(4.0 * np.abs(every.real).sum() / L.theta)
    excess = max(L.relative_degree, 1)
    return max(2.0 * largest, float(falls), largest * (every.size + excess) / excess, 1e-3 / L.theta)


def _slope(L: TransferFunction, x: FloatArray) -> FloatArray:
    w = np.exp(x)
    return w * L.log_derivative(1j * w).real


def _away_from_axis_roots(L: TransferFunction, omega: FloatArray) -> npt.NDArray[np.bool_]:
    every = np.concatenate([L.zeros, L.poles])
    on_axis = every.imag[(every.imag > 0) & (np.abs(every.real) <= AXIS_GAP * np.abs(every))]
    if not on_axis.size:
        return np.ones(omega.shape, dtype=bool)
    return np.asarray((np.abs(omega[:, None] - on_axis) > 3.0 * AXIS_GAP * on_axis).all(axis=1))


def _crossings_on(L: TransferFunction, omega: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Frequencies of real L on a grid, and whether the phase falls (-1), rises (+1) or touches (0) there."""
    x = np.log(omega)
    rate = _slope(L, x)
    # A root on the axis itself makes the slope undefined there; NaN compares false.
    with np.errstate(invalid="ignore"):
        turn = np.flatnonzero(np.sign(rate[1:]) * np.sign(rate[:-1]) < 0)
    # With its summits on the grid the phase is monotone between points: no pair of crossings is missed.
    summits = refine_brackets(lambda x: _slope(L, x), x[turn], x[turn + 1])
    level_miss = phase_rad(L, np.exp(summits)) / np.pi
    touching = np.exp(summits[np.abs(level_miss - np.round(level_miss)) * np.pi < TOUCH])
    x = np.unique(np.concatenate([x, summits]))
    phase = phase_rad(L, np.exp(x))
    band = np.floor(phase / np.pi)
    left: list[int] = []
    level: list[float] = []
    direction: list[float] = []
    for i in np.flatnonzero(band[1:] != band[:-1]):
        low, high = sorted((band[i], band[i + 1]))
        for value in np.arange(low + 1, high + 1) * np.pi:
            left.append(int(i))
            level.append(float(value))
            direction.append(-1.0 if band[i + 1] < band[i] else 1.0)
    at, target = np.array(left, dtype=int), np.array(level)
    found = np.exp(refine_brackets(lambda x: phase_rad(L, np.exp(x)) - target, x[at], x[at + 1]))
    sign = np.array(direction)
    if touching.size:
        # A touch that rounding split into two crossings, or into none.
        apart = np.abs(found[:, None] / touching[None, :] - 1.0).min(axis=1, initial=np.inf) > 1e-4
        found, sign = found[apart], sign[apart]
    found, sign = np.concatenate([found, touching]), np.concatenate([sign, np.zeros(touching.size)])
    keep = _away_from_axis_roots(L, found)
    return found[keep], sign[keep]


def real_axis_frequencies(L: TransferFunction) -> tuple[FloatArray, bool]:
    """Frequencies omega > 0 at which L(j omega) is real, and whether those listed decide the stability of every gain.

    Parameters
    ----------
    L : TransferFunction
        Not real at every frequency (see always_real), not zero.

    Returns
    -------
    omega : ndarray
        Increasing [rad/time]. With dead time there are infinitely many: listed are those up to where the phase only
        falls and \\|L\\| has come below its value at every frequency where the phase rises through the real axis.
        Each gain beyond then adds closed-loop poles to the right half-plane and never takes one back.
    complete : bool
        False where the dead time turns the curve too often for the list to reach that far.
    """
    if L.theta == 0.0:
        found, _ = _crossings_on(L, _delay_free_grid(L))
        return np.sort(found), True
    low = frequency_range(L)[0] * 1e-2
    end = _settled_frequency(L)
    reach = MAX_DELAY_POINTS * np.pi / (8.0 * L.theta)
    for _ in range(12):
        end = min(end, reach)
        # Two turns more, so that the falling crossings which close the last range are there for both signs.
        stop = end + 4.0 * np.pi / L.theta
        found, sign = _crossings_on(L, frequency_grid(L, min(low, stop / 10.0), stop))
        if L.relative_degree == 0:
            return np.sort(found), end < reach
        size = log_magnitude(L, found)
        least = size[sign >= 0].min(initial=np.inf)
        if L.origin_order == 0:
            least = min(least, float(np.log(abs(L.origin_gain))))
        if end >= reach or log_magnitude(L, np.array([end]))[0] < least:
            return np.sort(found), end < reach
        end *= 2.0
    return np.sort(found), False
