"""Poles of one gain, how near they are to each other, and paired with those of the next."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def nearest_pairs(gap: npt.NDArray[np.float64], gate: float = np.inf) -> list[tuple[int, int]]:
    """Pairs (row, column) of a matrix of distances, nearest first, each row and column used once, none beyond gate."""
    rows, columns = gap.shape
    values = gap.ravel()
    order = values.argsort(kind="stable")
    free_rows, free_columns = set(range(rows)), set(range(columns))
    pairs: list[tuple[int, int]] = []
    for flat, distance in zip(order.tolist(), values[order].tolist(), strict=True):
        i, j = divmod(flat, columns)
        if i in free_rows and j in free_columns:
            if distance > gate:
                break
            pairs.append((i, j))
            free_rows.remove(i)
            free_columns.remove(j)
            if not (free_rows and free_columns):
                break
    return pairs


def nearest_neighbour(points: npt.NDArray[np.complex128]) -> npt.NDArray[np.float64]:
    """Distance of each point to the nearest other of its row but NaN, shape (m, n); infinite where it is alone."""
    m, n = points.shape
    gap = np.abs(points[:, :, None] - points[:, None, :])
    gap.reshape(m, n * n)[:, :: n + 1] = np.inf
    out: npt.NDArray[np.float64] = np.fmin.reduce(gap, axis=1)
    return out
