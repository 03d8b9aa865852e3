"""The polynomial equation A L + B P = D through Sylvester's matrix, refined with exact residuals."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.polynomial import FloatArray

# Steps of refinement: each gains the digits that the conditioning leaves; three reach rounding up to 1e10 or so.
REFINEMENTS = 3
# Leading coefficients below this share of the largest are what rounding leaves of a zero.
NEGLIGIBLE = 1e-14


@dataclass(frozen=True)
class Diophantine:
    """L and P with what is left of the equation.

    Attributes
    ----------
    L, P : ndarray
        Coefficients, highest power first.
    residual : float
        Largest coefficient of A L + B P - D in exact arithmetic, over the largest of D, in the scaled variable [-].
    condition : float
        2-norm condition number of Sylvester's matrix in the scaled variable [-].
    scale : float
        s = scale * p: the variable in which it was solved [rad/time].
    """

    L: FloatArray
    P: FloatArray
    residual: float
    condition: float
    scale: float


def _shifts(coefficients: FloatArray, columns: int, rows: int) -> FloatArray:
    """Coefficients (highest first) times s^(columns-1) ... s^0, one a column, in rows from the highest power down."""
    out = np.zeros((rows, columns))
    for j in range(columns):
        start = rows - columns - coefficients.size + 1 + j
        out[start : start + coefficients.size, j] = coefficients
    return out


def sylvester_matrix(A: FloatArray, B: FloatArray, L_degree: int, P_degree: int, D_degree: int) -> FloatArray:
    r"""The matrix of (L, P) -> A L + B P on coefficients, for any degrees.

    .. math:: \Phi \begin{pmatrix} l \\ p \end{pmatrix} = d

    With deg A = n, deg B < n and deg L = deg P = n - 1 this is Sylvester's matrix, singular exactly where A and B
    share a root.

    Parameters
    ----------
    A, B : ndarray
        Coefficients, highest power first.
    L_degree, P_degree, D_degree : int
        Degrees, such that neither A L nor B P exceeds that of D.

    Returns
    -------
    ndarray, shape (D_degree + 1, L_degree + P_degree + 2)

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 7.2.
    """
    rows = D_degree + 1
    return np.hstack([_shifts(A, L_degree + 1, rows), _shifts(B, P_degree + 1, rows)])


def _scaled(coefficients: FloatArray, scale: float) -> FloatArray:
    """Coefficients in p = s/scale."""
    out: FloatArray = coefficients * scale ** np.arange(coefficients.size - 1, -1, -1.0)
    return out


def _exact_product(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        if x:
            for j, y in enumerate(b):
                out[i + j] += x * y
    return out


def exact_residual(A: FloatArray, L: FloatArray, B: FloatArray, P: FloatArray, D: FloatArray) -> FloatArray:
    """D - A L - B P in rational arithmetic, rounded once, shape of D; the products are no longer than D."""
    out = [Fraction(float(v)) for v in D]
    for first, second in ((A, L), (B, P)):
        terms = _exact_product(*([Fraction(float(v)) for v in c] for c in (first, second)))
        for i, value in enumerate(terms):
            out[len(out) - len(terms) + i] -= value
    return np.array([float(v) for v in out])


def _cleaned(coefficients: FloatArray) -> FloatArray:
    """Without what rounding left of leading and trailing zeros."""
    out = coefficients.copy()
    seen = np.flatnonzero(np.abs(out) > NEGLIGIBLE * np.abs(out).max(initial=0.0))
    if not seen.size:
        return np.zeros(1)
    out[seen[-1] + 1 :] = 0.0
    return out[seen[0] :]


def solve_diophantine(A: FloatArray, B: FloatArray, D: FloatArray, scale: float) -> Diophantine:
    r"""The solution of least degree in P, to rounding.

    .. math:: A(s) L(s) + B(s) P(s) = D(s), \qquad \deg P < \deg A, \quad \deg L = \deg D - \deg A

    Parameters
    ----------
    A, B, D : ndarray
        Coefficients, highest power first; deg B <= deg A and deg D >= 2 deg A - 1.
    scale : float
        About the size of the roots: the equation is solved in s/scale [rad/time].

    Returns
    -------
    Diophantine

    Raises
    ------
    InvalidInput
        The coefficients leave double precision.

    References
    ----------
    .. [1] K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 3rd ed., Prentice Hall 1997, sec. 5.3.
    .. [2] N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., SIAM 2002, ch. 12 (refinement).
    """
    n, degree = A.size - 1, D.size - 1
    with np.errstate(over="ignore", under="ignore"):
        a, b, d = (_scaled(c, scale) for c in (A, B, D))
        sizes = [float(np.abs(c).max()) for c in (a, b, d)]
    if not (np.isfinite(sizes).all() and min(sizes) > 0):
        raise InvalidInput("the coefficients leave double precision", field="D", hint="choose another time unit")
    # Powers of two, so that nothing is rounded.
    a, b, d = (c / 2.0 ** np.round(np.log2(size)) for c, size in zip((a, b, d), sizes, strict=True))
    alpha, beta, delta = (2.0 ** np.round(np.log2(size)) for size in sizes)
    L_degree, P_degree = degree - n, n - 1
    matrix = sylvester_matrix(a, b, L_degree, P_degree, degree)
    U, singular, Vt = np.linalg.svd(matrix)
    condition = float(singular[0] / singular[-1]) if singular[-1] > 0 else np.inf

    def solve(rest: FloatArray) -> FloatArray:
        out: FloatArray = Vt.T @ ((U.T @ rest) / singular)
        return out

    if not np.isfinite(condition):
        return Diophantine(np.zeros(1), np.zeros(1), np.inf, condition, scale)
    x = solve(d)
    split = L_degree + 1
    for _ in range(REFINEMENTS):
        x = x + solve(exact_residual(a, x[:split], b, x[split:], d))

    def residual_of(L: FloatArray, P: FloatArray) -> float:
        return float(np.abs(exact_residual(a, L, b, P, d)).max() / np.abs(d).max())

    # Only with a plant that passes jumps on can the first coefficient of L vanish.
    given = (x[:split], x[split:])
    clean = (_cleaned(given[0]) if b.size == a.size else given[0], _cleaned(given[1]))
    residual, plain = residual_of(*clean), residual_of(*given)
    # What looked like rounding was not, where coefficients are of very different sizes.
    (L, P), residual = (clean, residual) if residual <= max(10.0 * plain, NEGLIGIBLE) else (given, plain)
    # Powers of the scale, undone one by one: sizes first, they are powers of two.
    back_L = L * (delta / alpha) * scale ** -np.arange(L.size - 1, -1, -1.0)
    back_P = P * (delta / beta) * scale ** -np.arange(P.size - 1, -1, -1.0)
    return Diophantine(back_L, back_P, residual, condition, scale)
