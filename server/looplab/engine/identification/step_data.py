"""What the graphical methods read off a record: the step, the levels before and after it, and a smooth curve."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.identification.record import Record
from looplab.engine.systems.polynomial import FloatArray

# The input may wander by this part of its step on either side of it.
_FLAT = 0.05
_TAIL = 0.1
_FEWEST = 5
# Where the rise begins and by when it has been steepest, as parts of the change.
_STARTED, _RISEN = 0.05, 0.632
# Sample and neighbour pairs that are smoothed at once.
_AT_ONCE = 200_000
_HANKEL = np.add.outer(np.arange(3), np.arange(3))


@dataclass(frozen=True)
class Choices:
    """What the caller may set by hand; None is found from the data.

    Attributes
    ----------
    y0, y_final : float or None
        Levels before the step and after it [output].
    window : float or None
        Width of the smoothing window, 0 for the least [time].
    t_inflection, y_inflection, slope : float or None
        The tangent: where it touches, and its slope [time, output, output/time].
    """

    y0: float | None = None
    y_final: float | None = None
    window: float | None = None
    t_inflection: float | None = None
    y_inflection: float | None = None
    slope: float | None = None


@dataclass(frozen=True)
class StepData:
    """A step test.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times of the samples, from the step on [time].
    y, dy : ndarray, shape (n,)
        Smoothed output and its slope [output, output/time].
    raw : ndarray, shape (n,)
        The samples themselves [output].
    t_step : float
        When the input stepped: the first sample with the new value [time].
    step : float
        [input]
    y0, y_final : float
        [output]
    window : float
        Width of the smoothing window [time].
    notes : tuple of str
    """

    t: FloatArray
    y: FloatArray
    dy: FloatArray
    raw: FloatArray
    t_step: float
    step: float
    y0: float
    y_final: float
    window: float
    notes: tuple[str, ...]

    @property
    def K(self) -> float:
        """Gain [output/input]."""
        return (self.y_final - self.y0) / self.step

    def at(self, t: float) -> tuple[float, float]:
        """Smoothed output and slope at a time.

        Raises
        ------
        InvalidInput
            The time is outside the record.
        """
        if not self.t[0] <= t <= self.t[-1]:
            raise InvalidInput("the time is outside the record after the step", field="t_inflection")
        k = min(int(np.searchsorted(self.t, t, side="right")) - 1, self.t.size - 2)
        h = float(self.t[k + 1] - self.t[k])
        x = (t - float(self.t[k])) / h
        y0, y1, m0, m1 = float(self.y[k]), float(self.y[k + 1]), float(self.dy[k]) * h, float(self.dy[k + 1]) * h
        c, d = 3.0 * (y1 - y0) - 2.0 * m0 - m1, m0 + m1 - 2.0 * (y1 - y0)
        return y0 + x * (m0 + x * (c + x * d)), (m0 + x * (2.0 * c + 3.0 * x * d)) / h

    def steepest(self) -> float:
        """Where the curve rises fastest on its way to 63.2 %: neither its flat ends nor their noise count [time]."""
        z = (self.y - self.y0) / (self.y_final - self.y0)
        passed = np.flatnonzero(z >= _RISEN)
        end = int(passed[0]) + 1 if passed.size else z.size
        flat = np.flatnonzero(z[:end] <= _STARTED)
        begin = float(self.t[flat[-1]]) - 0.5 * self.window if flat.size else float(self.t[0])
        first = max(int(np.searchsorted(self.t, begin)) - _FEWEST // 2, 0)
        way = float(np.sign(self.y_final - self.y0))
        return float(self.t[first + int(np.argmax(way * self.dy[first:end]))])

    def crossing(self, fraction: float) -> float:
        """When the curve first passes a fraction of its way from y0 to y_final, after the step [time].

        Raises
        ------
        RuleNotApplicable
            It never does.
        """
        z = (self.y - self.y0) / (self.y_final - self.y0) - fraction
        above = np.flatnonzero(z >= 0)
        if not above.size:
            raise RuleNotApplicable(
                f"the output never passes {100 * fraction:.1f} % of its change", field="y", hint="check y_final"
            )
        k = int(above[0])
        if k == 0:
            return float(self.t[0]) - self.t_step
        low, high = float(self.t[k - 1]), float(self.t[k])
        for _ in range(60):
            middle = 0.5 * (low + high)
            passed = (self.at(middle)[0] - self.y0) / (self.y_final - self.y0) >= fraction
            low, high = (low, middle) if passed else (middle, high)
        return high - self.t_step


def noise_level(t: FloatArray, y: FloatArray) -> float:
    r"""Standard deviation of the noise, from how far each sample lies off the line of its neighbours.

    The median, so that a corner does not count; a smooth curve sampled finely gives next to nothing.
    """
    if y.size < 4:
        return 0.0
    a = (t[2:] - t[1:-1]) / (t[2:] - t[:-2])
    off = y[1:-1] - a * y[:-2] - (1.0 - a) * y[2:]
    # Of normal noise the median of |off| is 0.6745 of its deviation.
    return float(np.median(np.abs(off) / np.sqrt(1.0 + a**2 + (1.0 - a) ** 2)) / 0.6745)


def smoothed(t: FloatArray, y: FloatArray, window: float) -> tuple[FloatArray, FloatArray]:
    """Local quadratic regression with tricube weights, over ``window`` [time] or five samples; value and slope."""
    n = t.size
    low = np.searchsorted(t, t - 0.5 * window)
    high = np.searchsorted(t, t + 0.5 * window, side="right")
    few = high - low < _FEWEST
    low[few] = np.clip(np.flatnonzero(few) - _FEWEST // 2, 0, max(n - _FEWEST, 0))
    high[few] = np.minimum(low[few] + _FEWEST, n)
    widest = int((high - low).max())
    value, slope = np.empty(n), np.empty(n)
    rows = max(1, _AT_ONCE // widest)
    for start in range(0, n, rows):
        here = slice(start, start + rows)
        at = low[here, None] + np.arange(widest)
        inside = at < high[here, None]
        at = np.minimum(at, n - 1)
        s = np.where(inside, t[at] - t[here, None], 0.0)
        reach = 1.001 * np.abs(s).max(axis=1, keepdims=True)
        x = s / reach
        w = inside * (1.0 - np.abs(x) ** 3) ** 3
        powers = x[:, :, None] ** np.arange(5)
        sums = np.einsum("ij,ijk->ik", w, powers)
        right = np.einsum("ij,ijk->ik", w * y[at], powers[:, :, :3])
        c = np.linalg.solve(sums[:, _HANKEL], right[:, :, None])[:, :, 0]
        value[here], slope[here] = c[:, 0], c[:, 1] / reach[:, 0]
    return value, slope


def _find_step(record: Record) -> int:
    """Index of the first sample with the new input.

    Raises
    ------
    RuleNotApplicable
        The input is not one step.
    """
    u = np.append(record.u_before, record.u)
    k = int(np.argmax(np.abs(np.diff(u))))
    before, after = u[: k + 1], record.u[k:]
    size = abs(float(np.mean(after) - np.mean(before)))
    if record.hold != "zero" or max(np.ptp(before), np.ptp(after)) > _FLAT * size:
        raise RuleNotApplicable(
            "the input is not one step: this method reads a step response",
            field="u",
            hint="use least squares, which takes any input",
        )
    return k


def step_data(record: Record, choices: Choices | None = None) -> StepData:
    """Find the step and its levels, and smooth the output after it.

    y0 is the mean up to the step (the last fifth of the record's rest, at most), y_final the mean of the last tenth
    after it. The smoothing window follows the noise: none where there is none, with 2 % of it half of the time from
    10 % to 63 %.

    Parameters
    ----------
    record : Record
    choices : Choices or None

    Returns
    -------
    StepData

    Raises
    ------
    RuleNotApplicable
        The input is not one step, the output does not move, or too little of it follows the step.
    """
    choices = choices or Choices()
    k = _find_step(record)
    t_step = float(record.t[k])
    seen = record.seen
    t_all, y_all = record.t[seen], record.y[seen]
    # At the step itself the output is still the old one.
    rest = y_all[t_all <= t_step]
    after = t_all >= t_step
    t, raw = t_all[after], y_all[after]
    if t.size < 2 * _FEWEST:
        raise RuleNotApplicable(
            f"only {t.size} samples follow the step; {2 * _FEWEST} are needed", field="t", hint="record longer"
        )
    notes: list[str] = []
    y0 = choices.y0
    if y0 is None:
        y0 = float(np.mean(rest[-max(1, rest.size // 5) :])) if rest.size else float(raw[0])
        if rest.size < 2:
            notes.append("nothing was recorded before the step: y0 is the first sample alone")
    tail = raw[t >= t[-1] - _TAIL * (t[-1] - t_step)]
    y_final = float(np.mean(tail)) if choices.y_final is None else choices.y_final
    change = y_final - y0
    sigma = noise_level(t_all, y_all)
    if not abs(change) > max(3.0 * sigma / math.sqrt(tail.size), 1e-12 * max(abs(y0), abs(y_final))):
        raise RuleNotApplicable("the output ends where it began", field="y", hint="an integrating plant or a pulse?")
    if choices.y_final is None:
        earlier = raw[(t >= t[-1] - 2 * _TAIL * (t[-1] - t_step)) & (t < t[-1] - _TAIL * (t[-1] - t_step))]
        if earlier.size and abs(np.mean(tail) - np.mean(earlier)) > 0.01 * abs(change) + 3.0 * sigma / math.sqrt(
            earlier.size
        ):
            notes.append("the record is too short: the output is still moving at its end, so K and tau are uncertain")
    window = choices.window
    if window is None:
        window = _window(t, raw, y0, change, sigma)
    y, dy = smoothed(t, raw, window)
    step = float(np.mean(record.u[k:])) - (float(np.mean(record.u[:k])) if k else record.u_before)
    return StepData(t, y, dy, raw, t_step, step, y0, y_final, window, tuple(notes))


def _window(t: FloatArray, y: FloatArray, y0: float, change: float, sigma: float) -> float:
    relative = sigma / abs(change)
    if relative < 1e-3:
        return 0.0
    rise = _reached(t, (y - y0) / change, 0.632) - _reached(t, (y - y0) / change, 0.1)
    return max(rise, 0.0) * min(0.5, 0.5 * math.sqrt(relative / 0.02))


def _reached(t: FloatArray, z: FloatArray, level: float) -> float:
    """About when a noisy curve passes a level: most of five samples in a row are beyond it."""
    runs = np.convolve(z >= level, np.ones(_FEWEST), "valid") > _FEWEST / 2
    return float(t[int(runs.argmax()) + _FEWEST // 2]) if runs.any() else float(t[-1])
