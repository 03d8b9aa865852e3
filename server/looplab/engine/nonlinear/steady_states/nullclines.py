"""Lines in a plane along which a function is zero, from a grid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from looplab.engine.systems.polynomial import FloatArray

PlaneFunction = Callable[[float, float], float]
Edge = tuple[int, int, bool]
_HALVINGS = 60
# What is left at a zero, as part of the values at the ends of its edge; more is a jump.
_STEEP = 1e-3


@dataclass(frozen=True)
class ZeroLine:
    """One line: its points, shape (count,), and whether it comes back to where it began."""

    horizontal: FloatArray
    vertical: FloatArray
    closed: bool


def zero_lines(function: PlaneFunction, values: FloatArray, h: FloatArray, v: FloatArray) -> tuple[ZeroLine, ...]:
    """Zero lines of a function: where an edge of the grid changes sign, the zero on it is found by bisection.

    Parameters
    ----------
    function : callable of (horizontal, vertical)
        Returns nan where it is undefined.
    values : ndarray, shape (v.size, h.size)
        The function on the grid.
    h, v : ndarray
        Increasing coordinates of the grid.

    Returns
    -------
    tuple of ZeroLine
        Points are exact on the edges; between them a line is straight. A jump from one sign to the other, as at a
        pole, is no zero.
    """
    positive = values >= 0
    known = np.isfinite(values)
    cells = known[:-1, :-1] & known[1:, :-1] & known[:-1, 1:] & known[1:, 1:]
    corners = positive[:-1, :-1].astype(int) + positive[1:, :-1] + positive[:-1, 1:] + positive[1:, 1:]
    points: dict[Edge, tuple[float, float] | None] = {}
    links: dict[Edge, list[Edge]] = {}

    def crossing(edge: Edge) -> tuple[float, float] | None:
        if edge not in points:
            points[edge] = _zero_on(edge, function, values, h, v)
        return points[edge]

    for row, column in np.argwhere(cells & (corners % 4 != 0)).tolist():
        for a, b in _pairs(row, column, positive, function, h, v):
            if crossing(a) is not None and crossing(b) is not None:
                links.setdefault(a, []).append(b)
                links.setdefault(b, []).append(a)
    return tuple(_line(path, points) for path in _chains(links))


def _pairs(
    row: int, column: int, positive: np.ndarray, function: PlaneFunction, h: FloatArray, v: FloatArray
) -> list[tuple[Edge, Edge]]:
    """Which edges of a cell a line connects."""
    bottom, top = (row, column, True), (row + 1, column, True)
    left, right = (row, column, False), (row, column + 1, False)
    p = [bool(positive[row, column]), bool(positive[row, column + 1])]
    q = [bool(positive[row + 1, column]), bool(positive[row + 1, column + 1])]
    cut = [
        edge
        for edge, changes in ((bottom, p[0] != p[1]), (right, p[1] != q[1]), (top, q[0] != q[1]), (left, p[0] != q[0]))
        if changes
    ]
    if len(cut) == 2:
        return [(cut[0], cut[1])]
    # All four: the sign in the middle says which corners belong together.
    middle = function(0.5 * (h[column] + h[column + 1]), 0.5 * (v[row] + v[row + 1])) >= 0
    if middle == p[0]:
        return [(bottom, right), (top, left)]
    return [(bottom, left), (right, top)]


def _zero_on(
    edge: Edge, function: PlaneFunction, values: FloatArray, h: FloatArray, v: FloatArray
) -> tuple[float, float] | None:
    row, column, along = edge
    start = np.array([h[column], v[row]])
    end = np.array([h[column + 1], v[row]]) if along else np.array([h[column], v[row + 1]])
    ends = values[row, column], values[row, column + 1] if along else values[row + 1, column]
    low, high = 0.0, 1.0
    value = ends[0]
    for _ in range(_HALVINGS):
        part = 0.5 * (low + high)
        if not low < part < high:
            break
        value = function(*(start + part * (end - start)).tolist())
        if not np.isfinite(value):
            return None
        if (value >= 0) == (ends[0] >= 0):
            low = part
        else:
            high = part
    if abs(value) > _STEEP * max(abs(ends[0]), abs(ends[1])):
        return None
    at = start + 0.5 * (low + high) * (end - start)
    return float(at[0]), float(at[1])


def _chains(links: dict[Edge, list[Edge]]) -> list[list[Edge]]:
    """Edges in the order in which a line passes them; open lines first."""
    left = {edge: list(others) for edge, others in links.items()}
    out = []
    for begin in sorted(links, key=lambda edge: (len(links[edge]) != 1, edge)):
        while left[begin]:
            path = [begin]
            while left[path[-1]]:
                here = path[-1]
                there = left[here].pop()
                left[there].remove(here)
                path.append(there)
            out.append(path)
    return out


def _line(path: list[Edge], points: dict[Edge, tuple[float, float] | None]) -> ZeroLine:
    at = np.array([points[edge] for edge in path], dtype=float)
    return ZeroLine(at[:, 0], at[:, 1], path[0] == path[-1])
