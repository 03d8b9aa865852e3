"""State space of a factored system: a cascade of first- and second-order sections, so that nothing is expanded."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import sqrt
from typing import NamedTuple

import numpy as np

from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class StateSpace:
    """x' = A x + B u, y = C x + D u for one input and output: A (n,n), B (n,), C (n,), D scalar; read-only arrays."""

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: float


class _Section(NamedTuple):
    """x' = a x + b u, y = c x + d u of one or two poles, as plain numbers."""

    a: list[list[float]]
    b: list[float]
    c: list[float]
    d: float


def _pairing(system: TransferFunction) -> list[tuple[list[complex], list[complex]]]:
    """Pair zeros with nearby poles: (poles, zeros) of each section, at most two of each, never more zeros."""
    poles, zeros = system.poles.tolist(), system.zeros.tolist()
    groups: list[list[complex]] = [[p, p.conjugate()] for p in poles if p.imag > 0]
    singles = sorted((p for p in poles if p.imag == 0), key=lambda p: p.real)
    pairs = [z for z in zeros if z.imag > 0]
    # A complex pair of zeros needs two poles under it: join real poles where complex ones are too few.
    while len(groups) < len(pairs):
        groups.append([singles.pop(0), singles.pop(0)])
    groups += [[p] for p in singles]
    taken: list[list[complex]] = [[] for _ in groups]

    def nearest(z: complex, need: int) -> int:
        free = [i for i, g in enumerate(groups) if len(g) - len(taken[i]) >= need and (need == 1 or len(g) == 2)]
        return min(free, key=lambda i: min(abs(z - p) for p in groups[i]))

    for z in pairs:
        taken[nearest(z, 2)] += [z, z.conjugate()]
    for z in sorted((z for z in zeros if z.imag == 0), key=lambda z: z.real):
        taken[nearest(z, 1)].append(z)
    return list(zip(groups, taken, strict=True))


def _first_order(pole: float, zeros: list[complex]) -> _Section:
    b = abs(pole) or 1.0
    if zeros:
        return _Section([[pole]], [b], [(pole - zeros[0].real) / b], 1.0)
    return _Section([[pole]], [b], [1.0 / b], 0.0)


def _second_order(poles: list[complex], zeros: list[complex]) -> _Section:
    total, product = (poles[0] + poles[1]).real, (poles[0] * poles[1]).real
    w = sqrt(abs(product)) or max(map(abs, poles)) or 1.0
    a, b = [[0.0, w], [-product / w, total]], [0.0, w]
    if len(zeros) == 2:
        n1, n0 = -(zeros[0] + zeros[1]).real, (zeros[0] * zeros[1]).real
        return _Section(a, b, [(n0 - product) / w**2, (n1 + total) / w], 1.0)
    if len(zeros) == 1:
        return _Section(a, b, [-zeros[0].real / w**2, 1.0 / w], 0.0)
    return _Section(a, b, [1.0 / w**2, 0.0], 0.0)


def realize(system: TransferFunction) -> StateSpace:
    """State space of the rational part (the dead time is left to the caller).

    Parameters
    ----------
    system : TransferFunction
        Proper; hidden modes (cancelling poles and zeros) are kept as states.

    Returns
    -------
    StateSpace
        n = number of poles; each section's states are scaled by its natural frequency. The gain is in C and D alone.

    Raises
    ------
    ImproperSystem
        More zeros than poles.
    """
    system.require_proper()
    if not system.gain:
        return StateSpace(np.zeros((0, 0)), np.zeros(0), np.zeros(0), 0.0)
    unit, size = _realize_unit(system.unit), abs(system.gain)
    C = unit.C * size
    C.setflags(write=False)
    return StateSpace(unit.A, unit.B, C, unit.D * size)


@lru_cache(maxsize=128)
def _realize_unit(system: TransferFunction) -> StateSpace:
    n = system.order
    # Plain numbers: the arrays would be small and many.
    rows: list[list[float]] = []
    B: list[float] = []
    chain, through = [0.0] * n, 1.0
    for poles, zeros in _pairing(system) if n else ():
        section = _first_order(poles[0].real, zeros) if len(poles) == 1 else _second_order(poles, zeros)
        at = len(rows)
        for own, b in zip(section.a, section.b, strict=True):
            # Input of this section: output of the chain so far, chain x + through u.
            row = [b * c for c in chain]
            for j, value in enumerate(own, at):
                row[j] += value
            rows.append(row)
            B.append(b * through)
        chain = [section.d * c for c in chain]
        for j, c in enumerate(section.c, at):
            chain[j] += c
        through *= section.d
    arrays = np.array(rows).reshape(n, n), np.array(B), system.gain * np.array(chain)
    for array in arrays:
        array.setflags(write=False)
    return StateSpace(*arrays, float(system.gain * through))
