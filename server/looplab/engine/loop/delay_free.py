"""Exact responses of a linear loop without dead time: one matrix exponential, then doubling."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

FloatArray = npt.NDArray[np.float64]


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
    """
    n, c = x0.shape
    power = (expm(A * h) if step is None else step).T
    states = np.empty((count * c, n))
    states[:c] = x0.T
    done = 1
    while done < count:
        more = min(done, count - done)
        np.matmul(states[: more * c], power, out=states[done * c : (done + more) * c])
        done += more
        if done < count:
            power = power @ power
    return (states @ C.T).reshape(count, c, -1).transpose(0, 2, 1)
