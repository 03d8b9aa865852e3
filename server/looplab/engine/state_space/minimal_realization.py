"""A state-space model without its hidden modes: the staircase algorithm, and what it took out at which tolerance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import matrix_balance

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.systems.polynomial import FloatArray

TOLERANCE = 1e-10


@dataclass(frozen=True)
class RemovedMode:
    """A mode that was taken out: ``hidden_from`` is "input" (no input moves it) or "output" (no output shows it)."""

    pole: complex
    hidden_from: str
    stable: bool


@dataclass(frozen=True)
class Kept:
    """A, B and C of what was kept, what was removed, and the singular values on either side of the tolerance."""

    A: FloatArray
    B: FloatArray
    C: FloatArray
    removed: tuple[RemovedMode, ...]
    smallest_kept: float | None
    largest_removed: float | None


@dataclass(frozen=True)
class MinimalRealization:
    """A model in which every mode is controllable and observable, with the same transfer matrix.

    Attributes
    ----------
    model : StateSpaceModel
    removed : tuple of RemovedMode
    tolerance : float
        Singular values at most this counted as zero; they are relative to the balanced model's A and to unit columns
        of B (rows of C).
    smallest_kept, largest_removed : float or None
        The nearest singular values above and below: far apart, the decision was clear. None where there are none.
    """

    model: StateSpaceModel
    removed: tuple[RemovedMode, ...]
    tolerance: float
    smallest_kept: float | None
    largest_removed: float | None


def staircase(A: FloatArray, B: FloatArray, tolerance: float) -> tuple[FloatArray, int, list[float]]:
    """Orthogonal coordinates whose first r states are the ones B reaches, r, and every singular value that decided."""
    n = A.shape[0]
    Q, done, decided = np.eye(n), 0, []
    size = np.linalg.norm(B, axis=0)
    step = B / np.where(size > 0, size, 1.0)
    while done < n:
        U, sigma, _ = np.linalg.svd(step)
        decided += sigma.tolist()
        rank = int(np.count_nonzero(sigma > tolerance))
        if not rank:
            break
        Q[:, done:] = Q[:, done:] @ U
        step = (Q.T @ A @ Q)[done + rank :, done : done + rank]
        done += rank
    return Q, done, decided


def remove_hidden_modes(A: FloatArray, B: FloatArray, C: FloatArray, tolerance: float) -> Kept:
    """The controllable and observable part of (A, B, C), arrays of any number of states and channels.

    Raises
    ------
    InvalidInput
        The tolerance is out of range.
    """
    if not 1e-15 <= tolerance <= 1e-2:
        raise InvalidInput("the tolerance must be from 1e-15 to 1e-2", field="tolerance", hint="1e-10 is usual")
    removed: list[RemovedMode] = []
    decided: list[float] = []
    if A.size:
        A, (scale, _) = matrix_balance(A, permute=False, separate=True)
        B, C = B / scale[:, None], C * scale
    whole = (A, B, C)
    for side in ("input", "output"):
        if side == "output":
            A, B, C = A.T, C.T, B.T
        speed = float(np.abs(A).max(initial=0.0)) or 1.0
        Q, rank, sigma = staircase(A / speed, B, tolerance)
        decided += sigma
        A, B, C = Q.T @ A @ Q, Q.T @ B, C @ Q
        removed += [RemovedMode(complex(p), side, bool(p.real < 0)) for p in eigenvalues(A[rank:, rank:])]
        A, B, C = A[:rank, :rank], B[:rank], C[:, :rank]
    A, B, C = (A.T, C.T, B.T) if removed else whole
    values = np.array(decided)
    kept, dropped = values[values > tolerance], values[values <= tolerance]
    return Kept(
        A, B, C, tuple(removed),
        float(kept.min()) if kept.size else None, float(dropped.max()) if dropped.size else None,
    )  # fmt: skip


def minimal_realization(model: StateSpaceModel, tolerance: float = TOLERANCE) -> MinimalRealization:
    r"""Take out the modes that no input moves or no output shows.

    .. math:: C (sI - A)^{-1} B + D = \tilde C (sI - \tilde A)^{-1} \tilde B + D

    Parameters
    ----------
    model : StateSpaceModel
    tolerance : float
        Relative size below which a singular value counts as zero, 1e-15 to 1e-2.

    Returns
    -------
    MinimalRealization
        The model itself where nothing hides.

    Raises
    ------
    InvalidInput
        The tolerance is out of range.

    References
    ----------
    .. [1] P. Van Dooren, The generalized eigenstructure problem in linear system theory, IEEE Trans. Autom. Control 26
       (1981) 111-129 (staircase form).
    """
    found = remove_hidden_modes(model.A, model.B, model.C, tolerance)
    kept = StateSpaceModel(found.A, found.B, found.C, model.D) if found.removed else model
    return MinimalRealization(kept, found.removed, tolerance, found.smallest_kept, found.largest_removed)
