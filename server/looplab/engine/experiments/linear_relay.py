"""Relay feedback around a linear plant with dead time: exact from switch to switch."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.experiments.relay import Relay, RelayRun, limit_cycle
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.ultimate_point import ultimate_point

_PER_PERIOD = 200
_MOST_STEPS = 20_000
_RUNAWAY = 1e3
_ALIKE = 1e-5
# The relay is held on at first, so that the cycle begins large.
_HELD = 0.25


def _period(plant: TransferFunction, relay: Relay) -> float:
    """About how long a period will last, for the choice of the step [time].

    Raises
    ------
    RuleNotApplicable
        Without hysteresis the relay would switch without end.
    """
    try:
        return ultimate_point(plant).Pu
    except RuleNotApplicable as error:
        if not relay.hysteresis:
            raise RuleNotApplicable(
                f"{error.message}; the relay would switch without end",
                field="plant",
                hint="give the relay some hysteresis, or the plant the dead time that it really has",
            ) from None
        lags = -1.0 / plant.poles.real[plant.poles.real < 0]
        return float(4.0 * lags.max()) if lags.size else max(plant.theta, 1.0)


class _Piece:
    """The rational part under u = +-d held: steps of h and of any part of it."""

    def __init__(self, plant: TransferFunction, d: float) -> None:
        ss = realize(plant)
        n = ss.B.size
        self.M = np.zeros((n + 1, n + 1))
        self.M[:n, :n], self.M[:n, n] = ss.A, ss.B * d
        self.row = np.append(ss.C, ss.D * d)
        self.slope = self.row @ self.M

    def over(self, dt: float) -> FloatArray:
        """The transition over dt."""
        return expm(self.M * dt)


def linear_relay(plant: TransferFunction, relay: Relay, periods: int = 12) -> RelayRun:
    """Run a relay against a plant at rest until the cycle is steady; every switch is found to rounding.

    Parameters
    ----------
    plant : TransferFunction
        Strictly proper.
    relay : Relay
    periods : int
        The fewest that are run; more until two in a row are alike, within 20000 steps of a two hundredth.

    Returns
    -------
    RelayRun
        Cut, with the reason, where the output runs away.

    Raises
    ------
    InvalidInput
        The plant passes its input on at once.
    RuleNotApplicable
        The relay would switch without end.
    """
    if plant.relative_degree < 1:
        raise InvalidInput(
            "the plant passes its input on at once: the relay would switch without end",
            field="plant",
            hint="give it a lag",
        )
    sign = relay.sign
    period = _period(plant, relay)
    h, held = period / _PER_PERIOD, _HELD * period + plant.theta
    pieces = {s: _Piece(plant, s * relay.amplitude) for s in (1, -1)}
    steps = {s: piece.over(h) for s, piece in pieces.items()}
    x = np.zeros(plant.order + 1)
    x[-1] = 1.0
    # What the plant sees is the relay's output the dead time ago: pending holds the switches on their way.
    at, seen, out = 0.0, 0, 1
    pending: list[tuple[float, int]] = [(plant.theta, 1)]
    t, u, y, dy, switches = [0.0], [float(relay.amplitude)], [0.0], [0.0], [0.0]
    reason, largest, held_within = None, 0.0, np.inf
    while not _settled(switches, periods) and len(t) < _MOST_STEPS:
        dt, arrives = h, bool(pending) and pending[0][0] <= at + h
        if arrives:
            dt = max(pending[0][0] - at, 0.0)
        new = x
        if seen:
            piece = pieces[seen]
            new = (steps[seen] if dt == h else piece.over(dt)) @ x if dt else x
            level = -sign * out * relay.hysteresis
            crossed = _crossing(piece, x, new, dt, level, sign * out) if at >= held else None
            if crossed is not None:
                dt, new, arrives = crossed[0], crossed[1], False
                out = -out
                switches.append(at + dt)
                pending.append((at + dt + plant.theta, out))
        at, x = at + dt, new
        if arrives or (pending and pending[0][0] <= at):
            seen = pending.pop(0)[1]
        if seen:
            t.append(at)
            u.append(out * relay.amplitude)
            y.append(float(pieces[seen].row @ x))
            dy.append(float(pieces[seen].slope @ x))
            if at == switches[-1]:
                held_within = largest
            largest = max(largest, abs(y[-1]))
            if len(switches) > 2 and not abs(y[-1]) < _RUNAWAY * held_within:
                reason = "the output runs away: a relay of this size does not hold the plant"
                break
        else:
            t.append(at)
            u.append(out * relay.amplitude)
            y.append(0.0)
            dy.append(0.0)
    return limit_cycle(relay, np.array(t), np.array(u), np.array(y), np.array(dy), np.array(switches), reason)


def _settled(switches: list[float], periods: int) -> bool:
    if len(switches) <= 2 * periods:
        return False
    last, before = switches[-1] - switches[-3], switches[-3] - switches[-5]
    return abs(last - before) < _ALIKE * last


def _crossing(
    piece: _Piece, x: FloatArray, new: FloatArray, dt: float, level: float, way: int
) -> tuple[float, FloatArray] | None:
    """When y has passed the level that makes the relay switch, within a step, and the state then; None if it has not.

    While the relay's output pushes y one way (``way`` is the side of the error), it switches as y leaves by the other.
    """
    before, after = way * float(piece.row @ x) + way * level, way * float(piece.row @ new) + way * level
    if not (after > 0 and dt > 0):
        return None
    if before >= 0:
        return (0.0, x) if way * float(piece.slope @ x) > 0 else None
    low, high = 0.0, dt
    s = dt * before / (before - after)
    state = x
    for _ in range(60):
        state = piece.over(s) @ x
        value = way * float(piece.row @ state) + way * level
        low, high = (s, high) if value < 0 else (low, s)
        slope = way * float(piece.slope @ state)
        following = s - value / slope if slope else 0.5 * (low + high)
        if not low < following < high:
            following = 0.5 * (low + high)
        if abs(following - s) <= 1e-15 * dt:
            break
        s = following
    return s, state
