"""The ultimate cycle of a linear plant: proportional control with a given gain, and the search for Ku."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import NoConvergence, RuleNotApplicable
from looplab.engine.experiments.gain_search import GainSearch, search_ultimate_gain
from looplab.engine.experiments.oscillation import FEWEST_SWINGS, Oscillation, oscillation
from looplab.engine.loop import FeedbackLoop, Response, closed_loop_step, default_horizon
from looplab.engine.stability.gain_ranges import GainRange, gain_ranges
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.ultimate_point import UltimatePoint, stabilising_sign, ultimate_point

_POINTS = 2000
_MOST_SWINGS = 60
_FEW_SWINGS = 16
_LENGTHENINGS = 5


@dataclass(frozen=True)
class Ringing:
    """A closed-loop run with a proportional controller, after a unit step of the setpoint."""

    Kc: float
    horizon: float
    response: Response
    oscillation: Oscillation


def ring(plant: TransferFunction, Kc: float, horizon: float | None = None, points: int = _POINTS) -> Ringing:
    """Exact response of u = Kc (r - y) to a unit step of r, and what its swings tell.

    Parameters
    ----------
    plant : TransferFunction
    Kc : float
        [input/output]
    horizon : float or None
        None: from 16 to 60 swings, where there are so many [time].
    points : int

    Returns
    -------
    Ringing

    Raises
    ------
    ImproperSystem, InvalidInput, IllPosedLoop
    """
    loop = FeedbackLoop(plant, TransferFunction((), (), Kc))
    length = horizon or default_horizon(loop)
    for _ in range(_LENGTHENINGS):
        response = closed_loop_step(loop, length, points).setpoint
        found = oscillation(response.t[: response.y.size], response.y, response.dy)
        if horizon is not None or response.truncated_at is not None:
            break
        if found.t.size > _MOST_SWINGS:
            length *= max(0.5 * _MOST_SWINGS / found.t.size, 0.05)
        elif FEWEST_SWINGS <= found.t.size < _FEW_SWINGS and found.t[-1] > 0.6 * length:
            length *= 2.0
        else:
            break
    return Ringing(Kc, length, response, found)


@dataclass(frozen=True)
class UltimateCycle:
    """The searched ultimate point, the exact one beside it, and the run at the searched gain.

    Attributes
    ----------
    found : GainSearch
    exact : UltimatePoint
        From the frequency response.
    window : GainRange
        The stable gains that the search began in.
    ringing : Ringing
        At Ku.
    """

    found: GainSearch
    exact: UltimatePoint
    window: GainRange
    ringing: Ringing


def stable_window(plant: TransferFunction) -> GainRange:
    """The stable range of gains that ends in an oscillation, in size; the gain has the sign of ``stabilising_sign``.

    Raises
    ------
    RuleNotApplicable
        There is none, with the reason.
    """
    point = ultimate_point(plant)
    sign = stabilising_sign(plant)
    for found in gain_ranges(plant * sign).ranges:
        if found.high.K is not None and abs(found.high.K - abs(point.Ku)) < 1e-6 * abs(point.Ku):
            return found
    raise RuleNotApplicable("no range of stable gains ends in an oscillation", field="plant")


def ultimate_cycle(plant: TransferFunction) -> UltimateCycle:
    r"""Ultimate gain and period by experiment: from responses alone, beginning inside the stable range.

    .. math:: K_u:\ \frac{|y_{k+1} - y_k|}{|y_{k-1} - y_{k-2}|} \to 1

    Parameters
    ----------
    plant : TransferFunction

    Returns
    -------
    UltimateCycle

    Raises
    ------
    RuleNotApplicable
        The plant has no ultimate gain, or no gain holds it, with the reason.
    NoConvergence
        The responses do not show it.

    References
    ----------
    .. [1] J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768.
    """
    if plant.relative_degree < 1:
        raise RuleNotApplicable(
            "the plant passes its input on at once, so that the loop's swings are jumps",
            field="plant",
            hint="give it a lag",
        )
    exact = ultimate_point(plant)
    sign = stabilising_sign(plant)
    window = stable_window(plant)
    low, high = window.low.K or 0.0, window.high.K
    assert high is not None
    start = sign * (1.05 * low if 1.05 * low < high else float(np.sqrt(low * high)))
    if not low:
        start = sign * _first_gain(plant, high)
    found = search_ultimate_gain(lambda Kc: ring(plant, Kc).oscillation, start)
    if abs(found.Ku / exact.Ku - 1.0) > 0.5:
        raise NoConvergence(
            f"the responses point to {found.Ku:.4g}, but the stable gains end at {exact.Ku:.4g}: other modes hide "
            "the oscillation",
            field="plant",
        )
    return UltimateCycle(found, exact, window, ring(plant, found.Ku))


def _first_gain(plant: TransferFunction, high: float) -> float:
    """A tenth of 1/|P(0)|, as one who knows the plant's gain would begin; else a small part of the range."""
    K = abs(plant.dc_gain)
    return min(0.1 / K, 0.5 * high) if np.isfinite(K) and K > 0 else 0.03 * high
