"""Input signals that can be answered exactly: pieces of straight lines, one sine, and impulses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import LARGEST

MAX_SAMPLES = 2000


@dataclass(frozen=True)
class InputSignal:
    """u(t): zero before the first of ``times``, from there on piece by piece.

    Attributes
    ----------
    times : ndarray, shape (k,)
        Start of each piece, strictly increasing, the first >= 0 [time].
    starts : ndarray, shape (k, 2)
        (a, b) at the start of each piece: u = a + b s with s the time since then, or for a sine
        u = a cos(omega s) + b sin(omega s).
    omega : float
        0 for straight lines, else the sine's frequency [rad/time].
    areas : ndarray, shape (k,)
        Area of an impulse at the start of each piece [input*time].
    """

    times: FloatArray
    starts: FloatArray
    areas: FloatArray
    omega: float = 0.0

    @property
    def held(self) -> bool:
        """True for a staircase: pieces that are constant, and no impulse."""
        return not (self.omega or self.starts[:, 1].any() or self.areas.any())

    def value(self, t: npt.ArrayLike) -> FloatArray:
        """u at times t, same shape; the new value at a jump; impulses are not in it."""
        t = np.asarray(t, dtype=float)
        # A time within rounding of a jump is that jump.
        piece = np.searchsorted(self.times, t * (1.0 + 1e-12), side="right") - 1
        s = t - self.times[np.maximum(piece, 0)]
        a, b = self.starts[np.maximum(piece, 0)].T
        u = a * np.cos(self.omega * s) + b * np.sin(self.omega * s) if self.omega else a + b * s
        return np.where(piece >= 0, u, 0.0)

    def shifted(self, delay: float) -> InputSignal:
        """The same signal, later by ``delay`` >= 0."""
        return InputSignal(self.times + delay, self.starts, self.areas, self.omega)

    def scaled(self, factor: float) -> InputSignal:
        """The same signal times ``factor``."""
        return InputSignal(self.times, self.starts * factor, self.areas * factor, self.omega)

    def jumps(self) -> FloatArray:
        """Change of u at the start of each piece, shape (k,)."""
        ends = np.zeros(self.times.size)
        if self.times.size > 1:
            s = np.diff(self.times)
            a, b = self.starts[:-1].T
            w = self.omega
            ends[1:] = a * np.cos(w * s) + b * np.sin(w * s) if w else a + b * s
        return self.starts[:, 0] - ends


def _number(value: float, name: str, positive: bool = False) -> float:
    if not np.isfinite(value) or abs(value) > LARGEST or (positive and value <= 0):
        raise InvalidInput(f"{name} must be a {'positive ' if positive else ''}number up to {LARGEST:g}", field=name)
    return float(value)


def _start(value: float) -> float:
    if not np.isfinite(value) or not 0 <= value <= LARGEST:
        raise InvalidInput(f"start must be a time from 0 to {LARGEST:g}", field="start")
    return float(value)


def _one_piece(start: float, a: float = 0.0, b: float = 0.0, omega: float = 0.0, area: float = 0.0) -> InputSignal:
    return InputSignal(np.array([_start(start)]), np.array([[a, b]]), np.array([area]), omega)


def step(amplitude: float = 1.0, start: float = 0.0) -> InputSignal:
    """A step of ``amplitude`` at ``start``."""
    return _one_piece(start, _number(amplitude, "amplitude"))


def impulse(area: float = 1.0, start: float = 0.0) -> InputSignal:
    """An impulse of ``area`` [input*time] at ``start``."""
    return _one_piece(start, area=_number(area, "area"))


def ramp(slope: float = 1.0, start: float = 0.0) -> InputSignal:
    """A ramp of ``slope`` [input/time] from ``start`` on."""
    return _one_piece(start, b=_number(slope, "slope"))


def sine(amplitude: float = 1.0, omega: float = 1.0, phase_deg: float = 0.0, start: float = 0.0) -> InputSignal:
    """amplitude sin(omega (t - start) + phase), from ``start`` on."""
    phase = np.deg2rad(_number(phase_deg, "phase_deg"))
    size = _number(amplitude, "amplitude")
    return _one_piece(start, size * np.sin(phase), size * np.cos(phase), _number(omega, "omega", positive=True))


def pulse(amplitude: float = 1.0, width: float = 1.0, start: float = 0.0) -> InputSignal:
    """A rectangle of ``amplitude`` that lasts ``width`` from ``start``."""
    begin = _start(start)
    end = begin + _number(width, "width", positive=True)
    if not end > begin:
        raise InvalidInput("the width vanishes beside the start time", field="width")
    return _lines(np.array([begin, end]), np.array([[_number(amplitude, "amplitude"), 0.0], [0.0, 0.0]]))


def _lines(times: FloatArray, starts: FloatArray) -> InputSignal:
    return InputSignal(times, starts, np.zeros(times.size))


def _samples(times: npt.ArrayLike, values: npt.ArrayLike, least: int) -> tuple[FloatArray, FloatArray]:
    t, u = (np.asarray(v, dtype=float) for v in (times, values))
    if t.ndim != 1 or not least <= t.size <= MAX_SAMPLES:
        raise InvalidInput(f"times must be a list of {least} to {MAX_SAMPLES} numbers", field="times")
    if u.shape != t.shape:
        raise InvalidInput(f"there are {t.size} times but {u.size} values", field="values")
    if not np.isfinite(t).all() or t[0] < 0 or not (np.diff(t) > 0).all() or t[-1] > LARGEST:
        raise InvalidInput("times must be >= 0 and strictly increasing", field="times")
    if not np.isfinite(u).all() or np.abs(u).max() > LARGEST:
        raise InvalidInput(f"values must be finite numbers up to {LARGEST:g}", field="values")
    return t, u


def held_samples(times: npt.ArrayLike, values: npt.ArrayLike) -> InputSignal:
    """Samples held until the next one (zero-order hold); the last is held for ever."""
    t, u = _samples(times, values, 1)
    return _lines(t, np.stack([u, np.zeros(u.size)], axis=1))


def joined_samples(times: npt.ArrayLike, values: npt.ArrayLike) -> InputSignal:
    """Samples joined by straight lines (first-order hold); zero before the first, the last held for ever."""
    t, u = _samples(times, values, 2)
    return _lines(t, np.stack([u, np.append(np.diff(u) / np.diff(t), 0.0)], axis=1))
