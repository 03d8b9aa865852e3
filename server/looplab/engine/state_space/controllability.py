"""Controllability and observability: matrices, ranks with their singular values, and the modes that hide."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import matrix_balance

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

TOLERANCE = 1e-12


@dataclass(frozen=True)
class RankTest:
    """A Kalman matrix and its rank.

    Attributes
    ----------
    matrix : ndarray
        [B, AB, ...] of shape (n, n m), or C, CA, ... stacked, of shape (p n, n).
    singular_values : ndarray, shape (n,)
        Those of the matrix for balanced states, unit columns of B (rows of C), and time measured in 1/``speed``:
        the rank does not change by that, but it no longer hangs on the choice of units.
    rank : int
        Singular values above ``tolerance`` times the largest.
    full : bool
        Whether no mode hides, decided mode by mode (``Mode``).
    reason : str or None
        Where the rank of the matrix says otherwise: powers of A lose digits, the modes do not.
    """

    matrix: FloatArray
    singular_values: FloatArray
    rank: int
    full: bool
    tolerance: float
    speed: float
    reason: str | None


@dataclass(frozen=True)
class Mode:
    """An eigenvalue of A, and how far it is from hiding.

    ``sigma_controllable`` and ``sigma_observable`` are the smallest singular values of [A - pole I, B] and of
    [A - pole I; C], relative to the largest entry of the balanced model; at most ``tolerance`` means hidden.
    """

    pole: complex
    stable: bool
    controllable: bool
    observable: bool
    sigma_controllable: float
    sigma_observable: float


@dataclass(frozen=True)
class StructureAnalysis:
    """Controllability and observability of a model. Stabilisable (detectable): every mode that hides decays."""

    controllability: RankTest
    observability: RankTest
    modes: tuple[Mode, ...]
    stabilizable: bool
    detectable: bool
    minimal: bool


def controllability_matrix(model: StateSpaceModel) -> FloatArray:
    r"""Kalman's controllability matrix.

    .. math:: \mathcal{C} = [B,\; AB,\; \dots,\; A^{n-1}B]

    Parameters
    ----------
    model : StateSpaceModel

    Returns
    -------
    ndarray, shape (n, n m)
        Every state can be reached where its rank is n.

    References
    ----------
    .. [1] R. E. Kalman, Mathematical description of linear dynamical systems, J. SIAM Control 1 (1963) 152-192.
    """
    return _krylov(model.A, model.B)


def observability_matrix(model: StateSpaceModel) -> FloatArray:
    r"""Kalman's observability matrix, the transpose of the dual's controllability matrix.

    .. math:: \mathcal{O} = [C;\; CA;\; \dots;\; CA^{n-1}]

    Parameters
    ----------
    model : StateSpaceModel

    Returns
    -------
    ndarray, shape (p n, n)
        The state can be told from the output where its rank is n.

    References
    ----------
    .. [1] R. E. Kalman, Mathematical description of linear dynamical systems, J. SIAM Control 1 (1963) 152-192.
    """
    return _krylov(model.A.T, model.C.T).T


def _krylov(A: FloatArray, B: FloatArray) -> FloatArray:
    blocks = [B]
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(A.shape[0] - 1):
            blocks.append(A @ blocks[-1])
    return np.hstack(blocks) if A.size else B.copy()


def _unit_columns(B: FloatArray) -> FloatArray:
    size = np.linalg.norm(B, axis=0)
    return B / np.where(size > 0, size, 1.0)


def _candidates(poles: ComplexArray) -> ComplexArray:
    """For each pole the centre of its cluster: a k-fold eigenvalue comes out spread by eps^(1/k), its mean does not."""
    centres = np.empty_like(poles)
    for i, p in enumerate(poles):
        near = np.abs(poles - p) <= 1e-3 * abs(p)
        centres[i] = poles[near].mean() if near.any() else p
    return centres


def _smallest(A: FloatArray, B: FloatArray, poles: ComplexArray) -> FloatArray:
    """Smallest singular value of [A - p I, B] for each p, the cluster's centre or the pole itself."""
    n = A.shape[0]
    if not n:
        return np.zeros(0)
    tries = np.concatenate([poles, _candidates(poles)])
    stacked = np.empty((tries.size, n, n + B.shape[1]), dtype=complex)
    stacked[:, :, :n] = A - tries[:, None, None] * np.eye(n)
    stacked[:, :, n:] = B
    sigma = np.linalg.svd(stacked, compute_uv=False)[:, -1]
    return np.minimum(sigma[: poles.size], sigma[poles.size :])


def _rank_test(
    matrix: FloatArray, A: FloatArray, B: FloatArray, full: bool, tolerance: float, speed: float, word: str
) -> RankTest:
    n = A.shape[0]
    sigma = np.linalg.svd(_krylov(A, B), compute_uv=False)[:n].astype(float)
    rank = int(np.count_nonzero(sigma > tolerance * sigma.max(initial=0.0)))
    reason = None
    if full and rank < n:
        reason = (
            f"the matrix has rank {rank} at this tolerance although no mode is {word}: "
            "high powers of A lose digits, the test of each mode does not, and it decides"
        )
    elif not full and rank == n:
        reason = f"a mode is {word} at this tolerance although the matrix has full rank: the modes decide"
    return RankTest(matrix, sigma, rank, full, tolerance, speed, reason)


def analyse_structure(model: StateSpaceModel, tolerance: float = TOLERANCE) -> StructureAnalysis:
    r"""Which modes the input can move and the output shows.

    .. math:: \operatorname{rank}\,[A - \lambda I,\; B] = n, \qquad
              \operatorname{rank}\,[A - \lambda I;\; C] = n \quad \text{for every eigenvalue } \lambda

    Parameters
    ----------
    model : StateSpaceModel
    tolerance : float
        Relative size below which a singular value counts as zero, 1e-15 to 1e-2.

    Returns
    -------
    StructureAnalysis
        Kalman's matrices with their ranks, and each mode by the test of Popov, Belevitch and Hautus, which decides.

    Raises
    ------
    InvalidInput
        The tolerance is out of range.

    References
    ----------
    .. [1] M. L. J. Hautus, Controllability and observability conditions of linear autonomous systems, Indag. Math. 31
       (1969) 443-448.
    """
    if not 1e-15 <= tolerance <= 1e-2:
        raise InvalidInput("the tolerance must be from 1e-15 to 1e-2", field="tolerance", hint="1e-12 is usual")
    A, B, C = model.A, model.B, model.C
    speed = 1.0
    if model.states:
        A, (scale, _) = matrix_balance(A, permute=False, separate=True)
        B, C = B / scale[:, None], C * scale
        speed = float(np.abs(A).max()) or 1.0
        A = A / speed
    B, Ct = _unit_columns(B), _unit_columns(C.T)
    poles = model.poles
    by_input, by_output = _smallest(A, B, poles / speed), _smallest(A.T, Ct, poles / speed)
    modes = tuple(
        Mode(
            pole=complex(p),
            stable=bool(p.real < 0),
            controllable=bool(b > tolerance),
            observable=bool(c > tolerance),
            sigma_controllable=float(b),
            sigma_observable=float(c),
        )
        for p, b, c in zip(poles, by_input, by_output, strict=True)
    )
    controllable, observable = all(m.controllable for m in modes), all(m.observable for m in modes)
    return StructureAnalysis(
        _rank_test(controllability_matrix(model), A, B, controllable, tolerance, speed, "uncontrollable"),
        _rank_test(observability_matrix(model), A.T, Ct, observable, tolerance, speed, "unobservable"),
        modes,
        all(m.controllable or m.stable for m in modes),
        all(m.observable or m.stable for m in modes),
        controllable and observable,
    )
