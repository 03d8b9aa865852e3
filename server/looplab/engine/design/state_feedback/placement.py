"""Pole placement by state feedback, for one input and for several."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import schur
from scipy.linalg.lapack import ztrexc

from looplab.engine.design.state_feedback.hidden import split_reachable, without_kept
from looplab.engine.errors import InvalidInput, NoConvergence
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.systems.polynomial import ComplexArray, FloatArray, pair_conjugates

LARGEST_POLE = 1e6
# Turns of all eigenvectors; most of what they can gain comes with the first few.
SWEEPS = 10
ENOUGH = 0.98


@dataclass(frozen=True)
class Placement:
    """A gain and the poles that it gives.

    Attributes
    ----------
    K : ndarray, shape (m, n)
        u = -K x.
    desired, obtained : ndarray, shape (n,)
        Poles asked for, and eigenvalues of A - B K in the same order [rad/time].
    error : float
        Largest distance between the two, relative to the size of the pole or 1.
    condition : float or None
        Condition number of the eigenvectors of A - B K: how much its poles move with an error of its entries.
        1e8 and more for a repeated pole of one input, whose eigenvectors coincide; None where it is infinite.
    kept : ndarray
        Hidden modes that stay where they are.
    """

    K: FloatArray
    desired: ComplexArray
    obtained: ComplexArray
    error: float
    condition: float | None
    kept: ComplexArray


def place_poles(A: FloatArray, B: FloatArray, poles: Sequence[complex], dual: bool = False) -> Placement:
    r"""Gain that puts the poles of A - B K at given places.

    .. math:: \det(sI - A + BK) = \prod_i (s - p_i)

    For one input the gain is unique; it is found on the Schur form, one pole at a time, repeated poles included, where
    Ackermann's formula loses its digits with the powers of A. For several inputs the freedom goes into eigenvectors
    that are as independent as can be.

    Parameters
    ----------
    A : ndarray, shape (n, n)
        [1/time]
    B : ndarray, shape (n, m)
    poles : sequence of complex
        n poles, complex ones with their conjugates [rad/time].
    dual : bool
        Whether A and B are the transposes of an observer's A and C, for the words of errors.

    Returns
    -------
    Placement

    Raises
    ------
    InvalidInput
        The poles are not n or not closed under conjugation, a mode that cannot be moved is not among them, or a pole
        is repeated more often than several inputs allow.
    NoConvergence
        The gain leaves double precision.

    References
    ----------
    .. [1] A. Varga, A Schur method for pole assignment, IEEE Trans. Autom. Control 26 (1981) 517-519.
    .. [2] J. Kautsky, N. K. Nichols, P. Van Dooren, Robust pole assignment in linear state feedback, Int. J. Control 41
       (1985) 1129-1155.
    """
    n = A.shape[0]
    desired = _closed(poles, n)
    A_r, B_r, T, hidden = split_reachable(A, B)
    rest = without_kept(desired, hidden, dual)
    K = np.zeros((B.shape[1], n))
    with np.errstate(all="ignore"):
        if rest:
            K[:, : len(rest)] = _reachable_gain(A_r, B_r, rest)
        K = K @ np.linalg.inv(T)
    if not np.isfinite(K).all():
        raise NoConvergence(
            "these poles cannot be placed to working precision",
            field="poles",
            hint="poles that are nearer to those of the plant, or other units",
        )
    obtained = matched(eigenvalues(A - B @ K), np.array(desired, dtype=complex))
    wanted = np.array(desired, dtype=complex)
    error = float((np.abs(obtained - wanted) / np.maximum(1.0, np.abs(wanted))).max(initial=0.0))
    return Placement(K, wanted, obtained, error, eigenvector_condition(A - B @ K), hidden)


def eigenvector_condition(A: FloatArray) -> float | None:
    """Condition number of the eigenvectors; None where it is infinite."""
    if not A.size:
        return 1.0
    condition = float(np.linalg.cond(np.linalg.eig(A)[1]))
    return condition if np.isfinite(condition) else None


def matched(found: ComplexArray, wanted: ComplexArray) -> ComplexArray:
    """``found`` in the order of ``wanted``: the closest pair first."""
    distance = np.abs(found[:, None] - wanted[None, :])
    out = np.empty_like(wanted)
    for _ in range(wanted.size):
        i, j = np.unravel_index(int(np.argmin(distance)), distance.shape)
        out[j] = found[i]
        distance[i, :] = distance[:, j] = np.inf
    return out


def _closed(poles: Sequence[complex], n: int) -> list[complex]:
    if len(poles) != n:
        raise InvalidInput(
            f"{len(poles)} poles for {n} states", field="poles", hint=f"give {n}, conjugates and repeated ones included"
        )
    values = pair_conjugates(poles, "poles")
    if not np.abs(values).max(initial=0.0) <= LARGEST_POLE:
        raise InvalidInput(f"poles must be up to {LARGEST_POLE:g} in size", field="poles")
    found: list[complex] = values.tolist()
    return found


def _reachable_gain(A: FloatArray, B: FloatArray, poles: list[complex]) -> FloatArray:
    """K for a controllable pair; inputs that say the same count as one."""
    U, sigma, Vt = np.linalg.svd(B, full_matrices=False)
    rank = int(np.count_nonzero(sigma > 1e-12 * sigma[0]))
    independent = U[:, :rank] * sigma[:rank]
    inner = _single_input(A, independent[:, 0], poles)[None, :] if rank == 1 else _several(A, independent, poles)
    return np.asarray(Vt[:rank].T @ inner)


def _single_input(A: FloatArray, b: FloatArray, poles: list[complex]) -> FloatArray:
    """The row k with the poles of A - b k: the last entry of the Schur form is moved, then swapped to the top."""
    n = A.shape[0]
    T, Q = schur(A, output="complex")
    k = np.zeros(n, dtype=complex)
    left = list(poles)
    for done in range(n):
        row = Q.conj().T @ b
        pole = min(left, key=lambda p: abs(p - T[-1, -1]))
        left.remove(pole)
        step = (T[-1, -1] - pole) / row[-1]
        k += step * Q[:, -1].conj()
        T[:, -1] -= step * row
        T, Q, _ = ztrexc(T, Q, n, done + 1)
    return np.asarray(k.real)


def _several(A: FloatArray, B: FloatArray, poles: list[complex]) -> FloatArray:
    """The gain whose eigenvectors, each within what its pole allows, are turned away from all the others in turn."""
    n, m = B.shape
    most = max(poles.count(p) for p in poles)
    if most > m:
        raise InvalidInput(
            f"a pole stands {most} times, which {m} independent inputs do not allow here",
            field="poles",
            hint=f"repeat it at most {m} times, or spread the poles a little",
        )
    U, Z = np.linalg.qr(B, mode="complete")
    rest = U[:, m:].T
    allowed = [_null_space(rest @ (A - p * np.eye(n)), m) for p in poles]
    start = np.random.default_rng(0).standard_normal((n, n))
    X = np.eye(n, dtype=complex)
    for i in range(n):
        _turn(X, poles, allowed, i, start[:, i].astype(complex))
    best, condition = X.copy(), float(np.linalg.cond(X))
    for _ in range(SWEEPS):
        for i, pole in enumerate(poles):
            if pole.imag < 0:
                continue
            own = [i, i + 1] if pole.imag > 0 else [i]
            others = np.delete(X, own, axis=1)
            free = np.linalg.svd(np.hstack([others.real, others.imag]) if n > len(own) else np.zeros((n, 1)))[0]
            away = free[:, -1] + (1j * free[:, -2] if pole.imag > 0 else 0.0)
            _turn(X, poles, allowed, i, away)
        now = float(np.linalg.cond(X))
        if now > ENOUGH * condition:
            break
        best, condition = X.copy(), now
    M = np.linalg.solve(best.T, (best * np.array(poles)).T).T.real
    return np.asarray(np.linalg.solve(Z[:m], U[:, :m].T @ (A - M)))


def _null_space(matrix: ComplexArray, size: int) -> ComplexArray:
    """An orthonormal basis of ``size`` columns."""
    columns = matrix.shape[1]
    if not matrix.size:
        return np.eye(columns, dtype=complex)
    return np.asarray(np.linalg.svd(matrix)[2][columns - size :].conj().T)


def _turn(X: ComplexArray, poles: list[complex], allowed: list[ComplexArray], i: int, away: ComplexArray) -> None:
    """Make eigenvector i, and its conjugate, as near to a direction as its pole allows."""
    x = allowed[i] @ (allowed[i].conj().T @ away)
    size = float(np.linalg.norm(x))
    if poles[i].imag < 0 or not size:
        return
    X[:, i] = x / size
    if poles[i].imag > 0:
        X[:, i + 1] = X[:, i].conj()
