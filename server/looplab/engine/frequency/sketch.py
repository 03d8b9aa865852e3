"""The Bode diagram as it is sketched by hand: straight lines for magnitude and phase, and what each corner is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.asymptotes import bode_asymptotes
from looplab.engine.frequency.response import frequency_range
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

# Roots this close [relative] are one corner.
SAME_ROOT = 1e-6
# Half width [decades] of the jump at a root on the imaginary axis.
STEEPEST = 1e-9
DEAD_TIME_POINTS_PER_DECADE = 24


@dataclass(frozen=True)
class CornerMeaning:
    """A pole or zero, or a conjugate pair, and what it does to both lines.

    Attributes
    ----------
    omega : float
        Corner frequency, the size of the root [rad/time].
    kind : {"pole", "zero"}
    s : complex
        The root; of a pair the one with positive imaginary part [rad/time].
    multiplicity : int
        How many times the root, or the pair, is there.
    zeta : float or None
        Damping of a pair, |Re s|/|s| [-]; None for a real root.
    slope_change : int
        In units of 20 dB/decade.
    phase_change_deg : float
        Total change of the phase [deg].
    phase_from, phase_to : float
        Where the sloping line of the phase begins and ends [rad/time].
    """

    omega: float
    kind: Literal["pole", "zero"]
    s: complex
    multiplicity: int
    zeta: float | None
    slope_change: int
    phase_change_deg: float
    phase_from: float
    phase_to: float


@dataclass(frozen=True)
class BodeSketch:
    """Straight-line magnitude and phase with their corners.

    Attributes
    ----------
    omega, mag_dB : ndarray
        Vertices of the magnitude [rad/time], [dB].
    phase_omega, phase_deg : ndarray
        Vertices of the phase [rad/time], [deg]; dead time is no straight line and bends the line as it is.
    corners : tuple of CornerMeaning
        By growing frequency.
    initial_slope : int
        In units of 20 dB/decade, left of all corners.
    initial_phase_deg : float
        Phase left of all corners [deg].
    """

    omega: FloatArray
    mag_dB: FloatArray
    phase_omega: FloatArray
    phase_deg: FloatArray
    corners: tuple[CornerMeaning, ...]
    initial_slope: int
    initial_phase_deg: float


def _meaning(s: complex, multiplicity: int, kind: Literal["pole", "zero"]) -> CornerMeaning:
    omega = abs(s)
    pair = s.imag > 0
    zeta = abs(s.real) / omega if pair else None
    slope = (1 if kind == "zero" else -1) * multiplicity * (2 if pair else 1)
    # A root in the right half-plane bends the magnitude like its mirror image and turns the phase the other way.
    phase = 90.0 * slope * (-1 if s.real > 0 else 1)
    reach = 10.0 ** max(zeta if zeta is not None else 1.0, STEEPEST)
    return CornerMeaning(omega, kind, s, multiplicity, zeta, slope, phase, omega / reach, omega * reach)


def corner_meanings(system: TransferFunction) -> tuple[CornerMeaning, ...]:
    """The corners of a system by growing frequency; roots at the origin have none.

    Parameters
    ----------
    system : TransferFunction

    Returns
    -------
    tuple of CornerMeaning
    """
    out = []
    kinds: tuple[tuple[npt.NDArray[np.complex128], Literal["pole", "zero"]], ...] = (
        (system.zeros, "zero"),
        (system.poles, "pole"),
    )
    for roots, kind in kinds:
        left = [complex(r) for r in roots if r != 0 and r.imag >= 0]
        while left:
            s = left[0]
            same = [r for r in left if abs(r - s) <= SAME_ROOT * abs(s)]
            left = [r for r in left if abs(r - s) > SAME_ROOT * abs(s)]
            out.append(_meaning(s, len(same), kind))
    return tuple(sorted(out, key=lambda c: c.omega))


def bode_sketch(system: TransferFunction, low: float | None = None, high: float | None = None) -> BodeSketch:
    r"""Straight lines of magnitude and phase, as they are drawn by hand.

    .. math:: \arg G \approx \varphi_0 - \omega\theta + \sum_i \Delta\varphi_i\,
        \frac{\log_{10}(\omega/\omega_i) + h_i}{2 h_i}\Big|_{\text{clipped to } 0 \ldots 1}, \qquad
        h_i = 1 \text{ (real root)}, \; \zeta_i \text{ (pair)}

    Parameters
    ----------
    system : TransferFunction
    low, high : float or None
        Ends of the lines [rad/time]; None takes the decades that hold the corners.

    Returns
    -------
    BodeSketch
        A real root's phase is off by at most 5.71 deg, at a tenth and ten times its corner. A pair jumps as its
        damping goes to 0 and is two real roots at damping 1.

    References
    ----------
    .. [1] E. Cheever, Linear Physical Systems Analysis, Swarthmore College, "The Asymptotic Bode Diagram".
    .. [2] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 9.6.
    """
    auto_low, auto_high = frequency_range(system)
    low, high = low or auto_low, high or auto_high
    lines = bode_asymptotes(system, low, high)
    corners = corner_meanings(system)
    start = -90.0 * system.origin_order - (180.0 if system.origin_gain < 0 else 0.0)
    marks = np.array([w for c in corners for w in (c.phase_from, c.phase_to)])
    points = [np.array([low, high]), marks[(marks > low) & (marks < high)]]
    if system.theta:
        count = int(np.ceil(np.log10(high / low) * DEAD_TIME_POINTS_PER_DECADE))
        points.append(np.geomspace(low, high, max(count, 2)))
    omega = np.unique(np.concatenate(points))
    phase = start - np.degrees(system.theta * omega)
    for c in corners:
        share = np.log(omega / c.phase_from) / np.log(c.phase_to / c.phase_from)
        phase = phase + c.phase_change_deg * np.clip(share, 0.0, 1.0)
    return BodeSketch(lines.omega, lines.mag_dB, omega, phase, corners, lines.initial_slope, start)
