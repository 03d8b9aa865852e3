"""The best PID settings within a limit of robustness: smallest IAE, ISE or ITAE with Ms and Mt no larger than asked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import product

import numpy as np

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.frequency import margins
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.comparison import judge_step
from looplab.engine.tuning.loop_family import ALPHA, Aim, Criterion, FloatArray, LoopFamily
from looplab.engine.tuning.settings import TypeName

SMALLEST_LIMIT, LARGEST_LIMIT = 1.05, 4.0
# Rounds of the zoom and how much of the box each keeps; points per direction (times, then gain).
ROUNDS, ROUNDS_NEAR, KEEP = 13, 8, 0.45
# Half a box, in logarithms, around settings that are close already.
NEAR = 0.7
# A share of the range of gains from which on the limit is what holds.
ON_LIMIT = 1.0 - 1e-3
TRIES = 6
GAINS = 400
# Crossover frequencies times the plant's time scale beyond which the model is not to be trusted.
FASTEST = 8.0
OFFSET = "grows with the horizon: without integral action an offset remains; this is the largest gain allowed"
COARSE = {"PI": (25, 7), "PD": (25, 7), "PID": (13, 11, 4)}
FINE = {"PI": (7, 5), "PD": (7, 5), "PID": (5, 5, 3)}
# Times searched, over the plant's time scale.
INTEGRAL_RANGE, DERIVATIVE_RANGE = (0.1, 100.0), (0.03, 10.0)
SMALLEST_SHARE = 0.05
POINTS = 1600


@dataclass(frozen=True)
class OptimalTuning:
    """Settings that are best by one criterion within the limits.

    Attributes
    ----------
    type : str
        P, PI, PD or PID.
    controller : PID
        Ideal form.
    criterion, aim : str
        What was minimised, after a step of what.
    value : float or None
        The criterion, from the exact response; None (with a reason) where an offset remains.
    Ms, Mt : float
        Of the loop.
    active : tuple of str
        The limits that the loop lies on.
    edges : tuple of str
        Settings that ended on an edge of the box that was searched: outside it there may be better ones.
    reasons : dict
        Why ``value`` is None.
    """

    type: TypeName
    controller: PID
    criterion: Criterion
    aim: Aim
    value: float | None
    Ms: float
    Mt: float
    active: tuple[str, ...]
    edges: tuple[str, ...]
    reasons: dict[str, str] = field(default_factory=dict)


class _Search:
    """The box of one type of controller: logarithms of its times, and the share of the range of gains."""

    def __init__(self, family: LoopFamily, type: TypeName, Ms: float, Mt: float | None) -> None:
        self.family, self.type, self.Ms, self.Mt = family, type, Ms, Mt
        P = family.plant
        lags = sum(1.0 / abs(p) for p in P.poles if p != 0) + P.theta
        names = [n for n, letter in (("tau_I", "I"), ("tau_D", "D")) if letter in type]
        box = {
            "tau_I": (INTEGRAL_RANGE[0], max(INTEGRAL_RANGE[1], 3.0 * lags / family.scale)),
            "tau_D": DERIVATIVE_RANGE,
        }
        self.names = names
        self.low = np.log([box[n][0] * family.scale for n in names])
        self.high = np.log([box[n][1] * family.scale for n in names])

    def times(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """tau_I and tau_D of points of the box, shape (m, names)."""
        columns = dict(zip(self.names, np.exp(x).T, strict=True))
        return columns.get("tau_I", np.full(len(x), np.inf)), columns.get("tau_D", np.zeros(len(x)))

    def best(self, criterion: Criterion, aim: Aim, near: PID | None) -> tuple[FloatArray, float]:
        """Zoom in on the smallest cost: point of the box (times, then share), and that cost."""
        low, high = np.append(self.low, SMALLEST_SHARE), np.append(self.high, 1.0)
        if near is None:
            point, cost = self._grid(low, high, COARSE[self.type], criterion, aim)
            if not np.isfinite(cost):
                return point, cost
            half = 1.5 * (high - low) / (np.array(COARSE[self.type]) - 1)
        else:
            start = [np.log(getattr(near, n) or np.nan) for n in self.names]
            point, cost = np.array([*start, 1.0]), np.inf
            half = np.append(np.full(len(start), NEAR), 1.0 - SMALLEST_SHARE)
        for _ in range(ROUNDS if near is None else ROUNDS_NEAR):
            a, b = np.maximum(low, point - half), np.minimum(high, point + half)
            found, value = self._grid(a, b, FINE[self.type], criterion, aim)
            if value < cost:
                point, cost = found, value
            if not np.isfinite(cost):
                break
            half *= KEEP
        return point, cost

    def _grid(
        self, a: FloatArray, b: FloatArray, points: Sequence[int], criterion: Criterion, aim: Aim
    ) -> tuple[FloatArray, float]:
        axes = [np.linspace(p, q, n) for p, q, n in zip(a, b, points, strict=True)]
        times = np.array(list(product(*axes[:-1])))
        lowest, highest = self.family.windows(*self.times(times), self.Ms, self.Mt)
        if np.isinf(highest).any():
            raise RuleNotApplicable(
                "the loop keeps within the limit at any gain, so that no gain is the best one",
                field="plant",
                hint="give the plant the dead time or the further lag that a real one has",
            )
        x = np.array([[*t, share] for t in times for share in axes[-1]])
        lowest, highest = (np.repeat(v, len(axes[-1])) for v in (lowest, highest))
        ok = np.isfinite(highest)
        if not ok.any():
            return np.full(len(axes), np.nan), np.inf
        x, Kc = x[ok], (lowest + x[:, -1] * (highest - lowest))[ok]
        costs = self.family.costs(Kc, *self.times(x[:, :-1]), criterion, aim)
        i = int(np.argmin(costs))
        return x[i], float(costs[i])

    def edges(self, point: FloatArray) -> tuple[str, ...]:
        """Names of the times at an end of their range."""
        near = 1e-3 * (self.high - self.low)
        return tuple(
            n
            for n, x, low, high, d in zip(self.names, point, self.low, self.high, near, strict=False)
            if x < low + d or x > high - d
        )


def _on_limit(plant: TransferFunction, shape: PID, Kc: float, Ms: float, Mt: float | None, inward: bool) -> float:
    """The gain near Kc at which the exact loop meets the limits: raised to them, or only lowered (inward)."""

    def excess(factor: float) -> float:
        C = PID(Kc * factor, shape.tau_I, shape.tau_D, ALPHA).to_transfer_function()
        found = margins(C * plant)
        if not found.closed_loop_stable or found.Ms is None or found.Mt is None:
            return 1.0
        return max(found.Ms / Ms, found.Mt / Mt if Mt is not None else 0.0) - 1.0

    here = excess(1.0)
    if inward and here <= 0:
        return Kc
    low = high = 1.0
    f_low = f_high = here
    step = 1e-3
    while not f_low <= 0 < f_high:
        if step > 0.3:
            return Kc * low if f_low <= 0 else Kc
        if here > 0:
            low *= 1.0 - step
            f_low = excess(low)
        else:
            high *= 1.0 + step
            f_high = excess(high)
        step *= 2.0
    for i in range(40):
        # False position, with a bisection now and then; the inner end is kept.
        middle = low - f_low * (high - low) / (f_high - f_low) if i % 3 < 2 else 0.5 * (low + high)
        value = excess(middle)
        low, f_low, high, f_high = (middle, value, high, f_high) if value <= 0 else (low, f_low, middle, value)
        if f_low > -1e-9 or high - low < 1e-13:
            break
    return Kc * low


def _check(type: TypeName, Ms: float, Mt: float | None) -> None:
    for name, value in (("Ms", Ms), ("Mt", Mt)):
        if value is not None and not SMALLEST_LIMIT <= value <= LARGEST_LIMIT:
            raise InvalidInput(
                f"the limit of {name} must be from {SMALLEST_LIMIT:g} to {LARGEST_LIMIT:g}",
                field=f"{name}_limit",
                hint="1.4 is robust, 2 is fast",
            )
    if type not in ("P", "PI", "PID"):
        raise InvalidInput("the type must be P, PI or PID", field="type")


@lru_cache(maxsize=32)
def optimal_tuning(
    plant: TransferFunction,
    type: TypeName = "PI",
    criterion: Criterion = "IAE",
    aim: Aim = "load",
    Ms: float = 1.6,
    Mt: float | None = None,
    near: PID | None = None,
) -> OptimalTuning:
    r"""Minimise an integral of the error after a step, with bounded sensitivity.

    .. math::

        \min_{K_c, \tau_I, \tau_D} \int_0^\infty |e|\,dt \ \text{ (or } e^2,\ t|e|\text{)}, \qquad
        \max_\omega |S| \le M_s, \quad \max_\omega |T| \le M_t

    For each pair of times the gains within the limits are an interval in closed form; the cost is mapped over the box
    of times and shares of that interval, and the box shrinks around the best point 13 times. Limits, criterion and
    stability of the result are then those of the exact loop.

    Parameters
    ----------
    plant : TransferFunction
        Proper, dead time exact; integrating and unstable ones too.
    type : {"P", "PI", "PID"}
        Ideal form, derivative filtered with alpha = 0.1. For P the largest gain within the limits (the smallest
        offset), unless the error vanishes without integral action.
    criterion : {"IAE", "ISE", "ITAE"}
    aim : {"load", "setpoint"}
        A unit step at the plant's input, or of the setpoint.
    Ms, Mt : float or None
        Limits, 1.05 to 4; None for none [-].
    near : PID or None
        Settings close to which the best ones are expected: the search then starts there.

    Returns
    -------
    OptimalTuning

    Raises
    ------
    InvalidInput
        A limit or the type is outside its range.
    ImproperSystem
        The plant has more zeros than poles.
    RuleNotApplicable
        No such controller keeps within the limits, or every gain does.

    References
    ----------
    .. [1] K. J. Åström, H. Panagopoulos, T. Hägglund, Automatica 34 (1998) 585-601.
    .. [2] O. Garpinger, T. Hägglund, K. J. Åström, J. Process Control 24 (2014) 568-577 (IAE with Ms = Mt limits).
    """
    _check(type, Ms, Mt)
    family = LoopFamily(plant)
    aimed_Ms, aimed_Mt = Ms, Mt
    for _ in range(TRIES):
        found = _candidate(family, type, criterion, aim, aimed_Ms, aimed_Mt, near)
        gain = _on_limit(plant, found.shape, family.sign * found.gain, Ms, Mt, inward=not found.on_limit)
        controller = PID(gain, found.shape.tau_I, found.shape.tau_D, ALPHA)
        result = _judge(family, controller, type, criterion, aim, (Ms, Mt), found.edges)
        if result is not None:
            return result
        # The grid of frequencies passed over a peak: aim a little lower.
        aimed_Ms, aimed_Mt = 1.0 + 0.995 * (aimed_Ms - 1.0), None if aimed_Mt is None else 0.998 * aimed_Mt
    raise _refusal(type)


def _refusal(type: TypeName) -> RuleNotApplicable:
    return RuleNotApplicable(
        f"no {type} controller keeps this plant stable within the limits",
        field="Ms_limit",
        hint="allow a larger Ms, or choose another type of controller",
    )


@dataclass(frozen=True)
class _Candidate:
    """Times (as a controller of unit gain), size of the gain, and where it lies in its range."""

    shape: PID
    gain: float
    on_limit: bool
    edges: tuple[str, ...]


def _candidate(
    family: LoopFamily,
    type: TypeName,
    criterion: Criterion,
    aim: Aim,
    Ms: float,
    Mt: float | None,
    near: PID | None,
) -> _Candidate:
    if type == "P":
        gain, share = _best_gain(family, criterion, aim, Ms, Mt)
        return _Candidate(PID(1.0), gain, share > ON_LIMIT, ())
    search = _Search(family, type, Ms, Mt)
    point, cost = search.best(criterion, aim, near)
    if not np.isfinite(cost):
        raise _refusal(type)
    tau_I, tau_D = search.times(point[None, :-1])
    low, high = family.windows(tau_I, tau_D, Ms, Mt)
    gain = float(low[0] + point[-1] * (high[0] - low[0]))
    shape = PID(1.0, float(tau_I[0]), float(tau_D[0]) or None, ALPHA)
    return _Candidate(shape, gain, bool(point[-1] > ON_LIMIT), search.edges(point))


def _offset_remains(plant: TransferFunction, type: TypeName, aim: Aim) -> bool:
    return type == "P" and not (aim == "setpoint" and plant.origin_order > 0)


def _best_gain(family: LoopFamily, criterion: Criterion, aim: Aim, Ms: float, Mt: float | None) -> tuple[float, float]:
    """Gain of a P controller and its share of the range: the best by the criterion, else the largest."""
    low, high = (float(v[0]) for v in family.windows(np.array([np.inf]), np.array([0.0]), Ms, Mt))
    if not np.isfinite(high):
        why = "keeps within the limits at any gain" if np.isinf(high) else "is not kept within the limits by any gain"
        raise RuleNotApplicable(f"under proportional control this plant {why}", field="plant")
    if _offset_remains(family.plant, "P", aim):
        return high, 1.0
    shares = np.linspace(SMALLEST_SHARE, 1.0, GAINS)
    gains = low + shares * (high - low)
    costs = family.costs(gains, np.full(GAINS, np.inf), np.zeros(GAINS), criterion, "setpoint")
    i = int(np.argmin(costs))
    return float(gains[i]), float(shares[i])


def _judge(
    family: LoopFamily,
    controller: PID,
    type: TypeName,
    criterion: Criterion,
    aim: Aim,
    limits: tuple[float, float | None],
    edges: tuple[str, ...],
) -> OptimalTuning | None:
    """Everything said of the result, from the exact loop; None where it is not within the limits."""
    loop = FeedbackLoop(family.plant, controller)
    found = margins(loop.open_loop)
    if not found.closed_loop_stable or found.Ms is None or found.Mt is None:
        return None
    if found.omega_c is not None and found.omega_c * family.scale > FASTEST:
        raise RuleNotApplicable(
            "the best loop would be far faster than the plant: nothing in this plant limits its speed",
            field="plant",
            hint="give the plant the dead time or the further lag that a real one has",
        )
    active = []
    for name, peak, limit in zip(("Ms", "Mt"), (found.Ms, found.Mt), limits, strict=True):
        if limit is not None and peak > limit * (1.0 + 1e-9):
            return None
        if limit is not None and peak > limit * (1.0 - 1e-4):
            active.append(name)
    value: float | None = None
    reasons = {"value": OFFSET}
    if not _offset_remains(family.plant, type, aim):
        steps = closed_loop_step(loop, 2.0 * family.horizon, POINTS)
        response, setpoint = (steps.load, 0.0) if aim == "load" else (steps.setpoint, 1.0)
        judged = judge_step(response, setpoint=setpoint, stable=True)
        value = getattr(judged, criterion)
        reasons = {"value": judged.reasons[criterion]} if value is None else {}
    return OptimalTuning(type, controller, criterion, aim, value, found.Ms, found.Mt, tuple(active), edges, reasons)
