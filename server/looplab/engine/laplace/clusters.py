"""Poles that are one pole to working precision: how they are grouped, by growing tolerances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.systems.polynomial import ComplexArray

# Relative distances at which neighbouring poles are joined, finest first.
LEVELS = (0.0, 1e-14, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 3e-2, 1e-1)
# A real part this much smaller than the pole is rounding: the pole lies on the axis.
ON_AXIS = 1e-13


@dataclass(frozen=True)
class Partition:
    """Groups of poles, each taken as one repeated pole.

    Attributes
    ----------
    tolerance : float
        Relative distance up to which neighbours were joined [-].
    centres : tuple of complex
        The repeated poles, closed under conjugation [rad/time].
    members : tuple of tuple of int
        Which of the given poles each centre stands for.
    moved : float
        The largest relative distance between a pole and its centre [-].
    """

    tolerance: float
    centres: tuple[complex, ...]
    members: tuple[tuple[int, ...], ...]
    moved: float


def _components(near: np.ndarray) -> list[tuple[int, ...]]:
    """Connected components of a symmetric relation, in the order of their first member."""
    left = set(range(near.shape[0]))
    groups = []
    for start in range(near.shape[0]):
        if start not in left:
            continue
        group, border = {start}, [start]
        while border:
            reached = set(np.flatnonzero(near[border.pop()]).tolist()) - group
            group |= reached
            border += sorted(reached)
        left -= group
        groups.append(tuple(sorted(group)))
    return groups


def _centre(poles: ComplexArray) -> complex:
    """Mean of a group; equal poles keep their digits, a self-conjugate group is real."""
    mean = complex(poles[0]) if (poles == poles[0]).all() else complex(poles.mean())
    if (poles.imag > 0).any() and (poles.imag < 0).any():
        mean = complex(mean.real, 0.0)
    if abs(mean.real) <= ON_AXIS * abs(mean):
        mean = complex(0.0, mean.imag)
    return mean


def partitions(poles: ComplexArray) -> list[Partition]:
    """The different ways to group poles, finest first.

    Single linkage in relative distance. A pole at the origin is joined only to others at the origin, so that the
    number of integrators never changes.

    Parameters
    ----------
    poles : ndarray, shape (n,)
        Closed under conjugation [rad/time].

    Returns
    -------
    list of Partition
        At least one.
    """
    size = np.abs(poles)
    scale = np.maximum.outer(size, size)
    distance = np.abs(poles[:, None] - poles[None, :]) / np.where(scale > 0, scale, 1.0)
    found: list[Partition] = []
    for level in LEVELS:
        groups = _components(distance <= level)
        if found and len(groups) == len(found[-1].members):
            continue
        centres = tuple(_centre(poles[list(group)]) for group in groups)
        moved = max(
            (float(np.abs(poles[list(g)] - c).max()) / (abs(c) or 1.0) for g, c in zip(groups, centres, strict=True)),
            default=0.0,
        )
        found.append(Partition(level, centres, tuple(groups), moved))
    return found
