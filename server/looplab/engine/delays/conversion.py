"""A delayed system as one transfer function with a dead time, where it is one; and without what does not show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.delays.structure import in_loops, reachable
from looplab.engine.delays.system import DelaySystem
from looplab.engine.errors import InvalidInput
from looplab.engine.state_space import RemovedMode, StateSpaceModel, to_transfer_function
from looplab.engine.state_space.minimal_realization import TOLERANCE, remove_hidden_modes
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

MAX_ROUTES = 64


def _rational(system: DelaySystem, b: FloatArray, c: FloatArray, d: float) -> TransferFunction | None:
    """c (s I - A)^-1 b + d with the states that lie between b and c; None where nothing passes."""
    edge = np.linalg.matrix_power(np.eye(system.order) + (system.A != 0), max(system.order, 1)) > 0
    reached, seen = (edge & (b != 0)).any(axis=1), (edge & (c != 0)[:, None]).any(axis=0)
    keep = reached & seen
    if not keep.any():
        return TransferFunction((), (), d) if d else None
    part = StateSpaceModel(system.A[np.ix_(keep, keep)], b[keep, None], c[None, keep], [[d]])
    found = to_transfer_function(part)
    return found if found.gain else None


def _routes(system: DelaySystem, c: FloatArray, d: float, e: FloatArray) -> list[TransferFunction]:
    """The ways from the input to c x + d u + e w, each with its rational parts and its dead times."""
    direct = _rational(system, system.B1[:, 0], c, d)
    out = [] if direct is None else [direct]
    for i in range(system.tau.size):
        last = _rational(system, system.B2[:, i], c, float(e[i]))
        if last is not None:
            late = TransferFunction((), (), 1.0, float(system.tau[i]))
            before = _routes(system, system.C2[i], float(system.D21[i, 0]), system.D22[i])
            out += [late * last * first for first in before]
        if len(out) > MAX_ROUTES:
            raise InvalidInput("there are too many ways through the dead times", field="system")
    return out


def single_transfer_function(system: DelaySystem) -> TransferFunction:
    """The system as zeros, poles, gain and one dead time.

    Parameters
    ----------
    system : DelaySystem
        One input and one output.

    Returns
    -------
    TransferFunction
        Poles are eigenvalues: of equal ones the digits beyond eps^(1/m) are lost.

    Raises
    ------
    InvalidInput
        It is no such system: a dead time lies in a loop, or there are several ways with and without dead times.
    """
    system = system.require_single()
    if in_loops(system).any():
        raise InvalidInput(
            "a dead time lies in a loop inside the system: it is no single transfer function with a dead time",
            field="system",
        )
    routes = _routes(system, system.C1[0], float(system.D11[0, 0]), system.D12[0])
    if len(routes) > 1:
        raise InvalidInput(
            f"the system is a sum of {len(routes)} terms with dead times of their own, no single transfer function",
            field="system",
        )
    return routes[0] if routes else TransferFunction((), (), 0.0)


@dataclass(frozen=True)
class MinimalDelaySystem:
    """A system without what cannot be moved or seen from outside, and what was taken out at which tolerance.

    ``removed_delays`` are the dead times of channels that no input reaches or no output shows [time]. ``smallest_kept``
    and ``largest_removed`` are the singular values on either side of the tolerance, None where there are none.
    """

    system: DelaySystem
    removed: tuple[RemovedMode, ...]
    removed_delays: tuple[float, ...]
    tolerance: float
    smallest_kept: float | None
    largest_removed: float | None


def minimal_delay_system(system: DelaySystem, tolerance: float = TOLERANCE) -> MinimalDelaySystem:
    """The system without hidden modes of its rational part and without idle delays; its response is the same.

    Parameters
    ----------
    system : DelaySystem
    tolerance : float
        Relative size below which a singular value counts as zero, 1e-15 to 1e-2.

    Returns
    -------
    MinimalDelaySystem
        The delayed signals count as inputs and outputs of the rational part: what hides only because two delays are
        equal (a Smith predictor with the exact model) stays.

    Raises
    ------
    InvalidInput
        The tolerance is out of range.
    """
    n, k = system.order, system.tau.size
    reach = reachable(system)
    reach[np.diag_indices(n + k)] = True
    driven = np.vstack([system.B1, system.D21]).any(axis=1)
    shown = np.hstack([system.C1, system.D12]).any(axis=0)
    alive = np.array([(reach[n + i] & driven).any() and (reach[:, n + i] & shown).any() for i in range(k)], dtype=bool)
    rows = np.append(np.arange(system.outputs), system.outputs + np.flatnonzero(alive))
    columns = np.append(np.arange(system.inputs), system.inputs + np.flatnonzero(alive))
    found = remove_hidden_modes(system.A, system.B[:, columns], system.C[rows], tolerance)
    return MinimalDelaySystem(
        DelaySystem(found.A, found.B, found.C, system.D[np.ix_(rows, columns)], system.tau[alive]),
        found.removed,
        tuple(float(t) for t in system.tau[~alive]),
        tolerance,
        found.smallest_kept,
        found.largest_removed,
    )
