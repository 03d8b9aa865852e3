"""Stability margins and sensitivity peaks, with the closed-loop verdict beside them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache, partial
from math import degrees, exp, isfinite, log, log10, pi, sqrt

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.crossings import OFTEN, ON_AXIS, ROUNDING, crossings
from looplab.engine.frequency.nyquist import nyquist_count
from looplab.engine.frequency.response import AXIS_GAP
from looplab.engine.frequency.sampled import Sampled, UnitCurve
from looplab.engine.frequency.scalar import newton_in_bracket, scalar_loop
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class GainCrossover:
    """\\|L\\| = 1 at omega [rad/time], with the phase margin there [deg]."""

    omega: float
    PM_deg: float


@dataclass(frozen=True)
class PhaseCrossover:
    """L real and negative at omega [rad/time], with the gain margin 1/\\|L\\| there [-]."""

    omega: float
    GM: float


@dataclass(frozen=True)
class Margins:
    """Margins of an open loop; None is explained in ``reasons`` under the field's name."""

    closed_loop_stable: bool
    GM: float | None
    GM_dB: float | None
    omega_180: float | None
    PM_deg: float | None
    omega_c: float | None
    delay_margin: float | None
    Ms: float | None
    omega_Ms: float | None
    Mt: float | None
    omega_Mt: float | None
    gain_crossovers: tuple[GainCrossover, ...]
    phase_crossovers: tuple[PhaseCrossover, ...]
    reasons: dict[str, str] = field(default_factory=dict)


_NAMES = ("GM", "GM_dB", "omega_180", "PM_deg", "omega_c", "delay_margin", "Ms", "omega_Ms", "Mt", "omega_Mt")


@lru_cache(maxsize=64)
def _sensitivity_terms(curve: UnitCurve) -> tuple[FloatArray, ...]:
    r"""What 1 + L and the slopes of \|S\| and \|T\| are made of, apart from powers of the gain, shape (n,) each.

    With q = omega L'/L they are Im(T q) for ln\|S\| and -Im(S q) for ln\|T\| over ln omega; times \|1 + L\|^2 these are
    k Im(L q) + k^2 \|L\|^2 Im q and -(Im q + k Im(q conj L)) for the gain k.
    """
    with np.errstate(all="ignore"):
        value, q = curve.value, curve.rate
        square = np.square(curve.size)
        terms = (2.0 * value.real, square, (value * q).imag, square * q.imag, q.imag, (q * value.conj()).imag)
    return tuple(map(np.ascontiguousarray, terms))


def _peaks_on(grid: Sampled) -> list[tuple[float, float]]:
    """Largest |S| and largest |T| on a grid, refined where their slopes change sign: (value, omega) of each."""
    omega, value, k = grid.omega, grid.curve.value, abs(grid.gain)
    twice_real, square, first, second, third, fourth = _sensitivity_terms(grid.curve)
    loop = scalar_loop(grid.curve.unit)
    out = []
    with np.errstate(all="ignore"):
        away = np.abs(1.0 + k * (twice_real + k * square))
        both = (("S", 1.0 / away, k * (first + k * second)), ("T", square / away, -third - k * fourth))
    for part, size, slopes in both:
        if not grid.curve.is_finite:
            size[np.isnan(size)] = 0.0
        highest = int(size.argmax())
        on_grid = sqrt(size[highest]) * (1.0 if part == "S" else k)
        top = where = 0.0
        rising = slopes > 0.0
        slope = partial(loop.sensitivity_slope, gain=k, part=part)
        summits = (rising[:-1] > rising[1:]).nonzero()[0].tolist()
        for i in sorted(summits, key=size.__getitem__, reverse=True):
            # The chord bounds how near -1 the curve may come between two points: most summits cannot win.
            start, end = (k * v for v in value[i : i + 2].tolist())
            nearest = 0.5 * (abs(1.0 + start) + abs(1.0 + end)) - 0.6 * abs(end - start)
            reach = 1.0 if part == "S" else 1.1 * max(abs(start), abs(end))
            if nearest > 0.0 and reach <= max(top, on_grid) * nearest:
                continue
            x = newton_in_bracket(slope, log(omega[i]), log(omega[i + 1]), slopes[i : i + 2].tolist())
            peak = loop.peak_size(x, k, part)
            if peak > top:
                top, where = peak, exp(x)
        if top < on_grid:
            end = float(omega[highest])
            peak = loop.peak_size(log(end), k, part)
            if peak > top:
                top, where = peak, end
        out.append((top, where))
    return out


def _stands_on_the_real_axis(grid: Sampled) -> bool:
    """Whether two neighbours on the grid lie on the negative real axis."""
    on_axis = np.abs(np.mod(grid.phase, 2.0 * pi) - pi) <= ON_AXIS
    return bool((on_axis[1:] & on_axis[:-1]).any())


def _sensitivity_peaks(L: TransferFunction, grid: Sampled) -> dict[str, float]:
    (Ms, omega_Ms), (Mt, omega_Mt) = _peaks_on(grid)
    # Limits of L at both ends of the frequency axis, where they are finite.
    ends: list[tuple[float, float]] = []
    if L.origin_order <= 0:
        ends.append((L.dc_gain, 0.0))
    if L.theta == 0 or L.relative_degree > 0:
        ends.append((L.high_frequency_gain, np.inf))
    for value, w in ends:
        if value == -1.0:
            Ms, omega_Ms, Mt, omega_Mt = np.inf, w, np.inf, w
            continue
        if abs(1.0 / (1.0 + value)) >= Ms * (1 - 1e-12):
            Ms, omega_Ms = abs(1.0 / (1.0 + value)), w
        if abs(value / (1.0 + value)) >= Mt * (1 - 1e-12):
            Mt, omega_Mt = abs(value / (1.0 + value)), w
    if L.theta > 0 and L.relative_degree == 0:
        # The dead time turns L around a circle of radius |L(inf)| without end.
        c = abs(L.gain)
        limit = np.inf if c == 1.0 else 1.0 / abs(1.0 - c)
        if limit > Ms:
            Ms, omega_Ms = limit, np.inf
        if c * limit > Mt:
            Mt, omega_Mt = c * limit, np.inf
    if L.origin_order > 0 and Mt <= 1.0:
        Mt, omega_Mt = 1.0, 0.0
    return {"Ms": Ms, "omega_Ms": omega_Ms, "Mt": Mt, "omega_Mt": omega_Mt}


@lru_cache(maxsize=64)
def margins(L: TransferFunction) -> Margins:
    r"""Gain, phase and delay margins, all crossovers, and the peaks of the sensitivity functions.

    .. math::

        \mathrm{GM} = \frac{1}{|L(i\omega_{180})|}, \quad \mathrm{PM} = 180^\circ + \arg L(i\omega_c), \quad
        M_s = \max_\omega \left|\frac{1}{1+L}\right|, \quad M_t = \max_\omega \left|\frac{L}{1+L}\right|

    Of several crossovers the one that is nearest to instability is reported (smallest \|ln GM\|, smallest \|PM\|).

    Parameters
    ----------
    L : TransferFunction
        Proper open loop, dead time exact.

    Returns
    -------
    Margins
        None with a reason where a margin is infinite or undefined. GM is below 1 where lowering the gain (or, for an
        unstable loop, raising it) crosses the limit. An unstable loop is a result; its margins prove nothing.

    Notes
    -----
    GM > 1 and PM > 0 prove stability only for simple loops: ``closed_loop_stable`` is Nyquist's count.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 2.4.
    """
    found = crossings(L)
    count = nyquist_count(L)
    reduced, hidden = split_hidden_modes(L)
    if found.overrun:
        why = dict.fromkeys(_NAMES, f"not computed: the dead time turns the Nyquist curve {OFTEN}")
        return Margins(False, gain_crossovers=(), phase_crossovers=(), reasons=why, **dict.fromkeys(_NAMES))
    if L.gain == 0.0:
        hidden = L.poles
    # A hidden mode on the axis does not decay, and the curve does not know of it.
    stays = any(p.real >= -AXIS_GAP * abs(p) for p in hidden.tolist())
    stable = count.Z == 0 and not count.through_minus_one and not stays
    reasons: dict[str, str] = {}

    phase_crossovers = [
        PhaseCrossover(w, exp(-m))
        for w, m in zip(found.phase_omega.tolist(), found.phase_log_magnitude.tolist(), strict=True)
        if isfinite(m)
    ]
    if L.origin_order == 0 and L.origin_gain < 0:
        phase_crossovers.insert(0, PhaseCrossover(0.0, 1.0 / abs(L.origin_gain)))
    if found.cut:
        reasons["phase_crossovers"] = (
            f"dead time makes them infinitely many: listed up to omega = {found.grid.omega[-1]:.4g}"
        )
    GM = omega_180 = GM_dB = None
    if phase_crossovers:
        nearest = min(phase_crossovers, key=lambda c: abs(log(c.GM)))
        GM, omega_180, GM_dB = nearest.GM, nearest.omega, 20.0 * log10(nearest.GM)
    else:
        text = "infinite: the phase never reaches -180 deg" if L.gain else "undefined: the open loop is zero"
        if L.gain and _stands_on_the_real_axis(found.grid):
            text = "undefined: the phase stands at -180 deg, L is negative over a whole range of frequencies"
        reasons |= dict.fromkeys(("GM", "GM_dB", "omega_180"), text)

    gain_omega, gain_phase = found.gain_omega.tolist(), found.gain_phase.tolist()
    gain_crossovers = [  # the phase is 0 on the negative real axis
        GainCrossover(w, degrees(p % (2 * pi) - pi)) for w, p in zip(gain_omega, gain_phase, strict=True)
    ]
    PM_deg = omega_c = delay_margin = None
    if gain_crossovers:
        tightest = min(gain_crossovers, key=lambda c: abs(c.PM_deg))
        PM_deg, omega_c = tightest.PM_deg, tightest.omega
        if stable:
            delay_margin = min((p + pi) % (2 * pi) / w for w, p in zip(gain_omega, gain_phase, strict=True))
        else:
            reasons["delay_margin"] = "undefined: the closed loop is not stable as it is"
    else:
        text = "infinite: the gain never reaches 1"
        if not L.gain:
            text = "undefined: the open loop is zero"
        elif (np.abs(found.grid.log_magnitude) < ROUNDING).all():
            text = "undefined: the gain is 1 at every frequency"
        elif abs(L.response(found.grid.omega[:1])[0]) > 1.0:
            text = "undefined: the gain never falls to 1"
        reasons |= dict.fromkeys(("PM_deg", "omega_c", "delay_margin"), text)

    peaks: dict[str, float | None] = (
        dict(_sensitivity_peaks(reduced, found.grid)) if L.gain else dict(Ms=1.0, omega_Ms=0.0, Mt=0.0, omega_Mt=0.0)
    )
    # Where one is infinite L is -1, and so is the other; along the real axis the peak may hide between grid points.
    infinite = any(value is not None and not value < 1e8 for value in (peaks["Ms"], peaks["Mt"]))
    on_minus_one = [c.omega for c in gain_crossovers if abs(c.PM_deg) < 1e-6]
    if on_minus_one and not infinite:
        infinite, peaks["omega_Ms"], peaks["omega_Mt"] = True, on_minus_one[0], on_minus_one[0]
    for name in ("Ms", "Mt"):
        if infinite:
            peaks[name] = None
            reasons[name] = "infinite: the Nyquist curve passes through -1"
        if peaks[f"omega_{name}"] == np.inf:
            peaks[f"omega_{name}"] = None
            reasons[f"omega_{name}"] = "approached at ever higher frequencies"
    return Margins(
        stable, GM, GM_dB, omega_180, PM_deg, omega_c, delay_margin,
        peaks["Ms"], peaks["omega_Ms"], peaks["Mt"], peaks["omega_Mt"],
        tuple(gain_crossovers), tuple(phase_crossovers), reasons,
    )  # fmt: skip
