"""The rightmost poles of a delayed system: its delay lines collocated, each candidate polished on det H(s) = 0."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from looplab.engine.delays.resolvent import characteristic_matrix, characteristic_slope
from looplab.engine.delays.structure import in_loops
from looplab.engine.delays.system import DelaySystem
from looplab.engine.stability.delay_line import chebyshev_differentiation
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

MOST = 24
NEWTON_STEPS = 12
# Unknowns of the collocated delay lines.
LARGEST_MATRIX = 400


@dataclass(frozen=True)
class DelayPoles:
    """Poles, rightmost first [rad/time]; not ``complete`` where a dead time in a loop makes them infinitely many."""

    poles: ComplexArray
    complete: bool
    reason: str | None = None


def _line_matrix(system: DelaySystem, nodes: int) -> FloatArray:
    """State matrix with each delay as a wave at Chebyshev points: dv/dt = -dv/dx / tau, v(0) = z, v(1) = w."""
    n, k = system.order, system.tau.size
    M = np.zeros((n + k * nodes, n + k * nodes))
    ends = n + nodes * np.arange(1, k + 1) - 1
    M[:n, :n] = system.A
    M[:n, ends] = system.B2
    for i in range(k):
        D = chebyshev_differentiation(nodes) / system.tau[i]
        rows = slice(n + i * nodes, n + (i + 1) * nodes)
        M[rows, rows] -= D[1:, 1:]
        M[rows, :n] -= np.outer(D[1:, 0], system.C2[i])
        M[rows, ends] -= np.outer(D[1:, 0], system.D22[i])
    return M


def newton(system: DelaySystem, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Candidates moved onto det H(s) = 0, and their last steps."""
    step = np.zeros_like(s)
    with np.errstate(all="ignore"):
        for _ in range(NEWTON_STEPS):
            H = characteristic_matrix(system, s)
            whole = np.flatnonzero(np.isfinite(H).all(axis=(1, 2)))
            whole = whole[np.linalg.slogdet(H[whole])[0] != 0]
            step = np.zeros_like(s)
            inner = np.linalg.solve(H[whole], characteristic_slope(system, s[whole]))
            step[whole] = 1.0 / np.trace(inner, axis1=1, axis2=2)
            s = s - np.where(np.isfinite(step), step, 0.0)
    return s, step


@lru_cache(maxsize=64)
def rightmost_poles(system: DelaySystem) -> DelayPoles:
    """Poles of a system, hidden modes included.

    Parameters
    ----------
    system : DelaySystem

    Returns
    -------
    DelayPoles
        Without a dead time in a loop all of them, from the state matrix; else the 24 rightmost that were found, each
        exact to rounding. Whether one was missed in the right half-plane is what ``delay_verdict`` counts.

    References
    ----------
    .. [1] D. Breda, S. Maset, R. Vermiglio, SIAM J. Sci. Comput. 27 (2005) 482-495 (pseudospectral collocation).
    """
    system = system.balanced
    looped = in_loops(system)
    if not looped.any():
        poles = eigenvalues(system.A)
        return DelayPoles(poles[np.argsort(-poles.real)], True)
    # Delays outside every loop move no pole.
    kept = DelaySystem(
        system.A,
        np.hstack([system.B1, system.B2[:, looped]]),
        np.vstack([system.C1, system.C2[looped]]),
        np.block([[system.D11, system.D12[:, looped]], [system.D21[looped], system.D22[np.ix_(looped, looped)]]]),
        system.tau[looped],
    )
    nodes = int(np.clip(LARGEST_MATRIX // kept.tau.size, 12, 60))
    guess = np.linalg.eigvals(_line_matrix(kept, nodes)).astype(complex)
    # Beyond about half a wave per node of the longest line the eigenvalues are those of the grid.
    guess = guess[(guess.imag >= -1e-9 * np.abs(guess)) & (np.abs(guess) * kept.tau.max() < 1.5 * nodes)]
    guess = np.concatenate([guess, np.linalg.eigvals(kept.A).astype(complex)])
    guess = guess[np.argsort(-guess.real)][: 4 * MOST]
    poles, step = newton(kept, guess)
    good = np.isfinite(poles) & (np.abs(step) <= 1e-7 * np.maximum(np.abs(poles), 1e-9 / kept.tau.max()))
    distinct: list[complex] = []
    for p in poles[good & (poles.imag >= -1e-9 * np.abs(poles))].tolist():
        if abs(p.imag) <= 1e-9 * abs(p):
            p = complex(p.real)
        if all(abs(p - q) > 1e-7 * max(abs(p), 1e-12) for q in distinct):
            distinct.append(p)
    whole = [q for p in sorted(distinct, key=lambda p: -p.real) for q in ([p, p.conjugate()] if p.imag else [p])]
    reason = "a dead time in a loop makes infinitely many poles; the rightmost that were found are listed"
    return DelayPoles(np.array(whole[:MOST], dtype=complex), False, reason)
