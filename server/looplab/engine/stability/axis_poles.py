"""Whether the closed-loop poles on the imaginary axis are simple: then the loop is stable in the sense of Lyapunov."""

from __future__ import annotations

import numpy as np

from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.stability.closed_loop import closed_loop_poles

# Computed poles this near to the axis, or to one another, are on it, or one; relative to their size.
SAME = 1e-6


def axis_poles_are_simple(loop: FeedbackLoop) -> bool:
    r"""Whether no closed-loop pole on the imaginary axis is repeated, in a loop without poles right of it.

    .. math:: L(p) = -1: \qquad p \text{ is simple} \iff
        \frac{L'(p)}{L(p)} = \sum_i \frac{1}{p - z_i} - \sum_i \frac{1}{p - p_i} - \theta \neq 0

    Parameters
    ----------
    loop : FeedbackLoop
        Its verdict is marginal.

    Returns
    -------
    bool
        True: the state stays bounded. With dead time poles that coincide are told by the derivative, as they need not
        be listed twice.

    References
    ----------
    .. [1] J. K. Hale, S. M. Verduyn Lunel, Introduction to Functional Differential Equations, Springer 1993, sec. 7.4.
    """
    poles = [complex(p) for p in closed_loop_poles(loop).poles]
    least = 1e-3 * max(map(abs, poles), default=0.0)

    def same(p: complex, q: complex) -> bool:
        return abs(p - q) <= SAME * max(abs(p), least)

    axis = [p for p in poles if same(p, 1j * p.imag)]
    if any(same(p, q) for i, p in enumerate(axis) for q in axis[:i]):
        return False
    if not loop.theta or not loop.open_loop.gain:
        return True
    L = loop.open_loop
    for p in axis:
        if np.any(L.zeros == p) or np.any(L.poles == p):
            continue
        terms = np.concatenate([1.0 / (p - L.zeros), -1.0 / (p - L.poles), [-L.theta]])
        if abs(terms.sum()) <= SAME * np.abs(terms).sum():
            return False
    return True
