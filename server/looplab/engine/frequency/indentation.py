"""The Nyquist contour at poles on the imaginary axis: its indentations, and the arcs at infinity they are mapped to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.response import AXIS_GAP
from looplab.engine.systems.transfer_function import TransferFunction

HALF_TURN_DEG = 180.0


@dataclass(frozen=True)
class IndentationArc:
    """The image of a small half circle to the right of a pole on the imaginary axis.

    Attributes
    ----------
    omega : float
        The pole is at j omega, omega >= 0 [rad/time]; the arc of its conjugate is the mirror image.
    multiplicity : int
        m, zeros at the same place taken off.
    start_deg, end_deg : float
        Angle of L on the large arc where the contour reaches the pole from below, and where it leaves it upwards
        [deg]; the start in (-180, 180], the end 180 m below it: clockwise.
    """

    omega: float
    multiplicity: int
    start_deg: float
    end_deg: float

    @property
    def turn_deg(self) -> float:
        """How far the arc turns clockwise, 180 m [deg]."""
        return HALF_TURN_DEG * self.multiplicity


def _on_axis(roots: npt.NDArray[np.complex128]) -> npt.NDArray[np.complex128]:
    return roots[(np.abs(roots.real) <= AXIS_GAP * np.abs(roots)) & (roots.imag >= 0)]


def indentation_arcs(L: TransferFunction) -> tuple[IndentationArc, ...]:
    r"""Arcs at infinity that close the Nyquist curve, dead time exact.

    .. math:: s = j\omega_0 + \varepsilon e^{j\varphi},\; \varphi: -90^\circ \to 90^\circ \quad\Rightarrow\quad
        L(s) \approx c\,\varepsilon^{-m} e^{-jm\varphi}, \quad c = \lim_{s \to j\omega_0} (s - j\omega_0)^m L(s)

    Parameters
    ----------
    L : TransferFunction
        Open loop.

    Returns
    -------
    tuple of IndentationArc
        By growing omega; none without poles on the axis.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 10.2.
    .. [2] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, sec. 7-5.
    """
    return _arcs(L.unit) if L.gain else ()


@lru_cache(maxsize=128)
def _arcs(L: TransferFunction) -> tuple[IndentationArc, ...]:
    """The arcs of an L with gain 1 or -1: a moving gain changes none of them."""
    out = []
    heights: list[float] = []
    for b in np.sort(_on_axis(L.poles).imag):
        if not heights or b - heights[-1] > AXIS_GAP * b:
            heights.append(float(b))
    for b in heights:
        s = 1j * b
        at = np.abs(L.poles - s) <= 2 * AXIS_GAP * b
        zero_at = np.abs(L.zeros - s) <= 2 * AXIS_GAP * b
        m = int(np.count_nonzero(at)) - int(np.count_nonzero(zero_at))
        if m <= 0:
            continue
        if b == 0.0:
            angle = HALF_TURN_DEG if L.origin_gain < 0 else 0.0
        else:
            rest = np.angle(s - L.zeros[~zero_at]).sum() - np.angle(s - L.poles[~at]).sum() - L.theta * b
            angle = float(np.degrees(rest)) + (HALF_TURN_DEG if L.gain < 0 else 0.0)
        start = HALF_TURN_DEG - (HALF_TURN_DEG - (angle + 90.0 * m)) % 360.0
        out.append(IndentationArc(b, m, start, start - HALF_TURN_DEG * m))
    return tuple(out)
