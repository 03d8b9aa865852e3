"""Partial fractions with repeated and complex poles, from the factors: nothing is expanded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import ImproperSystem
from looplab.engine.laplace.clusters import Partition, partitions
from looplab.engine.laplace.inputs import LaplaceInput
from looplab.engine.laplace.rational import Rational
from looplab.engine.systems.polynomial import ComplexArray
from looplab.engine.systems.transfer_function import TransferFunction

# A coefficient within so many times its rounding error of zero is zero.
_ZERO = 4.0
# Of two groupings of poles that are about as accurate, the one with fewer poles is meant.
_AS_GOOD, _ROUNDING = 3.0, 1e-14


@dataclass(frozen=True)
class PartialFraction:
    """coefficient/(s - pole)^power."""

    pole: complex
    power: int
    coefficient: complex


@dataclass(frozen=True)
class PartialFractions:
    r"""Y(s) as a sum of simple fractions.

    .. math:: Y(s) = \Bigl(d + \sum_i \sum_{k=1}^{m_i} \frac{c_{ik}}{(s - p_i)^k}\Bigr) e^{-\theta s}

    Attributes
    ----------
    terms : tuple of PartialFraction
        Fractions with a coefficient that is not zero; conjugates are both there, + before -.
    direct : float
        d, the polynomial part of a function with as many zeros as poles.
    theta : float
        Dead time [time].
    cluster_tolerance : float
        Relative distance up to which poles were taken as one repeated pole [-]; 0 when only equal ones were.
    moved : float
        The largest relative distance by which a pole was moved to its repeated one [-].
    residual : float
        Largest difference between the sum and the factored function at the speeds of the poles, relative to its
        largest value there [-]: distinct poles that nearly coincide leave large terms that cancel.
    cancelled : tuple of complex
        Poles whose fractions all vanish: a zero hides them [rad/time].
    """

    terms: tuple[PartialFraction, ...]
    direct: float
    theta: float
    cluster_tolerance: float
    moved: float
    residual: float
    cancelled: tuple[complex, ...]

    def __call__(self, s: ComplexArray) -> ComplexArray:
        """The sum at complex s, dead time included; shape of s."""
        s = np.asarray(s, dtype=complex)
        value = np.full(s.shape, complex(self.direct))
        for term in self.terms:
            value += term.coefficient / (s - term.pole) ** term.power
        return value * np.exp(-self.theta * s)


def _real_parts(value: ComplexArray, error: np.ndarray) -> ComplexArray:
    """Coefficients with parts that are only rounding set to zero."""
    keep = _ZERO * error
    return np.where(np.abs(value.real) > keep, value.real, 0.0) + 1j * np.where(
        np.abs(value.imag) > keep, value.imag, 0.0
    )


def _expand(rational: Rational, partition: Partition) -> tuple[list[PartialFraction], list[complex]]:
    terms: list[PartialFraction] = []
    cancelled: list[complex] = []
    everyone = np.concatenate(
        [np.full(len(members), centre) for centre, members in zip(partition.centres, partition.members, strict=True)]
        or [np.zeros(0, dtype=complex)]
    )
    for centre, members in zip(partition.centres, partition.members, strict=True):
        if centre.imag < 0:
            continue
        m = len(members)
        value, error = rational.series(centre, everyone[everyone != centre], m)
        value = _real_parts(value, error)
        if centre.imag == 0:
            value = value.real.astype(complex)
        # The coefficient of (s - p)^-k is the Taylor coefficient m - k.
        found = [(k, complex(value[m - k])) for k in range(1, m + 1) if value[m - k] != 0]
        mirrored = [centre] if centre.imag == 0 else [centre, centre.conjugate()]
        for pole in mirrored:
            flip = pole != centre
            terms += [PartialFraction(pole, k, c.conjugate() if flip else c) for k, c in found]
            if not found:
                cancelled.append(pole)
    terms.sort(key=lambda f: (f.pole != 0, -f.pole.real, abs(f.pole.imag), -f.pole.imag, f.power))
    return terms, cancelled


def _test_points(poles: ComplexArray) -> ComplexArray:
    """Points in the right half-plane at the speeds of the poles: s is about 1/t."""
    sizes = np.unique(np.abs(poles[poles != 0])) if (poles != 0).any() else np.ones(1)
    if sizes.size > 12:
        sizes = sizes[np.unique(np.linspace(0, sizes.size - 1, 12).astype(int))]
    radii = np.concatenate([[0.37 * sizes[0]], 1.03 * sizes, [2.9 * sizes[-1]]])
    return (radii[:, None] * np.exp(1j * np.array([0.3, 0.9, 1.3]))).ravel()


def _residual(rational: Rational, terms: list[PartialFraction], direct: float) -> float:
    """Error of s Y(s), which is about y(1/s), over the largest |s Y(s)| at the speeds of the poles."""
    s = _test_points(rational.poles)
    with np.errstate(all="ignore"):
        total = np.full(s.shape, complex(direct))
        for term in terms:
            total += term.coefficient / (s - term.pole) ** term.power
        exact = rational(s)
        size, error = np.abs(s * exact), np.abs(s * (total - exact))
    usable = np.isfinite(size) & np.isfinite(error)
    largest = float(size[usable].max(initial=0.0))
    return float(error[usable].max(initial=0.0)) / largest if largest > 0.0 else 0.0


def expand_rational(rational: Rational) -> PartialFractions:
    """Partial fractions of any rational function with known poles; see partial_fractions.

    Raises
    ------
    ImproperSystem
        The numerator has the higher degree.
    """
    if rational.is_zero:
        return PartialFractions((), 0.0, rational.theta, 0.0, 0.0, 0.0, ())
    if rational.relative_degree < 0:
        raise ImproperSystem(
            "the numerator has a higher degree than the denominator: its inverse contains derivatives of an impulse",
            hint="add the lag that the device has, for example divide by (0.01 s + 1)",
        )
    direct = float(rational.coefficients[0]) if rational.relative_degree == 0 else 0.0
    tried = []
    for partition in partitions(rational.poles):
        terms, cancelled = _expand(rational, partition)
        tried.append((_residual(rational, terms, direct), terms, cancelled, partition))
    enough = max(_AS_GOOD * min(t[0] for t in tried), _ROUNDING)
    residual, terms, cancelled, partition = [t for t in tried if t[0] <= enough][-1]
    return PartialFractions(
        tuple(terms), direct, rational.theta, partition.tolerance, partition.moved, residual, tuple(cancelled)
    )


def partial_fractions(system: TransferFunction, signal: LaplaceInput | None = None) -> PartialFractions:
    r"""Partial fractions of G(s), or of G(s) U(s).

    .. math::

        Y(s) = d + \sum_i \sum_{k=1}^{m_i} \frac{c_{ik}}{(s - p_i)^k}, \qquad
        c_{ik} = \frac{1}{(m_i - k)!} \lim_{s \to p_i} \frac{d^{\,m_i - k}}{d s^{\,m_i - k}} (s - p_i)^{m_i} Y(s)

    The derivatives are the Taylor coefficients of the remaining factors, multiplied one after the other. Poles that
    are one repeated pole to working precision (as roots of a written-out polynomial are) are joined: of all ways to
    join neighbours the one whose sum reproduces the factored function best is taken, and reported.

    Parameters
    ----------
    system : TransferFunction
        G(s), proper; its dead time is carried along.
    signal : LaplaceInput or None
        The input u; None takes G itself (its impulse response).

    Returns
    -------
    PartialFractions

    Raises
    ------
    ImproperSystem
        G has more zeros than poles.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, appendix B.
    """
    system.require_proper()
    return expand_rational(Rational.of(system if signal is None else system * signal.transform()))
