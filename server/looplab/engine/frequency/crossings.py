"""Where the open loop crosses |L| = 1 and the negative real axis: bracketed on the grid, then refined to rounding."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, exp, floor, inf, log, log10, pi

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.frequency.response import (
    AXIS_GAP,
    MAX_DELAY_POINTS,
    corners,
    frequency_range,
    log_magnitude,
    phase_rad,
    unit_asymptotes,
)
from looplab.engine.frequency.sampled import Sampled, UnitCurve, search_grid
from looplab.engine.frequency.scalar import newton_in_bracket, scalar_loop
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

# |L| below which further phase crossovers of a dead time are not listed (gain margin above 20).
NEGLIGIBLE = 0.05
# Closer to the real axis than this [rad] rounding decides on which side the curve lies.
ON_AXIS = 1e-9
# Up to so many crossings plain numbers beat arrays.
FEW = 40


# Said of a loop whose dead time turns the curve more often than the grid follows.
OFTEN = f"more than {MAX_DELAY_POINTS // 16} times before |L| falls below 1"


@dataclass(frozen=True)
class PhaseCrossings:
    """Where the curve of unit gain crosses the negative real axis: the same for every gain of one sign.

    Attributes
    ----------
    curve : UnitCurve
        L of unit gain on the search grid, crossovers included.
    omega, log_magnitude, direction : ndarray
        Frequencies [rad/time], ln \\|L\\| there, and -1 where the phase falls, +1 where it rises. Passing over a pole
        on the imaginary axis counts, with infinite \\|L\\|.
    start_phase : float or None
        Phase where the curve first leaves the negative real axis [rad]; None where it never does.
    """

    curve: UnitCurve
    omega: FloatArray
    log_magnitude: FloatArray
    direction: FloatArray
    start_phase: float | None


@dataclass(frozen=True)
class Crossings:
    """All crossovers of an open loop.

    Attributes
    ----------
    grid : Sampled
        L on the search grid, phase crossovers included.
    gain_omega, gain_phase : ndarray
        Frequencies with \\|L\\| = 1 [rad/time] and the phase there [rad].
    phase_omega, phase_log_magnitude, phase_direction : ndarray
        As in PhaseCrossings, for the gain of the loop.
    start_phase : float or None
        As in PhaseCrossings.
    cut : bool
        The dead time makes further phase crossovers beyond the grid (for a strictly proper L with \\|L\\| below 0.05).
    overrun : bool
        The dead time turns the phase more than 250 times before \\|L\\| falls below 1: the lists are not complete.
    """

    grid: Sampled
    gain_omega: FloatArray
    gain_phase: FloatArray
    phase_omega: FloatArray
    phase_log_magnitude: FloatArray
    phase_direction: FloatArray
    start_phase: float | None
    cut: bool
    overrun: bool


@lru_cache(maxsize=64)
def _largest_beyond(unit: TransferFunction, low: float, high: float) -> float:
    """Largest ln|L| of unit gain between two frequencies far out [rad/time]."""
    return float(log_magnitude(unit, np.logspace(log10(low), max(log10(low), log10(high)) + 0.1, 200)).max())


def _small_beyond(L: TransferFunction, omega: float) -> bool:
    """Whether |L| is surely below 1 from omega on: twice as fast as every root, each factor is within 2 of s."""
    if omega < 2.0 * fastest_root(L.unit):
        return False
    bound = log(abs(L.gain)) + (L.zeros.size + L.poles.size) * log(2.0) - L.relative_degree * log(omega)
    return bound < 0


@lru_cache(maxsize=64)
def fastest_root(unit: TransferFunction) -> float:
    """Size of the largest pole or zero [rad/time]; 0 where there is none."""
    return float(np.abs(np.concatenate([unit.zeros, unit.poles])).max(initial=0.0))


def _search_range(L: TransferFunction) -> tuple[float, float, bool]:
    """Ends of the search grid, and whether |L| is above 1 beyond: the dead time turns too often to follow."""
    overrun, reach = False, inf
    # Three decades beyond the corners: there |L| follows its asymptotes, which say whether it has 1 still before it.
    slowest, fastest = corners(L.unit)
    low, high = 1e-3 * slowest, 1e3 * fastest
    for at_one in unit_asymptotes(L):
        low, high = min(low, 0.1 * at_one), max(high, 10.0 * at_one)
    if L.theta > 0:
        # The grid follows the turns of the dead time up to here.
        reach = MAX_DELAY_POINTS * pi / (8.0 * L.theta)
        if L.relative_degree > 0 and L.gain:
            overrun = not _small_beyond(L, reach) and _largest_beyond(L.unit, reach, high) + log(abs(L.gain)) > 0
            # Beyond this |L| < NEGLIGIBLE for good; the dead time would add crossovers without end.
            fade = (abs(L.gain) / NEGLIGIBLE) ** (1.0 / L.relative_degree)
            high = max(2.0 * fastest_root(L.unit), fade, 4.0 * pi / L.theta) * 1.1
        else:
            high = max(frequency_range(L)[1], 40.0 * pi / L.theta)
        high = min(high, reach)
    # Whole decades, so that a moved gain finds the same grid again.
    return 10.0 ** floor(log10(min(low, high / 10))), min(10.0 ** ceil(log10(high)), reach), overrun


def _on_axis(roots: npt.NDArray[np.complex128]) -> FloatArray:
    """Frequencies of the roots on the positive imaginary axis [rad/time]."""
    return np.asarray(roots.imag[(roots.imag > 0) & (np.abs(roots.real) <= AXIS_GAP * np.abs(roots))])


def _gain_crossovers(L: TransferFunction, grid: Sampled) -> FloatArray:
    level = -grid.shift
    above = grid.curve.log_magnitude > level
    at = (above[1:] != above[:-1]).nonzero()[0]
    omega = grid.omega
    if at.size <= FEW:
        f, at_grid = scalar_loop(L.unit).log_magnitude, grid.curve.log_magnitude
        return np.array(
            [
                exp(newton_in_bracket(f, log(omega[i]), log(omega[i + 1]), at_grid[i : i + 2].tolist(), level))
                for i in at.tolist()
            ]
        )
    x = np.log(omega)
    return np.exp(refine_brackets(lambda x: log_magnitude(L, np.exp(x)), x[at], x[at + 1]))


def _phase_crossovers(L: TransferFunction, omega: FloatArray, phase: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Frequencies and directions; several levels may lie in one interval."""
    band = np.floor((phase + np.pi) / (2.0 * np.pi))  # changes by one at each odd multiple of pi
    change = band[1:] - band[:-1]
    hit = change.nonzero()[0]
    count = np.abs(change[hit]).astype(int)
    at = np.repeat(hit, count)
    direction = np.sign(change[at])
    # The levels of one interval in the order in which they are met.
    nth = np.arange(at.size) - np.repeat(np.cumsum(count) - count, count)
    target = 2.0 * np.pi * np.where(direction < 0, band[at] - nth, band[at] + 1.0 + nth) - np.pi
    a, b = np.log(omega[at]), np.log(omega[at + 1])

    if at.size <= FEW:
        f = scalar_loop(L).phase
        ends = np.stack([phase[at], phase[at + 1]], axis=1).tolist()
        brackets = zip(a.tolist(), b.tolist(), ends, target.tolist(), strict=True)
        return np.array([exp(newton_in_bracket(f, *bracket)) for bracket in brackets]), direction
    return np.exp(refine_brackets(lambda x: phase_rad(L, np.exp(x)) - target, a, b)), direction


@lru_cache(maxsize=64)
def _of_unit_gain(unit: TransferFunction, low: float, high: float) -> PhaseCrossings:
    omega = search_grid(unit, low, high)
    phase = phase_rad(unit, omega)
    where, direction = _phase_crossovers(unit, omega, phase)
    # As long as the curve lies on the real axis but for rounding it has crossed nothing.
    off_axis = np.abs(np.mod(phase, 2.0 * np.pi) - np.pi) > ON_AXIS
    start = int(np.argmax(off_axis)) if off_axis.any() else None
    if start is None:
        where, direction = np.zeros(0), np.zeros(0)
    elif start:
        later = where > omega[start]
        where, direction = where[later], direction[later]
    size = log_magnitude(unit, where)
    for b in _on_axis(unit.poles):
        size[np.abs(where - b) <= 2 * AXIS_GAP * b] = np.inf
    for b in _on_axis(unit.zeros):
        size[np.abs(where - b) <= 2 * AXIS_GAP * b] = -np.inf
    start_phase = None if start is None else float(phase[start])
    every = np.unique(np.concatenate([omega, where])) if where.size else omega
    return PhaseCrossings(UnitCurve(unit, every), where, size, direction, start_phase)


@lru_cache(maxsize=64)
def crossings(L: TransferFunction) -> Crossings:
    """Find every crossover of the open loop L; cached by content, and up to the gain where the gain does not matter."""
    # On a hidden mode of the imaginary axis L is 0/0.
    L, _ = split_hidden_modes(L)
    low, high, overrun = _search_range(L)
    if L.gain == 0.0:
        empty = np.zeros(0)
        grid = Sampled(UnitCurve(L.unit, search_grid(L.unit, low, high)), 0.0)
        return Crossings(grid, empty, empty, empty, empty, empty, None, False, False)
    unit = _of_unit_gain(L.unit, low, high)
    grid = Sampled(unit.curve, L.gain)
    gain = _gain_crossovers(L, grid)
    if gain.size <= FEW:
        angle = scalar_loop(L.unit).phase
        gain_phase = np.array([angle(log(w))[0] for w in gain.tolist()])
    else:
        gain_phase = phase_rad(L, gain)
    return Crossings(
        grid, gain, gain_phase, unit.omega, unit.log_magnitude + grid.shift, unit.direction, unit.start_phase,
        L.theta > 0, overrun,
    )  # fmt: skip
