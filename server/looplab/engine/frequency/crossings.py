"""Where the open loop crosses |L| = 1 and the negative real axis: bracketed on the grid, then refined to rounding."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import exp

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.frequency.response import (
    AXIS_GAP,
    MAX_DELAY_POINTS,
    frequency_range,
    log_magnitude,
    phase_rad,
)
from looplab.engine.frequency.sampled import Sampled, sampled
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
class Crossings:
    """All crossovers of an open loop.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        The search grid, crossovers included [rad/time].
    gain_omega, gain_phase : ndarray
        Frequencies with \\|L\\| = 1 [rad/time] and the phase there [rad].
    phase_omega, phase_log_magnitude, phase_direction : ndarray
        Frequencies with L on the negative real axis [rad/time], ln \\|L\\| there, and -1 where the phase falls, +1
        where it rises. Passing over a pole on the imaginary axis counts, with infinite \\|L\\|.
    start_phase : float or None
        Phase where the curve first leaves the negative real axis [rad]; None where it never does.
    cut : bool
        The dead time makes further phase crossovers beyond the grid (for a strictly proper L with \\|L\\| below 0.05).
    overrun : bool
        The dead time turns the phase more than 250 times before \\|L\\| falls below 1: the lists are not complete.
    """

    omega: FloatArray
    gain_omega: FloatArray
    gain_phase: FloatArray
    phase_omega: FloatArray
    phase_log_magnitude: FloatArray
    phase_direction: FloatArray
    start_phase: float | None
    cut: bool
    overrun: bool


def _search_grid(L: TransferFunction) -> tuple[Sampled, bool]:
    """L on the search grid, and whether |L| is above 1 beyond its end: the dead time turns too often to follow."""
    overrun, reach = False, np.inf
    low, high = frequency_range(L)
    low, high = low * 1e-2, high * 1e2
    if L.theta > 0:
        # The grid follows the turns of the dead time up to here.
        reach = MAX_DELAY_POINTS * np.pi / (8.0 * L.theta)
        outside = np.logspace(np.log10(reach), max(np.log10(reach), np.log10(high)) + 0.1, 200)
        overrun = bool(L.relative_degree > 0 and L.gain and log_magnitude(L, outside).max() > 0)
        # Beyond this |L| < NEGLIGIBLE for good; the dead time would add crossovers without end.
        if L.relative_degree > 0 and L.gain:
            roots = np.concatenate([L.zeros, L.poles])
            top = 2.0 * np.abs(roots).max(initial=0.0)
            fade = (abs(L.gain) / NEGLIGIBLE) ** (1.0 / L.relative_degree)
            high = max(top, fade, 4.0 * np.pi / L.theta) * 1.1
        else:
            high = max(frequency_range(L)[1], 40.0 * np.pi / L.theta)
        high = min(high, reach)
    # Whole decades, so that a moved gain finds the same grid again.
    ends = float(10.0 ** np.floor(np.log10(min(low, high / 10)))), float(10.0 ** np.ceil(np.log10(high)))
    return sampled(L, ends[0], min(ends[1], reach)), overrun


def _on_axis(roots: npt.NDArray[np.complex128]) -> FloatArray:
    """Frequencies of the roots on the positive imaginary axis [rad/time]."""
    return np.asarray(roots.imag[(roots.imag > 0) & (np.abs(roots.real) <= AXIS_GAP * np.abs(roots))])


def _gain_crossovers(L: TransferFunction, omega: FloatArray, log_mag: FloatArray) -> FloatArray:
    sign = log_mag > 0
    at = np.flatnonzero(sign[1:] != sign[:-1])
    a, b = np.log(omega[at]), np.log(omega[at + 1])
    if at.size <= FEW:
        f = scalar_loop(L).log_magnitude
        return np.array(
            [exp(newton_in_bracket(f, low, high)) for low, high in zip(a.tolist(), b.tolist(), strict=True)]
        )
    return np.exp(refine_brackets(lambda x: log_magnitude(L, np.exp(x)), a, b))


def _phase_crossovers(L: TransferFunction, omega: FloatArray, phase: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Frequencies and directions; several levels may lie in one interval."""
    band = np.floor((phase + np.pi) / (2.0 * np.pi))  # changes by one at each odd multiple of pi
    left: list[int] = []
    level: list[float] = []
    direction: list[float] = []
    for i in np.flatnonzero(band[1:] != band[:-1]):
        low, high = sorted((band[i], band[i + 1]))
        levels = 2.0 * np.pi * np.arange(low + 1, high + 1) - np.pi
        falling = band[i + 1] < band[i]
        for value in levels[::-1] if falling else levels:
            left.append(int(i))
            level.append(float(value))
            direction.append(-1.0 if falling else 1.0)
    at, target = np.array(left, dtype=int), np.array(level)
    a, b = np.log(omega[at]), np.log(omega[at + 1])

    if at.size <= FEW:
        f = scalar_loop(L).phase
        ends = zip(a.tolist(), b.tolist(), level, strict=True)
        return np.array([exp(newton_in_bracket(f, low, high, value)) for low, high, value in ends]), np.array(direction)
    return np.exp(refine_brackets(lambda x: phase_rad(L, np.exp(x)) - target, a, b)), np.array(direction)


@lru_cache(maxsize=256)
def crossings(L: TransferFunction) -> Crossings:
    """Find every crossover of the open loop L; cached by content."""
    # On a hidden mode of the imaginary axis L is 0/0.
    L, _ = split_hidden_modes(L)
    empty = np.zeros(0)
    grid, overrun = _search_grid(L)
    omega = grid.omega
    if L.gain == 0.0:
        return Crossings(omega, empty, empty, empty, empty, empty, None, False, False)
    log_mag, phase = grid.log_magnitude, grid.phase
    gain = _gain_crossovers(L, omega, log_mag)
    where, direction = _phase_crossovers(L, omega, phase)
    # As long as the curve lies on the real axis but for rounding it has crossed nothing.
    off_axis = np.abs(np.mod(phase, 2.0 * np.pi) - np.pi) > ON_AXIS
    start = int(np.argmax(off_axis)) if off_axis.any() else None
    if start is None:
        where, direction = empty, empty
    elif start:
        later = where > omega[start]
        where, direction = where[later], direction[later]
    size = log_magnitude(L, where)
    for b in _on_axis(L.poles):
        size[np.abs(where - b) <= 2 * AXIS_GAP * b] = np.inf
    for b in _on_axis(L.zeros):
        size[np.abs(where - b) <= 2 * AXIS_GAP * b] = -np.inf
    every = np.unique(np.concatenate([omega, gain, where]))
    start_phase = None if start is None else float(phase[start])
    cut = L.theta > 0
    return Crossings(every, gain, phase_rad(L, gain), where, size, direction, start_phase, cut, overrun)
