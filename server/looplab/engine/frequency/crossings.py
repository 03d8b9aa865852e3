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
from looplab.engine.frequency.sampled import Sampled, UnitCurve, search_curve
from looplab.engine.frequency.scalar import newton_in_bracket, scalar_loop
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

# |L| below which further phase crossovers of a dead time are not listed (gain margin above 20).
NEGLIGIBLE = 0.05
# Closer to the real axis than this [rad] rounding decides on which side the curve lies.
ON_AXIS = 1e-9
# Rounding of ln|L|.
ROUNDING = 1e-13
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


def _on_axis(roots: npt.NDArray[np.complex128]) -> list[float]:
    """Frequencies of the roots on the positive imaginary axis [rad/time]."""
    return [r.imag for r in roots.tolist() if r.imag > 0 and abs(r.real) <= AXIS_GAP * abs(r)]


def _gain_crossovers(L: TransferFunction, grid: Sampled) -> FloatArray:
    level, on_grid, omega = -grid.shift, grid.curve.log_magnitude, grid.omega
    above = on_grid > level
    at = (above[1:] != above[:-1]).nonzero()[0]
    brackets = [
        (i, ends)
        for i, *ends in zip(at.tolist(), on_grid[at].tolist(), on_grid[at + 1].tolist(), strict=True)
        # Where |L| stays at 1, as that of an all-pass does, it crosses nothing but in rounding.
        if max(abs(ends[0] - level), abs(ends[1] - level)) > ROUNDING
    ]
    if len(brackets) <= FEW:
        f = scalar_loop(L.unit).log_magnitude
        found = [exp(newton_in_bracket(f, log(omega[i]), log(omega[i + 1]), ends, level)) for i, ends in brackets]
        return np.array(found)
    at = np.array([i for i, _ in brackets])
    x = np.log(omega)
    return np.exp(refine_brackets(lambda x: log_magnitude(L, np.exp(x)), x[at], x[at + 1]))


def _phase_crossovers(curve: UnitCurve) -> tuple[list[float], list[float]]:
    """Frequencies and directions; several levels may lie in one interval."""
    omega, phase = curve.omega, curve.phase
    band = np.floor((phase + np.pi) / (2.0 * np.pi))  # changes by one at each odd multiple of pi
    left: list[int] = []
    target: list[float] = []
    direction: list[float] = []
    for i in (band[1:] != band[:-1]).nonzero()[0].tolist():
        first, last = int(band[i]), int(band[i + 1])
        # The levels of one interval in the order in which they are met.
        levels = range(first, last, -1) if last < first else range(first + 1, last + 1)
        left += [i] * len(levels)
        target += [(2 * level - 1) * pi for level in levels]
        direction += [-1.0 if last < first else 1.0] * len(levels)
    x = np.log(omega)
    if len(left) <= FEW:
        f = scalar_loop(curve.unit).phase
        found = [
            exp(newton_in_bracket(f, float(x[i]), float(x[i + 1]), phase[i : i + 2].tolist(), level))
            for i, level in zip(left, target, strict=True)
        ]
        return found, direction
    at, levels_ = np.array(left), np.array(target)
    found_ = refine_brackets(lambda x: phase_rad(curve.unit, np.exp(x)) - levels_, x[at], x[at + 1])
    return np.exp(found_).tolist(), direction


@lru_cache(maxsize=64)
def _of_unit_gain(unit: TransferFunction, low: float, high: float) -> PhaseCrossings:
    curve = search_curve(unit, low, high)
    phase = curve.phase.tolist()
    # As long as the curve lies on the real axis but for rounding it has crossed nothing.
    start = next((i for i, angle in enumerate(phase) if abs(angle % (2.0 * pi) - pi) > ON_AXIS), None)
    if start is None:
        return PhaseCrossings(curve, np.zeros(0), np.zeros(0), np.zeros(0), None)
    where, direction = _phase_crossovers(curve)
    if start:
        passed = [w <= curve.omega[start] for w in where].count(True)
        where, direction = where[passed:], direction[passed:]
    return PhaseCrossings(
        curve.with_points(where) if where else curve,
        np.array(where),
        np.array(_sizes(unit, where)),
        np.array(direction),
        phase[start],
    )


def _sizes(unit: TransferFunction, omega: list[float]) -> list[float]:
    """ln|L| at crossings of the real axis; infinite on a pole or zero of the imaginary axis."""
    size_at = scalar_loop(unit).log_magnitude
    size = [size_at(log(w))[0] for w in omega]
    for roots, limit in ((unit.poles, inf), (unit.zeros, -inf)):
        for b in _on_axis(roots):
            size = [limit if abs(w - b) <= 2 * AXIS_GAP * b else m for w, m in zip(omega, size, strict=True)]
    return size


@lru_cache(maxsize=64)
def crossings(L: TransferFunction) -> Crossings:
    """Find every crossover of the open loop L; cached by content, and up to the gain where the gain does not matter."""
    # On a hidden mode of the imaginary axis L is 0/0.
    L, _ = split_hidden_modes(L)
    low, high, overrun = _search_range(L)
    if L.gain == 0.0:
        empty = np.zeros(0)
        grid = Sampled(search_curve(L.unit, low, high), 0.0)
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
