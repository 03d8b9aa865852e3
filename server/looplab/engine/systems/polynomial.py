"""Polynomials as coefficient arrays (highest power first) and as conjugate-closed root sets."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dgeev

from looplab.engine.errors import InvalidInput, NoConvergence

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

CONJUGATE_TOLERANCE = 1e-9


def trim(coefficients: FloatArray) -> FloatArray:
    """Drop leading zeros; the zero polynomial becomes ``[0.]``."""
    nonzero = np.flatnonzero(coefficients)
    return coefficients[nonzero[0] :] if nonzero.size else np.zeros(1)


def _quadratic_roots(a: float, b: float, c: float) -> ComplexArray:
    # Divide first: squares of very large or very small coefficients overflow.
    with np.errstate(over="ignore", invalid="ignore"):
        b, c = b / a, c / a
        disc = b * b - 4.0 * c
    if disc < 0.0:
        im = 0.5 * np.sqrt(-disc)
        return np.array([complex(-0.5 * b, im), complex(-0.5 * b, -im)])
    q = -0.5 * (b + np.copysign(np.sqrt(disc), b))
    with np.errstate(invalid="ignore"):
        return np.array([q, c / q if q != 0.0 else 0.0], dtype=complex)


def roots(coefficients: FloatArray) -> ComplexArray:
    """Roots of a real polynomial, exactly conjugate-closed.

    Parameters
    ----------
    coefficients : ndarray, shape (n+1,)
        Real coefficients, highest power first.

    Returns
    -------
    ndarray, shape (n,)
        The roots; roots at the origin are exact.

    Raises
    ------
    InvalidInput
        The coefficients are so far apart that their quotients leave double precision.
    """
    p = trim(np.asarray(coefficients, dtype=float))
    nonzero = np.flatnonzero(p)
    if p.size == 1 or not nonzero.size:
        return np.zeros(0, dtype=complex)
    origin = p.size - 1 - nonzero[-1]
    p = p[: p.size - origin]
    if p.size == 1:
        found = np.zeros(0, dtype=complex)
    elif p.size == 2:
        with np.errstate(over="ignore"):
            found = np.array([-p[1] / p[0]], dtype=complex)
    elif p.size == 3:
        found = _quadratic_roots(*p)
    else:
        # Scale s so that the product of the roots is 1: companions of stiff polynomials lose digits otherwise.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            monic = p / p[0]
            scale = abs(monic[-1]) ** (1.0 / (p.size - 1))
            scaled = monic * scale ** -np.arange(p.size)
        if not np.isfinite(scaled).all():
            raise InvalidInput("the coefficients are too far apart", hint="choose other units")
        found = pair_conjugates(eigenvalues(_companion(scaled)) * scale)
    return np.concatenate([np.zeros(origin, dtype=complex), found])


def eigenvalues(matrix: FloatArray) -> ComplexArray:
    """Eigenvalues of one small real matrix, shape (n, n): LAPACK without what numpy does around it.

    Raises
    ------
    NoConvergence
        LAPACK's QR iteration failed.
    """
    if not matrix.size:
        return np.zeros(0, dtype=complex)
    re, im, _, _, failed = dgeev(matrix, compute_vl=0, compute_vr=0)
    if failed:
        raise NoConvergence(
            "the eigenvalues do not converge", hint="choose a time unit in which the numbers are moderate"
        )
    return np.asarray(re + 1j * im)


def _companion(monic: FloatArray) -> FloatArray:
    """Companion matrix of a polynomial with leading coefficient 1, highest power first."""
    n = monic.size - 1
    out = np.zeros((n, n))
    out.ravel()[n :: n + 1] = 1.0
    out[0] = -monic[1:]
    return out


def pair_conjugates(values: npt.ArrayLike, field: str | None = None) -> ComplexArray:
    """Order a root set as reals first, then exact conjugate pairs (+ before -).

    Raises
    ------
    InvalidInput
        A complex root has no conjugate partner.
    """
    v = np.asarray(values, dtype=complex).ravel()
    scale = np.maximum(np.abs(v), 1e-300)
    real = np.abs(v.imag) <= 1e-14 * scale
    reals = np.sort(v[real].real)
    upper, lower = v[~real & (v.imag > 0)], v[~real & (v.imag < 0)]
    if upper.size != lower.size:
        raise InvalidInput(
            "complex roots must come in conjugate pairs",
            field=field,
            hint="add the conjugate [re, -im] of each complex root [re, im]",
        )
    pairs = []
    rest = list(lower)
    for root in sorted(upper, key=lambda z: (z.real, z.imag)):
        partner = min(range(len(rest)), key=lambda i: abs(rest[i] - root.conjugate()))
        if abs(rest[partner] - root.conjugate()) > max(CONJUGATE_TOLERANCE * abs(root), 1e-300):
            raise InvalidInput(
                f"the complex root {root:.6g} has no conjugate partner",
                field=field,
                hint="complex roots must come in conjugate pairs [re, im], [re, -im]",
            )
        mean = 0.5 * (root + rest.pop(partner).conjugate())
        pairs += [mean, mean.conjugate()]
    return np.concatenate([reals.astype(complex), np.array(pairs, dtype=complex)])


def from_roots(values: ComplexArray) -> FloatArray:
    """Monic real polynomial with the given conjugate-closed roots, highest power first."""
    out = np.ones(1, dtype=complex)
    for root in values:
        out = np.convolve(out, (1.0, -root))
    return out.real.copy()
