"""One frequency at a time on plain Python numbers: for a handful of points several times faster than arrays."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import zip_longest

from looplab.engine.systems.transfer_function import TransferFunction

# In place of a distance of zero: on a root itself the numbers are huge, not undefined.
TINY = 1e-200

Slope = Callable[[float], tuple[float, float]]


class ScalarLoop:
    """L of unit gain at s = j exp(x), as functions of x = ln omega, each with its slope."""

    def __init__(self, unit: TransferFunction) -> None:
        zeros, poles = unit.zeros.tolist(), unit.poles.tolist()
        self.sign, self.theta = unit.gain, unit.theta
        # Each root and whether it is a zero, both in turn: their product neither overflows nor underflows.
        both = zip_longest([(z, True) for z in zeros], [(p, False) for p in poles])
        self.factors: list[tuple[complex, bool]] = [factor for pair in both for factor in pair if factor]
        self.anchor = -0.5 * math.pi * unit.origin_order - (math.pi if unit.origin_gain < 0 else 0.0)
        # Real part, its size, imaginary part and +1 for a zero, -1 for a pole.
        self.roots = [(abs(r.real), r.imag, sign) for roots, sign in ((zeros, 1.0), (poles, -1.0)) for r in roots]
        # The same of roots off the origin, with the sense in which each turns.
        self.turning = [
            (abs(r.real), r.imag, -sign if r.real > 0 else sign)
            for roots, sign in ((zeros, 1.0), (poles, -1.0))
            for r in roots
            if r
        ]

    def log_magnitude(self, x: float) -> tuple[float, float]:
        """ln |L| and its slope."""
        omega = math.exp(x)
        out = slope = 0.0
        for a, b, sign in self.roots:
            rise = omega - b
            size = math.hypot(a, rise) or TINY
            out += sign * math.log(size)
            slope += sign * (rise / size) / size
        return out, slope * omega

    def phase(self, x: float) -> tuple[float, float]:
        """Phase anchored at omega -> 0 and its slope [rad]."""
        omega = math.exp(x)
        out, slope = self.anchor - self.theta * omega, -self.theta
        for a, b, sense in self.turning:
            rise = omega - b
            size = math.hypot(a, rise) or TINY
            out += sense * math.atan2(rise, a)
            slope += sense * (a / size) / size
        return out, slope * omega

    def value_and_rate(self, s: complex, gain: float) -> tuple[complex, complex]:
        """L and q = L'/L at s."""
        value = self.sign * gain * cmath.exp(-self.theta * s)
        q = complex(-self.theta)
        for r, is_zero in self.factors:
            apart = (s - r) or TINY
            if is_zero:
                value *= apart
                q += 1.0 / apart
            else:
                part = 1.0 / apart
                value *= part
                q -= part
        return value, q

    def magnitude_slope(self, x: float) -> tuple[float, float]:
        """d ln |L| / dx and its slope."""
        rate, bend = self.rate(x)
        return -rate.imag, -bend.imag

    def phase_slope(self, x: float) -> tuple[float, float]:
        """d arg L / dx and its slope."""
        rate, bend = self.rate(x)
        return rate.real, bend.real

    def rate(self, x: float) -> tuple[complex, complex]:
        """omega L'/L and its slope."""
        omega = math.exp(x)
        s = complex(0.0, omega)
        q, dq = complex(-self.theta), 0j
        for r, is_zero in self.factors:
            part = 1.0 / ((s - r) or TINY)
            if is_zero:
                q += part
                dq -= part * part
            else:
                q -= part
                dq += part * part
        return omega * q, omega * (q + s * dq)

    def value_and_rates(self, s: complex, gain: float) -> tuple[complex, complex, complex]:
        """L, q = L'/L and q' at s."""
        value = self.sign * gain * cmath.exp(-self.theta * s)
        q, dq = complex(-self.theta), 0j
        for r, is_zero in self.factors:
            apart = (s - r) or TINY
            part = 1.0 / apart
            if is_zero:
                value *= apart
                q += part
                dq -= part * part
            else:
                value *= part
                q -= part
                dq += part * part
        return value, q, dq

    def sensitivity_slope(self, x: float, gain: float, part: str) -> tuple[float, float]:
        """d ln|S| / dx or d ln|T| / dx for L of the given gain, and its slope.

        With q = L'/L they are omega Im(T q) and -omega Im(S q); S' = -S T q and T' = S T q.
        """
        omega = math.exp(x)
        value, q, dq = self.value_and_rates(1j * omega, gain)
        S = 1.0 / ((1.0 + value) or TINY)
        turn = value * S * S * q * q
        factor = value * S if part == "S" else -S
        slope = (factor * q).imag * omega
        return slope, slope + (turn + factor * dq).real * omega * omega

    def peak_size(self, x: float, gain: float, part: str) -> float:
        """|S| or |T| for L of the given gain."""
        value, _ = self.value_and_rate(1j * math.exp(x), gain)
        return abs((1.0 if part == "S" else value) / ((1.0 + value) or TINY))


@lru_cache(maxsize=64)
def scalar_loop(unit: TransferFunction) -> ScalarLoop:
    """The scalar form of a system of gain 1 or -1, cached by content."""
    return ScalarLoop(unit)


def newton_in_bracket(f: Slope, a: float, b: float, ends: Sequence[float], target: float = 0.0) -> float:
    """Root of f - target between a and b by Newton's method, bisecting where a step would leave the bracket.

    Parameters
    ----------
    f : callable
        x -> value and slope; f - target changes sign between a and b.
    a, b : float
    ends : two floats
        f(a) and f(b).
    target : float

    Returns
    -------
    float
        To rounding.
    """
    at_a, at_b = ends
    high_at_b = at_b > at_a
    x = a + (b - a) * (target - at_a) / (at_b - at_a) if at_b != at_a else 0.5 * (a + b)
    if not a < x < b:
        x = 0.5 * (a + b)
    last = b - a
    for _ in range(80):
        value, slope = f(x)
        value -= target
        if value == 0.0:
            return x
        if (value > 0) == high_at_b:
            b = x
        else:
            a = x
        new = x - value / slope if slope else math.inf
        if not a < new < b:
            new = 0.5 * (a + b)
        step, negligible = abs(new - x), 4e-16 * max(abs(x), 1e-3)
        # Steps shrink as their squares: the next would be step^3 / last^2.
        if step * step * step <= negligible * last * last or b - a <= negligible:
            return new
        x, last = new, step
    return x
