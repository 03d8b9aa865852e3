"""The characteristic polynomial of a loop without dead time, expanded."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.systems.polynomial import from_roots, trim

FloatArray = npt.NDArray[np.float64]

# Expanding moves a coefficient by a few roundings; within this of a short decimal it is that decimal.
ROUNDINGS = 1e-14
DIGITS = 12


def _settle(c: float) -> float:
    short = float(f"{c:.{DIGITS - 1}e}")
    return short if abs(short - c) <= ROUNDINGS * abs(c) else c


def characteristic_polynomial(loop: FeedbackLoop) -> FloatArray:
    r"""D(s) + N(s) of the open loop L = N/D with monic D, nothing cancelled, highest power first.

    .. math:: \Delta(s) = D_P(s) D_C(s) + N_P(s) N_C(s)

    Parameters
    ----------
    loop : FeedbackLoop
        Without dead time.

    Returns
    -------
    ndarray, shape (n+1,)
        A coefficient within 1e-14 of a decimal of 12 digits is that decimal.

    Raises
    ------
    InvalidInput
        The loop has a dead time: its characteristic equation is no polynomial.

    References
    ----------
    .. [1] K. J. Åström, R. M. Murray, Feedback Systems, 2nd ed., Princeton University Press 2021, sec. 12.1.
    """
    L = loop.open_loop
    if loop.theta and L.gain:
        raise InvalidInput(
            "with dead time the characteristic equation is no polynomial",
            field="theta",
            hint="the stable gain ranges and Nyquist's count take dead time as it is",
        )
    D, N = from_roots(L.poles), L.gain * from_roots(L.zeros)
    total = np.polyadd(D, N)
    # What is left of two terms that cancel is rounding.
    size = np.polyadd(np.abs(D), np.abs(N))
    total[np.abs(total) <= 1e-15 * size] = 0.0
    return trim(np.array([_settle(float(c)) for c in total]))
