"""Which delay of a system lies in a loop, which only delays an input or an output: seen in the zeros of matrices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.delays.system import DelaySystem
from looplab.engine.systems.polynomial import FloatArray

Flags = npt.NDArray[np.bool_]


def reachable(system: DelaySystem) -> Flags:
    """[i, j] True where signal j acts on signal i, at once or in the end; signals are n states, then k delays."""
    reach: Flags = np.asarray(np.block([[system.A, system.B2], [system.C2, system.D22]]) != 0)
    while True:
        # Products of counts, not of flags: numpy has no fast boolean product.
        longer = reach | (reach.astype(float) @ reach.astype(float) > 0)
        if (longer == reach).all():
            return reach
        reach = longer


@dataclass(frozen=True)
class Channels:
    """The delay channels by their part in the system, as lists of indices.

    ``inputs`` carry nothing but steps of the inputs, ``outputs`` act on outputs alone; both in an order in which each
    needs only those before it. ``core`` is the rest.
    """

    inputs: list[int]
    core: list[int]
    outputs: list[int]


def channels(system: DelaySystem) -> Channels:
    """Sort the delay channels of a system."""
    D22 = system.D22 != 0
    from_states, to_states = (system.C2 != 0).any(axis=1), (system.B2 != 0).any(axis=0)
    left = list(range(system.tau.size))
    inputs: list[int] = []
    while more := [i for i in left if not from_states[i] and all(j in inputs for j in np.flatnonzero(D22[i]))]:
        inputs += more
        left = [i for i in left if i not in more]
    outputs: list[int] = []
    while more := [i for i in left if not to_states[i] and all(j in outputs for j in np.flatnonzero(D22[:, i]))]:
        outputs += more
        left = [i for i in left if i not in more]
    return Channels(inputs, left, outputs[::-1])


def in_loops(system: DelaySystem) -> Flags:
    """Whether each delay lies in a loop, shape (k,): only those make infinitely many poles."""
    reach = reachable(system)
    return np.diagonal(reach)[system.order :].copy()


def pruned(system: DelaySystem) -> DelaySystem:
    """The system without states and delays that no input reaches or no output shows, the rest as it was.

    Only what the zeros of the matrices tell: unlike a minimal form it rounds nothing.
    """
    n = system.order
    reach = reachable(system)
    reach[np.diag_indices(n + system.tau.size)] = True
    driven = np.vstack([system.B1, system.D21]).any(axis=1)
    shown = np.hstack([system.C1, system.D12]).any(axis=0)
    alive = np.logical_and(reach[:, driven].any(axis=1), reach[shown].any(axis=0))
    states, delays = np.flatnonzero(alive[:n]), np.flatnonzero(alive[n:])
    rows = np.append(np.arange(system.outputs), system.outputs + delays)
    columns = np.append(np.arange(system.inputs), system.inputs + delays)
    return DelaySystem(
        system.A[np.ix_(states, states)],
        system.B[np.ix_(states, columns)],
        system.C[np.ix_(rows, states)],
        system.D[np.ix_(rows, columns)],
        system.tau[delays],
    )


def channel(system: DelaySystem, inputs: list[int], outputs: list[int]) -> DelaySystem:
    """Some inputs and outputs of a system, without what they do not reach or show."""
    k = system.tau.size
    columns = [*inputs, *range(system.inputs, system.inputs + k)]
    rows = [*outputs, *range(system.outputs, system.outputs + k)]
    return pruned(
        DelaySystem(system.A, system.B[:, columns], system.C[rows], system.D[np.ix_(rows, columns)], system.tau)
    )


def echo(system: DelaySystem) -> tuple[float, float]:
    r"""How much of a jump comes back through delays alone: a bound below and a bound above.

    .. math:: \sup_{|\phi_i| = 1} \rho\left(D_{22}\, \operatorname{diag}(\phi)\right)

    Below 1 the difference equation w = D22 w(t - tau) dies out however the dead times are changed a little (it is
    strongly stable); from 1 on there are infinitely many poles at or right of the imaginary axis.

    Parameters
    ----------
    system : DelaySystem
        Channels of equal dead time share a phase.

    Returns
    -------
    tuple of two floats
        The largest radius found by a search over the phases, and the Perron root of \|D22\|, which it cannot exceed.

    References
    ----------
    .. [1] J. K. Hale, S. M. Verduyn Lunel, Introduction to Functional Differential Equations, Springer 1993, sec. 9.6.
    """
    keep = in_loops(system)
    D, tau = system.D22[np.ix_(keep, keep)], system.tau[keep]
    if not D.any():
        return 0.0, 0.0
    above = _radius(np.abs(D))
    _, group = np.unique(np.round(np.log(tau), 12), return_inverse=True)
    count = int(group.max()) + 1
    below, angles = 0.0, np.linspace(-np.pi, np.pi, 33)
    # One phase may always be zero: turning all together turns the eigenvalues only.
    for start in np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (1 if count == 1 else 8 * count, count)):
        phase = start.copy()
        best = _radius(D * np.exp(1j * phase[group]))
        # Around the circle first, then nearer and nearer to the best angle.
        for closer in range(10 if count > 1 else 0):
            for i in range(1, count):
                tries = np.repeat(phase[None, :], angles.size, axis=0)
                tries[:, i] = phase[i] + angles / 8.0**closer
                sizes = np.abs(np.linalg.eigvals(D * np.exp(1j * tries[:, group])[:, None, :])).max(axis=1)
                phase, best = tries[np.argmax(sizes)], float(sizes.max())
        below = max(below, best)
    return below, above


def _radius(matrix: npt.NDArray) -> float:
    return float(np.abs(np.linalg.eigvals(matrix)).max(initial=0.0))


def step_events(system: DelaySystem, inputs: list[int]) -> dict[int, list[tuple[float, FloatArray]]]:
    """For each channel of ``inputs`` the steps that leave it: (time, size for a unit step of each input, (m,))."""
    out: dict[int, list[tuple[float, FloatArray]]] = {}
    for i in inputs:
        tau = float(system.tau[i])
        found = [(tau, system.D21[i])] if system.D21[i].any() else []
        for j in inputs:
            if system.D22[i, j]:
                found += [(at + tau, size * system.D22[i, j]) for at, size in out[j]]
        out[i] = found
    return out
