"""A delayed system whose dead times are all equal, as one function of the shift z: the form of the fast kernel."""

from __future__ import annotations

import numpy as np

from looplab.engine.delays.system import DelaySystem
from looplab.engine.loop.shift_series import expm_batch
from looplab.engine.systems.polynomial import ComplexArray, FloatArray


class ShiftEquations:
    r"""x' = A(z) x for the states and the inputs as constant states, with z the shift by the one dead time.

    .. math:: w = z\,(I - z D_{22})^{-1} (C_2 x + D_{21} u)

    Parameters
    ----------
    system : DelaySystem
        All its dead times are equal.
    offsets : ndarray, shape (p,)
        How much later than asked each output is read, >= 0 [time].
    """

    def __init__(self, system: DelaySystem, offsets: FloatArray) -> None:
        self.system = system.balanced
        self.offsets = offsets
        _, self.group = np.unique(offsets, return_inverse=True)
        self.echo = float(np.abs(np.linalg.eigvals(system.D22)).max(initial=0.0))

    @property
    def starts(self) -> FloatArray:
        """Initial states for a unit step of each input, shape (n + m, m)."""
        n, m = self.system.order, self.system.inputs
        return np.vstack([np.zeros((n, m)), np.eye(m)])

    def at(self, z: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """A(z), shape (K, n + m, n + m), and the rows of the outputs and of their slopes, shape (K, 2 p, n + m)."""
        s, n, m, p = self.system, self.system.order, self.system.inputs, self.system.outputs
        k = s.tau.size
        column = z[:, None, None]
        w = column * np.linalg.solve(np.eye(k) - column * s.D22, np.hstack([s.C2, s.D21]).astype(complex))
        A = np.zeros((z.size, n + m, n + m), dtype=complex)
        A[:, :n] = np.hstack([s.A, s.B1]) + s.B2 @ w
        rows = np.hstack([s.C1, s.D11]) + s.D12 @ w
        for g, offset in enumerate(np.unique(self.offsets)):
            if offset > 0:
                rows[:, self.group == g] = rows[:, self.group == g] @ expm_batch(A * offset)
        return A, np.concatenate([rows, rows @ A], axis=1).reshape(z.size, 2 * p, n + m)
