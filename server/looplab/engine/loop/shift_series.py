r"""Series in the shift z of the dead time: the coefficients F_j(s) of exp(s A(z)) = sum_j F_j(s) z^j.

They are read off exp(s A(z)) at points of a circle by an inverse FFT. On the circle the exponential may be much larger
than the coefficients, so s is kept short enough that it is not: see ``pieces_of_dead_time``.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import ceil, factorial, log2
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import NoConvergence

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
Matrices = TypeVar("Matrices", FloatArray, ComplexArray)

# z (k,) -> A(z) (k, n, n), C(z) (k, p, n)
Symbol = Callable[[ComplexArray], tuple[ComplexArray, ComplexArray]]

TAIL = 1e-15
# Coefficients this small, relative to the largest, are left out; up to the second if the last ones are as large.
NEGLIGIBLE, LARGEST_NEGLIGIBLE = 1e-16, 4e-15
STAGNATION = 1e-11
MAX_NODES = 4096
# Largest exp(s A(z)) on the circle: that many digits of the coefficients may be lost to cancellation.
LARGEST_EXPONENTIAL = 1e2
# Longest piece in units of 1/norm(A): each squaring of a stiff exponential costs a little accuracy.
LONGEST_PIECE = 256.0
# A returning jump (neutral loop) shrinks by this factor per dead time on the circle chosen for it.
NEUTRAL_DECAY = 0.983
# 1/k! for k = 4 i + j
_TAYLOR = np.array([[1.0 / factorial(4 * i + j) for j in range(4)] for i in range(4)])
_COMPLEX_TAYLOR = _TAYLOR.astype(complex)


@lru_cache(maxsize=64)
def _identity(n: int) -> FloatArray:
    return np.eye(n)


def _product(matrices: Matrices) -> Callable[..., Matrices]:
    """Matrix product for one matrix or many: for one small matrix `dot` is half as costly to call."""
    return np.dot if matrices.ndim == 2 else np.matmul


def _taylor(matrices: Matrices) -> Matrices:
    """exp of matrices of norm <= 1/2: degree 15 in powers of the fourth power (Paterson-Stockmeyer), error < 1e-18."""
    product = _product(matrices)
    powers = np.empty((4, *matrices.shape), dtype=matrices.dtype)
    powers[0], powers[1] = _identity(matrices.shape[-1]), matrices
    product(matrices, matrices, out=powers[2])
    product(powers[2], matrices, out=powers[3])
    a4 = product(powers[2], powers[2])
    taylor = _COMPLEX_TAYLOR if np.iscomplexobj(powers) else _TAYLOR
    blocks = taylor.dot(powers.reshape(4, -1)).reshape(powers.shape)
    out = blocks[3]
    for block in (blocks[2], blocks[1], blocks[0]):
        out = product(a4, out)
        out += block
    return out


def _norm(matrices: Matrices) -> float:
    return float(np.abs(matrices).sum(axis=-1).max(initial=0.0))


def expm_batch(matrices: Matrices, norm: float | None = None) -> Matrices:
    """exp of matrices, shape (..., n, n), real or complex, by scaling, a Taylor polynomial and squaring."""
    norm = _norm(matrices) if norm is None else norm
    squarings = max(0, ceil(log2(norm)) + 1) if norm > 0.5 else 0
    product = _product(matrices)
    out = _taylor(matrices * 0.5**squarings)
    for _ in range(squarings):
        out = product(out, out)
    return out


@lru_cache(maxsize=64)
def circle(nodes: int, radius: float) -> ComplexArray:
    """The upper half of ``nodes`` points of a circle, read-only; a real series is known from it."""
    z: ComplexArray = radius * np.exp(-2j * np.pi * np.arange(nodes // 2 + 1) / nodes)
    z.setflags(write=False)
    return z


def circle_radius(neutral: float) -> float:
    """Radius of a circle inside which a series with jumps of relative size ``neutral`` converges."""
    return 1.0 if neutral <= NEUTRAL_DECAY else NEUTRAL_DECAY / neutral


def pieces_of_dead_time(symbol: Symbol, theta: float, radius: float) -> int:
    """Into how many pieces the dead time must be cut for exp(s A(z)) to stay small on the circle."""
    A, _ = symbol(circle(16, radius))
    norm = _norm(A * theta)
    if norm <= 4.0:
        return 1
    halvings = int(np.ceil(np.log2(norm))) + 1
    grown = _taylor(A * (theta / 2.0**halvings))
    pieces = 2.0**halvings
    while pieces > 1 and norm * 2 / pieces <= LONGEST_PIECE:
        with np.errstate(over="ignore", invalid="ignore"):
            grown = grown @ grown
        if not _norm(grown) <= LARGEST_EXPONENTIAL:
            break
        pieces /= 2
    return int(pieces)


def _squares(step: ComplexArray, count: int) -> list[ComplexArray]:
    """step, step^2, step^4 ... up to the largest that count powers are made of."""
    out = [step]
    while 2 ** len(out) <= count:
        out.append(out[-1] @ out[-1])
    return out


def _power(squares: list[ComplexArray], exponent: int) -> ComplexArray:
    factors = [square for bit, square in enumerate(squares) if exponent >> bit & 1]
    out = factors[0]
    for factor in factors[1:]:
        out = out @ factor
    return out


def _powers_of(squares: list[ComplexArray], rows: ComplexArray, count: int) -> ComplexArray:
    """rows @ step^k for k = 0..count-1, shape (nodes, count p, n), by doubling."""
    nodes, p, n = rows.shape
    out = np.empty((nodes, count * p, n), dtype=complex)
    out[:, :p] = rows
    done = 1
    for square in squares:
        more = min(done, count - done)
        if more > 0:
            np.matmul(out[:, : more * p], square, out=out[:, done * p : (done + more) * p])
        done += more
    return out


def shift_series(
    symbol: Symbol, h: float, samples: int, terms: int, neutral: float = 0.0, largest: float = np.inf
) -> tuple[FloatArray, FloatArray] | None:
    """Coefficients over one piece of length samples*h.

    Parameters
    ----------
    symbol : callable
        z, shape (k,) -> A(z), shape (k, n, n), and C(z), shape (k, p, n).
    h : float
        Sampling interval [time].
    samples : int
        Samples per piece.
    terms : int
        Terms that can matter at most.
    neutral : float
        Relative size of the jump that comes back after one dead time [-].
    largest : float
        Give up, with None, where the exponential is larger on the circle or the piece too long for it to be exact.

    Returns
    -------
    F : ndarray, shape (J, n, n)
        Coefficients of exp(samples h A(z)).
    H : ndarray, shape (J, samples, p, n)
        Coefficients of C(z) exp(k h A(z)), k = 0..samples-1.

    Raises
    ------
    NoConvergence
        More than 4096 terms would be needed.
    """
    radius = circle_radius(neutral)
    nodes, tail = 16, np.inf
    if neutral > 0:
        wanted = np.log(TAIL) / np.log(min(neutral * radius, NEUTRAL_DECAY))
        nodes = min(MAX_NODES, max(16, 2 ** int(np.ceil(np.log2(max(wanted, 1.0) / 0.75)))))
    while nodes <= MAX_NODES:
        A, C = symbol(circle(nodes, radius))
        length = _norm(A) * (h * samples)
        if largest < np.inf and length > LONGEST_PIECE:
            return None
        squares = _squares(expm_batch(A * h, length / samples), samples)
        whole = _power(squares, samples)
        # At these points the forward transform is the series itself, so irfft returns its coefficients.
        F = np.fft.irfft(whole, n=nodes, axis=0)
        size = np.abs(F).max(axis=(1, 2))
        # The coefficients bound what they are the coefficients of.
        if largest < np.inf and not (size.sum() * F.shape[1] <= largest or _norm(whole) <= largest):
            return None
        # The exponential of a stiff matrix has rounding noise of its own, in every coefficient: a small tail that no
        # longer shrinks is that noise.
        noise = max(TAIL * 30.0, TAIL * length)
        tail, before = size[nodes * 3 // 4 :].max() / size.max(), tail
        if tail <= noise or nodes == MAX_NODES or 0.1 * before < tail < STAGNATION:
            H = np.fft.irfft(_powers_of(squares, C, samples), n=nodes, axis=0)
            reach = np.abs(H).max(axis=(1, 2))
            if reach[nodes * 3 // 4 :].max() <= max(10 * noise, 2 * tail) * max(reach.max(), size.max()):
                size = np.maximum(size / size.max(), reach / max(reach.max(), 1e-300))
                # What is as small as the last ones is rounding like them; one more is kept.
                negligible = min(max(NEGLIGIBLE, float(size[nodes * 3 // 4 :].max())), LARGEST_NEGLIGIBLE)
                last = min(int(np.flatnonzero(size[:terms] > negligible)[-1]) + 2, terms, nodes)
                F, H = F[:last], H[:last]
                if radius != 1.0:
                    undo = (radius ** -np.arange(last, dtype=float))[:, None, None]
                    F, H = F * undo, H * undo
                return F, H.reshape(last, samples, *C.shape[1:])
        nodes *= 2
    raise NoConvergence(
        "the dead-time series does not converge for these settings",
        field="theta",
        hint="the loop changes very much within one dead time; lower the gain or shorten the horizon",
    )
