"""Stability margins and sensitivity peaks, with the closed-loop verdict beside them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from math import exp, log

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.crossings import OFTEN, crossings
from looplab.engine.frequency.nyquist import nyquist_count
from looplab.engine.frequency.response import AXIS_GAP
from looplab.engine.frequency.scalar import illinois, scalar_loop
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


def _peak(L: TransferFunction, omega: FloatArray, kind: str) -> tuple[float, float]:
    """Largest |S| or |T| over omega, refined where the slope changes sign; (value, omega)."""

    value, q = _on_grid(L, omega)
    with np.errstate(divide="ignore", invalid="ignore"):
        S = 1.0 / (1.0 + value)
        size = np.abs(S if kind == "S" else value * S)
        # d ln|S| / d omega = Im(T q), d ln|T| / d omega = -Im(S q), with q = L'/L.
        rate = np.imag((value if kind == "S" else -1.0) * S * q)
    size = np.nan_to_num(size, nan=0.0, posinf=np.inf)
    at = np.flatnonzero((rate[:-1] > 0) & (rate[1:] <= 0))
    # Only the highest summits can win; the rest need no refinement.
    if at.size > 8:
        at = at[np.argsort(np.maximum(size[at], size[at + 1]))[-8:]]
    best = int(np.argmax(size))
    top, where = float(size[best]), float(omega[best])
    loop = scalar_loop(L)
    for i in at.tolist():
        x = illinois(lambda x: loop.sensitivity_slope(x, kind), log(omega[i]), log(omega[i + 1]))
        peak = loop.peak_size(x, kind)
        if peak > top:
            top, where = peak, exp(x)
    return top, where


def _on_grid(L: TransferFunction, omega: FloatArray) -> tuple[npt.NDArray[np.complex128], npt.NDArray[np.complex128]]:
    """L and L'/L at j omega."""
    s = (1j * omega).astype(complex)
    return L(s), L.log_derivative(s)


def _sensitivity_peaks(L: TransferFunction, omega: FloatArray) -> dict[str, float]:
    Ms, omega_Ms = _peak(L, omega, "S")
    Mt, omega_Mt = _peak(L, omega, "T")
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


@lru_cache(maxsize=256)
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
    stays = bool((hidden.real >= -AXIS_GAP * np.abs(hidden)).any())
    stable = count.Z == 0 and not count.through_minus_one and not stays
    reasons: dict[str, str] = {}

    listed = np.isfinite(found.phase_log_magnitude)
    phase_crossovers = [
        PhaseCrossover(float(w), float(np.exp(-m)))
        for w, m in zip(found.phase_omega[listed], found.phase_log_magnitude[listed], strict=True)
    ]
    if L.origin_order == 0 and L.origin_gain < 0:
        phase_crossovers.insert(0, PhaseCrossover(0.0, 1.0 / abs(L.origin_gain)))
    if found.cut:
        reasons["phase_crossovers"] = (
            f"dead time makes them infinitely many: listed up to omega = {found.omega[-1]:.4g}"
        )
    GM = omega_180 = GM_dB = None
    if phase_crossovers:
        nearest = min(phase_crossovers, key=lambda c: abs(np.log(c.GM)))
        GM, omega_180, GM_dB = nearest.GM, nearest.omega, float(20 * np.log10(nearest.GM))
    else:
        text = "infinite: the phase never reaches -180 deg" if L.gain else "undefined: the open loop is zero"
        reasons |= dict.fromkeys(("GM", "GM_dB", "omega_180"), text)

    wrapped = np.mod(found.gain_phase, 2 * np.pi) - np.pi  # 0 on the negative real axis
    gain_crossovers = [
        GainCrossover(float(w), float(np.degrees(p))) for w, p in zip(found.gain_omega, wrapped, strict=True)
    ]
    PM_deg = omega_c = delay_margin = None
    if gain_crossovers:
        tightest = min(gain_crossovers, key=lambda c: abs(c.PM_deg))
        PM_deg, omega_c = tightest.PM_deg, tightest.omega
        if stable:
            room = np.mod(found.gain_phase + np.pi, 2 * np.pi) / found.gain_omega
            delay_margin = float(room.min())
        else:
            reasons["delay_margin"] = "undefined: the closed loop is not stable as it is"
    else:
        text = "infinite: the gain never reaches 1"
        if not L.gain:
            text = "undefined: the open loop is zero"
        elif abs(L.response(found.omega[:1])[0]) > 1.0:
            text = "undefined: the gain never falls to 1"
        reasons |= dict.fromkeys(("PM_deg", "omega_c", "delay_margin"), text)

    peaks: dict[str, float | None] = (
        dict(_sensitivity_peaks(reduced, found.omega)) if L.gain else dict(Ms=1.0, omega_Ms=0.0, Mt=0.0, omega_Mt=0.0)
    )
    # Where one is infinite L is -1, and so is the other.
    infinite = any(value is not None and not value < 1e8 for value in (peaks["Ms"], peaks["Mt"]))
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
