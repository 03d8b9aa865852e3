"""Modes that no feedback moves, refused by name."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import matrix_balance

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.state_space.minimal_realization import TOLERANCE, staircase
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

# A desired pole this near to a hidden mode, relative to it, keeps the mode where it is.
SAME = 1e-6


def split_reachable(A: FloatArray, B: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, ComplexArray]:
    """The part of (A, B) that inputs reach: its A and B, T with x = T z, and the modes that are left.

    T has shape (n, r + rest); A_z = T^-1 A T is block triangular, with the reachable part first.
    """
    A, (scale, _) = matrix_balance(A, permute=False, separate=True)
    B = B / scale[:, None]
    speed = float(np.abs(A).max(initial=0.0)) or 1.0
    Q, rank, _ = staircase(A / speed, B, TOLERANCE)
    A, B = Q.T @ A @ Q, Q.T @ B
    return A[:rank, :rank], B[:rank], scale[:, None] * Q, eigenvalues(A[rank:, rank:])


def pole_text(pole: complex) -> str:
    """-1.5 or -1 + 2i."""
    if pole.imag == 0:
        return f"{pole.real:.4g}"
    return f"{pole.real:.4g} {'+' if pole.imag > 0 else '-'} {abs(pole.imag):.4g}i"


def without_kept(desired: Sequence[complex], hidden: ComplexArray, dual: bool) -> list[complex]:
    """The desired poles that remain to be placed.

    Raises
    ------
    InvalidInput
        A hidden mode is not among the desired poles.
    """
    rest = list(desired)
    for mode in hidden.tolist():
        near = min(rest, key=lambda p: abs(p - mode), default=None)
        if near is None or abs(near - mode) > SAME * max(1.0, abs(mode)):
            word, does = ("unobservable", "no output shows") if dual else ("uncontrollable", "no input moves")
            raise InvalidInput(
                f"the mode at s = {pole_text(mode)} is {word}: {does} it, so it stays where it is",
                field="poles",
                hint=f"put {pole_text(mode)} among the poles to keep it"
                if mode.real < 0
                else "it does not decay: choose other inputs or outputs",
            )
        rest.remove(near)
    return rest
