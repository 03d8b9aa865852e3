"""Exact responses of a linear loop without dead time: one matrix exponential, then its powers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

from looplab.engine.loop.shift_series import expm_batch

FloatArray = npt.NDArray[np.float64]

# Up to this norm a Taylor polynomial and a few squarings are as exact as Pade's fraction, and several times faster.
LARGEST_TAYLOR = 16.0


def _exponential(A: FloatArray) -> FloatArray:
    norm = float(np.abs(A).sum(axis=-1).max(initial=0.0))
    return expm_batch(A, norm) if norm <= LARGEST_TAYLOR else np.asarray(expm(A))


def delay_free_response(
    A: FloatArray, C: FloatArray, x0: FloatArray, h: float, count: int, step: FloatArray | None = None
) -> FloatArray:
    """Outputs C x of x' = A x at t = 0, h, 2h, ...

    Parameters
    ----------
    A : ndarray, shape (n, n)
        Constant inputs are states of their own [1/time].
    C : ndarray, shape (p, n)
    x0 : ndarray, shape (n, c)
        c initial states, answered at once.
    h : float
        Sampling interval [time].
    count : int
        Number of samples.
    step : ndarray, shape (n, n), or None
        exp(A h) where the caller has it already.

    Returns
    -------
    ndarray, shape (count, p, c)
        A view of an array in which each output's samples follow one another.
    """
    n, c = x0.shape
    p = C.shape[0]
    power = _exponential(A * h) if step is None else step
    # For small matrices `dot` is half as costly to call as `@`.
    # Sample i + q j is (C step^i) (step^(q j) x0): two short sequences, each by doubling, and one product.
    q = 1 << (count.bit_length() // 2)
    m = -(-count // q)
    rows = np.empty((q * p, n))
    rows[:p] = C
    done = 1
    while done < q:
        rows[: done * p].dot(power, out=rows[done * p : 2 * done * p])
        power = power.dot(power)
        done *= 2
    states = np.empty((m * c, n))
    states[:c] = x0.T
    done = 1
    while done < m:
        more = min(done, m - done)
        states[: more * c].dot(power.T, out=states[done * c : (done + more) * c])
        done += more
        if done < m:
            power = power.dot(power)
    # One product of all starts with all rows, then each output's samples side by side.
    by_start = states.reshape(m, c, n).transpose(1, 0, 2).reshape(c * m, n)
    by_output = rows.reshape(q, p, n).transpose(1, 0, 2).reshape(p * q, n)
    out = by_start.dot(by_output.T).reshape(c, m, p, q).transpose(0, 2, 1, 3)
    return out.reshape(c, p, m * q)[:, :, :count].transpose(2, 1, 0)
