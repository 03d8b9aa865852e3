"""The method of steps: from breakpoint to breakpoint, with polynomials of degree 24 between them."""

from __future__ import annotations

import numpy as np

from looplab.engine.delays.breakpoints import breakpoints
from looplab.engine.delays.chebyshev import DEGREE, NODES, TO_COEFFICIENTS, LinearPiece, interpolation, polynomials
from looplab.engine.delays.structure import channels, step_events
from looplab.engine.delays.system import DelaySystem
from looplab.engine.errors import NoConvergence
from looplab.engine.systems.polynomial import FloatArray

# Of the size of the shortest dead time or lag.
MAX_PIECES = 6_000
# Of the last coefficients of a piece, relative to the largest value so far.
TAIL = 2e-13
LARGEST_STATE = 1e13


def _too_long() -> NoConvergence:
    return NoConvergence(
        "the shortest dead time or lag is too short for so long a horizon",
        field="horizon",
        hint="shorten the horizon, or leave the shortest dead time out",
    )


class Steps:
    """Responses to unit steps of each input at t = 0 from rest, piece by piece, and their values at any time.

    Attributes
    ----------
    breaks : ndarray
        Times in (0, horizon) at which something inside the system jumps or has a kink [time].
    end : float
        Up to here the pieces reach; before the horizon where the response grows out of bounds [time].
    """

    def __init__(self, system: DelaySystem, horizon: float) -> None:
        self.system = system = system.balanced
        self.horizon = horizon
        self.parts = channels(system)
        self.events = step_events(system, self.parts.inputs)
        self.breaks = breakpoints(system, self.parts, horizon)
        core = self.parts.core
        self.tau = system.tau[core]
        self.n, self.m = system.order, system.inputs
        self.solver = LinearPiece(system.A)
        self.A, self.B2 = system.A, system.B2[:, core]
        self.C2, self.D22 = system.C2[core], system.D22[np.ix_(core, core)]
        self.starts, self.values, self.count = np.empty(64), np.empty((64, self.n + len(core), DEGREE + 1, self.m)), 0
        self.lengths = np.empty(64)
        self.end = self._march()
        self.starts, self.lengths = self.starts[: self.count], self.lengths[: self.count]
        self.values = self.values[: self.count]
        self.coefficients = np.einsum("jl,eclm->ecjm", TO_COEFFICIENTS, self.values)
        index = np.arange(DEGREE + 1)
        slopes = np.polynomial.chebyshev.chebder(np.moveaxis(self.coefficients, 2, 0), axis=0)
        slopes = np.concatenate([slopes, np.zeros((1, *slopes.shape[1:]))])[index]
        self.slopes = np.moveaxis(slopes, 0, 2) * (2.0 / self.lengths)[:, None, None, None]

    def _march(self) -> float:
        edges = np.append(self.breaks, self.horizon).tolist()
        longest = float(self.tau.min(initial=np.inf))
        if self.horizon > MAX_PIECES * longest:
            raise _too_long()
        a, at, x = 0.0, 0, np.zeros((self.n, self.m))
        wanted, scale = np.inf, np.zeros((self.n + self.tau.size, self.m))
        shortest = 1e-11 * self.horizon
        while at < len(edges):
            room = edges[at] - a
            # No sliver before an edge: it would be one more piece for nothing.
            parts = max(1.0, np.ceil(room / min(longest, wanted) - 1e-9))
            h = room / parts if parts < 4 else min(longest, wanted)
            if parts == 1:
                h = room
            x_new, piece = self._piece(a, h, x)
            size = np.maximum(scale, np.abs(piece).max(axis=1))
            tail = np.abs(piece.transpose(0, 2, 1) @ TO_COEFFICIENTS[-3:].T).max(axis=2)
            floor = 1e-6 * size.max(axis=0, initial=1e-300)
            error = float((tail / np.maximum(size, floor)).max(initial=0.0))
            if not error <= TAIL and np.isfinite(error) and h > shortest:
                wanted = h * (0.5 if error < 1e-7 else 0.25)
                continue
            scale = size
            self._keep(a, h, piece)
            if not float(size.max(initial=0.0)) < LARGEST_STATE:
                return a + h
            # A short piece before an edge says nothing about the next ones.
            wanted = max(wanted, h * (2.0 if error < 1e-3 * TAIL else 1.25))
            a, x = (edges[at], x_new) if parts == 1 else (a + h, x_new)
            at += parts == 1
        return self.horizon

    def _piece(self, a: float, h: float, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """States and delayed signals at the nodes of [a, a + h], and the state at its end."""
        w = self._delayed(a, h)
        into_x, into_z = self._steps(a + 0.5 * h)
        piece = np.empty((self.n + self.tau.size, DEGREE + 1, self.m))
        if self.n:
            f = into_x[:, None, :] + np.tensordot(self.B2, w, axes=1)
            piece[: self.n] = self.solver.solve(h, x, f)
        piece[self.n :] = (
            into_z[:, None, :] + np.tensordot(self.C2, piece[: self.n], axes=1) + np.tensordot(self.D22, w, axes=1)
        )
        return piece[: self.n, -1], piece

    def _steps(self, t: float) -> tuple[FloatArray, FloatArray]:
        """What the inputs, delayed or not, add to x' and to z (of the core channels) at time t."""
        system, core = self.system, self.parts.core
        into_x, into_z = system.B1, system.D21[core]
        for i, found in self.events.items():
            w = sum((size for at, size in found if at <= t), np.zeros(self.m))
            if w.any():
                into_x = into_x + np.outer(system.B2[:, i], w)
                into_z = into_z + np.outer(system.D22[core, i], w)
        return into_x, into_z

    def _delayed(self, a: float, h: float) -> FloatArray:
        """w of the core channels at the nodes of [a, a + h], shape (k, DEGREE + 1, m)."""
        w = np.zeros((self.tau.size, DEGREE + 1, self.m))
        middle = a + 0.5 * h
        for i, tau in enumerate(self.tau.tolist()):
            if middle <= tau:
                continue
            # Towards the middle, so that an end on a breakpoint belongs to the piece inside.
            q = middle - tau + 0.5 * h * NODES
            inside = middle - tau + 0.5 * h * NODES * (1.0 - 1e-7)
            piece = np.searchsorted(self.starts[: self.count], inside, side="right") - 1
            for e in range(max(int(piece[0]), 0), int(piece[-1]) + 1):
                here = piece == e
                if here.any():
                    local = 2.0 * (q[here] - self.starts[e]) / self.lengths[e] - 1.0
                    w[i, here] = interpolation(local) @ self.values[e, self.n + i]
        return w

    def _keep(self, a: float, h: float, piece: FloatArray) -> None:
        if self.count == MAX_PIECES:
            raise _too_long()
        if self.count == self.starts.size:
            for name in ("starts", "lengths", "values"):
                old = getattr(self, name)
                new = np.empty((2 * old.shape[0], *old.shape[1:]))
                new[: self.count] = old
                setattr(self, name, new)
        self.starts[self.count], self.lengths[self.count], self.values[self.count] = a, h, piece
        self.count += 1

    def _inside(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """States and core signals z with their slopes at times t, right-hand limits, shape (t.size, n + k, m) each."""
        piece = np.searchsorted(self.starts, t + 1e-12 * self.horizon, side="right") - 1
        before = piece < 0
        piece[before] = 0
        T = polynomials(2.0 * (t - self.starts[piece]) / self.lengths[piece] - 1.0)
        out = []
        for coefficients in (self.coefficients, self.slopes):
            values = np.einsum("qj,qcjm->qcm", T, coefficients[piece])
            values[before] = 0.0
            out.append(values)
        return out[0], out[1]

    def _channel(self, i: int, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """w_i and its slope at times t, shape (t.size, m) each."""
        parts, system = self.parts, self.system
        if i in parts.inputs:
            on = [(t[:, None] >= at - 1e-12 * self.horizon) * size for at, size in self.events[i]]
            return sum(on, np.zeros((t.size, self.m))), np.zeros((t.size, self.m))
        late = t - system.tau[i]
        if i in parts.core:
            values, slopes = self._inside(late)
            row = self.n + parts.core.index(i)
            return values[:, row], slopes[:, row]
        return self._row(late, system.C2[i], system.D21[i], system.D22[i])

    def _row(self, t: FloatArray, c: FloatArray, d: FloatArray, e: FloatArray) -> tuple[FloatArray, FloatArray]:
        """c x + d u + e w and its slope at times t, zero before t = 0."""
        values, slopes = self._inside(t)
        running = t[:, None] >= -1e-12 * self.horizon
        value = np.tensordot(values[:, : self.n], c, axes=(1, 0)) + d * running
        slope = np.tensordot(slopes[:, : self.n], c, axes=(1, 0))
        for i in np.flatnonzero(e):
            w, dw = self._channel(int(i), t)
            value, slope = value + e[i] * w, slope + e[i] * dw
        return value, slope

    def outputs(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """y and its slope at increasing times t in [0, end], right-hand limits, shape (t.size, p, m) each."""
        system = self.system
        rows = [self._row(t, system.C1[i], system.D11[i], system.D12[i]) for i in range(system.outputs)]
        return np.stack([v for v, _ in rows], axis=1), np.stack([s for _, s in rows], axis=1)
