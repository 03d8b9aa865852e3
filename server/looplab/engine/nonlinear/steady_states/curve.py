"""Following a curve of steady states around its turns, by steps along its arc."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from looplab.engine.errors import NonFinite
from looplab.engine.nonlinear.steady_states.equations import SteadyEquations
from looplab.engine.nonlinear.steady_states.newton import bisect, correct
from looplab.engine.nonlinear.steady_states.verdict import unstable_count
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

MAX_POINTS = 800
_FIRST, _LONGEST, _SHORTEST = 2e-3, 1e-2, 1e-8
# Cosine of the largest angle between neighbouring tangents.
_STRAIGHT = 0.985
TURNING, HOPF, BRANCH = "turning", "hopf", "branch"


@dataclass(frozen=True)
class CurvePoint:
    """A point of a curve: unknowns and over, unit tangent in scaled coordinates, eigenvalues (rightmost first).

    ``special`` is empty, or TURNING, HOPF or BRANCH.
    """

    y: FloatArray
    tangent: FloatArray
    poles: ComplexArray
    special: str = ""

    @property
    def unstable(self) -> int:
        """Number of eigenvalues in the right half-plane."""
        return unstable_count(self.poles.real)


@dataclass(frozen=True)
class Curve:
    """Points in order, for each segment the number of unstable eigenvalues on it, and why it ends on either side."""

    points: tuple[CurvePoint, ...]
    unstable: tuple[int, ...]
    ends: tuple[str, str]
    closed: bool = False


@dataclass
class _Side:
    points: list[CurvePoint] = field(default_factory=list)
    unstable: list[int] = field(default_factory=list)
    end: str = ""
    closed: bool = False


class CurveFollower:
    """Follows curves of one family of equations inside a box.

    Parameters
    ----------
    equations : SteadyEquations
        With ``over``.
    box : ndarray, shape (k + 1, 2)
        Where the curve ends; its last row are the bounds of ``over``.
    width : ndarray, shape (k + 1,)
        Scales of the unknowns: steps are measured in them.
    judged : bool
        Whether stability matters: otherwise eigenvalues are not computed.
    """

    def __init__(self, equations: SteadyEquations, box: FloatArray, width: FloatArray, judged: bool = True) -> None:
        self.equations, self.box, self.width, self.judged = equations, box, width, judged
        model = equations.model
        self.names = [*(model.state_names[index] for index in equations.free), equations.over or ""]

    def point(self, y: FloatArray, along: FloatArray) -> CurvePoint:
        """The point with its tangent, which is turned to point ``along``; raises NonFinite, LinAlgError."""
        J = self.equations.jacobian(y)
        scaled = J * self.width
        rows = np.abs(scaled).max(axis=1, initial=0.0)
        whole = np.vstack([scaled / np.where(rows > 0, rows, 1.0)[:, None], along])
        tangent = np.linalg.solve(whole, np.eye(y.size)[-1])
        tangent = tangent / np.linalg.norm(tangent)
        poles = eigenvalues(J[:, :-1]) if self.judged else np.zeros(0, dtype=complex)
        return CurvePoint(y, tangent, poles[np.argsort(-poles.real, kind="stable")])

    def first_tangent(self, y: FloatArray) -> FloatArray:
        """A direction of the curve at a point, towards larger ``over`` where it goes there."""
        scaled = self.equations.jacobian(y) * self.width
        rows = np.abs(scaled).max(axis=1, initial=0.0)
        tangent = np.linalg.svd(scaled / np.where(rows > 0, rows, 1.0)[:, None])[2][-1]
        return np.asarray(-tangent if tangent[-1] < 0 else tangent)

    def follow(self, y: FloatArray) -> Curve:
        """The whole curve through a point, in both directions."""
        tangent = self.first_tangent(y)
        forward = self._side(self.point(y, tangent))
        if forward.closed:
            return Curve(tuple(forward.points), tuple(forward.unstable), (forward.end, forward.end), True)
        back = self._side(self.point(y, -tangent))
        points = [*reversed(back.points), *forward.points[1:]]
        unstable = [*reversed(back.unstable), *forward.unstable]
        return Curve(tuple(points), tuple(unstable), (back.end, forward.end))

    def _side(self, start: CurvePoint) -> _Side:
        side = _Side([start])
        ds, here = _FIRST, start
        while len(side.points) < MAX_POINTS:
            there, count = self._step(here, ds)
            straight = there is not None and float(there.tangent @ here.tangent) >= _STRAIGHT
            if there is None or not (straight and self._plain(here, there, ds)):
                ds *= 0.5
                if ds < _SHORTEST:
                    side.end = "the curve cannot be followed any further"
                    return side
                continue
            leaves = self._leaves(here, there)
            if leaves is not None:
                self._end(side, here, there, leaves)
                return side
            self._append(side, here, there)
            if len(side.points) > 6 and self._back_home(start, here, there):
                self._append(side, there, start)
                side.closed, side.end = True, "the curve closes"
                return side
            here = there
            if count <= 3 and float(there.tangent @ side.points[-2].tangent) > 0.997:
                ds = min(1.5 * ds, _LONGEST)
        side.end = f"after {MAX_POINTS} points"
        return side

    def _step(self, here: CurvePoint, ds: float) -> tuple[CurvePoint | None, int]:
        found = correct(self.equations, here.y + ds * self.width * here.tangent, self.width, here.tangent, 8)
        if found is None:
            return None, 0
        try:
            return self.point(found[0], here.tangent), found[1]
        except (NonFinite, np.linalg.LinAlgError):
            return None, 0

    def _plain(self, here: CurvePoint, there: CurvePoint, ds: float) -> bool:
        """At most one special point lies between, so that it can be told which."""
        change = abs(there.unstable - here.unstable)
        turns = there.tangent[-1] * here.tangent[-1] < 0
        return ds < 1e-5 or not self.judged or (change == 1 if turns else change <= 2)

    def _leaves(self, here: CurvePoint, there: CurvePoint) -> tuple[int, float] | None:
        """Which unknown leaves the box first, and over which bound."""
        first: tuple[float, int, float] | None = None
        for index, (a, b, (low, high)) in enumerate(zip(here.y, there.y, self.box, strict=True)):
            slack = 1e-9 * (high - low)
            bound = low if b < low - slack else high if b > high + slack else None
            if bound is not None and b != a:
                part = max(0.0, (bound - a) / (b - a))
                if first is None or part < first[0]:
                    first = (part, index, float(bound))
        return None if first is None else (first[1], first[2])

    def _end(self, side: _Side, here: CurvePoint, there: CurvePoint, leaves: tuple[int, float]) -> None:
        index, bound = leaves
        side.end = f"{self.names[index]} = {bound:.6g}, where its range ends"
        part = (bound - here.y[index]) / (there.y[index] - here.y[index])
        if part <= 1e-9:
            return
        guess = here.y + part * (there.y - here.y)
        guess[index] = bound
        found = correct(self.equations, guess, self.width, np.eye(guess.size)[index])
        if found is None:
            return
        y = found[0]
        y[index] = bound
        try:
            self._append(side, here, self.point(y, here.tangent))
        except (NonFinite, np.linalg.LinAlgError):
            return

    def _append(self, side: _Side, here: CurvePoint, there: CurvePoint) -> None:
        special = self._special(here, there) if self.judged else None
        if special is not None:
            side.points.append(special)
            side.unstable.append(here.unstable)
        side.points.append(there)
        side.unstable.append(there.unstable if special is not None else max(here.unstable, there.unstable))

    def _back_home(self, start: CurvePoint, here: CurvePoint, there: CurvePoint) -> bool:
        """Whether the start lies between two neighbouring points, on the way in its own direction."""
        step = (there.y - here.y) / self.width
        to_start = (start.y - here.y) / self.width
        length = float(np.linalg.norm(step))
        along = float(to_start @ step) / length**2
        aside = float(np.linalg.norm(to_start - along * step))
        return 0.0 <= along <= 1.0 and aside <= 0.2 * length and float(there.tangent @ start.tangent) > 0.9

    def _special(self, here: CurvePoint, there: CurvePoint) -> CurvePoint | None:
        turns = here.tangent[-1] * there.tangent[-1] < 0
        if not turns and here.unstable == there.unstable:
            return None
        index = min(here.unstable, there.unstable)

        def at(s: float) -> CurvePoint:
            found = correct(self.equations, here.y + s * self.width * here.tangent, self.width, here.tangent)
            if found is None:
                raise np.linalg.LinAlgError
            return self.point(found[0], here.tangent)

        # Real parts in their order depend continuously on the arc, so the crossing one changes sign.
        test: Callable[[float], float] = (
            (lambda s: float(at(s).tangent[-1])) if turns else (lambda s: float(at(s).poles[index].real))
        )
        end = float(here.tangent @ ((there.y - here.y) / self.width))
        try:
            point = at(bisect(test, 0.0, end))
        except (NonFinite, np.linalg.LinAlgError):
            return None
        if turns:
            return CurvePoint(point.y, point.tangent, point.poles, TURNING)
        crossing = point.poles[index]
        complex_pair = abs(crossing.imag) > 1e-6 * float(np.abs(point.poles).max(initial=0.0))
        return CurvePoint(point.y, point.tangent, point.poles, HOPF if complex_pair else BRANCH)

    def passes(self, curve: Curve, y: FloatArray) -> bool:
        """Whether a point of the equations lies on a curve."""
        values = np.array([point.y[-1] for point in curve.points])
        for index in np.flatnonzero((values[:-1] - y[-1]) * (values[1:] - y[-1]) <= 0):
            a, b = curve.points[index].y, curve.points[index + 1].y
            part = (y[-1] - a[-1]) / (b[-1] - a[-1]) if b[-1] != a[-1] else 0.0
            guess = a + part * (b - a)
            guess[-1] = y[-1]
            found = correct(self.equations, guess, self.width, np.eye(y.size)[-1])
            near = guess if found is None else found[0]
            if np.abs((near - y) / self.width).max() <= (1e-3 if found is None else 1e-5):
                return True
        return False
