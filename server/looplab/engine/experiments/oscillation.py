"""What is read off an oscillation: its swings, how they grow or decay, and its period."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.loop.hermite import HermiteCurves
from looplab.engine.systems.polynomial import FloatArray

# Swings below this part of the curve's range are rounding.
_SMALLEST = 1e-7
FEWEST_SWINGS = 6


@dataclass(frozen=True)
class Oscillation:
    """Turning points of a curve, and what they tell.

    Attributes
    ----------
    t, y : ndarray, shape (k,)
        Turning points, high and low by turns [time, output].
    growth : float or None
        Change of ln(swing) in one period, by a line through the later half of the swings: 0 goes on for ever, below
        decays; None where there are too few swings.
    Pu : float or None
        Period, over the later half [time].
    """

    t: FloatArray
    y: FloatArray
    growth: float | None
    Pu: float | None

    @property
    def decay_ratio(self) -> float | None:
        """Each swing over the one a period before."""
        return None if self.growth is None else float(np.exp(self.growth))


def oscillation(t: FloatArray, y: FloatArray, dy: FloatArray, noise: float = 0.0) -> Oscillation:
    r"""Turning points of a sampled curve with known slopes, and the growth of its swings.

    .. math:: g = 2\,\frac{d \ln|y_{k+1} - y_k|}{dk}

    From one turning point to the next the final value does not count, so it need not be known.

    Parameters
    ----------
    t, y, dy : ndarray, shape (n,)
        [time, output, output/time]
    noise : float
        Swings below this are an integrator's errors, and do not count [output].

    Returns
    -------
    Oscillation

    References
    ----------
    .. [1] D. E. Seborg, T. F. Edgar, D. A. Mellichamp, F. J. Doyle, Process Dynamics and Control, 3rd ed., Wiley 2011,
       sec. 12.5 (continuous cycling).
    """
    times, values = HermiteCurves(t, y[None], dy[None]).extrema(0)
    swings = np.abs(np.diff(values))
    if swings.size:
        largest = int(swings.argmax())
        small = np.flatnonzero(swings < max(_SMALLEST * float(np.ptp(y)), noise))
        # What goes before the output moves, and what a decay ends in.
        start = int(small[small <= largest].max(initial=-1)) + 1
        end = int(small[small >= largest].min(initial=swings.size))
        swings, times, values = swings[start:end], times[start : end + 1], values[start : end + 1]
    if swings.size < FEWEST_SWINGS or not swings.all():
        return Oscillation(times, values, None, None)
    late = swings.size // 2
    growth = 2.0 * float(np.polyfit(np.arange(swings.size - late), np.log(swings[late:]), 1)[0])
    half = np.diff(times)[late:]
    whole = half[: 2 * (half.size // 2)]
    return Oscillation(times, values, growth, 2.0 * float(whole.mean()) if whole.size else 2.0 * float(half.mean()))
