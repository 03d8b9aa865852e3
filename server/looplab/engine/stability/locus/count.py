"""How many closed-loop poles lie in a rectangle: the argument principle, a proof that none was missed."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

LARGEST_TURN = 0.8
MAX_POINTS = 20_000
MAX_ROUNDS = 12


def _characteristic(L: TransferFunction, K: float, s: ComplexArray) -> ComplexArray:
    """D(s) + K N(s) e^{-theta s}, scaled to unit size: entire, so that only zeros turn it."""
    log_d = np.log(s[:, None] - L.poles).sum(axis=1)
    log_n = np.log(s[:, None] - L.zeros).sum(axis=1) + np.log(K * L.gain + 0j) - L.theta * s
    # The larger term is divided out in size only: its phase stays.
    size = np.maximum(log_d.real, log_n.real)
    return np.exp(log_d - size) + np.exp(log_n - size)


def count_in_rectangle(
    L: TransferFunction, K: float, left: float, right: float, bottom: float, top: float
) -> int | None:
    r"""Closed-loop poles of 1 + K L(s) = 0 inside a rectangle.

    .. math:: n = \frac{1}{2\pi}\,\Delta_{\partial R} \arg\left(D(s) + K N(s) e^{-\theta s}\right)

    Parameters
    ----------
    L : TransferFunction
    K : float
        Gain, > 0.
    left, right, bottom, top : float
        The rectangle [rad/time].

    Returns
    -------
    int or None
        None where a pole lies on the boundary or the phase turns too fast to follow.

    References
    ----------
    .. [1] J. W. Brown, R. V. Churchill, Complex Variables and Applications, 8th ed., McGraw-Hill 2009, sec. 86.
    """
    corners = np.array([left + 1j * bottom, right + 1j * bottom, right + 1j * top, left + 1j * top, left + 1j * bottom])
    per_side = 64 + int(4 * L.theta * (top - bottom))
    path = np.concatenate([np.linspace(a, b, per_side, endpoint=False) for a, b in pairwise(corners)])
    path = np.append(path, corners[-1])
    with np.errstate(divide="ignore", invalid="ignore"):
        value = _characteristic(L, K, path)
        for _ in range(MAX_ROUNDS):
            turn = np.angle(value[1:] / value[:-1])
            fast = ~(np.abs(turn) < LARGEST_TURN)
            if not fast.any():
                return int(np.rint(turn.sum() / (2 * np.pi)))
            at = np.flatnonzero(fast)
            if path.size + at.size > MAX_POINTS:
                break
            middle = 0.5 * (path[at] + path[at + 1])
            path = np.insert(path, at + 1, middle)
            value = np.insert(value, at + 1, _characteristic(L, K, middle))
    return None
