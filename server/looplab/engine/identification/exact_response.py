"""Exact responses of the low-order models to a recorded input, at any times: irregular samples, any dead time.

The states at the input's breakpoints do not depend on the dead time, which only shifts them: they are found once for
each tau (and zeta), and every sample is one closed form away from the breakpoint before it.
"""

from __future__ import annotations

import math

import numpy as np

from looplab.engine.identification.record import Record, input_changes
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.integrating import IPDT
from looplab.engine.systems.polynomial import FloatArray

LowOrder = FOPDT | SOPDT | IPDT
_FLAT = 1e-8


class RecordedInput:
    """The input of a record as pieces a + b s from the times ``knots`` on, in deviation from u_before."""

    def __init__(self, record: Record) -> None:
        change = input_changes(record)
        self.knots = record.t[change]
        self.a = record.u[change] - record.u_before
        self.b = np.zeros(self.a.size)
        if record.hold == "linear":
            self.b[:-1] = np.diff(self.a) / np.diff(self.knots)
        self._states: dict[tuple[float, ...], FloatArray] = {}

    def response(self, shape: tuple[float, ...], theta: float, t: FloatArray) -> FloatArray:
        """Response at times ``t`` with unit gain, from rest before the record; shape of ``t``.

        ``shape`` is (), an integrator, (tau,) or (tau, zeta).
        """
        late = t - theta
        piece = np.searchsorted(self.knots, late, side="right") - 1
        at = np.maximum(piece, 0)
        s = late - self.knots[at]
        states = self._at_knots(shape)
        moved = _moved(shape, states[at].T, self.a[at], self.b[at], np.maximum(s, 0.0))
        return np.where(piece >= 0, moved[0], 0.0)

    def _at_knots(self, shape: tuple[float, ...]) -> FloatArray:
        """State at each breakpoint, shape (knots, 1 or 2)."""
        found = self._states.get(shape)
        if found is not None:
            return found
        size = 2 if len(shape) == 2 else 1
        # Over each piece the state goes to M x + f: the f and M of all pieces at once.
        zero = np.zeros((size, self.knots.size - 1))
        a, b, s = self.a[:-1], self.b[:-1], np.diff(self.knots)
        f = np.array(_moved(shape, zero, a, b, s)).T
        unit = [np.eye(size)[k][:, None] + zero for k in range(size)]
        M = np.array([_moved(shape, e, 0.0 * a, 0.0 * b, s) for e in unit]).T
        states = np.vstack([np.zeros(size), _chained(M, f)])
        if len(self._states) > 64:
            self._states.clear()
        self._states[shape] = states
        return states


def _chained(M: FloatArray, f: FloatArray) -> FloatArray:
    """x after each of the maps x -> M_k x + f_k in turn, from 0: shape (n, size), with M of shape (n, size, size).

    In rows of about sqrt(n) maps: all rows at once from 0 and from unit vectors, then from where the row before ended.
    """
    n, size = f.shape
    length = max(1, math.isqrt(n))
    rows = -(-n // length)
    padded_M, padded_f = np.zeros((rows * length, size, size)), np.zeros((rows * length, size))
    padded_M[:n], padded_f[:n] = M, f
    # Position first: each step reads one block of memory.
    M = np.ascontiguousarray(padded_M.reshape(rows, length, size, size).swapaxes(0, 1))
    f = np.ascontiguousarray(padded_f.reshape(rows, length, size).swapaxes(0, 1))
    for k in range(1, length):
        f[k] += np.matmul(M[k], f[k - 1, :, :, None])[:, :, 0]
        M[k] = M[k] @ M[k - 1]
    start = np.zeros((rows, size))
    for row in range(1, rows):
        start[row] = M[-1, row - 1] @ start[row - 1] + f[-1, row - 1]
    out = f + np.matmul(M, start[:, :, None])[:, :, :, 0]
    return out.swapaxes(0, 1).reshape(rows * length, size)[:n]


def free_response(shape: tuple[float, ...], s: FloatArray) -> list[FloatArray]:
    """What initial values of the states become after the time s >= 0: one curve for each state but an integrator's."""
    if not shape:
        return []
    nothing = np.zeros(s.size)
    size = len(shape)
    starts = [np.eye(size)[k][:, None] + np.zeros((size, s.size)) for k in range(size)]
    return [_moved(shape, start, nothing, nothing, s)[0] for start in starts]


def _moved(
    shape: tuple[float, ...], x: FloatArray, a: FloatArray, b: FloatArray, s: FloatArray
) -> tuple[FloatArray, ...]:
    """States after the time s of an input a + b s: (x,), or (x, tau x') of second order."""
    if not shape:
        return (x[0] + s * (a + 0.5 * b * s),)
    tau = shape[0]
    if len(shape) == 1:
        return (x[0] * np.exp(-s / tau) - (a - b * tau) * np.expm1(-s / tau) + b * s,)
    zeta = shape[1]
    z = s / tau
    beta = math.sqrt(abs(zeta * zeta - 1.0))
    # sinh(beta z)/beta and sin(beta z)/beta go to z where beta vanishes.
    if zeta < 1:
        decay = np.exp(-zeta * z)
        S = decay * np.sin(beta * z) / beta if beta > _FLAT else decay * z
        C = decay * np.cos(beta * z)
    else:
        decay, fast = np.exp(-z / (zeta + beta)), np.expm1(-2.0 * beta * z)
        S = decay * fast / (-2.0 * beta) if beta > _FLAT else decay * z
        C = decay * (1.0 + 0.5 * fast)
    start = a - 2.0 * zeta * tau * b
    e, v = x[0] - start, x[1] - tau * b
    return start + b * s + (C + zeta * S) * e + S * v, tau * b + (C - zeta * S) * v - S * e


def shape_of(model: LowOrder) -> tuple[float, ...]:
    """(), (tau,) or (tau, zeta): what makes the form of a model's response."""
    if isinstance(model, SOPDT):
        return (model.tau, model.zeta)
    return () if isinstance(model, IPDT) else (model.tau,)


def model_response(model: LowOrder, record: Record, t: FloatArray | None = None) -> FloatArray:
    r"""Deviation of the output that a model gives to the recorded input, exact, shape of ``t``.

    .. math:: \hat y(t) = K \int_{t_0}^{t} h(t - s)\, \bigl(u(s - \theta) - u_{before}\bigr)\, ds

    Parameters
    ----------
    model : FOPDT, SOPDT or IPDT
        Without a lag in the integrating one.
    record : Record
        From rest at u_before.
    t : ndarray or None
        Times; None takes those of the record [time].

    Returns
    -------
    ndarray
        [output]

    References
    ----------
    .. [1] D. E. Seborg, T. F. Edgar, D. A. Mellichamp, F. J. Doyle, Process Dynamics and Control, 3rd ed., Wiley 2011,
       ch. 5 (responses to steps and ramps).
    """
    times = record.t if t is None else t
    return model.K * RecordedInput(record).response(shape_of(model), model.theta, times)
