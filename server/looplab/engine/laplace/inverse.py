"""y(t) as an exact sum of t^k e^{at} cos(bt) and sin(bt), starting after the dead time."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.laplace.partial_fractions import PartialFractions
from looplab.engine.laplace.rational import Rational
from looplab.engine.loop.step_response import step_response
from looplab.engine.systems.polynomial import FloatArray, roots
from looplab.engine.systems.transfer_function import TransferFunction

AGREES = 1e-9


@dataclass(frozen=True)
class Mode:
    """Re(sum_k coefficients[k] t^k e^{pole t}) with Im(pole) >= 0.

    The factor of t^k e^{at} cos(bt) is the real part of coefficients[k], that of t^k e^{at} sin(bt) minus its
    imaginary part.
    """

    pole: complex
    coefficients: tuple[complex, ...]


@dataclass(frozen=True)
class ExponentialSum:
    r"""A time function with a rational transform and a dead time.

    .. math::

        y(t) = d\,\delta(x) + 1(x)\,\mathrm{Re} \sum_i \sum_k c_{ik}\, x^k e^{p_i x}, \qquad x = t - \theta

    Attributes
    ----------
    modes : tuple of Mode
        One a pole, conjugate pairs once.
    impulse : float
        d, the weight of the impulse at t = theta (not part of the values).
    theta : float
        Dead time [time].
    """

    modes: tuple[Mode, ...]
    impulse: float = 0.0
    theta: float = 0.0

    def __call__(self, t: npt.ArrayLike) -> FloatArray:
        """y(t), shape of t [time]; 0 before the dead time, the right-hand limit at it; the impulse is left out."""
        x = np.asarray(t, dtype=float) - self.theta
        y = np.zeros(x.shape)
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):
            for mode in self.modes:
                polynomial = np.polyval(np.array(mode.coefficients[::-1]), x)
                y += (polynomial * np.exp(mode.pole * x)).real
        return np.where(x >= 0, y, 0.0)

    def derivative(self) -> ExponentialSum:
        """dy/dt for t > theta (the jump and the impulse at t = theta are left out)."""
        modes = []
        for mode in self.modes:
            c = (*mode.coefficients, 0j)
            slope = tuple(mode.pole * c[k] + (k + 1) * c[k + 1] for k in range(len(mode.coefficients)))
            modes.append(Mode(mode.pole, slope))
        return ExponentialSum(tuple(modes), 0.0, self.theta)

    def to_text(self, digits: int = 6) -> str:
        """For example ``1 - e^(-t) (1 + t)``."""
        from looplab.engine.laplace.notation import TEXT, time_function

        return time_function(self, TEXT, digits)

    def to_latex(self, digits: int = 4) -> str:
        r"""For example ``1 - e^{-t} \left(1 + t\right)``."""
        from looplab.engine.laplace.notation import LATEX, time_function

        return time_function(self, LATEX, digits)


def inverse_transform(fractions: PartialFractions) -> ExponentialSum:
    r"""y(t) of partial fractions.

    .. math::

        \mathcal{L}^{-1}\Bigl\{\frac{c}{(s-p)^k}\,e^{-\theta s}\Bigr\}
        = c\,\frac{(t-\theta)^{k-1}}{(k-1)!}\,e^{p(t-\theta)}\,1(t-\theta)

    Parameters
    ----------
    fractions : PartialFractions
        Of Y(s).

    Returns
    -------
    ExponentialSum
        Fractions of conjugate poles joined to real terms.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, appendix A (table of transforms).
    """
    by_pole: dict[complex, list[complex]] = {}
    for term in fractions.terms:
        if term.pole.imag < 0:
            continue
        row = by_pole.setdefault(term.pole, [])
        row += [0j] * (term.power - len(row))
        pair = 2.0 if term.pole.imag > 0 else 1.0
        row[term.power - 1] = pair * term.coefficient / math.factorial(term.power - 1)
    modes = tuple(Mode(pole, tuple(row)) for pole, row in by_pole.items())
    return ExponentialSum(modes, fractions.direct, fractions.theta)


def suggested_horizon(y: ExponentialSum) -> float:
    """A time by which y has shown itself [time]: decay over, five periods seen, or growth by e^8."""
    growing = [m.pole.real for m in y.modes if m.pole.real > 0]
    if growing:
        return float(f"{y.theta + 8.0 / max(growing):.3g}")
    wanted = [0.0]
    for mode in y.modes:
        a, b, powers = -mode.pole.real, mode.pole.imag, len(mode.coefficients) - 1
        if b:
            # Beyond thirty periods of a slow decay nothing can be seen any more.
            wanted.append(min((6.0 + 2.0 * powers) / a, 60.0 * math.pi / b) if a else 10.0 * math.pi / b)
        elif a:
            wanted.append((6.0 + 2.0 * powers) / a)
    longest = max(wanted) or (4.0 * y.theta or 10.0)
    return float(f"{y.theta + longest:.3g}")


@dataclass(frozen=True)
class SimulationCheck:
    """Largest difference between the formula and the simulation over the horizon, relative to the largest value.

    ``difference`` is None, with a reason, where the simulation cannot follow; a difference above 1e-9 has one too.
    ``t`` and ``y``, shape (n,), are the simulation itself, dead time included [time]; empty where there is none.
    """

    difference: float | None
    horizon: float
    reason: str | None = None
    t: FloatArray = field(default_factory=lambda: np.zeros(0))
    y: FloatArray = field(default_factory=lambda: np.zeros(0))


def check_by_simulation(rational: Rational, y: ExponentialSum, horizon: float, points: int = 400) -> SimulationCheck:
    """Compare y(t) with the state-space simulation of the same transform, dead time aside.

    Parameters
    ----------
    rational : Rational
        Y(s), strictly proper: it is simulated as the step response of s Y(s).
    y : ExponentialSum
        What was found for it.
    horizon : float
        Length of the comparison, > 0 [time].
    points : int
        Samples, 20 to 5000.

    Returns
    -------
    SimulationCheck
    """
    if rational.is_zero:
        return SimulationCheck(0.0, horizon)
    if rational.relative_degree < 1:
        return SimulationCheck(None, horizon, "an impulse cannot be simulated")
    zeros = np.concatenate([rational.zeros, roots(rational.coefficients), [0.0]])
    try:
        times_s = TransferFunction(zeros, rational.poles, float(rational.coefficients[0]))
        simulated = step_response(times_s, horizon, points)
    except InvalidInput as error:
        return SimulationCheck(None, horizon, error.message)
    if not simulated.t.size:
        return SimulationCheck(None, horizon, "the response is too large to simulate")
    formula = ExponentialSum(y.modes)(simulated.t)
    size = float(np.abs(simulated.y).max())
    difference = float(np.abs(formula - simulated.y).max())
    if not math.isfinite(difference):
        return SimulationCheck(None, horizon, "the values leave the range of double precision")
    relative = difference / size if size else difference
    # Poles close together, or slow ones seen at the speed of fast ones, have terms far larger than their sum.
    why = None if relative <= AGREES else "the terms are much larger than their sum: their leading digits cancel"
    return SimulationCheck(relative, horizon, why, simulated.t + y.theta, simulated.y)
