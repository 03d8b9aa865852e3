"""Several PID loops on one process: any pairing, each loop automatic or in manual, a decoupler in between."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from looplab.engine.delays import DelaySystem, append, connect, delay_verdict, minimal_delay_system
from looplab.engine.delays.structure import channel
from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID
from looplab.engine.mimo.process import ProcessMatrix, check_pairing
from looplab.engine.stability.closed_loop import Verdict
from looplab.engine.systems.transfer_function import TransferFunction

Decoupling = tuple[tuple[TransferFunction, ...], ...]


@dataclass(frozen=True)
class MultiLoop:
    r"""y = G (u + d), u = D c in the order of the pairing, c_i = C_i (r_i - y_i) + v_i where loop i is closed.

    Attributes
    ----------
    process : ProcessMatrix
    pairing : tuple of int
        ``pairing[i]`` is the input that controls output i.
    controllers : tuple of PID
        One for each output.
    closed : tuple of bool
        Which loops are automatic; in manual c_i = v_i.
    decoupler : tuple of tuple of TransferFunction, or None
        ``decoupler[i][k]``: from the controller of output k to the input of output i; None is the unit matrix.

    Raises
    ------
    InvalidInput
        The parts do not fit each other.
    """

    process: ProcessMatrix
    pairing: tuple[int, ...]
    controllers: tuple[PID, ...]
    closed: tuple[bool, ...]
    decoupler: Decoupling | None = None

    def __post_init__(self) -> None:
        n = self.process.size
        check_pairing(self.pairing, n)
        if len(self.controllers) != n or len(self.closed) != n:
            raise InvalidInput(f"{n} outputs need {n} loops", field="loops")

    def with_loop(self, loop: int, closed: bool) -> MultiLoop:
        """The same with one loop closed or opened."""
        return replace(self, closed=(*self.closed[:loop], closed, *self.closed[loop + 1 :]))

    def with_others(self, loop: int, closed: bool) -> MultiLoop:
        """The same with all loops but one closed or opened."""
        return replace(self, closed=tuple(own if i == loop else closed for i, own in enumerate(self.closed)))

    @cached_property
    def system(self) -> DelaySystem:
        """From (r, d, v), n each, to (y, u): d by inputs of the process, all else by outputs; u before the load.

        Raises
        ------
        IllPosedLoop
        """
        n = self.process.size
        parts = [self.process.system]
        controllers = [DelaySystem.from_transfer_function(C.to_transfer_function()) for C in self.controllers]
        crossing = self.decoupler or tuple(
            tuple(TransferFunction((), (), float(i == k)) for k in range(n)) for i in range(n)
        )
        used = [(i, k) for i in range(n) for k in range(n) if crossing[i][k].gain]
        paths = [DelaySystem.from_transfer_function(crossing[i][k]) for i, k in used]
        inner = append(*parts, *controllers, *paths)
        size = 2 * n + len(used)
        F, E = np.zeros((size, size)), np.zeros((size, 3 * n))
        H, J = np.zeros((2 * n, size)), np.zeros((2 * n, 3 * n))
        for i in range(n):
            E[i, n + i] = 1.0
            if self.closed[i]:
                F[n + i, i], E[n + i, i] = -1.0, 1.0
            H[i, i] = 1.0
        for at, (i, k) in enumerate(used):
            path, input = 2 * n + at, self.pairing[i]
            F[path, n + k] = 1.0
            E[path, 2 * n + k] = 1.0
            if self.closed[k]:
                C = self.controllers[k]
                E[path, k] = C.sign * C.Kc * (C.beta - 1.0)
            F[input, path] = H[n + input, path] = 1.0
        return connect(inner, F, E, H, J)

    @cached_property
    def verdict(self) -> Verdict:
        """Stable, marginal or unstable, and why: the argument principle on the determinant with every dead time.

        The controller of a loop in manual does not count: nothing drives it.
        """
        n = self.process.size
        driven = channel(self.system, [*(i for i in range(n) if self.closed[i]), *range(n, 2 * n)], list(range(2 * n)))
        return delay_verdict(driven if self.process.all_stable else minimal_delay_system(driven).system)
