"""Step responses where all dead times are multiples of one time: windows of that length, each by the same matrix.

Jumps and kinks then lie between windows, never inside, and a delayed signal is that of a whole window before: there is
nothing to search and nothing to interpolate. A loop of two inputs with decimal dead times takes milliseconds.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, gcd, lcm

import numpy as np

from looplab.engine.delays.chebyshev import differentiation, interpolation
from looplab.engine.delays.system import DelaySystem
from looplab.engine.systems.polynomial import FloatArray

DEGREE = 14
MAX_WINDOWS = 20_000
# Numbers kept of all windows together (64 MB).
MAX_NUMBERS = 8_000_000
LARGEST_DENOMINATOR = 10_000
# A mode of this size per window is a polynomial of that degree to rounding.
LONGEST_WINDOW = 2.0
LARGEST_STATE = 1e13
# So many windows apart it is looked whether the response has run away.
LOOK_EVERY = 32

_index = np.arange(DEGREE + 1)
DIFFERENTIATE = differentiation(DEGREE)


def common_time(tau: FloatArray) -> float | None:
    """The longest time of which all dead times are multiples; None where there is no such decimal."""
    found = [Fraction(t).limit_denominator(LARGEST_DENOMINATOR) for t in tau.tolist()]
    if not found or any(abs(float(f) - t) > 1e-14 * t for f, t in zip(found, tau.tolist(), strict=True)):
        return None
    bottom = lcm(*(f.denominator for f in found))
    return gcd(*(int(f * bottom) for f in found)) / bottom


class Lattice:
    """Responses to unit steps of each input at t = 0 from rest, window by window, and their values at any time.

    Attributes
    ----------
    h : float
        Length of a window [time].
    end : float
        Up to here the windows reach; before the horizon where the response grows out of bounds [time].
    """

    def __init__(self, system: DelaySystem, horizon: float, h: float, count: int) -> None:
        self.system, self.h = system.balanced, h
        self.n, self.k, self.m = system.order, system.tau.size, system.inputs
        self.lags = np.rint(system.tau / h).astype(int)
        self.first = int(self.lags.max(initial=0))
        self.states = np.zeros((count, self.n, self.m))
        # Zeros before t = 0 stand in for what has not begun.
        self.signals = np.zeros((self.first + count, self.k, DEGREE + 1, self.m))
        self.count = count
        self._equations()
        self.end = min(self._march(), horizon)

    @classmethod
    def of(cls, system: DelaySystem, horizon: float) -> Lattice | None:
        """The windows for a system; None where its dead times have no common time that is long enough."""
        base = common_time(system.tau) if system.tau.size else horizon
        if base is None:
            return None
        fastest = float(np.abs(np.linalg.eigvals(system.A)).max(initial=0.0))
        parts = max(1, ceil(base * fastest / LONGEST_WINDOW))
        h = base / parts
        count = ceil(horizon / h + 1e-9)
        if count > MAX_WINDOWS or count * system.tau.size * (DEGREE + 1) * system.inputs > MAX_NUMBERS:
            return None
        return cls(system, horizon, h, count)

    def _equations(self) -> None:
        """Matrices from a window's first state, delayed signals and inputs to its last state, signals and outputs."""
        system, n, k, m, q = self.system, self.n, self.k, self.m, DEGREE
        size = n + k * (q + 1)
        rate = 2.0 / self.h
        nodes = np.zeros((n, q + 1, size + m))
        if n:
            nodes[:, 0, :n] = np.eye(n)
            right = np.zeros((q, n, size + m))
            right[:, :, :n] = -rate * DIFFERENTIATE[1:, 0, None, None] * np.eye(n)
            for j in range(q):
                for i in range(k):
                    right[j, :, n + i * (q + 1) + j + 1] = system.B2[:, i]
            right[:, :, size:] = system.B1
            left = np.kron(rate * DIFFERENTIATE[1:, 1:], np.eye(n)) - np.kron(np.eye(q), system.A)
            nodes[:, 1:] = np.linalg.solve(left, right.reshape(q * n, -1)).reshape(q, n, -1).transpose(1, 0, 2)

        def rows(C: FloatArray, D: FloatArray, E: FloatArray) -> FloatArray:
            out = np.tensordot(C, nodes, axes=1)
            for i in range(k):
                out[:, _index, n + i * (q + 1) + _index] += E[:, i, None]
            out[:, :, size:] += D[:, None, :]
            return out

        z = rows(system.C2, system.D21, system.D22).reshape(k * (q + 1), size + m)
        step = np.vstack([nodes[:, -1], z])
        self.step, self.push = step[:, :size].copy(), step[:, size:].copy()
        y = rows(system.C1, system.D11, system.D12)
        self.out, self.straight = y[..., :size], y[..., size:]

    def _march(self) -> float:
        n, m = self.n, self.m
        x, channel = np.zeros((n, m)), np.arange(self.k)
        given = np.empty((n + self.k * (DEGREE + 1), m))
        for e in range(self.count):
            self.states[e] = x
            given[:n] = x
            given[n:] = self.signals[self.first + e - self.lags, channel].reshape(-1, m)
            found = self.step @ given
            found += self.push
            x = found[:n]
            self.signals[self.first + e] = found[n:].reshape(self.k, DEGREE + 1, m)
            if e % LOOK_EVERY == 0 and not float(np.abs(found).max(initial=0.0)) < LARGEST_STATE:
                return (e + 1) * self.h
        return self.count * self.h

    def outputs(self, t: FloatArray) -> FloatArray:
        """y at increasing times t <= end, right-hand limits, shape (t.size, p, m); zero before t = 0."""
        window = np.floor(t / self.h + 1e-9).astype(int)
        out = np.zeros((t.size, self.system.outputs, self.m))
        running = window >= 0
        window = np.minimum(window[running], self.count - 1)
        used, where = np.unique(window, return_inverse=True)
        delayed = self.signals[self.first + used[:, None] - self.lags, np.arange(self.k)]
        given = np.concatenate([self.states[used], delayed.reshape(used.size, -1, self.m)], axis=1)
        nodes = np.tensordot(given, self.out, axes=(1, 2)).transpose(0, 2, 3, 1) + self.straight
        local = 2.0 * (t[running] / self.h - window) - 1.0
        out[running] = np.einsum("tj,tpjm->tpm", interpolation(local, DEGREE), nodes[where])
        return out
