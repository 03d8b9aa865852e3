"""The ultimate gain by experiment: raise the gain until the oscillation grows, then halve the bracket."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from looplab.engine.errors import NoConvergence
from looplab.engine.experiments.oscillation import Oscillation

_DOUBLINGS = 40
_HALVINGS = 40
_CLOSE = 1e-3


@dataclass(frozen=True)
class Trial:
    """One run of the search: its gain, and the growth of ln(swing) in a period; None where it died out."""

    Kc: float
    growth: float | None
    Pu: float | None


@dataclass(frozen=True)
class GainSearch:
    """What the search found.

    Attributes
    ----------
    Ku : float
        [input/output]
    Pu : float
        [time]
    trials : tuple of Trial
        In the order in which they were run.
    """

    Ku: float
    Pu: float
    trials: tuple[Trial, ...]


def search_ultimate_gain(run: Callable[[float], Oscillation], start: float, doublings: int = _DOUBLINGS) -> GainSearch:
    """Gain at which the swings neither grow nor decay.

    The gain is doubled from ``start`` until the swings grow. What was doubled to is no estimate: it may be twice too
    large. The bracket is halved, in ratio, until it is narrower than 0.1 %, or the growths at its ends tell where
    between them the growth is zero.

    Parameters
    ----------
    run : callable
        Gain -> the oscillation that a loop with this gain answers with.
    start : float
        A gain, with its sign, at which the swings decay.
    doublings : int
        How often the gain is doubled at most.

    Returns
    -------
    GainSearch

    Raises
    ------
    NoConvergence
        The swings never grow, or already do at the start.
    """
    trials: list[Trial] = []

    def growth(Kc: float) -> float:
        found = run(Kc)
        trials.append(Trial(Kc, found.growth, found.Pu))
        return -math.inf if found.growth is None else found.growth

    low, high = start, start
    g_low = g_high = growth(start)
    if g_low > 0:
        raise NoConvergence("the loop already runs away at the gain that the search began with", field="Kc")
    for _ in range(doublings):
        high = 2.0 * low
        g_high = growth(high)
        if g_high > 0:
            break
        low, g_low = high, g_high
    else:
        raise NoConvergence("the loop does not begin to oscillate, however large the gain", field="Kc")
    for _ in range(_HALVINGS):
        if high / low - 1.0 < _CLOSE:
            break
        middle = math.copysign(math.sqrt(low * high), low)
        if math.isfinite(g_low) and math.isfinite(g_high):
            # Where the line through both growths meets zero, kept off the ends so that the bracket does shrink.
            share = min(max(-g_low / (g_high - g_low), 0.02), 0.98)
            middle = low * (high / low) ** share
        g = growth(middle)
        if abs(g) < 1e-6:
            low = high = middle
            break
        low, high, g_low, g_high = (middle, high, g, g_high) if g <= 0 else (low, middle, g_low, g)
    share = 0.5
    if math.isfinite(g_low) and math.isfinite(g_high) and high != low:
        share = -g_low / (g_high - g_low)
    Ku = low * (high / low) ** share
    nearest = min(
        (trial for trial in trials if trial.Pu is not None and trial.growth is not None),
        key=lambda trial: abs(trial.growth or 0.0),
    )
    assert nearest.Pu is not None
    return GainSearch(Ku, nearest.Pu, tuple(trials))
