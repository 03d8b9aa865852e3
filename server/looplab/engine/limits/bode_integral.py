"""Bode's integral of the sensitivity: what is gained at some frequencies is lost at others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.frequency.margins import margins
from looplab.engine.frequency.response import AXIS_GAP, default_grid
from looplab.engine.limits.quadrature import integrate_panels
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.stability.closed_loop import closed_loop_verdict
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

# ln|S| agrees with its asymptote for omega -> 0 to this much where the analytic piece ends.
ORIGIN_TOLERANCE = 1e-10
# Of what one panel adds, relative to the largest of omega ln|S|.
PANEL_TOLERANCE = 1e-13
# Beyond the last corner by this factor, and with |L| below this size, ln(1 + L) is smooth in 1/omega.
BEYOND, SMALL = 4.0, 0.5
# exp(-45) is below rounding.
DECAY = 45.0
PLOT_POINTS = 400
# A peak of S below this is hardly seen.
SEEN = 1.05


@dataclass(frozen=True)
class BodeIntegral:
    r"""The integral of ln\|S\| from 0 to infinity, in three pieces, beside what the theorem says.

    Attributes
    ----------
    value : float or None
        origin + middle + tail [rad/time]; None, as all pieces are, where the integral does not exist: ``reason``.
    theorem : float or None
        pi times the sum of the unstable poles of L, less (pi/2) lim s L where there is no dead time [rad/time].
    origin, middle, tail : float or None
        0 to omega_low by the asymptote of \|S\|, omega_low to omega_high by Gauss's rule, and the rest from L at
        high frequencies [rad/time].
    omega_low, omega_high : float or None
        [rad/time]
    area_below, area_above : float or None
        Areas between ln\|S\| and zero up to omega_high, both positive [rad/time].
    error : float or None
        Bound on what the quadrature leaves [rad/time].
    limit_sL : float or None
        k, the limit of s L(s) for s to infinity without its dead time [rad/time]; None where it is infinite.
    unstable_poles : ndarray of complex
        Those of L [rad/time].
    omega, ln_S : ndarray, shape (n,)
        The curve over linear omega, from 0 on, without the points at which S is zero [rad/time], [-].
    reason : str or None
    """

    value: float | None
    theorem: float | None
    origin: float | None
    middle: float | None
    tail: float | None
    omega_low: float | None
    omega_high: float | None
    area_below: float | None
    area_above: float | None
    error: float | None
    limit_sL: float | None
    unstable_poles: npt.NDArray[np.complex128]
    omega: FloatArray
    ln_S: FloatArray
    reason: str | None = None


def log_sensitivity(L: TransferFunction, omega: FloatArray) -> FloatArray:
    """ln|S| = -ln|1 + L| over omega, -inf at a pole of L; small values keep their digits."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        value = L.response(omega)
        small = 0.5 * np.log1p(2.0 * value.real + value.real**2 + value.imag**2)
        out = -np.where(np.abs(value) < 0.1, small, np.log(np.abs(1.0 + value)))
    return np.where(np.isfinite(value), out, -np.inf)


def _refusal(loop: FeedbackLoop, L: TransferFunction) -> str | None:
    verdict = closed_loop_verdict(loop)
    if not verdict.closed_loop_stable:
        return f"the theorem is about stable loops, and this one is not: {verdict.because}"
    if L.relative_degree == 0 and L.gain:
        where = "turns around without end" if L.theta else "settles elsewhere"
        return (
            f"L has as many zeros as poles: at high frequencies it does not vanish, ln|S| {where} and the integral "
            "does not converge. Give the controller or the plant one lag more"
        )
    return None


def bode_integral(loop: FeedbackLoop) -> BodeIntegral:
    r"""Bode's integral of a loop, computed and foretold.

    .. math:: \int_0^\infty \ln|S(i\omega)|\,d\omega = \pi \sum_k \mathrm{Re}\,p_k -
        \begin{cases} 0 & \theta > 0 \\ \tfrac{\pi}{2} \lim_{s\to\infty} s L(s) & \theta = 0 \end{cases}

    p_k are the poles of L in the open right half-plane. Neither end of the axis is cut off: near 0 the asymptote
    k_0/s^m of L is integrated in closed form. Beyond all corners the rest is integrated over 1/omega, or, with dead
    time, along the line that leaves the axis at right angles: ln(1 + L) has no singularity between the two paths, and
    on that line it decays as e^{-theta t}.

    Parameters
    ----------
    loop : FeedbackLoop
        Dead time exact.

    Returns
    -------
    BodeIntegral
        Without a value, with the reason, where the loop is not stable or L does not vanish at high frequencies.

    Raises
    ------
    NoConvergence
        The dead time is so long that it turns more than some ten thousand times below the last corner.

    References
    ----------
    .. [1] J. S. Freudenberg, D. P. Looze, Right half plane poles and zeros and design tradeoffs in feedback systems,
       IEEE Trans. Autom. Control 30 (1985) 555-565.
    .. [2] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 9.2.
    """
    L, _ = split_hidden_modes(loop.open_loop)
    if L.gain == 0.0:
        # Poles that nothing moves are no poles of L = 0.
        L = TransferFunction([], [], 0.0)
    unstable = L.poles[L.poles.real > AXIS_GAP * np.abs(L.poles)]
    omega, ln_S = _curve(L)
    reason = _refusal(loop, L)
    if reason or not L.gain:
        none = None if reason else 0.0
        return BodeIntegral(
            *(none,) * 5, None, None, none, none, none, _limit(L), unstable, omega, ln_S, reason
        )  # fmt: skip
    k = L.gain if L.relative_degree == 1 else 0.0
    theorem = float(np.pi * unstable.real.sum()) - (0.0 if L.theta else 0.5 * np.pi * k)
    low, origin = _origin(L)
    # What is drawn, and whose areas are told, lies below the tail.
    high = max(_beyond_corners(L), float(omega[-1]), 2.0 * low)
    edges = _edges(L, low, high)

    def over_log(x: FloatArray) -> FloatArray:
        w = np.exp(x)
        return w * log_sensitivity(L, w)

    inner = over_log(np.log(edges[1:-1]))
    scale = float(np.abs(inner[np.isfinite(inner)]).max(initial=1e-300))
    panels, error = integrate_panels(over_log, np.log(edges), PANEL_TOLERANCE * scale)
    tail, tail_error = _tail(L, high, PANEL_TOLERANCE * scale)
    middle = float(panels.sum())
    parts = np.append(panels, origin)
    left = error + tail_error + ORIGIN_TOLERANCE * low
    return BodeIntegral(
        origin + middle + tail, theorem, origin, middle, tail, low, high,
        float(-parts[parts < 0].sum()) + 0.0, float(parts[parts > 0].sum()), left,
        k, unstable, omega, ln_S,
    )  # fmt: skip


def _limit(L: TransferFunction) -> float | None:
    """The limit of s L(s), dead time left out; None where it is infinite."""
    if not L.gain or L.relative_degree > 1:
        return 0.0
    return L.gain if L.relative_degree == 1 else None


def _origin(L: TransferFunction) -> tuple[float, float]:
    """A frequency below which ln|S| is its asymptote m ln omega - ln|k0|, and the integral up to there."""
    m = L.origin_order
    level = -np.log(abs(L.origin_gain)) if m > 0 else -np.log(abs(1.0 + L.dc_gain)) if m == 0 else 0.0
    low, power = float(default_grid(L)[0]), max(m, 0)
    while abs(log_sensitivity(L, np.array([low]))[0] - power * np.log(low) - level) > ORIGIN_TOLERANCE and low > 1e-30:
        low *= 0.25
    return low, float(low * (power * (np.log(low) - 1.0) + level))


def _beyond_corners(L: TransferFunction) -> float:
    """A frequency beyond which |s| > 4 |root| for every root, and |L(s)| < 1/2 in the right half-plane."""
    sizes_z, sizes_p = np.abs(L.zeros), np.abs(L.poles)
    high = BEYOND * max(sizes_z.max(initial=0.0), sizes_p.max(initial=0.0))
    high = max(high, abs(L.gain) ** (1.0 / L.relative_degree))

    def bound(w: float) -> float:
        return float(
            np.log(abs(L.gain)) - L.relative_degree * np.log(w)
            + np.log1p(sizes_z / w).sum() - np.log1p(-sizes_p / w).sum()
        )  # fmt: skip

    while bound(high) > np.log(SMALL):
        high *= 1.5
    return float(high)


def _edges(L: TransferFunction, low: float, high: float) -> FloatArray:
    """Panels from low to high that end where |S| is 0 or 1."""
    grid = default_grid(L)
    more = [np.geomspace(low, high, 2 + int(8 * np.log10(high / low))), grid[(grid > low) & (grid < high)]]
    omega = np.unique(np.concatenate(more))
    on_axis = np.abs(L.poles.imag[np.abs(L.poles.real) <= AXIS_GAP * np.abs(L.poles)])
    zero = np.unique(on_axis[(on_axis > low) & (on_axis < high)])
    sign = log_sensitivity(L, omega) > 0
    at = np.flatnonzero(sign[1:] != sign[:-1])
    one = refine_brackets(lambda w: log_sensitivity(L, w), omega[at], omega[at + 1])
    return np.unique(np.concatenate([omega, zero, one]))


def _tail(L: TransferFunction, high: float, tolerance: float) -> tuple[float, float]:
    """The integral from ``high`` to infinity, and what the quadrature leaves."""
    if not L.theta:

        def over_period(x: FloatArray) -> FloatArray:
            return log_sensitivity(L, high / x) * high / x**2

        panels, error = integrate_panels(over_period, np.linspace(0.0, 1.0, 3), tolerance)
        return float(panels.sum()), error

    def off_axis(t: FloatArray) -> FloatArray:
        value = 1.0 + L((1j * high + t).astype(complex))
        return -np.arctan2(value.imag, value.real)

    end = DECAY / L.theta
    edges = np.concatenate([[0.0], np.geomspace(min(high, end) * 1e-2, end, 24)])
    panels, error = integrate_panels(off_axis, edges, tolerance)
    return float(panels.sum()), error


def _curve(L: TransferFunction) -> tuple[FloatArray, FloatArray]:
    """ln|S| over a linear axis that shows where it is large: to four times the last of its marks."""
    if not L.gain:
        omega = np.linspace(0.0, 1.0, 2)
        return omega, np.zeros(2)
    found = margins(L)
    summit = found.omega_Ms if (found.Ms or 1.0) > SEEN else None
    marks = [w for w in (summit, found.omega_c) if w]
    end = 4.0 * max(marks) if marks else float(np.sqrt(default_grid(L)[0] * default_grid(L)[-1]))
    grid = default_grid(L)
    omega = np.unique(np.concatenate([np.linspace(0.0, end, PLOT_POINTS), grid[grid < end]]))
    ln_S = log_sensitivity(L, omega)
    shown = np.isfinite(ln_S)
    return omega[shown], ln_S[shown]
