"""L(j omega) of a delayed system on a grid that follows every turn of its phase."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from looplab.engine.delays.poles import rightmost_poles
from looplab.engine.delays.resolvent import transfer_and_slope, transfer_matrix
from looplab.engine.delays.system import DelaySystem
from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

POINTS_PER_DECADE = 40
MAX_POINTS = 20_000
# Turns of the fastest dead time that the grid follows.
MOST_TURNS = 250
LARGEST_TURN = 0.35
SURPRISE = 0.03
# |L| below which further crossings of the negative real axis are not listed (gain margin above 20).
NEGLIGIBLE = 0.05
CLOSEST = 1e-10


@dataclass(frozen=True)
class Curve:
    """L over omega [rad/time], all of shape (n,).

    Attributes
    ----------
    omega, value : ndarray
    slope : ndarray of complex
        d ln L/ds at s = j omega [time].
    phase : ndarray
        Continuous, anchored at omega -> 0 [rad].
    origin_order : int
        Integrators less zeros at s = 0.
    overrun : bool
        \\|L\\| is still above 1 where the dead times turn it too often to follow: the grid ends before.
    fading : bool
        \\|L\\| stays below 0.05 beyond the grid.
    """

    omega: FloatArray
    value: ComplexArray
    slope: ComplexArray
    phase: FloatArray
    origin_order: int
    overrun: bool
    fading: bool


def _sample(system: DelaySystem, omega: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    value, slope = transfer_and_slope(system, (1j * omega).astype(complex))
    with np.errstate(divide="ignore", invalid="ignore"):
        return value[:, 0, 0], slope[:, 0, 0] / value[:, 0, 0]


def log_magnitude(system: DelaySystem, x: FloatArray) -> FloatArray:
    """ln\\|L(j e^x)\\|, shape of x."""
    with np.errstate(divide="ignore"):
        return np.log(np.abs(transfer_matrix(system, 1j * np.exp(x))[:, 0, 0]))


def corner_range(system: DelaySystem) -> tuple[float, float]:
    """Decades that hold poles (rightmost and of the rational part) and dead times, one to spare [rad/time]."""
    poles = np.abs(np.concatenate([np.linalg.eigvals(system.A), rightmost_poles(system).poles]))
    # Eigenvalues of an integrator come out as rounding.
    poles = poles[poles > 1e-9 * poles.max(initial=0.0)]
    marks = np.concatenate([poles, 1.0 / system.tau])
    if not marks.size:
        marks = np.ones(1)
    low, high = np.floor(np.log10(marks.min()) + 1e-9) - 1, np.ceil(np.log10(marks.max()) - 1e-9) + 1
    return float(10.0**low), float(10.0**high)


def _reach(system: DelaySystem, low: float, high: float) -> tuple[float, bool, bool]:
    """Where the grid may end, whether \\|L\\| is above 1 beyond, and whether it stays below 0.05."""
    wide = np.geomspace(low, 1e4 * high, int(60 * np.log10(1e4 * high / low)))
    size = np.exp(log_magnitude(system, np.log(wide)))
    loud = np.flatnonzero(size >= NEGLIGIBLE)
    fading = not loud.size or loud[-1] < wide.size - 1
    last = float(wide[loud[-1] + 1]) if loud.size and fading else high
    if not system.tau.size:
        return max(last, high), False, fading
    turns = MOST_TURNS * 2.0 * np.pi / float(system.tau.max())
    end = min(max(last, 4.0 * np.pi / float(system.tau.min())), turns)
    if not fading:
        end = min(max(high, 40.0 * np.pi / float(system.tau.min())), turns)
    return max(end, 10.0 * low), bool(fading and (size[wide > end] > 1.0).any()), fading


def _refine(system: DelaySystem, omega: FloatArray) -> tuple[FloatArray, ComplexArray, ComplexArray]:
    value, slope = _sample(system, omega)
    for _ in range(40):
        with np.errstate(all="ignore"):
            step = np.log(value[1:] / value[:-1])
            gap = np.diff(omega)
            promised = 0.5j * (slope[1:] + slope[:-1]) * gap
            calm = (np.abs(step.imag) < LARGEST_TURN) & (np.abs(step.real) < 2 * LARGEST_TURN)
            calm &= np.abs(step - promised) < SURPRISE
        # On a pole or zero of the axis no step is small enough.
        coarse = np.flatnonzero(~calm & (gap > CLOSEST * omega[1:]))
        if not coarse.size or omega.size + coarse.size > MAX_POINTS:
            break
        middle = 0.5 * (omega[coarse] + omega[coarse + 1])
        more, slopes = _sample(system, middle)
        omega = np.insert(omega, coarse + 1, middle)
        value, slope = np.insert(value, coarse + 1, more), np.insert(slope, coarse + 1, slopes)
    keep = np.isfinite(value) & (value != 0) & np.isfinite(slope)
    return omega[keep], value[keep], slope[keep]


def _extrema(system: DelaySystem, omega: FloatArray, slope: ComplexArray) -> FloatArray:
    """Where magnitude or phase turn between two points of the grid: no pair of crossings hides there."""
    found = []
    # d ln|L|/d omega is -Im, d arg L/d omega is Re of d ln L/ds.
    for turned in (1j, 1.0):
        rate = (turned * slope).real
        at = np.flatnonzero(rate[:-1] * rate[1:] < 0)

        def rates(x: FloatArray, turned: complex = turned) -> FloatArray:
            return np.asarray((turned * _sample(system, np.exp(x))[1]).real)

        found.append(np.exp(refine_brackets(rates, np.log(omega[at]), np.log(omega[at + 1]), 25)))
    return np.concatenate(found)


@lru_cache(maxsize=32)
def follow(system: DelaySystem, low: float | None = None, high: float | None = None) -> Curve | None:
    """L of one input and output, from well below its corners to where it has faded or turned too often.

    Parameters
    ----------
    system : DelaySystem
    low, high : float or None
        Ends of the grid [rad/time]; None chooses them.

    Returns
    -------
    Curve or None
        None where L is zero at all frequencies.
    """
    system = system.require_single().balanced
    auto_low, auto_high = corner_range(system)
    if not transfer_matrix(system, 1j * np.geomspace(auto_low, auto_high, 7)).any():
        return None
    start = auto_low * 1e-2 if low is None else min(low, auto_low)
    for _ in range(8):
        # Down to where L is its first Taylor term, k0 s^-m: there the phase is known.
        value, slope = _sample(system, np.array([start]))
        power = float((1j * start * slope[0]).real)
        order = -round(power)
        if abs(power + order) < 1e-3:
            break
        start *= 0.1
    if order:
        # There too the asymptote passes 1, if it does so below.
        passes = start * abs(value[0]) ** (1.0 / order)
        start = float(min(start, max(0.1 * passes, 1e-12 * start)))
        value, slope = _sample(system, np.array([start]))
    end, overrun, fading = _reach(system, auto_low, auto_high)
    end = high if high is not None else end
    points = [np.geomspace(start, end, int(np.log10(end / start) * POINTS_PER_DECADE) + 2)]
    if system.tau.size:
        points.append(np.arange(1, min(end * system.tau.max() / 0.3, MAX_POINTS / 4)) * 0.3 / system.tau.max())
    if low is not None:
        points.append(np.array([low]))
    grid = np.unique(np.concatenate(points))
    omega, value, slope = _refine(system, grid[grid <= end])
    more = _extrema(system, omega, slope)
    omega = np.unique(np.concatenate([omega, more]))
    value, slope = _sample(system, omega)
    keep = np.isfinite(value) & (value != 0) & np.isfinite(slope)
    omega, value, slope = omega[keep], value[keep], slope[keep]
    turn = np.angle(value[1:] / value[:-1])
    # A pole on the axis is passed on its right: the phase falls by pi there; at a zero it rises.
    sharp = np.abs(turn) > 2.0
    at_pole = np.abs(value[:-1])[sharp] > np.median(np.abs(value))
    turn[sharp] = np.abs(turn[sharp]) * np.where(at_pole, -1.0, 1.0)
    k0 = (value[0] * (1j * omega[0]) ** order).real
    anchor = -0.5 * np.pi * order - (np.pi if k0 < 0 else 0.0)
    first = anchor + float(np.angle(value[0] * np.exp(-1j * anchor)))
    phase = first + np.concatenate([[0.0], np.cumsum(turn)])
    if low is not None:
        inside = omega >= low * (1 - 1e-12)
        omega, value, slope, phase = omega[inside], value[inside], slope[inside], phase[inside]
    return Curve(omega, value, slope, phase, order, overrun, fading)
