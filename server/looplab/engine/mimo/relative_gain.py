"""The relative gain array: how much the gain of a loop changes when the other loops close."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.mimo.process import ProcessMatrix
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

# Of the determinant of a matrix whose rows and columns have been brought to size one.
SINGULAR = 1e-10


def equilibrated(G: npt.NDArray) -> npt.NDArray:
    """A matrix with its rows and then its columns divided by their largest entries; zero ones stay."""
    G = np.array(G)
    for axis in (1, 0):
        size = np.abs(G).max(axis=axis, keepdims=True)
        G = G / np.where(size > 0, size, 1.0)
    return G


def relative_gain_array(G: npt.ArrayLike) -> npt.NDArray:
    r"""The RGA of a matrix of gains, or of the frequency responses at one or many frequencies.

    .. math:: \Lambda = G \circ (G^{-1})^{T}, \qquad
        \lambda_{ij} = \frac{(\partial y_i/\partial u_j)_{u}}{(\partial y_i/\partial u_j)_{y}}

    Parameters
    ----------
    G : array_like, shape (..., n, n)
        Real gains [output/input], or complex responses.

    Returns
    -------
    ndarray, shape (..., n, n)
        Rows and columns sum to one; units of inputs and outputs do not matter [-].

    Raises
    ------
    InvalidInput
        A matrix is singular: an input too many, or two outputs that always move alike.

    References
    ----------
    .. [1] E. H. Bristol, IEEE Trans. Automatic Control 11 (1966) 133-134.
    .. [2] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 3.4.
    """
    G = np.asarray(G)
    flat = G.reshape(-1, *G.shape[-2:])
    scaled = np.stack([equilibrated(each) for each in flat])
    if not (np.abs(np.linalg.det(scaled)) > SINGULAR).all():
        raise InvalidInput(
            "the gain matrix is singular: the outputs cannot be moved independently of each other",
            field="plant",
            hint="leave an output out, or choose another input",
        )
    return np.asarray((scaled * np.linalg.inv(scaled).swapaxes(-1, -2)).reshape(G.shape))


@dataclass(frozen=True)
class RestGains:
    """What the matrix tends to for s to 0, up to powers of s in its rows and columns.

    ``leading`` holds the factors of the leading powers, zero where an entry falls behind them; RGA and Niederlinski
    index depend on it alone. Without integrators it is G(0).
    """

    leading: FloatArray


def rest_gains(process: ProcessMatrix) -> RestGains:
    r"""Leading factors of a matrix at s = 0, integrators included.

    .. math:: g_{ij} \approx k_{ij}\, s^{-m_{ij}}, \qquad
        \lim_{s\to 0} s^{a_i + b_j} g_{ij} = k_{ij} \text{ if } a_i + b_j = m_{ij}, \text{ else } 0

    The powers a and b are those of an assignment of largest total order (its dual), so that the determinant keeps its
    leading term; the RGA does not see powers that multiply whole rows and columns.

    Parameters
    ----------
    process : ProcessMatrix

    Returns
    -------
    RestGains

    Raises
    ------
    InvalidInput
        The determinant is zero for all s, by its zero entries alone.

    References
    ----------
    .. [1] A. Schrijver, Combinatorial Optimization, Springer 2003, sec. 17.2 (assignment and its dual).
    """
    n = process.size
    order = np.full((n, n), -np.inf)
    factor = np.zeros((n, n))
    for i, row in enumerate(process.entries):
        for j, entry in enumerate(row):
            if entry.gain:
                order[i, j], factor[i, j] = entry.origin_order, entry.origin_gain
    known = np.where(np.isfinite(order), order, -1e6)
    from scipy.optimize import linear_sum_assignment  # late: a server that does not need it is 26 MB smaller

    rows, columns = linear_sum_assignment(known, maximize=True)
    if known[rows, columns].min() < -1e5:
        raise InvalidInput(
            "too many entries are zero: the outputs cannot be moved independently of each other", field="plant"
        )
    # a_k - a_i <= m_kk' - m_ik', with k' the partner of k: shortest paths give one a that satisfies all.
    apart = known[np.arange(n), columns][None, :] - known[:, columns]
    for k in range(n):
        apart = np.minimum(apart, apart[:, [k]] + apart[[k], :])
    a = apart.min(axis=0)
    b = np.empty(n)
    b[columns] = known[np.arange(n), columns] - a
    tight = np.abs(a[:, None] + b[None, :] - order) < 0.5
    return RestGains(np.where(tight, factor, 0.0))


def rga_at_rest(process: ProcessMatrix) -> FloatArray:
    """The RGA at s = 0, shape (n, n); of integrating entries its limit. Raises InvalidInput where it is not defined."""
    leading = rest_gains(process).leading
    try:
        return np.asarray(relative_gain_array(leading))
    except InvalidInput:
        if not process.integrates:
            raise
        raise InvalidInput(
            "the integrators make the matrix singular at s = 0: its relative gains have no limit there",
            field="plant",
            hint="read the RGA at the frequencies of the loops instead",
        ) from None


def rga_response(process: ProcessMatrix, omega: FloatArray) -> ComplexArray:
    """The RGA over frequency, shape (N, n, n) complex; raises InvalidInput where it is singular at one of them."""
    return relative_gain_array(process.response(omega))


def rga_number(rga: npt.NDArray, pairing: tuple[int, ...]) -> FloatArray:
    r"""How far an RGA is from that of a process without interaction under a pairing.

    .. math:: \sum_{ij} |\lambda_{ij} - p_{ij}|

    Parameters
    ----------
    rga : ndarray, shape (..., n, n)
    pairing : tuple of int
        Input of each output; P has ones there.

    Returns
    -------
    ndarray, shape (...)
        0 without interaction [-].

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 3.4.
    """
    target = np.eye(rga.shape[-1])[list(pairing)]
    return np.asarray(np.abs(rga - target).sum(axis=(-2, -1)))
