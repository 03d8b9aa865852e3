r"""Many PID loops on one plant at once, from its exact frequency response.

Robustness needs |1 + K G(i omega)| on one grid; the error after a step is the Fourier series of its transform, sampled
at multiples of pi/h, which is exactly the sum of the error's repetitions with the period 2h (Poisson). Dead time is
exact. What is found here is then computed again by the loop's own exact response.
"""

from __future__ import annotations

from functools import cached_property
from typing import Literal

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.frequency.crossings import crossings
from looplab.engine.frequency.response import AXIS_GAP, frequency_grid, frequency_range
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.ultimate_point import stabilising_sign

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
Criterion = Literal["IAE", "ISE", "ITAE"]
Aim = Literal["load", "setpoint"]

ALPHA = 0.1
# Samples of one horizon; the period of the series is two horizons.
SAMPLES = 768
HORIZON_PERIODS = 10.0
LARGEST_CHUNK = 256
# |L| that no longer moves 1 + L, over |L| at the phase crossover.
NEGLIGIBLE = 0.05
# A grid of fewer points is made twice as dense: there it costs nothing.
FEW_POINTS = 500
# Separate ranges of gains looked at, from the lowest.
GAPS = 4


def time_scale(plant: TransferFunction) -> float:
    """1/omega at the plant's first phase crossover, or where lags and dead time suggest it [time]."""
    found = crossings(plant)
    usable = np.isfinite(found.phase_log_magnitude)
    if usable.any():
        return float(1.0 / found.phase_omega[usable].min())
    lags = [1.0 / abs(p) for p in plant.poles if p != 0]
    return 0.25 * float(sum(lags) + plant.theta) or 1.0


class LoopFamily:
    """Ideal PID controllers (filtered derivative, alpha = 0.1) on one plant.

    Parameters
    ----------
    plant : TransferFunction
        Proper, dead time exact.

    Raises
    ------
    ImproperSystem
        The plant has more zeros than poles.
    RuleNotApplicable
        The plant is zero, or has poles on the imaginary axis beside the origin.

    Attributes
    ----------
    scale : float
        time_scale of the plant [time].
    sign : float
        Sign of the gains that can stabilise it.
    """

    def __init__(self, plant: TransferFunction) -> None:
        plant.require_proper("plant")
        if plant.gain == 0.0:
            raise RuleNotApplicable("the plant is zero: no controller acts on it", field="plant")
        on_axis = (plant.poles != 0) & (np.abs(plant.poles.real) <= AXIS_GAP * np.abs(plant.poles))
        if on_axis.any():
            raise RuleNotApplicable(
                "the plant has undamped poles on the imaginary axis: give them the little damping that real ones have",
                field="plant",
            )
        self.plant, self.scale = plant, time_scale(plant)
        right = int(np.count_nonzero(plant.poles.real > 0))
        self.unstable_poles = right
        self.sign = stabilising_sign(plant)
        low, high = frequency_range(plant)
        omega = frequency_grid(plant, min(low, 1e-3 / self.scale), max(10.0 * high, 1e3 / self.scale))
        P = self.sign * plant.response(omega)
        # Where even the derivative's gain leaves |L| negligible, the loop is open.
        matters = np.flatnonzero(
            (1.0 + 1.0 / ALPHA) * np.abs(P) > NEGLIGIBLE * np.abs(plant.response(np.array([1.0 / self.scale])))
        )
        end = int(matters[-1]) + 2 if matters.size else omega.size
        if end < FEW_POINTS:
            omega = np.sort(np.concatenate([omega, np.sqrt(omega[1:] * omega[:-1])]))
            P, end = self.sign * plant.response(omega), 2 * end
        self.omega, self.P = omega[:end], P[:end]
        self.horizon = HORIZON_PERIODS * 2.0 * np.pi * self.scale

    def unit_controller(self, omega: FloatArray, tau_I: FloatArray, tau_D: FloatArray) -> ComplexArray:
        """C(i omega)/Kc, shape (m, n); tau_I = inf and tau_D = 0 switch those actions off."""
        s = 1j * omega
        integral = np.divide(1.0, tau_I[:, None])
        lead = tau_D[:, None]
        return 1.0 + integral / s + lead * s / (ALPHA * lead * s + 1.0)

    def loop_shape(self, tau_I: FloatArray, tau_D: FloatArray) -> ComplexArray:
        """L(i omega)/|Kc| on the robustness grid, shape (m, n)."""
        return self.unit_controller(self.omega, tau_I, tau_D) * self.P

    def stable(self, L: ComplexArray, integrators: int) -> npt.NDArray[np.bool_]:
        """Nyquist's criterion by the turn of 1 + L over the grid, shape (m,) for L of shape (m, n)."""
        turn = np.unwrap(np.angle(1.0 + L), axis=1)
        wanted = 0.5 * np.pi * (integrators + 2 * self.unstable_poles)
        # Where the grid begins, L is its integrators but for a small angle.
        return np.abs(turn[:, -1] - turn[:, 0] - wanted) < 0.5 * np.pi

    def integrators(self, integral: bool) -> int:
        """Poles of L at the origin."""
        return self.plant.origin_order + int(integral)

    def windows(
        self, tau_I: FloatArray, tau_D: FloatArray, Ms: float, Mt: float | None
    ) -> tuple[FloatArray, FloatArray]:
        r"""For each pair of times the lowest range of gains that is stable and within both limits.

        .. math::

            |1 + K G|^2 \ge 1/M_s^2, \qquad |K G|^2 \le M_t^2\,|1 + K G|^2

        are quadratic in K at each frequency: each forbids one interval.

        Parameters
        ----------
        tau_I, tau_D : ndarray, shape (m,)
            [time]
        Ms, Mt : float
            Limits > 1; None for none [-].

        Returns
        -------
        low, high : ndarray, shape (m,)
            Sizes of Kc; NaN where there is no such range, high = inf where it has no end.

        References
        ----------
        .. [1] K. J. Åström, H. Panagopoulos, T. Hägglund, Automatica 34 (1998) 585-601.
        """
        G = self.loop_shape(tau_I, tau_D)
        re, square = G.real, np.abs(G) ** 2
        starts, ends = _forbidden(re, square, 1.0 - 1.0 / Ms**2)
        if Mt is not None:
            more = _forbidden(re, square, Mt**2 / (Mt**2 - 1.0), Mt**2 / (Mt**2 - 1.0))
            starts, ends = np.concatenate([starts, more[0]], axis=1), np.concatenate([ends, more[1]], axis=1)
        order = np.argsort(starts, axis=1)
        starts = np.take_along_axis(starts, order, axis=1)
        reach = np.maximum.accumulate(np.take_along_axis(ends, order, axis=1), axis=1)
        zero = np.zeros((starts.shape[0], 1))
        lows = np.concatenate([zero, reach], axis=1)
        highs = np.concatenate([starts, np.full_like(zero, np.inf)], axis=1)
        return self._first_stable(G, lows, highs, bool(np.isfinite(tau_I).all()))

    def _first_stable(
        self, G: ComplexArray, lows: FloatArray, highs: FloatArray, integral: bool
    ) -> tuple[FloatArray, FloatArray]:
        """Of each row's allowed gaps the lowest in which the loop is stable."""
        low, high = np.full(G.shape[0], np.nan), np.full(G.shape[0], np.nan)
        gap = highs > lows * (1.0 + 1e-9)
        # Without poles to be moved, a little feedback of the right sign leaves the loop stable.
        harmless = not self.unstable_poles and self.plant.origin_order <= 0
        open_rows = np.arange(G.shape[0])
        for turn in range(GAPS):
            open_rows = open_rows[gap[open_rows].any(axis=1)]
            if not open_rows.size:
                break
            first = np.argmax(gap[open_rows], axis=1)
            a, b = lows[open_rows, first], highs[open_rows, first]
            if turn == 0 and harmless:
                ok = a == 0.0
            else:
                ok = self.stable(_inside(a, b)[:, None] * G[open_rows], self.integrators(integral))
            low[open_rows[ok]], high[open_rows[ok]] = a[ok], b[ok]
            gap[open_rows, first] = False
            open_rows = open_rows[~ok]
        return low, high

    def peaks(self, Kc: FloatArray, tau_I: FloatArray, tau_D: FloatArray) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
        """Ms of each loop (parabola through the nearest grid points; NaN where unstable) and its stability."""
        L = Kc[:, None] * self.loop_shape(tau_I, tau_D)
        size = np.abs(1.0 + L)
        stable = self.stable(L, self.integrators(bool(np.isfinite(tau_I).all())))
        at = np.clip(np.argmin(size, axis=1), 1, size.shape[1] - 2)
        rows = np.arange(size.shape[0])
        x = np.log(self.omega)
        x0, x1, x2 = x[at - 1], x[at], x[at + 1]
        y0, y1, y2 = size[rows, at - 1], size[rows, at], size[rows, at + 1]
        d1, d2 = (y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1)
        curve = (d2 - d1) / (x2 - x0)
        with np.errstate(divide="ignore", invalid="ignore"):
            move = np.clip(0.5 * (x0 + x1) - d1 / (2.0 * curve), x0, x2)
            low = y0 + d1 * (move - x0) + curve * (move - x0) * (move - x1)
        smallest = np.where((curve > 0) & (low > 0), np.minimum(low, y1), y1)
        return np.where(stable, 1.0 / smallest, np.nan), stable

    @cached_property
    def _series(self) -> tuple[FloatArray, ComplexArray]:
        """Frequencies of the Fourier series without zero, and the plant there."""
        omega = np.pi / self.horizon * np.arange(1.0, SAMPLES + 1.0)
        return omega, self.sign * self.plant.response(omega)

    def errors(self, Kc: FloatArray, tau_I: FloatArray, tau_D: FloatArray, aim: Aim) -> FloatArray:
        """e(t) after a unit step, repeated with the period 2h, shape (m, 2 SAMPLES) at multiples of h/SAMPLES."""
        omega, P = self._series
        s = 1j * omega
        C = Kc[:, None] * self.unit_controller(omega, tau_I, tau_D)
        S = 1.0 / (1.0 + P * C)
        spectrum = np.zeros((Kc.size, SAMPLES + 1), dtype=complex)
        jump = np.zeros(Kc.size)
        decay = 30.0 / self.horizon
        Ki = Kc / tau_I
        order = self.plant.origin_order
        if aim == "load":
            spectrum[:, 1:] = P * S / s
            spectrum[:, 0] = 1.0 / Ki
        else:
            # At t = 0 the error jumps; what jumps is taken out in closed form, so that the series converges fast.
            direct = 0.0 if self.plant.theta else self.sign * self.plant.high_frequency_gain
            lead = np.where(tau_D > 0, 1.0 + 1.0 / ALPHA, 1.0)
            jump = 1.0 / (1.0 + direct * Kc * lead)
            spectrum[:, 1:] = S / s - jump[:, None] / (s + decay)
            gain = self.sign * self.plant.origin_gain
            size = np.where(np.isinf(tau_I), Kc, Ki) * gain
            orders = order + np.isfinite(tau_I)
            spectrum[:, 0] = np.where(orders == 1, 1.0 / size, 0.0) - jump / decay
        spectrum[:, -1] = spectrum[:, -1].real
        e = np.fft.irfft(spectrum, n=2 * SAMPLES, axis=1) * (SAMPLES / self.horizon)
        if aim == "setpoint":
            t = self.horizon / SAMPLES * np.arange(2 * SAMPLES)
            e += jump[:, None] * np.exp(-decay * t)
        return e

    def costs(self, Kc: FloatArray, tau_I: FloatArray, tau_D: FloatArray, criterion: Criterion, aim: Aim) -> FloatArray:
        """IAE, ISE or ITAE of stable loops, shape (m,); time beyond the period 2h counts as if within it."""
        out = np.empty(Kc.size)
        for start in range(0, Kc.size, LARGEST_CHUNK):
            part = slice(start, start + LARGEST_CHUNK)
            out[part] = self.integral(self.errors(Kc[part], tau_I[part], tau_D[part], aim), criterion)
        return out

    def integral(self, e: FloatArray, criterion: Criterion) -> FloatArray:
        """The criterion of errors as ``errors`` gives them, by the trapezoidal rule, shape (m,)."""
        dt = self.horizon / SAMPLES
        size = e * e if criterion == "ISE" else np.abs(e)
        if criterion == "ITAE":
            return dt * (size @ (dt * np.arange(2 * SAMPLES)))
        return dt * (size.sum(axis=1) - 0.5 * size[:, 0])


def _forbidden(
    re: FloatArray, square: FloatArray, constant: float, slope: float = 1.0
) -> tuple[FloatArray, FloatArray]:
    """Positive gains with |G|^2 K^2 + 2 slope Re(G) K + constant < 0 at each frequency; (inf, -inf) for none."""
    disc = (slope * re) ** 2 - square * constant
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        root = np.sqrt(disc)
        # Both roots from the one without cancellation.
        high = (-slope * re + root) / square
        low = constant / (square * high)
    none = ~((disc > 0) & (re < 0) & np.isfinite(low) & np.isfinite(high))
    return np.where(none, np.inf, low), np.where(none, -np.inf, high)


def _inside(low: FloatArray, high: FloatArray) -> FloatArray:
    """A gain between the ends of each gap; beyond its start where it has no end."""
    with np.errstate(invalid="ignore"):
        middle = np.where(low > 0, np.sqrt(low * high), 0.5 * high)
    return np.where(np.isfinite(high), middle, np.where(low > 0, 2.0 * low, 1.0))
