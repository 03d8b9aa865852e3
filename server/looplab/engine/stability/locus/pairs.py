"""Poles of one gain paired with those of the next."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

ComplexArray = npt.NDArray[np.complex128]


def nearest_pairs(guess: ComplexArray, points: ComplexArray, gate: float = np.inf) -> list[tuple[int, int]]:
    """Pairs (guess, point), nearest first, each used once."""
    if not guess.size or not points.size:
        return []
    gap = np.abs(guess[:, None] - points[None, :])
    pairs: list[tuple[int, int]] = []
    for flat in np.argsort(gap, axis=None):
        i, j = divmod(int(flat), points.size)
        if gap[i, j] > gate:
            break
        if all(i != a and j != b for a, b in pairs):
            pairs.append((i, j))
    return pairs
