"""One frequency at a time on plain Python numbers: for a handful of points several times faster than arrays."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from functools import lru_cache

from looplab.engine.systems.transfer_function import TransferFunction

# In place of a distance of zero: on a root itself the numbers are huge, not undefined.
TINY = 1e-200

Slope = Callable[[float], tuple[float, float]]


class ScalarLoop:
    """L at s = j exp(x), as functions of x = ln omega."""

    def __init__(self, L: TransferFunction) -> None:
        self.zeros: list[complex] = L.zeros.tolist()
        self.poles: list[complex] = L.poles.tolist()
        self.gain, self.theta = L.gain, L.theta
        self.anchor = -0.5 * math.pi * L.origin_order - (math.pi if L.origin_gain < 0 else 0.0)

    def log_derivative(self, s: complex) -> complex:
        """L'(s)/L(s)."""
        total: complex = -self.theta
        for z in self.zeros:
            total += 1.0 / ((s - z) or TINY)
        for p in self.poles:
            total -= 1.0 / ((s - p) or TINY)
        return total

    def value(self, s: complex) -> complex:
        """L(s)."""
        out = self.gain * cmath.exp(-self.theta * s)
        for z, p in zip(self.zeros, self.poles, strict=False):
            out *= (s - z) / ((s - p) or TINY)
        for z in self.zeros[len(self.poles) :]:
            out *= s - z
        for p in self.poles[len(self.zeros) :]:
            out /= (s - p) or TINY
        return out

    def log_magnitude(self, x: float) -> tuple[float, float]:
        """ln |L| and its slope over x."""
        omega = math.exp(x)
        s = 1j * omega
        out = math.log(abs(self.gain))
        for z in self.zeros:
            out += math.log(abs(s - z) or TINY)
        for p in self.poles:
            out -= math.log(abs(s - p) or TINY)
        return out, -self.log_derivative(s).imag * omega

    def phase(self, x: float) -> tuple[float, float]:
        """Phase anchored at omega -> 0 and its slope over x [rad]."""
        omega = math.exp(x)
        out = self.anchor - self.theta * omega
        for roots, sign in ((self.zeros, 1.0), (self.poles, -1.0)):
            for r in roots:
                if r:
                    turn = math.atan2(omega - r.imag, abs(r.real))
                    out += -sign * turn if r.real > 0 else sign * turn
        return out, self.log_derivative(1j * omega).real * omega

    def sensitivity_slope(self, x: float, part: str) -> float:
        """d ln|S| / dx or d ln|T| / dx: Im(T q) omega and -Im(S q) omega with q = L'/L."""
        omega = math.exp(x)
        s = 1j * omega
        value = self.value(s)
        factor = value if part == "S" else -1.0
        return (factor / (1.0 + value) * self.log_derivative(s)).imag * omega

    def peak_size(self, x: float, part: str) -> float:
        """|S| or |T|."""
        value = self.value(1j * math.exp(x))
        return abs((1.0 if part == "S" else value) / (1.0 + value))


@lru_cache(maxsize=64)
def scalar_loop(L: TransferFunction) -> ScalarLoop:
    """The scalar form of a system, cached by content."""
    return ScalarLoop(L)


def newton_in_bracket(f: Slope, a: float, b: float, target: float = 0.0) -> float:
    """Root of f - target between a and b by Newton's method, bisecting where a step would leave the bracket.

    Parameters
    ----------
    f : callable
        x -> value and slope; f - target changes sign between a and b.
    a, b : float
    target : float

    Returns
    -------
    float
        To rounding.
    """
    high_at_b = f(b)[0] > f(a)[0]
    x = 0.5 * (a + b)
    for _ in range(80):
        value, slope = f(x)
        value -= target
        if value == 0.0:
            return x
        if (value > 0) == high_at_b:
            b = x
        else:
            a = x
        step = value / slope if slope else math.inf
        new = x - step
        if not a < new < b:
            new = 0.5 * (a + b)
        if abs(new - x) <= 4e-16 * max(abs(x), 1e-3) or b - a <= 4e-16 * max(abs(x), 1e-3):
            return new
        x = new
    return x


def illinois(f: Callable[[float], float], a: float, b: float) -> float:
    """Root of f between a and b by the Illinois variant of the false position, bisecting where that stalls.

    References
    ----------
    .. [1] M. Dowell, P. Jarratt, BIT 11 (1971) 168-174.
    """
    fa, fb = f(a), f(b)
    if fb == 0.0:
        return b
    for i in range(100):
        x = 0.5 * (a + b) if fb == fa or i % 8 == 7 else b - fb * (b - a) / (fb - fa)
        fx = f(x)
        if fx == 0.0 or abs(b - a) <= 1e-14 * max(abs(x), 1e-3):
            return x
        if (fx > 0) != (fb > 0):
            a, fa = b, fb
        else:
            fa *= 0.5
        b, fb = x, fx
    return b
