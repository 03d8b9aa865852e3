"""Responses of several loops to steps of setpoints, loads and manual outputs, exact with every dead time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from looplab.engine.delays.lattice import Lattice
from looplab.engine.delays.steps import Steps
from looplab.engine.delays.structure import channel
from looplab.engine.errors import InvalidInput
from looplab.engine.loop.step_response import LARGEST_VALUE
from looplab.engine.mimo.loops import MultiLoop
from looplab.engine.systems.polynomial import FloatArray

KINDS = ("setpoint", "load", "manual")


@dataclass(frozen=True)
class Change:
    """A step: ``kind`` "setpoint" of output ``index``, "load" on input ``index``, or "manual": the output of the
    controller of ``index`` is moved. ``size`` in the unit of what it moves, ``start`` >= 0 [time]."""

    kind: str
    index: int
    size: float
    start: float = 0.0


@dataclass(frozen=True)
class MultiLoopResponse:
    """t, shape (N,), outputs y and inputs u (before the load), shape (N, n) each; cut where one runs away."""

    t: FloatArray
    y: FloatArray
    u: FloatArray
    truncated_at: float | None
    truncated_reason: str | None


def _columns(loops: MultiLoop, changes: Sequence[Change]) -> list[int]:
    n = loops.process.size
    columns = []
    for at, change in enumerate(changes):
        if not 0 <= change.index < n:
            raise InvalidInput(f"there is no loop {change.index + 1}", field=f"changes[{at}]", hint=f"1 to {n}")
        if change.kind == "setpoint" and not loops.closed[change.index]:
            raise InvalidInput(
                f"loop {change.index + 1} is in manual: its setpoint moves nothing",
                field=f"changes[{at}].kind",
                hint="step its manual output, or close the loop",
            )
        columns.append(KINDS.index(change.kind) * n + change.index)
    return columns


def simulate_loops(loops: MultiLoop, changes: Sequence[Change], horizon: float, points: int = 500) -> MultiLoopResponse:
    r"""Outputs and inputs from rest after steps at any times.

    .. math:: y = G\,(u + d), \qquad u = D\,c, \qquad c_i = C_i (r_i - y_i) + v_i

    Parameters
    ----------
    loops : MultiLoop
    changes : sequence of Change
        Added up.
    horizon : float
        > 0 [time].
    points : int
        Samples, evenly from 0 to the horizon.

    Returns
    -------
    MultiLoopResponse
        By the method of steps, to rounding: on windows where the dead times have a common divisor, else from breakpoint
        to breakpoint.

    Raises
    ------
    InvalidInput
        A change names no loop, or the setpoint of a loop in manual.
    IllPosedLoop
        The loops have no solution.
    NoConvergence
        The shortest dead time or lag is too short for so long a horizon.

    References
    ----------
    .. [1] A. Bellen, M. Zennaro, Numerical Methods for Delay Differential Equations, Oxford 2003, ch. 3.
    """
    n = loops.process.size
    t = np.linspace(0.0, horizon, points)
    columns = _columns(loops, changes)
    total = np.zeros((points, 2 * n))
    used = sorted(set(columns))
    if used:
        system = channel(loops.system, used, list(range(2 * n)))
        solved = Lattice.of(system, horizon) or Steps(system, horizon)
        with np.errstate(over="ignore", invalid="ignore"):
            for change, column in zip(changes, columns, strict=True):
                late = t - change.start
                # Right-hand limits: a step shows from the sample it falls on.
                late[np.abs(late) < 1e-12 * horizon] = 0.0
                runs = (late >= 0) & (late <= solved.end)
                found = solved.outputs(late[runs])
                y = found[0] if isinstance(found, tuple) else found
                total[runs] += change.size * y[:, :, used.index(column)]
                total[late > solved.end] = np.inf
    bad = ~(np.abs(total) < LARGEST_VALUE).all(axis=1)
    stop = int(np.argmax(bad)) if bad.any() else points
    cut = stop < points
    return MultiLoopResponse(
        t[:stop],
        total[:stop, :n],
        total[:stop, n:],
        float(t[stop]) if cut else None,
        f"the response grows beyond {LARGEST_VALUE:g}: the loops are unstable" if cut else None,
    )
