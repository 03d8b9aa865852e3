"""Connections of delayed systems. All of them are one: put the systems side by side, and wire outputs to inputs."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import block_diag

from looplab.engine.delays.system import DelaySystem
from looplab.engine.errors import IllPosedLoop, InvalidInput
from looplab.engine.systems.polynomial import FloatArray

# Condition number of I - D11 F beyond which an algebraic loop has no solution worth the name.
SINGULAR = 1e12


def append(*systems: DelaySystem) -> DelaySystem:
    """Systems side by side: inputs, outputs and dead times in the order given."""
    if not systems:
        raise InvalidInput("there is no system to put side by side", field="systems")

    def blocks(name: str) -> FloatArray:
        return np.asarray(block_diag(*(getattr(system, name) for system in systems)))

    return DelaySystem(
        blocks("A"),
        np.hstack([blocks("B1"), blocks("B2")]),
        np.vstack([blocks("C1"), blocks("C2")]),
        np.block([[blocks("D11"), blocks("D12")], [blocks("D21"), blocks("D22")]]),
        np.concatenate([system.tau for system in systems]),
    )


def connect(
    system: DelaySystem, F: npt.ArrayLike, E: npt.ArrayLike, H: npt.ArrayLike, J: npt.ArrayLike | None = None
) -> DelaySystem:
    r"""Wire the outputs of a system to its own inputs.

    .. math:: u = F y + E v, \qquad q = H y + J v

    Parameters
    ----------
    system : DelaySystem
        With inputs u, shape (m,), and outputs y, shape (p,).
    F : array_like, shape (m, p)
        Which output feeds which input.
    E : array_like, shape (m, r)
        How the new inputs v enter.
    H : array_like, shape (q, p)
        The new outputs.
    J : array_like, shape (q, r), or None
        New inputs straight to new outputs; None is nothing.

    Returns
    -------
    DelaySystem
        From v to q. Its delays are those of ``system``.

    Raises
    ------
    IllPosedLoop
        I - D11 F is singular: the algebraic loop has no solution. What passes a delay first makes no algebraic loop.

    References
    ----------
    .. [1] K. Zhou, J. C. Doyle, K. Glover, Robust and Optimal Control, Prentice Hall 1996, ch. 10 (linear fractional
       transformations).
    """
    F, E, H = (np.atleast_2d(np.asarray(M, dtype=float)) for M in (F, E, H))
    D11 = system.D11
    loop = np.eye(system.outputs) - D11 @ F
    if np.linalg.cond(loop) > SINGULAR:
        raise IllPosedLoop(
            "the connection has no solution: an algebraic loop (no lag, no dead time) has gain one",
            field="systems",
            hint="change the gain a little, or give one of the systems in the loop a lag",
        )
    # y = Y_x x + Y_v v + Y_w w once the algebraic loop is solved.
    Y_x, Y_v, Y_w = (np.linalg.solve(loop, M) for M in (system.C1, D11 @ E, system.D12))
    into_x, into_z = system.B1 @ F, system.D21 @ F
    straight = np.zeros((H.shape[0], E.shape[1])) if J is None else np.atleast_2d(np.asarray(J, dtype=float))
    return DelaySystem(
        system.A + into_x @ Y_x,
        np.hstack([system.B1 @ E + into_x @ Y_v, system.B2 + into_x @ Y_w]),
        np.vstack([H @ Y_x, system.C2 + into_z @ Y_x]),
        np.block([[H @ Y_v + straight, H @ Y_w], [system.D21 @ E + into_z @ Y_v, system.D22 + into_z @ Y_w]]),
        system.tau,
    )


def _shapes(first: DelaySystem, second: DelaySystem, fits: bool, how: str) -> None:
    if not fits:
        sizes = " and ".join(f"{s.inputs} to {s.outputs}" for s in (first, second))
        raise InvalidInput(f"systems of {sizes} channels cannot be connected in {how}", field="systems")


def series(first: DelaySystem, second: DelaySystem) -> DelaySystem:
    """The output of ``first`` is the input of ``second``."""
    _shapes(first, second, first.outputs == second.inputs, "series")
    m, p, q = first.inputs, first.outputs, second.outputs
    F = np.block([[np.zeros((m, p + q))], [np.eye(p), np.zeros((p, q))]])
    E = np.vstack([np.eye(m), np.zeros((p, m))])
    return connect(append(first, second), F, E, np.hstack([np.zeros((q, p)), np.eye(q)]))


def parallel(first: DelaySystem, second: DelaySystem, sign: float = 1.0) -> DelaySystem:
    """One input for both; ``sign`` times the second output is added to the first."""
    fits = first.inputs == second.inputs and first.outputs == second.outputs
    _shapes(first, second, fits, "parallel")
    m, p = first.inputs, first.outputs
    E = np.vstack([np.eye(m), np.eye(m)])
    return connect(append(first, second), np.zeros((2 * m, 2 * p)), E, np.hstack([np.eye(p), sign * np.eye(p)]))


def feedback(forward: DelaySystem, backward: DelaySystem | None = None, sign: float = -1.0) -> DelaySystem:
    r"""Close a loop around ``forward``.

    .. math:: y = G\,(r \pm H y), \qquad y = (I \mp G H)^{-1} G\, r

    Parameters
    ----------
    forward : DelaySystem
        G.
    backward : DelaySystem or None
        H; None is 1.
    sign : {-1, 1}
        Of what comes back.

    Returns
    -------
    DelaySystem
        From r to y, every mode of both kept.

    Raises
    ------
    IllPosedLoop, InvalidInput

    References
    ----------
    .. [1] K. Zhou, J. C. Doyle, K. Glover, Robust and Optimal Control, Prentice Hall 1996, sec. 5.2 (well-posedness).
    """
    m, p = forward.inputs, forward.outputs
    if backward is None:
        _shapes(forward, forward, m == p, "unit feedback")
        return connect(forward, sign * np.eye(m), np.eye(m), np.eye(p))
    _shapes(forward, backward, (backward.inputs, backward.outputs) == (p, m), "feedback")
    F = np.block([[np.zeros((m, p)), sign * np.eye(m)], [np.eye(p), np.zeros((p, m))]])
    E = np.vstack([np.eye(m), np.zeros((p, m))])
    return connect(append(forward, backward), F, E, np.hstack([np.eye(p), np.zeros((p, m))]))


def summing(signs: npt.ArrayLike) -> DelaySystem:
    """A summing junction: y = sum of signs_i u_i."""
    return DelaySystem.static(np.atleast_1d(np.asarray(signs, dtype=float))[None, :])
