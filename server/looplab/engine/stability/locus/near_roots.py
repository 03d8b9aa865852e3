"""Closed-loop poles next to the open-loop poles and zeros that they leave or reach, where eigenvalues lose them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

# Nearer than this fraction of the gap to the next root (over the order) the iteration gains two digits a step.
NEAR = 0.01
STEPS = 7
SETTLED = 1e-15


@dataclass(frozen=True)
class NearRoot:
    """The poles within ``radius`` of one root of L, shape (gains, multiplicity) [rad/time]; NaN where not all are."""

    root: complex
    radius: float
    poles: ComplexArray


def poles_near_roots(L: TransferFunction, gains: FloatArray) -> list[NearRoot]:
    r"""Closed-loop poles near each root of L, to rounding.

    .. math:: (s - r)^m = (-K L_r(s))^{\pm 1}, \qquad L_r(s) = L(s)\,(s - r)^{\pm m}

    + at a pole r, - at a zero, solved by iterating on the distance s - r, so that a distance far below the rounding of
    s is right too.

    Parameters
    ----------
    L : TransferFunction
        Open loop for K = 1 without hidden modes, dead time exact.
    gains : ndarray, shape (g,)
        K > 0.

    Returns
    -------
    list of NearRoot
        Roots that no pole is near at any of the gains are left out.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, sec. 6-2 (angles of departure).
    """
    out = []
    every = np.concatenate([L.poles, L.zeros])
    distinct = np.array(list(dict.fromkeys(every.tolist())))
    sense = np.repeat([1.0, -1.0], [L.order, L.zeros.size])
    apart = np.abs(distinct[:, None] - every)
    there = apart == 0.0
    multiplicity = np.count_nonzero(there, axis=1)
    gap = np.where(there, np.inf, apart).min(axis=1)
    reach = NEAR * np.minimum(gap, 1.0 / L.theta if L.theta else np.inf) / L.order
    sign = sense[there.argmax(axis=1)]
    with np.errstate(divide="ignore"):
        # ln |K L_r(r)| says how near the poles are: to a pole of L at the smallest gain, to a zero at the largest.
        level = np.where(sign > 0.0, np.log(gains.min()), np.log(gains.max())) + np.log(abs(L.gain))
        level -= np.log(np.where(there, 1.0, apart)) @ sense + L.theta * distinct.real
        near = sign * level < multiplicity * np.log(reach)
    for i in near.nonzero()[0].tolist():
        r = distinct[i]
        others = TransferFunction._of(L.zeros[L.zeros != r], L.poles[L.poles != r], L.gain, L.theta)
        d = _distances(others, r, int(multiplicity[i]), float(sign[i]), gains, float(reach[i]))
        if np.isfinite(d).any():
            out.append(NearRoot(complex(r), float(reach[i]), r + d))
    return out


def _distances(
    others: TransferFunction, r: complex, m: int, sign: float, gains: FloatArray, reach: float
) -> ComplexArray:
    """s - r of the m branches for each gain, shape (g, m); NaN where they are not all below ``reach``."""
    z, p = (r - others.zeros)[:, None, None], (r - others.poles)[:, None, None]
    out = np.full((gains.size, m), np.nan, dtype=complex)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        at_root = np.log(z).sum() - np.log(p).sum() + np.log(others.gain + 0j) - others.theta * r
        # Each of the m-th roots belongs to one branch.
        start = sign * (np.log(gains)[:, None] + 1j * np.pi + at_root) + 2j * np.pi * np.arange(m)
        d = np.exp(start / m)
        near = (np.abs(d) < reach).all(axis=1).nonzero()[0]
        if not near.size:
            return out
        start, d, to_zeros, to_poles = start[near], d[near], 1.0 / z, 1.0 / p
        for _ in range(STEPS - 1):
            # Relative to the value at the root; so near it that no logarithm jumps across its cut.
            moved = np.log((1.0 + d * to_zeros).prod(axis=0) / (1.0 + d * to_poles).prod(axis=0))
            last, d = d, np.exp((start + sign * (moved - others.theta * d)) / m)
            if (np.abs(d - last) <= SETTLED * np.abs(d)).all():
                break
    if np.imag(r) == 0.0:
        d = np.where(np.abs(d.imag) < 1e-9 * np.abs(d), d.real, d)
    out[near] = d
    return out
