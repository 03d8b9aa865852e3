"""Relay feedback: the relay, and what its limit cycle tells of the plant."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.loop.hermite import HermiteCurves
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.tuning.ultimate_point import UltimatePoint, relay_point

_STEADY = 1e-3


@dataclass(frozen=True)
class Relay:
    """u = u0 + d where the error r - y is above the hysteresis, u0 - d where it is below its negative; else as it was.

    Attributes
    ----------
    amplitude : float
        d > 0 [input].
    hysteresis : float
        epsilon >= 0 [output].
    sign : int
        1, or -1 for a plant with negative gain.
    """

    amplitude: float
    hysteresis: float = 0.0
    sign: int = 1

    def __post_init__(self) -> None:
        if not (math.isfinite(self.amplitude) and self.amplitude > 0):
            raise InvalidInput("the relay's amplitude must be positive", field="amplitude")
        if not (math.isfinite(self.hysteresis) and self.hysteresis >= 0):
            raise InvalidInput("the hysteresis must be zero or positive", field="hysteresis")
        if self.sign not in (1, -1):
            raise InvalidInput("sign must be 1 or -1", field="sign")


@dataclass(frozen=True)
class RelayRun:
    """A run under relay feedback.

    Attributes
    ----------
    t, u, y : ndarray, shape (n,)
        In deviation from where it began; the new value of u at a switch [time, input, output].
    switches : ndarray, shape (k,)
        Times at which the relay switched, the first at the start [time].
    swing : float or None
        a: half the height of y over the last period [output].
    Pu : float or None
        The last period [time].
    point : UltimatePoint or None
        Estimated by the describing function.
    reason : str or None
        Why there is no estimate.
    """

    t: FloatArray
    u: FloatArray
    y: FloatArray
    switches: FloatArray
    swing: float | None
    Pu: float | None
    point: UltimatePoint | None
    reason: str | None


def limit_cycle(
    relay: Relay,
    t: FloatArray,
    u: FloatArray,
    y: FloatArray,
    dy: FloatArray,
    switches: FloatArray,
    reason: str | None = None,
) -> RelayRun:
    r"""Swing and period of the last two periods, and the ultimate point they stand for.

    .. math:: K_u \approx \frac{4 d}{\pi \sqrt{a^2 - \varepsilon^2}}

    The describing function takes y for a sine, which it is not quite: with much dead time or a first-order plant the
    gain may be off by a fifth and more.

    Parameters
    ----------
    relay : Relay
    t, u, y, dy : ndarray, shape (n,)
        Signals in deviation, and the slope of y.
    switches : ndarray, shape (k,)
    reason : str or None
        Why the run was cut, where it was.

    Returns
    -------
    RelayRun
        No estimate, with the reason, where the cycle is not steady.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, Automatica 20 (1984) 645-651.
    """
    if reason is not None or switches.size < 5:
        return RelayRun(
            t, u, y, switches, None, None, None, reason or "the relay has not switched often enough for a cycle"
        )
    Pu, before = float(switches[-1] - switches[-3]), float(switches[-3] - switches[-5])
    swing, swing_before = (
        _half_height(t, y, dy, a, b) for a, b in zip(switches[[-3, -5]], switches[[-1, -3]], strict=True)
    )
    if max(abs(Pu / before - 1.0), abs(swing / swing_before - 1.0)) > _STEADY:
        return RelayRun(t, u, y, switches, swing, Pu, None, "the cycle is not steady yet: the last two periods differ")
    try:
        point = relay_point(relay.amplitude, swing, Pu, relay.hysteresis)
    except EngineError as error:
        return RelayRun(t, u, y, switches, swing, Pu, None, error.message)
    point = UltimatePoint.of(relay.sign * point.Ku, Pu)
    return RelayRun(t, u, y, switches, swing, Pu, point, None)


def _half_height(t: FloatArray, y: FloatArray, dy: FloatArray, start: float, end: float) -> float:
    """Half of highest less lowest, with the tops between the samples."""
    k = np.flatnonzero((t >= start) & (t <= end))
    k = k[np.append(True, np.diff(t[k]) > 0)]
    _, tops = HermiteCurves(t[k], y[None, k], dy[None, k]).extrema(0)
    every = np.append(y[k], tops)
    return 0.5 * float(np.ptp(every))
