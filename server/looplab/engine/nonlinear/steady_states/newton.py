"""Newton's method for steady states: damped, of smallest step where solutions are not isolated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import NonFinite
from looplab.engine.nonlinear.steady_states.equations import SteadyEquations
from looplab.engine.systems.polynomial import FloatArray

_STEPS = 60
_RANK = 1e-11
_CLOSE = 1e-9
_LEAST_DAMPING = 1e-3
_PSEUDO_STEPS = 120


@dataclass(frozen=True)
class Root:
    """A solution, and orthonormal directions (rows, in scaled coordinates) along which it is not isolated."""

    y: FloatArray
    null: FloatArray


@dataclass(frozen=True)
class _Linear:
    """J w dy = -F by singular values, each row and each unknown on its own scale."""

    U: FloatArray
    sigma: FloatArray
    V: FloatArray
    rows: FloatArray

    @classmethod
    def of(cls, J: FloatArray, width: FloatArray) -> _Linear:
        scaled = J * width
        rows = np.abs(scaled).max(axis=1, initial=0.0)
        U, sigma, V = np.linalg.svd(scaled / np.where(rows > 0, rows, 1.0)[:, None])
        return cls(U, sigma, V, rows)

    @property
    def rank(self) -> int:
        return int(np.count_nonzero(self.sigma > _RANK * max(self.sigma.max(initial=0.0), 1e-300)))

    def step(self, F: FloatArray) -> FloatArray:
        r = self.rank
        right = F / np.where(self.rows > 0, self.rows, 1.0)
        return np.asarray(-(self.V[:r].T @ ((self.U[:, :r].T @ right) / self.sigma[:r])))

    def small(self, F: FloatArray) -> bool:
        return bool((np.abs(F) <= 1e-8 * self.rows + 1e-14).all())


def solve(equations: SteadyEquations, start: FloatArray, box: FloatArray) -> Root | None:
    """A solution from a start, by damped Newton steps with the exact Jacobian.

    Parameters
    ----------
    equations : SteadyEquations
        Without ``over``.
    start : ndarray, shape (k,)
    box : ndarray, shape (k, 2)
        Its widths are the scales; iterates stay within twice its size.

    Returns
    -------
    Root or None
        None where the iteration does not converge, which does not prove that there is no solution.
    """
    width = box[:, 1] - box[:, 0]
    low, high = box[:, 0] - 0.5 * width, box[:, 1] + 0.5 * width
    y, before = start, np.inf
    try:
        F = equations.residual(y)
        for _ in range(_STEPS):
            linear = _Linear.of(equations.jacobian(y), width)
            step = linear.step(F)
            size = float(np.linalg.norm(step))
            if size <= 1e-15 or (size <= _CLOSE and size >= 0.5 * before):
                return Root(y, linear.V[linear.rank :]) if linear.small(F) else None
            damping = 1.0
            while True:
                trial = y + damping * width * step
                now = _residual(equations, trial) if ((trial >= low) & (trial <= high)).all() else None
                # The natural test: it does not depend on the units of the equations.
                if now is not None and (
                    size <= _CLOSE or np.linalg.norm(linear.step(now)) <= (1 - 0.5 * damping) * size
                ):
                    break
                damping *= 0.5
                if damping < _LEAST_DAMPING:
                    return None
            y, F, before = trial, now, size if damping == 1.0 else np.inf
    except (NonFinite, np.linalg.LinAlgError):
        return None
    return None


def _residual(equations: SteadyEquations, y: FloatArray) -> FloatArray | None:
    try:
        return equations.residual(y)
    except NonFinite:
        return None


def settle(equations: SteadyEquations, start: FloatArray, box: FloatArray) -> Root | None:
    """A solution by implicit time steps that grow as the equations come to rest, then Newton steps.

    Slower than ``solve``, and able to come from farther away; arguments and result are the same.
    """
    y = start
    eye = np.eye(y.size)
    try:
        F = equations.residual(y)
        J = equations.jacobian(y)
        h = 1e-2 / max(float(np.linalg.norm(J, 2)), 1e-300)
        for _ in range(_PSEUDO_STEPS):
            trial = y + np.linalg.solve(eye / h - J, F)
            now = _residual(equations, trial)
            if now is None:
                h *= 0.25
                continue
            h *= min(4.0, max(0.25, 2.0 * float(np.linalg.norm(F) / max(float(np.linalg.norm(now)), 1e-300))))
            y, F, J = trial, now, equations.jacobian(trial)
            if np.abs(J).max(initial=0.0) * h > 1e8:
                break
    except (NonFinite, np.linalg.LinAlgError):
        return None
    return solve(equations, y, box)


def correct(
    equations: SteadyEquations, guess: FloatArray, width: FloatArray, row: FloatArray, steps: int = 10
) -> tuple[FloatArray, int] | None:
    """The point of the curve in the plane through a guess, and how many steps it took; None where there is none.

    Parameters
    ----------
    equations : SteadyEquations
        With ``over``.
    guess : ndarray, shape (k + 1,)
    width : ndarray, shape (k + 1,)
        Scales of the unknowns.
    row : ndarray, shape (k + 1,)
        Normal of the plane, in scaled coordinates.
    steps : int
        Most Newton steps.
    """
    y, before = guess, np.inf
    for count in range(steps):
        try:
            F, J = equations.residual(y), equations.jacobian(y) * width
            rows = np.abs(J).max(axis=1, initial=0.0)
            rows = np.where(rows > 0, rows, 1.0)
            whole = np.vstack([J / rows[:, None], row])
            step = np.linalg.solve(whole, -np.append(F / rows, row @ ((y - guess) / width)))
        except (NonFinite, np.linalg.LinAlgError):
            return None
        size = float(np.linalg.norm(step))
        if not size <= max(2.0 * before, 1e-9):
            return None
        y = y + width * step
        if size <= 1e-14 or (size <= 1e-10 and size >= 0.1 * before):
            return y, count
        before = size
    return (y, steps) if before <= 1e-11 else None


def bisect(function: Callable[[float], float], low: float, high: float) -> float:
    """A sign change of a function by bisection, to the last digit."""
    sign = function(low) > 0
    while True:
        middle = 0.5 * (low + high)
        if not (min(low, high) < middle < max(low, high)):
            return middle
        if (function(middle) > 0) == sign:
            low = middle
        else:
            high = middle
