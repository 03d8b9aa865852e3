"""What becomes of a loop when gain, time constants and dead time of the plant are not what they were thought to be."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.comparison import ComparedLoop, compare

FloatArray = npt.NDArray[np.float64]
LARGEST_SPREAD = 90.0


def perturbed_plant(plant: TransferFunction, K: float, tau: float, theta: float) -> TransferFunction:
    r"""The plant with its gain, all its time constants and its dead time multiplied by factors.

    .. math:: G(s) \to k_K\, G_0(k_\tau s)\, e^{-k_\theta \theta s}

    with the steady-state gain (of an integrating plant: the slope) changed by k_K alone.

    Parameters
    ----------
    plant : TransferFunction
    K, tau, theta : float
        Factors, K not zero, tau > 0, theta >= 0 [-].

    Returns
    -------
    TransferFunction

    Raises
    ------
    InvalidInput
        A factor is outside its range.

    References
    ----------
    .. [1] M. Morari, E. Zafiriou, Robust Process Control, Prentice Hall 1989, sec. 2.2 (parametric uncertainty).
    """
    if not (np.isfinite(K) and K != 0 and np.isfinite(tau) and tau > 0 and np.isfinite(theta) and theta >= 0):
        raise InvalidInput("factors of the plant must be positive numbers", field="spread_pct")
    moved = int(np.count_nonzero(plant.poles)) - int(np.count_nonzero(plant.zeros))
    return TransferFunction(plant.zeros / tau, plant.poles / tau, K * plant.gain / tau**moved, plant.theta * theta)


@dataclass(frozen=True)
class Case:
    """One plant of the spread: factors of gain, time constants and dead time, and what the loop does on it."""

    K: float
    tau: float
    theta: float
    loop: ComparedLoop


@dataclass(frozen=True)
class Band:
    """Lowest and highest y over the stable cases at each t; arrays of one shape."""

    low: FloatArray
    high: FloatArray


@dataclass(frozen=True)
class Sensitivity:
    """The loop over the spread.

    Attributes
    ----------
    t : ndarray
        Common times of the bands [time].
    cases : tuple of Case
        Everything that was looked at, the nominal plant first.
    unstable : tuple of Case
        Those on which the loop is not stable.
    worst_Ms, worst_IAE : Case or None
        Largest Ms, and largest IAE after a load step, over the stable cases; None where no case is stable.
    setpoint, load : Band or None
        Envelopes of y over the stable cases.
    """

    t: FloatArray
    cases: tuple[Case, ...]
    unstable: tuple[Case, ...]
    worst_Ms: Case | None
    worst_IAE: Case | None
    setpoint: Band | None
    load: Band | None


def sensitivity(
    plant: TransferFunction, controller: PID, spread_pct: float, horizon: float, points: int = 200
) -> Sensitivity:
    """Try every corner of -p and +p percent in gain, time constants and dead time, and the plant itself.

    Parameters
    ----------
    plant : TransferFunction
        Proper, dead time exact: the nominal plant.
    controller : PID
    spread_pct : float
        p, above 0 and up to 90 [%].
    horizon : float
        Length of the responses [time].
    points : int
        Samples of the bands, 20 to 5000.

    Returns
    -------
    Sensitivity
        9 cases, 5 where the plant has no dead time. The band is that of these cases, not of all between.

    Raises
    ------
    InvalidInput
        The spread is outside its range.
    """
    if not 0 < spread_pct <= LARGEST_SPREAD:
        raise InvalidInput(f"the spread must be above 0 and up to {LARGEST_SPREAD:g} %", field="spread_pct")
    p = spread_pct / 100.0
    levels = (1.0 - p, 1.0 + p)
    moves = bool(np.count_nonzero(plant.poles) + np.count_nonzero(plant.zeros))
    corners = product(levels, levels if moves else (1.0,), levels if plant.theta else (1.0,))
    cases = []
    for K, tau, theta in ((1.0, 1.0, 1.0), *corners):
        [loop] = compare(perturbed_plant(plant, K, tau, theta), [controller], horizon, points)
        cases.append(Case(K, tau, theta, loop))
    stable = [c for c in cases if c.loop.margins.closed_loop_stable]
    t = np.linspace(0.0, horizon, points)
    return Sensitivity(
        t,
        tuple(cases),
        tuple(c for c in cases if not c.loop.margins.closed_loop_stable),
        max(stable, key=lambda c: c.loop.margins.Ms or 0.0, default=None),
        max(stable, key=lambda c: c.loop.load.IAE or 0.0, default=None),
        _band(t, [(c.loop.steps.t, c.loop.steps.setpoint.y) for c in stable]),
        _band(t, [(c.loop.steps.t, c.loop.steps.load.y) for c in stable]),
    )


def _band(t: FloatArray, curves: list[tuple[FloatArray, FloatArray]]) -> Band | None:
    if not curves:
        return None
    y = np.array([np.interp(t, at[: values.size], values) for at, values in curves])
    return Band(y.min(axis=0), y.max(axis=0))
