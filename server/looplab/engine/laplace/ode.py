"""A linear differential equation with constant coefficients, solved by the Laplace transform."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.laplace.inputs import LaplaceInput
from looplab.engine.laplace.inverse import ExponentialSum, inverse_transform
from looplab.engine.laplace.partial_fractions import PartialFractions, expand_rational
from looplab.engine.laplace.rational import Rational
from looplab.engine.systems.polynomial import FloatArray, from_roots, roots, trim
from looplab.engine.systems.transfer_function import MAX_ORDER


@dataclass(frozen=True)
class ODESolution:
    """Y(s), its partial fractions and y(t), whole and in its two parts.

    Attributes
    ----------
    transform : Rational
        Y(s).
    fractions : PartialFractions
        Of Y(s).
    y : ExponentialSum
        The solution for t > 0.
    forced : ExponentialSum
        What the input does to a system at rest.
    free : ExponentialSum
        What the initial conditions do without an input.
    """

    transform: Rational
    fractions: PartialFractions
    y: ExponentialSum
    forced: ExponentialSum
    free: ExponentialSum


def _coefficients(name: str, values: Sequence[float]) -> FloatArray:
    c = np.asarray(values, dtype=float)
    if c.ndim != 1 or not c.size or not np.isfinite(c).all():
        raise InvalidInput(f"{name} must be a list of finite numbers, highest derivative first", field=name)
    return c


def _initial_polynomial(a: FloatArray, initial: FloatArray) -> FloatArray:
    """sum_k a_k sum_{j<k} s^{k-1-j} y^(j)(0), highest power first, shape (n,)."""
    n = a.size - 1
    rising, out = a[::-1], np.zeros(max(n, 1))
    for k in range(1, n + 1):
        for j in range(k):
            out[n - 1 - (k - 1 - j)] += rising[k] * initial[j]
    return out


def solve_linear_ode(
    a: Sequence[float],
    b: Sequence[float] = (1.0,),
    initial: Sequence[float] = (),
    signal: LaplaceInput | None = None,
) -> ODESolution:
    r"""Solve a linear ODE with initial conditions.

    .. math::

        a_n y^{(n)} + \dots + a_1 \dot y + a_0 y = b_m u^{(m)} + \dots + b_0 u, \qquad
        Y(s) = \frac{B(s)\,U(s) + \sum_k a_k \sum_{j<k} s^{k-1-j} y^{(j)}(0)}{A(s)}

    Parameters
    ----------
    a : sequence of float
        a_n ... a_0, highest derivative first; a_n is not zero, 1 <= n <= 50.
    b : sequence of float
        b_m ... b_0, m <= n.
    initial : sequence of float
        y(0), y'(0), ... just before the input acts (t = 0-); empty means all zero.
    signal : LaplaceInput or None
        u(t), zero for t < 0; None means no input.

    Returns
    -------
    ODESolution

    Raises
    ------
    InvalidInput
        a_n is zero, a coefficient is not finite, or there are not n initial values.
    ImproperSystem
        m > n: the equation would differentiate its input.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, sec. 2-2 and appendix A.
    """
    A, B = _coefficients("a", a), trim(_coefficients("b", b))
    n = A.size - 1
    if A[0] == 0:
        raise InvalidInput("the first coefficient is zero", field="a", hint="leave the leading zeros out")
    if not 1 <= n <= MAX_ORDER:
        raise InvalidInput(f"the order must be from 1 to {MAX_ORDER}", field="a", hint="a_n y^(n) + ... + a_0 y")
    if B.size > A.size:
        raise ImproperSystem(
            f"the input is differentiated {B.size - 1} times, the output only {n} times: not causal",
            field="b",
            hint="use at most as many derivatives of u as of y",
        )
    start = np.asarray(initial, dtype=float) if len(initial) else np.zeros(n)
    if start.shape != (n,) or not np.isfinite(start).all():
        raise InvalidInput(
            f"an equation of order {n} needs {n} finite initial values", field="initial", hint="y(0), y'(0), ..."
        )
    own = roots(A)
    none = np.zeros(0, dtype=complex)
    # Divided by a_n from the start: the denominator is the monic product of its poles.
    rest = trim(_initial_polynomial(A, start) / A[0])
    U = signal.transform() if signal is not None else None
    top = B / A[0] * (U.gain if U is not None else 0.0)
    poles = np.concatenate([own, U.poles]) if U is not None else own
    forced = Rational(trim(top), none, poles)
    free = Rational(rest, none, own)
    if U is not None and U.poles.size:
        # Over the common denominator, so that a mode which both parts excite is one term.
        whole = Rational(trim(np.polyadd(top, np.polymul(rest, from_roots(U.poles)))), none, poles)
    else:
        whole = Rational(trim(np.polyadd(top, rest)), none, poles)
    fractions = expand_rational(whole)
    return ODESolution(
        whole,
        fractions,
        inverse_transform(fractions),
        inverse_transform(expand_rational(forced)),
        inverse_transform(expand_rational(free)),
    )
