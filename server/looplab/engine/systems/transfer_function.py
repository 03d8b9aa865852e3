"""The linear system of the engine: zeros, poles, gain and an exact dead time."""

from __future__ import annotations

from functools import cached_property, lru_cache
from math import exp, isfinite, log
from struct import pack
from typing import overload

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.systems.polynomial import ComplexArray, FloatArray, from_roots, pair_conjugates, roots, trim

# Of one system that is given; connections of several may have more.
MAX_ORDER = 50
MAX_CONNECTED_ORDER = 200
SMALLEST, LARGEST = 1e-12, 1e12
# Products of so many factors within those bounds stay finite.
SMALL_ORDER = 12


def _check_range(field: str, sizes: FloatArray) -> None:
    """Times and rates are kept where double precision can still multiply them."""
    used = sizes[sizes != 0]
    if used.size and not (used.min() >= SMALLEST and used.max() <= LARGEST):
        worst = used.min() if used.min() < SMALLEST else used.max()
        raise InvalidInput(
            f"{field} contains {worst:.3g}, outside {SMALLEST:g} ... {LARGEST:g}",
            field=field,
            hint="choose a time unit in which the numbers are moderate",
        )


def _quotient(a: float, b: float) -> float:
    """a/b, refused where it leaves double precision."""
    value = a / b
    if not isfinite(value):
        raise InvalidInput("the leading coefficients are too far apart", field="den", hint="choose other units")
    return value


class TransferFunction:
    r"""A rational transfer function in factored form with a dead time, immutable and hashable by content.

    .. math:: G(s) = k\,\frac{\prod_i (s - z_i)}{\prod_j (s - p_j)}\; e^{-\theta s}

    Nothing is cancelled and nothing is expanded: (s+1)^10 keeps its ten equal poles.

    Parameters
    ----------
    zeros, poles : array_like of complex
        Roots of numerator and denominator, closed under conjugation [rad/time].
    gain : float
        k, the ratio of leading coefficients (not the steady-state gain).
    theta : float
        Dead time, >= 0 [time].

    Raises
    ------
    InvalidInput
        A value is not finite, theta is negative, roots are not in conjugate pairs, or the order exceeds 200.
    """

    __slots__ = ("__dict__", "gain", "poles", "theta", "zeros")

    zeros: ComplexArray
    poles: ComplexArray
    gain: float
    theta: float

    def __init__(
        self, zeros: npt.ArrayLike = (), poles: npt.ArrayLike = (), gain: float = 1.0, theta: float = 0.0
    ) -> None:
        given = {"zeros": np.asarray(zeros, dtype=complex), "poles": np.asarray(poles, dtype=complex)}
        for name, roots_ in given.items():
            if not np.isfinite(roots_).all():
                raise InvalidInput("zeros and poles must be finite numbers", field=name)
        z, p = (pair_conjugates(roots_, name) for name, roots_ in given.items())
        if not np.isfinite(gain):
            raise InvalidInput("the gain must be a finite number", field="gain")
        if not np.isfinite(theta) or theta < 0:
            raise InvalidInput(
                "the dead time must be zero or positive",
                field="theta",
                hint="dead time delays: write exp(-0.5 s), theta = 0.5",
            )
        _check_range("zeros", np.abs(z))
        _check_range("poles", np.abs(p))
        _check_range("theta", np.array([theta]))
        if max(z.size, p.size) > MAX_CONNECTED_ORDER:
            raise InvalidInput(f"order {max(z.size, p.size)} exceeds the limit of {MAX_CONNECTED_ORDER}", field="poles")
        for name, value in (("zeros", z), ("poles", p)):
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "gain", float(gain))
        object.__setattr__(self, "theta", float(theta))

    @classmethod
    def _of(cls, zeros: ComplexArray, poles: ComplexArray, gain: float, theta: float) -> TransferFunction:
        """From root sets that are known to be conjugate-closed and in range."""
        self = object.__new__(cls)
        for name, value in (("zeros", zeros), ("poles", poles)):
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "gain", float(gain))
        object.__setattr__(self, "theta", float(theta))
        return self

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("a TransferFunction is immutable")

    @classmethod
    def from_polynomials(cls, num: npt.ArrayLike, den: npt.ArrayLike, theta: float = 0.0) -> TransferFunction:
        """Build from real coefficients, highest power first.

        Raises
        ------
        InvalidInput
            The denominator is zero or empty, or a coefficient is not finite.
        """
        n, d = (np.atleast_1d(np.asarray(c, dtype=float)) for c in (num, den))
        for name, c in (("num", n), ("den", d)):
            if c.ndim != 1 or c.size == 0 or not np.isfinite(c).all():
                raise InvalidInput(f"{name} must be a list of finite numbers, highest power first", field=name)
        n, d = trim(n), trim(d)
        if not d.any():
            raise InvalidInput("the denominator is zero", field="den", hint="give at least one non-zero coefficient")
        if max(n.size, d.size) - 1 > MAX_ORDER:
            raise InvalidInput(f"order {max(n.size, d.size) - 1} exceeds the limit of {MAX_ORDER}", field="den")
        return cls(roots(n), roots(d), _quotient(float(n[0]), float(d[0])), theta)

    @cached_property
    def key(self) -> bytes:
        """Content of the system; equal systems have equal keys."""
        return pack("3d", self.gain + 0.0, self.theta + 0.0, self.zeros.size) + self.unit._roots_key

    @cached_property
    def _roots_key(self) -> bytes:
        return (self.zeros + 0.0).tobytes() + (self.poles + 0.0).tobytes()

    def __hash__(self) -> int:
        return hash(self.key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TransferFunction) and self.key == other.key

    def __repr__(self) -> str:
        return (
            f"TransferFunction(zeros={self.zeros.tolist()}, poles={self.poles.tolist()}, "
            f"gain={self.gain!r}, theta={self.theta!r})"
        )

    @property
    def order(self) -> int:
        """Number of poles."""
        return int(self.poles.size)

    @property
    def relative_degree(self) -> int:
        """Number of poles minus number of zeros; negative when improper."""
        return int(self.poles.size - self.zeros.size)

    @property
    def is_proper(self) -> bool:
        """True when the system does not differentiate its input."""
        return self.relative_degree >= 0 or self.gain == 0.0

    @property
    def num(self) -> FloatArray:
        """Numerator coefficients, highest power first (expanded: loses digits for clustered zeros)."""
        return self.gain * from_roots(self.zeros)

    @property
    def den(self) -> FloatArray:
        """Monic denominator coefficients, highest power first (expanded: loses digits for clustered poles)."""
        return from_roots(self.poles)

    @property
    def high_frequency_gain(self) -> float:
        """Limit of the rational part for s to infinity: k for equal degrees, 0 when strictly proper."""
        if self.relative_degree == 0:
            return self.gain
        return 0.0 if self.is_proper else float(np.copysign(np.inf, self.gain))

    @property
    def multiplicities(self) -> dict[complex, int]:
        """Each root once with how often it is a zero, less how often it is a pole; 0 where the two cancel."""
        return self.unit._multiplicities

    @cached_property
    def _multiplicities(self) -> dict[complex, int]:
        out: dict[complex, int] = {}
        for roots_, sense in ((self.zeros.tolist(), 1), (self.poles.tolist(), -1)):
            for r in roots_:
                out[r] = out.get(r, 0) + sense
        return out

    @property
    def origin_order(self) -> int:
        """Poles minus zeros at s = 0: the number of integrators (negative: differentiators)."""
        return self.unit._origin[0]

    @property
    def origin_gain(self) -> float:
        """Limit of s^m G(s) for s to 0 with m the number of integrators."""
        return self.gain * self.unit._origin[1]

    @cached_property
    def _origin(self) -> tuple[int, float]:
        """The number of integrators m, and the limit of s^m G(s) per gain."""
        order, log_magnitude, sign = 0, 0.0, 1.0
        for roots_, sense in ((self.zeros.tolist(), 1), (self.poles.tolist(), -1)):
            for r in roots_:
                if r == 0:
                    order -= sense
                    continue
                log_magnitude += sense * log(abs(r))
                if r.imag == 0.0 and r.real > 0.0:
                    sign = -sign
        return order, sign * exp(log_magnitude)

    @property
    def dc_gain(self) -> float:
        """Steady-state gain G(0): infinite for an integrator, 0 with a zero at the origin."""
        if self.origin_order > 0:
            return float(np.copysign(np.inf, self.origin_gain)) if self.gain else 0.0
        return 0.0 if self.origin_order < 0 else self.origin_gain

    @overload
    def __call__(self, s: complex) -> complex: ...
    @overload
    def __call__(self, s: ComplexArray) -> ComplexArray: ...
    def __call__(self, s):  # type: ignore[no-untyped-def]
        """Value at complex s, dead time exact; infinite at a pole.

        Zeros and poles are multiplied in alternation, so that order 50 neither overflows nor underflows.
        """
        s_array = np.asarray(s, dtype=complex)
        if s_array.ndim == 1 and 0 < max(self.zeros.size, self.poles.size) <= SMALL_ORDER:
            return self._of_low_order(s_array)
        both = min(self.zeros.size, self.poles.size)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            value = self.gain * np.exp(-self.theta * s_array)
            for z, p in zip(self.zeros[:both], self.poles[:both], strict=True):
                value = value * ((s_array - z) / (s_array - p))
            for z in self.zeros[both:]:
                value = value * (s_array - z)
            for p in self.poles[both:]:
                value = value / (s_array - p)
        return complex(value) if value.ndim == 0 else value

    def _of_low_order(self, s: ComplexArray) -> ComplexArray:
        """The same for orders whose products cannot overflow: one division."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            value = self.gain * np.exp(-self.theta * s) if self.theta else np.full(s.shape, self.gain, dtype=complex)
            for z in self.zeros.tolist():
                value *= s - z
            if self.poles.size:
                first, *others = self.poles.tolist()
                below = s - first
                for p in others:
                    below *= s - p
                value /= below
        return np.asarray(value)

    def response(self, omega: npt.ArrayLike) -> ComplexArray:
        """Frequency response G(j omega), shape of omega, dead time exact; omega in rad/time."""
        return np.atleast_1d(self(1j * np.asarray(omega, dtype=float)))

    def log_derivative(self, s: ComplexArray) -> ComplexArray:
        r"""G'(s)/G(s) = sum 1/(s - z) - sum 1/(s - p) - theta, same shape as s."""
        s = np.asarray(s)
        # Roots on the first axis: sums along a short last one are slow.
        apart = s - np.concatenate([self.zeros, self.poles]).reshape(-1, *(1,) * s.ndim)
        with np.errstate(divide="ignore", invalid="ignore"):
            apart = 1.0 / apart
            out: ComplexArray = apart[: self.zeros.size].sum(axis=0) - apart[self.zeros.size :].sum(axis=0)
        return out - self.theta

    def __mul__(self, other: TransferFunction | float) -> TransferFunction:
        """Series connection: roots joined, gains multiplied, dead times added; nothing is cancelled."""
        if not isinstance(other, TransferFunction):
            return TransferFunction(self.zeros, self.poles, self.gain * float(other), self.theta)
        gain = self.gain * other.gain
        if self.order + other.order <= MAX_ORDER and isfinite(gain):
            return _series(self.unit, other.unit).with_gain(gain)
        return TransferFunction(
            np.concatenate([self.zeros, other.zeros]),
            np.concatenate([self.poles, other.poles]),
            gain,
            self.theta + other.theta,
        )

    __rmul__ = __mul__

    @cached_property
    def factors(self) -> tuple[TransferFunction, TransferFunction] | None:
        """The two systems of gain 1 or -1 that a series connection of gain 1 or -1 was made of, where that is known."""
        return None

    @cached_property
    def unit(self) -> TransferFunction:
        """The same roots and dead time with gain +1 or -1: what a moved gain leaves as it is."""
        if abs(self.gain) == 1.0:
            return self
        return TransferFunction._of(self.zeros, self.poles, -1.0 if self.gain < 0 else 1.0, self.theta)

    def with_gain(self, gain: float) -> TransferFunction:
        """The same roots and dead time with another finite gain k; both share one ``unit`` if the signs agree."""
        out = TransferFunction._of(self.zeros, self.poles, gain, self.theta)
        if (gain < 0) == (self.gain < 0) and abs(gain) != 1.0:
            out.__dict__["unit"] = self.unit
        return out

    def without_dead_time(self) -> TransferFunction:
        """The rational part."""
        return TransferFunction(self.zeros, self.poles, self.gain)

    def require_proper(self, field: str | None = None) -> TransferFunction:
        """Return self, or raise ImproperSystem naming ``field``."""
        if not self.is_proper:
            raise ImproperSystem(
                f"the system has more zeros ({self.zeros.size}) than poles ({self.poles.size}): it differentiates "
                "its input, which no real device does",
                field=field,
                hint="add the lag that the device has, for example divide by (0.01 s + 1)",
            )
        return self

    def to_text(self, digits: int = 6) -> str:
        """Factored text that the parser reads back, e.g. ``2 (s + 3)/(s^2 (s + 2)) exp(-0.1 s)``."""
        from looplab.engine.systems.notation import to_text

        return to_text(self, digits)

    def to_latex(self, digits: int = 4) -> str:
        """Factored LaTeX."""
        from looplab.engine.systems.notation import to_latex

        return to_latex(self, digits)


@lru_cache(maxsize=128)
def _series(first: TransferFunction, second: TransferFunction) -> TransferFunction:
    """Two systems of gain 1 or -1 one after the other; for every gain of either the roots are the same arrays."""
    out = TransferFunction._of(
        np.concatenate([first.zeros, second.zeros]),
        np.concatenate([first.poles, second.poles]),
        first.gain * second.gain,
        first.theta + second.theta,
    )
    out.__dict__["factors"] = (first, second)
    return out
