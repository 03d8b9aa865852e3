"""The process of several loops: a square matrix of transfer functions, each entry with a dead time of its own."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from looplab.engine.delays import DelaySystem, append, connect
from looplab.engine.errors import InvalidInput
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

SMALLEST_SIZE, LARGEST_SIZE = 2, 5
# Time constants after which a response is at rest, to a third of a thousandth.
SETTLED = 8.0


@dataclass(frozen=True)
class ProcessMatrix:
    r"""y(s) = G(s) u(s) with as many inputs as outputs, two to five.

    Attributes
    ----------
    entries : tuple of tuple of TransferFunction
        ``entries[i][j]`` is what input j does to output i; proper.

    Raises
    ------
    InvalidInput
        It is not square, or too small or large.
    ImproperSystem
        An entry differentiates.
    """

    entries: tuple[tuple[TransferFunction, ...], ...]

    def __post_init__(self) -> None:
        n = len(self.entries)
        if not SMALLEST_SIZE <= n <= LARGEST_SIZE:
            raise InvalidInput(
                f"the matrix has {n} rows: from {SMALLEST_SIZE} to {LARGEST_SIZE} are possible", field="entries"
            )
        for i, row in enumerate(self.entries):
            if len(row) != n:
                raise InvalidInput(
                    f"row {i + 1} has {len(row)} entries: {n} outputs need as many inputs", field=f"entries[{i}]"
                )
            for j, entry in enumerate(row):
                entry.require_proper(f"entries[{i}][{j}]")

    @property
    def size(self) -> int:
        """Number of inputs, and of outputs."""
        return len(self.entries)

    @cached_property
    def all_stable(self) -> bool:
        """Whether every entry comes to rest after a step: all poles left of the imaginary axis."""
        return all(entry.poles.real.max(initial=-1.0) < 0 for row in self.entries for entry in row if entry.gain)

    @cached_property
    def integrates(self) -> bool:
        """Whether an entry has an integrator, and with it no gain at rest."""
        return any(entry.gain and entry.origin_order > 0 for row in self.entries for entry in row)

    def gains(self) -> FloatArray:
        """G(0), shape (n, n).

        Raises
        ------
        InvalidInput
            An entry integrates.
        """
        if self.integrates:
            raise InvalidInput("an entry integrates, so that the matrix has no gains at rest", field="plant")
        return np.array([[entry.dc_gain for entry in row] for row in self.entries])

    def response(self, omega: FloatArray) -> ComplexArray:
        """G(j omega), shape (N, n, n), dead times exact; omega in rad/time."""
        rows = [np.stack([entry.response(omega) for entry in row], axis=-1) for row in self.entries]
        return np.stack(rows, axis=1)

    def paired(self, pairing: tuple[int, ...]) -> ProcessMatrix:
        """The same with its inputs in the order of the outputs they control, so that loops lie on the diagonal."""
        return ProcessMatrix(tuple(tuple(row[j] for j in pairing) for row in self.entries))

    @cached_property
    def system(self) -> DelaySystem:
        """Every entry a path of its own with its dead time, from u to y."""
        n = self.size
        used = [(i, j) for i in range(n) for j in range(n) if self.entries[i][j].gain]
        if not used:
            return DelaySystem.static(np.zeros((n, n)))
        inner = append(*(_path(self.entries[i][j]) for i, j in used))
        E, H = np.zeros((len(used), n)), np.zeros((n, len(used)))
        for at, (i, j) in enumerate(used):
            E[at, j] = H[i, at] = 1.0
        return connect(inner, np.zeros((len(used), len(used))), E, H)

    def horizon(self) -> float:
        """A time in which the process settles, of two digits [time]."""
        slowest = [
            entry.theta + SETTLED * max((1.0 / abs(p) for p in entry.poles.tolist() if p), default=0.0)
            for row in self.entries
            for entry in row
        ]
        longest = max(slowest)
        return float(f"{longest:.1e}") if longest > 0 else 10.0

    def frequency_range(self) -> tuple[float, float]:
        """Where what happens can be seen: around all corners, and not far into the dead times [rad/time]."""
        marks = [abs(root) for row in self.entries for entry in row for root in (*entry.zeros, *entry.poles) if root]
        late = [2.0 / entry.theta for row in self.entries for entry in row if entry.theta]
        if not marks:
            return (0.01 * min(late), max(late)) if late else (0.01, 100.0)
        return 0.1 * min(marks), max([10.0 * max(marks), *late])


def _path(entry: TransferFunction) -> DelaySystem:
    """One entry with its dead time before its states: integrators of one row are then seen to be one and the same."""
    return DelaySystem.from_state_space(StateSpaceModel.from_channel(realize(entry)), entry.theta)


def check_pairing(pairing: tuple[int, ...], size: int) -> tuple[int, ...]:
    """The pairing, or InvalidInput where it is no order of all inputs; ``pairing[i]`` is the input of output i."""
    if sorted(pairing) != list(range(size)):
        raise InvalidInput(
            f"a pairing names each of the {size} inputs once",
            field="pairing",
            hint=f"for example {[j + 1 for j in range(size)]}: input 1 for output 1, and so on",
        )
    return pairing
