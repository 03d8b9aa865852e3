r"""The system at complex frequencies, exactly: one matrix H(s) holds its states and its delays.

.. math::

    H(s) = \begin{bmatrix} sI - A & -B_2 \Delta\\ -C_2 & I - D_{22}\Delta\end{bmatrix}, \quad
    \Delta = \operatorname{diag}(e^{-s\tau_i}), \quad
    G(s) = D_{11} + [C_1,\; D_{12}\Delta]\, H(s)^{-1} \begin{bmatrix} B_1\\ D_{21}\end{bmatrix}

det H(s) is an entire function whose zeros are the poles of the system, hidden modes included.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.delays.system import DelaySystem
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

# Entries of stacked matrices handled at once.
BATCH = 400_000


def _delays(system: DelaySystem, s: ComplexArray) -> ComplexArray:
    with np.errstate(over="ignore", invalid="ignore"):
        return np.exp(-s[:, None] * system.tau)


def characteristic_matrix(system: DelaySystem, s: ComplexArray) -> ComplexArray:
    """H(s), shape (N, n + k, n + k), for s of shape (N,)."""
    n, k = system.order, system.tau.size
    out = np.zeros((s.size, n + k, n + k), dtype=complex)
    diagonal = np.arange(n)
    out[:, :n, :n] = -system.A
    out[:, diagonal, diagonal] += s[:, None]
    if k:
        delta = _delays(system, s)[:, None, :]
        out[:, :n, n:] = -system.B2 * delta
        out[:, n:, :n] = -system.C2
        out[:, n:, n:] = np.eye(k) - system.D22 * delta
    return out


def characteristic_slope(system: DelaySystem, s: ComplexArray) -> ComplexArray:
    """dH/ds, shape (N, n + k, n + k)."""
    n, k = system.order, system.tau.size
    out = np.zeros((s.size, n + k, n + k), dtype=complex)
    diagonal = np.arange(n)
    out[:, diagonal, diagonal] = 1.0
    if k:
        delta = (system.tau * _delays(system, s))[:, None, :]
        out[:, :n, n:] = system.B2 * delta
        out[:, n:, n:] = system.D22 * delta
    return out


def _parts(s: ComplexArray, size: int) -> list[ComplexArray]:
    return np.array_split(s, max(1, s.size * size * size // BATCH)) if s.size else [s]


def characteristic_phase(system: DelaySystem, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """det H(s)/\\|det H(s)\\| (0 at a pole) and the derivative of ln det H(s), shape (N,) each."""
    size = system.order + system.tau.size
    phases, slopes = [], []
    for part in _parts(s, size):
        H = characteristic_matrix(system, part)
        sign, _ = np.linalg.slogdet(H)
        slope = np.full(part.size, np.inf + 0j)
        good = sign != 0
        with np.errstate(all="ignore"):
            inner = np.linalg.solve(H[good], characteristic_slope(system, part[good]))
        slope[good] = np.trace(inner, axis1=1, axis2=2)
        phases.append(sign)
        slopes.append(slope)
    return np.concatenate(phases), np.concatenate(slopes)


def _solve(H: ComplexArray, right: ComplexArray) -> ComplexArray:
    try:
        return np.asarray(np.linalg.solve(H, right))
    except np.linalg.LinAlgError:
        # One of them is a pole: the response there is infinite, the others are not.
        out = np.full((*H.shape[:-1], right.shape[-1]), np.inf + 0j)
        for i, matrix in enumerate(H):
            if np.linalg.slogdet(matrix)[0] != 0:
                out[i] = np.linalg.solve(matrix, right if right.ndim == 2 else right[i])
        return out


def transfer_matrix(system: DelaySystem, s: npt.ArrayLike) -> ComplexArray:
    r"""G(s), dead times exact.

    .. math:: G = D_{11} + [C_1, D_{12}\Delta]\, H^{-1} [B_1;\, D_{21}], \quad \Delta = \operatorname{diag}(e^{-s\tau})

    Parameters
    ----------
    system : DelaySystem
    s : array_like of complex, shape (N,)
        Complex frequencies [rad/time].

    Returns
    -------
    ndarray, shape (N, p, m)
        Infinite at a pole.

    References
    ----------
    .. [1] P. Gahinet, L. F. Shampine, Software for modeling and analysis of linear systems with delays, Proc. American
       Control Conference 2004, 5600-5605.
    """
    value, _ = transfer_and_slope(system, np.atleast_1d(np.asarray(s, dtype=complex)), slope=False)
    return value


def transfer_and_slope(system: DelaySystem, s: ComplexArray, slope: bool = True) -> tuple[ComplexArray, ComplexArray]:
    """G(s) and dG/ds, shape (N, p, m) each; without ``slope`` the second is empty."""
    system = system.balanced
    right = np.vstack([system.B1, system.D21]).astype(complex)
    values, slopes = [], []
    for part in _parts(s, system.order + system.tau.size):
        delta = _delays(system, part)[:, None, :]
        left = np.concatenate([np.broadcast_to(system.C1, (part.size, *system.C1.shape)), system.D12 * delta], axis=2)
        H = characteristic_matrix(system, part)
        with np.errstate(invalid="ignore", over="ignore"):
            inner = _solve(H, right)
            value = system.D11 + left @ inner
            # inf - inf is a pole, not an unknown.
            values.append(np.where(np.isfinite(value), value, np.inf + 0j))
            if slope:
                moved = _solve(H, characteristic_slope(system, part) @ inner)
                direct = -(system.D12 * system.tau * delta) @ inner[:, system.order :]
                slopes.append(direct - left @ moved)
    return np.concatenate(values), np.concatenate(slopes) if slope else np.zeros(0, dtype=complex)


def frequency_response(system: DelaySystem, omega: FloatArray) -> ComplexArray:
    """G(j omega), shape (N, p, m), for omega of shape (N,) [rad/time]."""
    return transfer_matrix(system, 1j * np.asarray(omega, dtype=float))
