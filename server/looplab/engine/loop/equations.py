"""State equations of the loop of plant and controller, as functions of the gain and of the shift of the dead time."""

from __future__ import annotations

from functools import cached_property, lru_cache
from math import frexp

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dgebal

from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]


class _PerGain:
    """What a moved gain k leaves as it is: the rows of A0, b_y, g and u0 of the equations as ``fixed + k moved``.

    Both have the shape (n + 3, n), in balanced states.
    """

    def __init__(self, plant: TransferFunction, unit: TransferFunction, weight: float, size: float) -> None:
        P, C = realize(plant), realize(unit)
        p, c = P.B.size, C.B.size
        n = p + c + 2
        self.starts = np.zeros((n, 2))
        self.starts[-2, 0] = self.starts[-1, 1] = 1.0
        self.Dc, self.DpDc = C.D, P.D * C.D
        self.fixed, self.moved = np.zeros((2, n + 3, n))
        base, (b_y, g, _) = self.fixed[:n], self.fixed[n:]
        base_k, (b_y_k, g_k, u) = self.moved[:n], self.moved[n:]
        u[p : p + c] = C.C
        u[n - 2] = C.D + weight
        base[:p, :p] = P.A
        base[p : p + c, p : p + c] = C.A
        base[p : p + c, n - 2] = C.B
        base[:p, n - 1] = P.B
        base_k[:p] = P.B[:, None] * u
        b_y[p : p + c] = -C.B
        b_y_k[:p] = -P.B * C.D
        # Plant output before its dead time: g x / (1 + Dp Dc z).
        g[:p] = P.C
        g[n - 1] = P.D
        g_k[:] = P.D * u
        self._balance(n, size)

    def _balance(self, n: int, k: float) -> None:
        """Scale the states so that rows and columns of A are of one size: exponentials keep their digits."""
        states = n - 2
        if not states:
            return
        at_k = self.fixed + k * self.moved
        size = np.abs(at_k[:n]) + np.abs(at_k[n])[:, None] * np.abs(at_k[n + 1])
        _, _, _, scale, _ = dgebal(size[:states, :states], scale=1, permute=0)
        for part in (self.fixed, self.moved):
            # Row n is a column of the state equation. Scales are powers of two: nothing is rounded.
            part[:states] /= scale[:, None]
            part[:, :states] *= scale
            part[n, :states] /= scale * scale


@lru_cache(maxsize=64)
def _per_gain(plant: TransferFunction, unit: TransferFunction, weight: float, power: int) -> _PerGain:
    return _PerGain(plant, unit, weight, 2.0**power)


class LoopEquations:
    """State equations of the loop, [x_plant, x_controller, r, d], as a function of the shift z of the dead time.

    Attributes
    ----------
    base, b_y : ndarray, shapes (n, n) and (n,)
        A(z) = base + b_y y(z).
    g : ndarray, shape (n,)
        y(z) = z g/(1 + Dp Dc z) is the row of the plant's output.
    u0 : ndarray, shape (n,)
        The row of the controller's output is u0 - Dc y(z).
    Dc, DpDc : float
        Direct terms of the controller and of the loop.
    starts : ndarray, shape (n, 2)
        Initial states of the setpoint and load steps.
    """

    def __init__(self, loop: FeedbackLoop) -> None:
        k = abs(loop.C.gain)
        # The states are balanced for gains of this size: a power of eight.
        power = 3 * round(frexp(k)[1] / 3) if k else 0
        unit = _per_gain(loop.plant, loop.C.unit, loop.feedforward / k if k else 0.0, power)
        every = unit.moved * k
        every += unit.fixed
        n = every.shape[1]
        self.starts, self.base = unit.starts, every[:n]
        self.b_y, self.g, self.u0 = every[n], every[n + 1], every[n + 2]
        self.Dc, self.DpDc = k * unit.Dc, k * unit.DpDc

    def at(self, z: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """A(z), shape (k, n, n), and the rows of y, u, dy/dt, du/dt, shape (k, 4, n), for z of shape (k,)."""
        y = (z / (1.0 + self.DpDc * z))[:, None] * self.g
        u = self.u0 - self.Dc * y
        A = self.base + self.b_y[:, None] * y[:, None, :]
        rows = np.empty((z.size, 4, self.g.size), dtype=complex)
        rows[:, 0], rows[:, 1] = y, u
        rows[:, 2:] = rows[:, :2] @ A
        return A, rows

    @cached_property
    def without_shift(self) -> tuple[FloatArray, FloatArray]:
        """A, shape (n, n), and the rows of y, u, dy/dt, du/dt, shape (4, n), of the loop without dead time."""
        y = self.g / (1.0 + self.DpDc)
        A = self.base + self.b_y[:, None] * y
        rows = np.empty((4, y.size))
        rows[0], rows[1] = y, self.u0 - self.Dc * y
        np.matmul(rows[:2], A, out=rows[2:])
        return A, rows

    def closed_loop_matrix(self) -> FloatArray:
        """A of the autonomous loop without dead time, shape (n, n): plant and controller states only."""
        return self.without_shift[0][:-2, :-2]


@lru_cache(maxsize=32)
def loop_equations(loop: FeedbackLoop) -> LoopEquations:
    """The equations of a loop, cached by content."""
    return LoopEquations(loop)
