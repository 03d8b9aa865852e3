"""A system sampled over frequency, cached up to its gain: moving a gain only shifts the curves."""

from __future__ import annotations

from functools import cached_property, lru_cache
from math import exp, inf, log
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.response import frequency_grid, log_magnitude, phase_at_start, phase_rad
from looplab.engine.frequency.scalar import newton_in_bracket, scalar_loop
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
Array = TypeVar("Array", FloatArray, ComplexArray)


MOST_EXTREMA = 200
DECIBELS = 20.0 / log(10.0)


def _read_only(array: Array) -> Array:
    array.setflags(write=False)
    return array


class UnitCurve:
    """A system of gain 1 or -1 over a grid; each part is computed when first asked for, read-only, shape (n,).

    Attributes
    ----------
    omega : ndarray
        The grid [rad/time].
    log_magnitude, phase : ndarray
        ln \\|G\\| and the phase, anchored at omega -> 0 [rad].
    decibels, phase_deg : ndarray
        The same as Bode plots have them [dB, deg].
    value, size : ndarray
        G(j omega) and its magnitude.
    rate : ndarray of complex
        omega G'(j omega)/G(j omega): its real part is the slope of the phase over ln omega, its imaginary part the
        negative slope of ln \\|G\\|.
    """

    def __init__(
        self, unit: TransferFunction, omega: FloatArray, parts: tuple[UnitCurve, UnitCurve] | None = None
    ) -> None:
        self.unit, self.omega = unit, _read_only(omega)
        # Of two systems in series those of each: what was computed of one of them is not computed again.
        self._parts = parts if parts and all(part.is_finite and part.value.all() for part in parts) else None

    @cached_property
    def log_magnitude(self) -> FloatArray:
        """ln|G|."""
        if self._parts:
            first, second = self._parts
            return _read_only(first.log_magnitude + second.log_magnitude)
        return _read_only(log_magnitude(self.unit, self.omega))

    @cached_property
    def phase(self) -> FloatArray:
        """Phase [rad]."""
        if self._parts:
            first, second = self._parts
            turns = phase_at_start(self.unit) - phase_at_start(first.unit) - phase_at_start(second.unit)
            return _read_only(first.phase + second.phase + turns)
        return _read_only(phase_rad(self.unit, self.omega))

    @cached_property
    def value(self) -> ComplexArray:
        """G(j omega)."""
        if self._parts:
            first, second = self._parts
            return _read_only(first.value * second.value)
        return _read_only(self.unit.response(self.omega))

    @cached_property
    def is_finite(self) -> bool:
        """Whether no point lies on a pole."""
        return bool(np.isfinite(self.value).all())

    @cached_property
    def size(self) -> FloatArray:
        """|G|."""
        return _read_only(np.abs(self.value))

    @cached_property
    def decibels(self) -> FloatArray:
        """20 log10 |G|."""
        return _read_only(self.log_magnitude * DECIBELS)

    @cached_property
    def phase_deg(self) -> FloatArray:
        """Phase [deg]."""
        return _read_only(np.degrees(self.phase))

    @cached_property
    def rate(self) -> ComplexArray:
        """omega G'/G at j omega."""
        return _read_only(self.omega * self.unit.log_derivative((1j * self.omega).astype(complex)))


class Sampled:
    """A system of any gain on the grid of its unit curve: ln|G|, phase [rad] and value over omega [rad/time]."""

    def __init__(self, curve: UnitCurve, gain: float) -> None:
        self.curve, self.gain = curve, gain
        self.omega, self.phase = curve.omega, curve.phase

    @property
    def shift(self) -> float:
        """What the gain adds to ln|G| of the unit curve."""
        return log(abs(self.gain)) if self.gain else -inf

    @cached_property
    def log_magnitude(self) -> FloatArray:
        """ln|G|, shape (n,)."""
        return self.curve.log_magnitude + self.shift if self.gain else np.full(self.omega.shape, -inf)

    @property
    def mag_dB(self) -> FloatArray:
        """20 log10 |G|, shape (n,)."""
        return self.curve.decibels + DECIBELS * self.shift if self.gain else np.full(self.omega.shape, -inf)

    @cached_property
    def value(self) -> ComplexArray:
        """G(j omega), shape (n,)."""
        if self.curve.is_finite:
            return self.curve.value * abs(self.gain)
        with np.errstate(invalid="ignore"):  # infinite on a pole of the axis
            return self.curve.value * abs(self.gain)


@lru_cache(maxsize=64)
def search_grid(unit: TransferFunction, low: float, high: float) -> FloatArray:
    """The adaptive grid with every extremum of magnitude and phase on it, so that no pair of crossings hides."""
    omega = frequency_grid(unit, low, high)
    loop = scalar_loop(unit)
    turning: list[float] = []
    with np.errstate(all="ignore"):
        rate = omega * unit.log_derivative((1j * omega).astype(complex))
    for slope, on_grid in ((loop.magnitude_slope, -rate.imag), (loop.phase_slope, rate.real)):
        falls = on_grid < 0
        at = np.flatnonzero((falls[1:] != falls[:-1]) & (on_grid[1:] != 0) & (on_grid[:-1] != 0))
        if at.size <= MOST_EXTREMA:
            for i in at.tolist():
                ends = on_grid[i : i + 2].tolist()
                turning.append(exp(newton_in_bracket(slope, log(omega[i]), log(omega[i + 1]), ends)))
    return _read_only(np.unique(np.concatenate([omega, turning])) if turning else omega)


@lru_cache(maxsize=64)
def _on_grid_of(unit: TransferFunction, grid_of: TransferFunction, low: float, high: float) -> UnitCurve:
    return UnitCurve(unit, search_grid(grid_of, low, high))


@lru_cache(maxsize=32)
def _on_frequencies(unit: TransferFunction, omega: bytes) -> UnitCurve:
    parts = unit.factors and (_on_frequencies(unit.factors[0], omega), _on_frequencies(unit.factors[1], omega))
    return UnitCurve(unit, np.frombuffer(omega), parts)


def sampled(system: TransferFunction, low: float, high: float, grid_of: TransferFunction | None = None) -> Sampled:
    """A system between two frequencies [rad/time], on its own adaptive grid or on that of another system."""
    return Sampled(_on_grid_of(system.unit, (grid_of or system).unit, low, high), system.gain)


def sampled_at(system: TransferFunction, omega: FloatArray) -> Sampled:
    """A system at given frequencies, shape (n,) [rad/time]."""
    return Sampled(_on_frequencies(system.unit, omega.tobytes()), system.gain)
