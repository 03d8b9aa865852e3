"""Do numerator and denominator share a root? Pole placement needs that they do not, and says which one it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.stability.notions import pole_text
from looplab.engine.systems.polynomial import ComplexArray

# Roots of typed polynomials come back with this relative error, or less unless they are repeated.
SAME = 1e-9


@dataclass(frozen=True)
class SharedRoot:
    """A root of both polynomials: where it is, how far apart the two are relative to their size, and its fate.

    ``stable`` roots may be cancelled; ``in_D`` tells whether the wanted polynomial has it.
    """

    root: complex
    distance: float
    stable: bool
    in_D: bool

    @property
    def text(self) -> str:
        """The root, for a sentence."""
        return pole_text(self.root)


def _nearest(root: complex, others: ComplexArray, least: float) -> float:
    """Relative distance to the nearest of the others; infinite where there are none."""
    if not others.size:
        return np.inf
    return float((np.abs(others - root) / max(abs(root), least)).min())


def shared_roots(
    poles: ComplexArray, zeros: ComplexArray, wanted: ComplexArray, tolerance: float = SAME
) -> tuple[SharedRoot, ...]:
    """Zeros that lie on a pole, one of each conjugate pair.

    Parameters
    ----------
    poles, zeros : ndarray of complex
        Roots of A and of B [rad/time].
    wanted : ndarray of complex
        Roots of D.
    tolerance : float
        Largest distance of two roots that count as one, relative to their size [-].

    Returns
    -------
    tuple of SharedRoot
    """
    sizes = np.abs(np.concatenate([poles, zeros, wanted]))
    least = 1e-6 * float(sizes.max(initial=1.0)) or 1.0
    out = []
    for zero in zeros[zeros.imag >= 0].tolist():
        distance = _nearest(zero, poles, least)
        if distance <= tolerance:
            in_D = _nearest(zero, wanted, least) <= max(tolerance, 1e-6)
            out.append(SharedRoot(zero, distance, zero.real < 0, in_D))
    return tuple(out)


def nearest_pair(poles: ComplexArray, zeros: ComplexArray) -> tuple[complex, complex]:
    """The pole and the zero that lie nearest to each other, relative to their size; both sets are not empty."""
    sizes = np.maximum(np.abs(poles)[:, None], np.abs(zeros))
    apart = np.abs(poles[:, None] - zeros) / np.where(sizes > 0, sizes, 1.0)
    i, j = np.unravel_index(int(np.argmin(apart)), apart.shape)
    return complex(poles[i]), complex(zeros[j])
