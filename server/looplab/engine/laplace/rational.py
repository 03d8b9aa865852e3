"""A rational function that stays factored, and its Taylor series at a pole with a running bound of its rounding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Rational:
    """coefficients(s) prod(s - zeros)/prod(s - poles): a transform whose poles are known one by one.

    Attributes
    ----------
    coefficients : ndarray
        A polynomial factor of the numerator, highest power first: a gain, or what initial conditions add up to.
    zeros, poles : ndarray
        Closed under conjugation [rad/time].
    theta : float
        Dead time [time].
    """

    coefficients: FloatArray
    zeros: ComplexArray
    poles: ComplexArray
    theta: float = 0.0

    @classmethod
    def of(cls, system: TransferFunction) -> Rational:
        """The same function as a transfer function."""
        return cls(np.array([system.gain]), system.zeros, system.poles, system.theta)

    @property
    def is_zero(self) -> bool:
        """True for the function 0."""
        return not self.coefficients.any()

    @property
    def relative_degree(self) -> int:
        """Degree of the denominator minus degree of the numerator."""
        return int(self.poles.size - self.zeros.size - (self.coefficients.size - 1))

    def __call__(self, s: ComplexArray) -> ComplexArray:
        """Values of the rational part at complex s, multiplied and divided in turn."""
        value = np.asarray(np.polyval(self.coefficients.astype(complex), s), dtype=np.complex128)
        both = min(self.zeros.size, self.poles.size)
        for z, p in zip(self.zeros[:both], self.poles[:both], strict=True):
            value = value * ((s - z) / (s - p))
        for z in self.zeros[both:]:
            value = value * (s - z)
        for p in self.poles[both:]:
            value = value / (s - p)
        return value

    def series(self, centre: complex, others: ComplexArray, terms: int) -> tuple[ComplexArray, FloatArray]:
        """Taylor coefficients at ``centre`` of the function with ``others`` as its only poles, and their errors.

        Parameters
        ----------
        centre : complex
            Point of expansion [rad/time].
        others : ndarray
            Poles that stay; each may be repeated.
        terms : int
            How many coefficients, lowest power first.

        Returns
        -------
        values : ndarray of complex, shape (terms,)
        errors : ndarray of float, shape (terms,)
            First-order bound of rounding, and of the last digit of each zero and pole.

        Raises
        ------
        InvalidInput
            The numbers leave the range of double precision.
        """
        value, error = self._polynomial_series(centre, terms)
        shift = 0
        zeros, poles = list(self.zeros), list(others)
        with np.errstate(over="ignore", invalid="ignore", under="ignore"):
            while zeros or poles:
                # Take what brings the size back towards 1; the exponent is kept aside.
                if zeros:
                    value, error = _times(value, error, centre, zeros.pop())
                if poles:
                    value, error = _over(value, error, centre, poles.pop())
                largest = float(np.abs(value).max())
                if np.isfinite(largest) and largest > 0.0:
                    exponent = int(np.frexp(largest)[1])
                    value, error, shift = _ldexp(value, -exponent), np.ldexp(error, -exponent), shift + exponent
            value, error = _ldexp(value, shift), np.ldexp(error, shift)
        if not np.isfinite(value).all():
            raise InvalidInput(
                "the poles and zeros are too far apart for partial fractions in double precision",
                hint="choose a time unit in which the numbers are moderate",
            )
        return value, error

    def _polynomial_series(self, centre: complex, terms: int) -> tuple[ComplexArray, FloatArray]:
        """Taylor coefficients of the polynomial factor by repeated Horner division."""
        rest = self.coefficients.astype(complex)
        bound = np.abs(rest)
        value, error = np.zeros(terms, dtype=complex), np.zeros(terms)
        for k in range(min(terms, rest.size)):
            for i in range(1, rest.size - k):
                rest[i] += centre * rest[i - 1]
                bound[i] += abs(centre) * bound[i - 1]
            last = rest.size - 1 - k
            value[k], error[k] = rest[last], (2.0 * EPS * rest.size * bound[last] if rest.size > 1 else 0.0)
        return value, error


def _ldexp(value: ComplexArray, exponent: int) -> ComplexArray:
    """value 2^exponent; the power itself may lie outside the range."""
    return np.asarray(np.ldexp(value.real, exponent) + 1j * np.ldexp(value.imag, exponent), dtype=complex)


def _times(value: ComplexArray, error: FloatArray, p: complex, z: complex) -> tuple[ComplexArray, FloatArray]:
    """Multiply a series by (p - z) + x."""
    d, slack = p - z, EPS * (abs(p) + abs(z))
    out, bound = value * d, error * abs(d) + np.abs(value) * slack
    out[1:] += value[:-1]
    bound[1:] += error[:-1]
    return out, bound + EPS * np.abs(out)


def _over(value: ComplexArray, error: FloatArray, p: complex, q: complex) -> tuple[ComplexArray, FloatArray]:
    """Divide a series by (p - q) + x."""
    d, slack = p - q, EPS * (abs(p) + abs(q))
    out, bound = np.empty_like(value), np.empty_like(error)
    before, before_error = 0j, 0.0
    for k in range(value.size):
        before = out[k] = (value[k] - before) / d
        before_error = bound[k] = (error[k] + before_error + abs(before) * slack) / abs(d) + EPS * abs(before)
    return out, bound
