r"""A loop on a family of plants: gain, time constants and dead time of the plant over those of the model.

The characteristic function of a loop with a predictor (M below; M = 1 without one) is

.. math:: W(s) = M(s) + C(s)\,P(s), \qquad M = 1 + C\,G_{m0}\,(1 - e^{-\theta_m s})
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import NoConvergence, RuleNotApplicable
from looplab.engine.loop import PID
from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.engine.systems.transfer_function import TransferFunction

Axis = Literal["K", "tau", "theta"]
POINTS_PER_DECADE, POINTS_PER_TURN = 50, 20
LARGEST_TURN, ROUNDS, MOST_POINTS = 0.8, 30, 12_000
# Values of W that are looked at in one go.
BATCH = 250_000
# |C P| below which W stays on the right side of the origin.
QUIET = 0.2
SMALLEST_GAIN = 0.05


def _on_axis(omega: FloatArray) -> ComplexArray:
    return (1j * omega).astype(complex)


class MismatchLoop:
    """A controller, with a predictor or without, on a family of plants.

    Parameters
    ----------
    controller : PID
    plant : TransferFunction
        The plant for factors of 1: stable or integrating.
    model : TransferFunction or None
        What the predictor knows; None for a plain loop.

    Raises
    ------
    RuleNotApplicable
        Plant or model is unstable, or the loop passes jumps straight through.
    """

    def __init__(self, controller: PID, plant: TransferFunction, model: TransferFunction | None) -> None:
        self.C, self.plant, self.model = controller.to_transfer_function(), plant, model
        for name, system in (("model", model), ("plant", plant)):
            if system is not None:
                _require_tame(system, name, self.C.relative_degree)
        self.origin = (self.C * plant).origin_order
        if not plant.gain or self.origin < 0:
            raise RuleNotApplicable("the plant passes no constant u: feedback cannot hold y", field="plant")
        self.rational_plant = plant.without_dead_time()
        self.predicted = None if model is None else self.C * model.without_dead_time()

    def ahead(self, omega: FloatArray) -> ComplexArray:
        """M(i omega), shape of omega."""
        if self.predicted is None or self.model is None:
            return np.ones(omega.shape, dtype=complex)
        return 1.0 - self.predicted(_on_axis(omega)) * np.expm1(-1j * omega * self.model.theta)

    def rational(self, omega: FloatArray, tau: FloatArray | float) -> ComplexArray:
        """C P0(i omega) for a gain factor of 1 and factors tau of the time constants, of one shape."""
        # P0(tau s), with the slope of an integrating plant kept.
        stretched = self.rational_plant(_on_axis(omega * tau)) * np.asarray(tau) ** self.plant.origin_order
        out: ComplexArray = self.C(_on_axis(omega)) * stretched
        return out

    def grid(self, K: float, tau: tuple[float, float], theta: float) -> FloatArray:
        """Frequencies that resolve W for gains up to K and dead times up to theta, to where the loop is silent.

        Parameters
        ----------
        K : float
            Largest gain factor [-].
        tau : tuple of float
            Smallest and largest factor of the time constants [-].
        theta : float
            Largest dead-time factor [-].

        Returns
        -------
        ndarray, shape (N,)

        Raises
        ------
        NoConvergence
            More than 12 000 would be needed.
        """
        late = self.plant.theta * theta + (self.model.theta if self.model else 0.0)
        marks = [np.abs(r) for r in (self.C.zeros, self.C.poles)]
        marks += [np.abs(r) / f for r in (self.plant.poles, self.plant.zeros) for f in tau]
        corners = np.concatenate([*marks, [1.0 / late] if late else []])
        corners = corners[corners > 0] if (corners > 0).any() else np.ones(1)
        low, high = 1e-3 * float(corners.min()), float(corners.max())
        if self.origin:
            # Down to where W is its integrators but for a small angle, for the smallest gain too.
            size = SMALLEST_GAIN * float(np.abs(self.rational(np.array([low]), tau[0]))[0])
            low *= min(1.0, (size / 100.0) ** (1.0 / self.origin))
        for _ in range(60):
            ends = np.array([high, high])
            loud = K * np.abs(self.rational(ends, np.array(tau))).max()
            if self.predicted is not None:
                loud += 2.0 * float(np.abs(self.predicted(1j * ends))[0])
            if loud < QUIET:
                break
            high *= 1.5
        steps = int(np.log10(high / low) * POINTS_PER_DECADE) + 2
        turns = high * late / (2 * np.pi) * POINTS_PER_TURN
        if not steps + turns < MOST_POINTS:
            raise NoConvergence(
                "the dead times turn the phase too often before the gain of the loop falls below 1",
                field="model",
                hint="give the model the further lag that a real plant has",
            )
        return np.unique(np.concatenate([np.geomspace(low, high, steps), np.linspace(low, high, int(turns) + 2)]))

    def characteristic(
        self, omega: FloatArray, K: FloatArray | float, tau: FloatArray | float, theta: FloatArray | float
    ) -> ComplexArray:
        """W(i omega) for factors of one shape with it."""
        delay = self.plant.theta * np.asarray(theta)
        return self.ahead(omega) + K * self.rational(omega, tau) * np.exp(-1j * omega * delay)

    def roots_right(self, K: FloatArray, tau: FloatArray, theta: FloatArray) -> npt.NDArray[np.int_]:
        r"""Closed-loop poles in the right half-plane for each of some plants, by the turn of W.

        .. math:: \Delta \arg W = \tfrac{\pi}{2}\, o - \pi Z

        with o the integrators of C P; a hidden integrator of the predictor is not counted.

        Parameters
        ----------
        K, tau, theta : ndarray, shape (m,)
            Factors of gain, time constants and dead time [-].

        Returns
        -------
        ndarray of int, shape (m,)
            -1 where a pole lies so near to the axis that its side cannot be told.

        References
        ----------
        .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 10.3.
        """
        if not K.size:
            return np.zeros(0, dtype=int)
        grid = self.grid(float(K.max()), (float(tau.min()), float(tau.max())), float(theta.max()))
        parts = [self._counted(grid, K[part], tau[part], theta[part]) for part in batches(K.size, grid.size)]
        return np.concatenate(parts)

    def _counted(self, grid: FloatArray, K: FloatArray, tau: FloatArray, theta: FloatArray) -> npt.NDArray[np.int_]:
        shape = (K.size, grid.size)
        each = [np.broadcast_to(v[:, None], shape).ravel() for v in (K, tau, theta)]
        value = self.characteristic(np.tile(grid, K.size), *each).reshape(shape)
        turn = np.angle(value[:, 1:] / value[:, :-1])
        whole = turn.sum(axis=1)
        told = np.ones(K.size, dtype=bool)
        for i in np.flatnonzero((np.abs(turn) > LARGEST_TURN).any(axis=1)):
            followed = self._followed(grid, value[i], float(K[i]), float(tau[i]), float(theta[i]))
            told[i], whole[i] = followed is not None, followed or 0.0
        # At the low end W is its integrators, at the high end 1: what is left of the angles there is no turn.
        first = np.angle(value[:, 0] * np.exp(0.5j * np.pi * self.origin))
        net = whole + (first - np.pi * np.round(first / np.pi)) - np.angle(value[:, -1])
        count = 0.5 * self.origin - net / np.pi
        return np.where(told, np.round(count).astype(int), -1)

    def _followed(self, omega: FloatArray, value: ComplexArray, K: float, tau: float, theta: float) -> float | None:
        """The turn of one W on a grid made finer where it turns fast; None where that does not help."""
        for _ in range(ROUNDS):
            turn = np.angle(value[1:] / value[:-1])
            coarse = np.flatnonzero(np.abs(turn) > LARGEST_TURN)
            if not coarse.size:
                return float(turn.sum())
            middle = 0.5 * (omega[coarse] + omega[coarse + 1])
            omega = np.insert(omega, coarse + 1, middle)
            value = np.insert(value, coarse + 1, self.characteristic(middle, K, tau, theta))
        return None


def batches(rows: int, columns: int) -> list[slice]:
    """Rows of a table in parts of a bounded size."""
    step = max(1, BATCH // columns)
    return [slice(start, start + step) for start in range(0, rows, step)]


def _require_tame(system: TransferFunction, name: str, controller_degree: int) -> None:
    away = system.poles[system.poles != 0]
    if (away.real > 0).any():
        raise RuleNotApplicable(
            "the model is unstable: its pole stays in the predictor, and the loop is stable on no plant at all"
            if name == "model"
            else "the plant is unstable: a region is drawn for plants that are stable or integrate",
            field=name,
        )
    if (np.abs(away.real) <= 1e-9 * np.abs(away)).any():
        raise RuleNotApplicable(f"the {name} has undamped poles: give them a little damping", field=name)
    if system.relative_degree + controller_degree < 1:
        raise RuleNotApplicable(
            f"the {name} passes jumps of u straight on: no region is drawn for such loops", field=name
        )
