"""A system sampled over frequency, cached up to its gain: moving a gain only shifts the curves."""

from __future__ import annotations

from functools import cached_property, lru_cache
from math import exp, inf, log
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.response import frequency_grid, log_magnitude, phase_at_start, phase_rad, rate
from looplab.engine.frequency.scalar import newton_in_bracket, scalar_loop
from looplab.engine.systems.transfer_function import SMALL_ORDER, TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
Array = TypeVar("Array", FloatArray, ComplexArray)


MOST_EXTREMA = 200
# Points where the curve follows its asymptotes: enough to bracket crossings.
FEW_PER_DECADE = 10
DECIBELS = 20.0 / log(10.0)


def read_only(array: Array) -> Array:
    """The array itself, which several callers will share."""
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
        self.unit, self.omega = unit, read_only(omega)
        # Of two systems in series those of each: what was computed of one of them is not computed again.
        self._parts = parts if parts and all(part.is_finite and part.value.all() for part in parts) else None

    @cached_property
    def log_magnitude(self) -> FloatArray:
        """ln|G|."""
        if self._parts:
            first, second = self._parts
            return read_only(first.log_magnitude + second.log_magnitude)
        # A product of few factors stays in double precision, but it may be zero or infinite on a root of the axis.
        if max(self.unit.zeros.size, self.unit.order) <= SMALL_ORDER and self.is_finite and self.value.all():
            return read_only(np.log(self.size))
        return read_only(log_magnitude(self.unit, self.omega))

    @cached_property
    def phase(self) -> FloatArray:
        """Phase [rad]."""
        if self._parts:
            first, second = self._parts
            turns = phase_at_start(self.unit) - phase_at_start(first.unit) - phase_at_start(second.unit)
            return read_only(first.phase + second.phase + turns)
        return read_only(phase_rad(self.unit, self.omega))

    @cached_property
    def value(self) -> ComplexArray:
        """G(j omega)."""
        if self._parts:
            first, second = self._parts
            return read_only(first.value * second.value)
        return read_only(self.unit.response(self.omega))

    @cached_property
    def is_finite(self) -> bool:
        """Whether no point lies on a pole."""
        return bool(np.isfinite(self.value).all())

    @cached_property
    def size(self) -> FloatArray:
        """|G|."""
        return read_only(np.abs(self.value))

    @cached_property
    def decibels(self) -> FloatArray:
        """20 log10 |G|."""
        return read_only(self.log_magnitude * DECIBELS)

    @cached_property
    def phase_deg(self) -> FloatArray:
        """Phase [deg]."""
        return read_only(np.degrees(self.phase))

    @cached_property
    def rate(self) -> ComplexArray:
        """omega G'/G at j omega."""
        return read_only(rate(self.unit, self.omega))

    def with_points(self, more: list[float]) -> UnitCurve:
        """The curve with a few more frequencies [rad/time]; phase and rate, where known, are not computed again."""
        omega = np.concatenate([self.omega, more])
        order = omega.argsort(kind="stable")
        omega = omega[order]
        new = omega[1:] > omega[:-1]
        if not new.all():
            keep = np.concatenate([[True], new])
            order, omega = order[keep], omega[keep]
        out, loop = UnitCurve(self.unit, omega), scalar_loop(self.unit)
        for name, at in (("phase", loop.phase), ("rate", loop.rate)):
            if name in self.__dict__:
                known = np.concatenate([self.__dict__[name], [at(log(w))[0] for w in more]])
                out.__dict__[name] = read_only(known[order])
        return out


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
def search_curve(unit: TransferFunction, low: float, high: float) -> UnitCurve:
    """The curve on the adaptive grid with every extremum of magnitude and phase on it: no pair of crossings hides."""
    curve = UnitCurve(unit, frequency_grid(unit, low, high, on_asymptotes=FEW_PER_DECADE))
    omega, loop = curve.omega, scalar_loop(unit)
    turning: list[float] = []
    for slope, on_grid in ((loop.magnitude_slope, -curve.rate.imag), (loop.phase_slope, curve.rate.real)):
        falls = on_grid < 0
        at = (falls[1:] != falls[:-1]).nonzero()[0]
        if at.size <= MOST_EXTREMA:
            for i in at.tolist():
                ends = on_grid[i : i + 2].tolist()
                if all(ends):
                    turning.append(exp(newton_in_bracket(slope, log(omega[i]), log(omega[i + 1]), ends)))
    return curve.with_points(turning) if turning else curve


@lru_cache(maxsize=64)
def _on_grid_of(unit: TransferFunction, grid_of: TransferFunction, low: float, high: float) -> UnitCurve:
    return UnitCurve(unit, search_curve(grid_of, low, high).omega)


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
