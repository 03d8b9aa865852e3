"""Zeros, poles and gain of one channel of a state-space model, and its minimal part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import matrix_balance

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space.eigenvalues import EPS, eigenvalues
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.systems.polynomial import ComplexArray, FloatArray, pair_conjugates
from looplab.engine.systems.transfer_function import TransferFunction


def invariant_zeros(model: StateSpaceModel, output: int = 0, input: int = 0) -> tuple[ComplexArray, float]:
    r"""Invariant zeros of one channel, and the leading coefficient of its transfer function.

    .. math:: \det\begin{bmatrix} A - zI & b\\ c & d\end{bmatrix} = 0, \qquad k = \lim_{s\to\infty} s^r\,G(s)

    Parameters
    ----------
    model : StateSpaceModel
    output, input : int
        The channel, counted from 0.

    Returns
    -------
    tuple of ndarray, shape (n - r,), and float
        Finite generalised eigenvalues z, hidden modes included, and k. A channel that passes nothing has k = 0 and no
        zeros. The infinite eigenvalues are deflated first, one for each of the r steps of relative degree, by
        orthogonal transformations: what is left is an ordinary eigenvalue problem.

    References
    ----------
    .. [1] A. Emami-Naeini, P. Van Dooren, Computation of zeros of linear multivariable systems, Automatica 18 (1982)
       415-430.
    """
    channel = model.channel(output, input)
    A, b, c, d = channel.A, channel.B, channel.C, channel.D
    if A.size:
        # Input and output are balanced with the states: the zeros depend on them as on A.
        whole = np.block([[A, b[:, None]], [c, np.zeros(1)]])
        whole, _ = matrix_balance(whole, permute=False, separate=True)
        A, b, c = whole[:-1, :-1], whole[:-1, -1], whole[-1, :-1]
    gain = 1.0
    size_A = float(np.linalg.norm(A, 2)) if A.size else 0.0
    size_b = float(np.linalg.norm(b))
    # The given C and D are meant to the last digit; those computed below carry rounding, relative to A and B.
    rounding = 0.0
    while True:
        if abs(d) > rounding * size_b:
            return eigenvalues(A - np.outer(b, c) / d), float(gain * d)
        height = float(np.linalg.norm(c))
        if not height > rounding * size_A:
            return np.zeros(0, dtype=complex), 0.0
        # A short c has the same rounding as a long one, so its direction is known less well.
        rounding = 8 * EPS + rounding * max(size_A / height, 1.0)
        # y = 0 keeps the state along c at rest: its own equation is the next output.
        along = c / height
        across = _complement(along)
        gain *= height
        d, c = float(along @ b), along @ A @ across.T
        A, b = across @ A @ across.T, across @ b


def _complement(direction: FloatArray) -> FloatArray:
    """Orthonormal rows that span what is orthogonal to a unit vector (a Householder reflection less one row)."""
    i = int(np.argmax(np.abs(direction)))
    w = direction.copy()
    w[i] += np.copysign(1.0, w[i])
    return np.delete(np.eye(w.size) - np.outer(w, w) * (2.0 / (w @ w)), i, axis=0)


def to_transfer_function(
    model: StateSpaceModel, output: int = 0, input: int = 0, theta: float = 0.0
) -> TransferFunction:
    """Transfer function of one channel with every state kept: hidden modes stay as equal zeros and poles.

    Parameters
    ----------
    model : StateSpaceModel
    output, input : int
        The channel, counted from 0.
    theta : float
        Dead time to give it, >= 0 [time].

    Returns
    -------
    TransferFunction
        gain 0 (and the poles) where the channel passes nothing.

    Raises
    ------
    InvalidInput
        There is no such channel, or a pole or zero is out of range.
    """
    zeros, gain = invariant_zeros(model, output, input)
    return TransferFunction(zeros, model.poles, gain, theta)


@dataclass(frozen=True)
class Cancellation:
    """A zero and a pole taken as equal: ``distance`` is |zero - pole| over the larger of |pole| and the system's speed.

    ``stable`` is False when the mode that was hidden does not decay.
    """

    pole: complex
    zero: complex
    distance: float
    stable: bool


@dataclass(frozen=True)
class MinimalForm:
    """A system without its hidden modes, and what was taken out at which tolerance.

    ``closest_kept`` is the smallest distance of a zero to a pole that were kept (None where there are none).
    """

    system: TransferFunction
    cancelled: tuple[Cancellation, ...]
    tolerance: float
    closest_kept: float | None


def minimal(system: TransferFunction, tolerance: float = 1e-8) -> MinimalForm:
    """Cancel zeros against equal poles, closest first, complex ones in conjugate pairs.

    Parameters
    ----------
    system : TransferFunction
    tolerance : float
        Largest distance to be taken as equal, relative to the pole (0 to 0.1).

    Returns
    -------
    MinimalForm
        What was cancelled, and how far the closest pair is that was not.

    Raises
    ------
    InvalidInput
        The tolerance is out of range.
    """
    if not 0 <= tolerance <= 0.1:
        raise InvalidInput("the tolerance must be from 0 to 0.1", field="tolerance", hint="1e-8 is usual")
    zeros, poles = list(system.zeros), list(system.poles)
    cancelled: list[Cancellation] = []
    closest: float | None = None
    both = [abs(r) for r in (*zeros, *poles) if r != 0]
    # A root at the origin has no size of its own: it is compared with the slowest other one.
    smallest = min(both) if both else 1.0
    while zeros and poles:
        z, p = np.array(zeros), np.array(poles)
        # A real root never stands for one of a complex pair: its partner would be left alone.
        alike = (z.imag > 0)[:, None] == (p.imag > 0)
        alike &= (z.imag < 0)[:, None] == (p.imag < 0)
        distance = np.abs(z[:, None] - p) / np.maximum(np.abs(p), smallest)
        distance = np.where(alike, distance, np.inf)
        i, j = np.unravel_index(np.argmin(distance), distance.shape)
        if not distance[i, j] <= tolerance:
            closest = float(distance[i, j]) if np.isfinite(distance[i, j]) else None
            break
        zero, pole = complex(zeros[i]), complex(poles[j])
        pairs = [(zero, pole)] if pole.imag == 0 else [(zero, pole), (zero.conjugate(), pole.conjugate())]
        for a, b in pairs:
            zeros.remove(a)
            poles.remove(b)
            cancelled.append(Cancellation(b, a, float(distance[i, j]), b.real < 0))
    kept = TransferFunction(pair_conjugates(zeros), pair_conjugates(poles), system.gain, system.theta)
    return MinimalForm(kept, tuple(cancelled), tolerance, closest)
