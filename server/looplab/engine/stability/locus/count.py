"""How many closed-loop poles lie in a rectangle: the argument principle, a proof that none was missed."""

from __future__ import annotations

from itertools import pairwise
from math import pi

import numpy as np
import numpy.typing as npt

from looplab.engine.systems.transfer_function import SMALL_ORDER, TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

LARGEST_TURN = 0.8
MAX_POINTS = 20_000
MAX_ROUNDS = 12
# Points to begin with on the longest side, without dead time.
LEAST_POINTS = 64
# Exponents of e that leave room for the factors.
MODERATE = 300.0


def _terms(L: TransferFunction, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """D(s) and k N(s) e^{-theta s}, scaled by their common size."""
    if max(L.order, L.zeros.size) <= SMALL_ORDER and L.theta * float(np.abs(s.real).max()) < MODERATE:
        # Products of so many factors stay in double precision.
        d = (s - L.poles[:, None]).prod(axis=0)
        n = (s - L.zeros[:, None]).prod(axis=0) * (L.gain * np.exp(-L.theta * s))
        return d, n
    log_d = np.log(s - L.poles[:, None]).sum(axis=0)
    log_n = np.log(s - L.zeros[:, None]).sum(axis=0) + np.log(L.gain + 0j) - L.theta * s
    # The larger term is divided out in size only: its phase stays.
    size = np.maximum(log_d.real, log_n.real)
    return np.exp(log_d - size), np.exp(log_n - size)


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
    corners = [left + 1j * bottom, right + 1j * bottom, right + 1j * top, left + 1j * top, left + 1j * bottom]
    (turn,) = _turns(L, np.array([K]), corners)
    return None if turn is None else round(turn / (2.0 * pi))


def count_on_both_sides(
    L: TransferFunction, gains: FloatArray, left: float, right: float, top: float
) -> list[int | None]:
    """The same for several gains in a rectangle that is symmetric about the real axis: its upper half tells."""
    turns = _turns(L, gains, [complex(right), right + 1j * top, left + 1j * top, complex(left)])
    return [None if turn is None else round(turn / pi) for turn in turns]


def _turns(L: TransferFunction, gains: FloatArray, corners: list[complex]) -> list[float | None]:
    """How far D + K N e^{-theta s} turns along a polygon, for each gain [rad]."""
    # Of a symmetric rectangle half a side is half as long.
    longest = max(abs(b - a) for a, b in pairwise(corners))
    path = [np.array(corners[:1])]
    for a, b in pairwise(corners):
        count = 1 + int((LEAST_POINTS * abs(b - a)) / longest + 4.0 * L.theta * abs((b - a).imag))
        path.append(a + (b - a) * (np.arange(1, count + 1) / count))
    s = np.concatenate(path)
    out: list[float | None] = [None] * gains.size
    with np.errstate(all="ignore"):
        d, n = _terms(L, s)
        value = d + gains[:, None] * n
        for _ in range(MAX_ROUNDS):
            quotient = value[:, 1:] / value[:, :-1]
            turn = np.arctan2(quotient.imag, quotient.real)
            fast = np.asarray(~(np.abs(turn) < LARGEST_TURN))
            out = [None if f.any() else float(t.sum()) for f, t in zip(fast, turn, strict=True)]
            at = np.flatnonzero(fast.any(axis=0))
            if not at.size or s.size + at.size > MAX_POINTS:
                break
            middle: ComplexArray = 0.5 * (s[at] + s[at + 1])
            s = np.insert(s, at + 1, middle)
            d, n = _terms(L, middle)
            value = np.insert(value, at + 1, d + gains[:, None] * n, axis=1)
    return out
