"""The plane of Kc and tau_I of a PI controller: where the loop is stable, how robust it is there and how good."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.stability.pi_region import pi_boundary
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.loop_family import Aim, Criterion, LoopFamily

FloatArray = npt.NDArray[np.float64]

SMALLEST_GRID, LARGEST_GRID = 4, 40
# Default window: gains up to a little above the largest stable one, integral times around the plant's time scale.
GAIN_DECADES, ABOVE = 1.7, 1.15
INTEGRAL_WINDOW = (0.4, 25.0)
# A boundary is where the loop is stable so far (relative) on one side of it and not on the other: farther than the
# chords between the frequencies of the grid stray from the Nyquist curve.
STEP = 0.03
CURVE_POINTS = 300
# The error left in the last quarter of twenty ultimate periods, over the largest, for a loop that settles in time.
SETTLED = 0.05


@dataclass(frozen=True)
class GainMap:
    """Ms and a criterion over a grid of gains and integral times.

    Attributes
    ----------
    Kc : ndarray, shape (n,)
        Gains, all of the sign that suits the plant, increasing in size [input/output].
    tau_I : ndarray, shape (m,)
        Integral times, increasing [time].
    Ms, value : ndarray, shape (m, n)
        Largest sensitivity, NaN where the loop is not stable, and the criterion, NaN also where the loop does not
        settle within twenty ultimate periods.
    boundary_Kc, boundary_tau_I : ndarray, shape (k,)
        Settings exactly on the boundary of stability, along the frequency; NaN breaks the curve.
    """

    Kc: FloatArray
    tau_I: FloatArray
    Ms: FloatArray
    value: FloatArray
    boundary_Kc: FloatArray
    boundary_tau_I: FloatArray


def _window(given: tuple[float, float] | None, default: tuple[float, float], name: str) -> tuple[float, float]:
    low, high = given or default
    if not (np.isfinite(low) and np.isfinite(high) and 0 < low < high):
        raise InvalidInput(
            f"the range of {name} must be two positive numbers, the smaller first", field=f"{name}_range"
        )
    return low, high


@dataclass(frozen=True)
class _Edge:
    """Points of the boundary curve (sizes of gains) with whether the loop is stable just below and just above."""

    Kc: FloatArray
    tau_I: FloatArray
    below: npt.NDArray[np.bool_]
    above: npt.NDArray[np.bool_]


def _edge(family: LoopFamily, Kc: tuple[float, float], tau_I: tuple[float, float]) -> _Edge:
    """The exact boundary curve inside a window, in the order of its frequencies."""

    def inside(omega: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        curve = pi_boundary(family.plant, omega)
        gain, times = family.sign * curve.Kc, curve.tau_I
        with np.errstate(invalid="ignore"):
            at = (gain >= Kc[0]) & (gain <= Kc[1]) & (times >= tau_I[0]) & (times <= tau_I[1])
        return curve.omega[at], gain[at], times[at]

    coarse, gain, times = inside(family.omega)
    if coarse.size:
        # One step of the grid to spare on either side, where the curve leaves the window.
        ends = np.searchsorted(family.omega, coarse[[0, -1]]) + np.array([-1, 1])
        first, last = family.omega[np.clip(ends, 0, family.omega.size - 1)]
        _, gain, times = inside(np.geomspace(first, last, CURVE_POINTS))
    G, order = family.loop_shape(times, np.zeros(times.size)), family.integrators(True)
    below, above = (family.stable((gain * factor)[:, None] * G, order) for factor in (1.0 - STEP, 1.0 + STEP))
    return _Edge(gain, times, below, above)


def gain_map(
    plant: TransferFunction,
    Kc_range: tuple[float, float] | None = None,
    tau_I_range: tuple[float, float] | None = None,
    points: tuple[int, int] = (24, 24),
    criterion: Criterion = "IAE",
    aim: Aim = "load",
) -> GainMap:
    r"""Map stability, robustness and performance of PI control over its two settings.

    .. math:: C = K_c\left(1 + \frac{1}{\tau_I s}\right), \qquad M_s = \max_\omega \frac{1}{|1 + P C|}

    Parameters
    ----------
    plant : TransferFunction
        Proper, dead time exact.
    Kc_range, tau_I_range : (float, float) or None
        Sizes of the gain [input/output] and integral times [time], positive; None takes a window around the stable
        region.
    points : (int, int)
        Gains and integral times on the grid, 4 to 40 each, evenly spaced in the logarithm.
    criterion : {"IAE", "ISE", "ITAE"}
    aim : {"load", "setpoint"}

    Returns
    -------
    GainMap
        Ms up to 5 is within 1 % of the exact one, which the loop's own analysis gives; the boundary is exact.

    Raises
    ------
    InvalidInput
        A range or the number of points is outside its limits.
    ImproperSystem
        The plant has more zeros than poles.
    RuleNotApplicable
        No gains are given, and stability has no boundary that would suggest some.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, Advanced PID Control, ISA 2006, ch. 6 (robustness region).
    """
    if not all(SMALLEST_GRID <= n <= LARGEST_GRID for n in points):
        raise InvalidInput(f"points must be from {SMALLEST_GRID} to {LARGEST_GRID}", field="points")
    family = LoopFamily(plant)
    times = _window(tau_I_range, (INTEGRAL_WINDOW[0] * family.scale, INTEGRAL_WINDOW[1] * family.scale), "tau_I")
    tau_I = np.geomspace(*times, points[1])
    gains = _window(Kc_range, _stable_gains(family, times) if Kc_range is None else Kc_range, "Kc")
    Kc = np.geomspace(*gains, points[0])
    none = np.zeros(points[0])
    Ms, value = np.full((points[1], points[0]), np.nan), np.full((points[1], points[0]), np.nan)
    for row, time in enumerate(tau_I):
        times_here = np.full(points[0], time)
        Ms[row], stable = family.peaks(Kc, times_here, none)
        e = family.errors(Kc, times_here, none, aim)
        size = np.abs(e)
        settled = size[:, -size.shape[1] // 4 :].max(axis=1) < SETTLED * size.max(axis=1)
        value[row] = np.where(stable & settled, family.integral(e, criterion), np.nan)
    edge = _edge(family, gains, times)
    real = edge.below != edge.above
    x, y = np.where(real, family.sign * edge.Kc, np.nan), np.where(real, edge.tau_I, np.nan)
    return GainMap(family.sign * Kc, tau_I, Ms, value, x, y)


def _stable_gains(family: LoopFamily, tau_I: tuple[float, float]) -> tuple[float, float]:
    """Window around the stable gains at the given integral times."""
    edge = _edge(family, (0.0, np.inf), tau_I)
    upper, lower = edge.Kc[edge.below & ~edge.above], edge.Kc[edge.above & ~edge.below]
    if not upper.size and not lower.size:
        raise RuleNotApplicable(
            "stability has no boundary at these integral times: the loop is stable at any gain, or at none",
            field="Kc_range",
            hint="say which gains the map is to show",
        )
    top = ABOVE * float(upper.max()) if upper.size else 10.0**GAIN_DECADES * float(lower.min())
    low = top * 10.0**-GAIN_DECADES
    return min(low, float(lower.min()) / ABOVE) if lower.size else low, top
