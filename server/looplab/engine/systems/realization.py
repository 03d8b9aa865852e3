"""State space of a factored system: a cascade of first- and second-order sections, so that nothing is expanded."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class StateSpace:
    """x' = A x + B u, y = C x + D u for one input and output: A (n,n), B (n,), C (n,), D scalar; read-only arrays."""

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: float


def _sections(system: TransferFunction) -> list[tuple[ComplexArray, ComplexArray]]:
    """Pair zeros with nearby poles: (poles, zeros) of each section, at most two of each, never more zeros."""
    poles, zeros = list(system.poles), list(system.zeros)
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
    return [(np.array(g), np.array(t, dtype=complex)) for g, t in zip(groups, taken, strict=True)]


def _first_order(pole: float, zeros: ComplexArray) -> tuple[FloatArray, FloatArray, FloatArray, float]:
    b = abs(pole) or 1.0
    if zeros.size:
        return np.array([[pole]]), np.array([b]), np.array([(pole - zeros[0].real) / b]), 1.0
    return np.array([[pole]]), np.array([b]), np.array([1.0 / b]), 0.0


def _second_order(poles: ComplexArray, zeros: ComplexArray) -> tuple[FloatArray, FloatArray, FloatArray, float]:
    total, product = (poles[0] + poles[1]).real, (poles[0] * poles[1]).real
    w = np.sqrt(abs(product)) or np.max(np.abs(poles)) or 1.0
    a = np.array([[0.0, w], [-product / w, total]])
    b = np.array([0.0, w])
    if zeros.size == 2:
        n1, n0 = -(zeros[0] + zeros[1]).real, (zeros[0] * zeros[1]).real
        return a, b, np.array([(n0 - product) / w**2, (n1 + total) / w]), 1.0
    if zeros.size == 1:
        return a, b, np.array([-zeros[0].real / w**2, 1.0 / w]), 0.0
    return a, b, np.array([1.0 / w**2, 0.0]), 0.0


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
    A, B = np.zeros((n, n)), np.zeros(n)
    at, d_chain, c_chain = 0, 1.0, np.zeros(n)
    for poles, zeros in _sections(system) if n else ():
        a, b, c, d = _first_order(poles[0].real, zeros) if poles.size == 1 else _second_order(poles, zeros)
        stop = at + poles.size
        # Input of this section: output of the chain so far, c_chain x + d_chain u.
        A[at:stop, :] += b[:, None] * c_chain
        A[at:stop, at:stop] += a
        B[at:stop] = b * d_chain
        c_chain = d * c_chain
        c_chain[at:stop] += c
        d_chain = d * d_chain
        at = stop
    C = system.gain * c_chain
    for array in (A, B, C):
        array.setflags(write=False)
    return StateSpace(A, B, C, float(system.gain * d_chain))
