"""Bode, Nyquist and margins of an open loop that is no single transfer function with a dead time."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from looplab.engine.delays.connections import feedback
from looplab.engine.delays.curve import Curve, follow, log_magnitude
from looplab.engine.delays.resolvent import transfer_and_slope, transfer_matrix
from looplab.engine.delays.system import DelaySystem
from looplab.engine.delays.verdict import delay_verdict
from looplab.engine.errors import InvalidInput
from looplab.engine.frequency.bode import Bode
from looplab.engine.frequency.bracketing import refine_brackets
from looplab.engine.frequency.margins import GainCrossover, Margins, PhaseCrossover
from looplab.engine.frequency.nyquist import NyquistCount, NyquistCurve
from looplab.engine.systems.polynomial import FloatArray


def delay_bode(system: DelaySystem, low: float | None = None, high: float | None = None) -> Bode:
    r"""Bode data of one input and output, dead times exact.

    .. math:: 20\log_{10}|L(i\omega)|, \qquad \arg L(i\omega)

    Parameters
    ----------
    system : DelaySystem
    low, high : float or None
        Ends of the frequency axis [rad/time]; None chooses them.

    Returns
    -------
    Bode
        On a grid that follows the phase, which is anchored at omega -> 0.

    Raises
    ------
    InvalidInput
        The system is zero at all frequencies, or low and high are not positive and increasing.

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, ch. 14.
    """
    if not (low or 1e-300) < (high or np.inf):
        raise InvalidInput("the frequency range must be two positive numbers, the smaller first", field="omega")
    curve = follow(system, low, high)
    if curve is None:
        raise InvalidInput("the system passes nothing", field="system")
    return Bode(curve.omega, 20.0 * np.log10(np.abs(curve.value)), np.degrees(curve.phase))


def delay_nyquist(system: DelaySystem) -> tuple[NyquistCurve, NyquistCount]:
    r"""The Nyquist curve of an open loop, and its count.

    .. math:: N = Z - P

    Parameters
    ----------
    system : DelaySystem
        L under unit negative feedback.

    Returns
    -------
    tuple of NyquistCurve and NyquistCount
        Z and P, the poles of the closed and of the open loop in the right half-plane, by the argument principle on
        their characteristic functions; None with a reason where they are infinitely many.

    Raises
    ------
    NoConvergence
        The dead times turn the phase too often.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 10.2.
    """
    curve = follow(system)
    shown = np.zeros(0, dtype=bool) if curve is None else np.abs(curve.value) < 1e6
    if curve is None:
        line = NyquistCurve(np.zeros(0), np.zeros(0), np.zeros(0))
    else:
        line = NyquistCurve(curve.omega[shown], curve.value.real[shown], curve.value.imag[shown])
    closed, opened = delay_verdict(feedback(system)), delay_verdict(system)
    Z, P = closed.rhp_poles, opened.rhp_poles
    if closed.verdict == "marginal":
        return line, NyquistCount(None, P or 0, None, f"N is not defined: {closed.because}", True)
    if Z is None or P is None:
        return line, NyquistCount(None, P or 0, None, closed.because if Z is None else opened.because)
    return line, NyquistCount(Z - P, P, Z)


def _crossings(system: DelaySystem, curve: Curve) -> tuple[list[GainCrossover], list[float], list[PhaseCrossover]]:
    x, size = np.log(curve.omega), np.log(np.abs(curve.value))
    at = np.flatnonzero((size[1:] > 0) != (size[:-1] > 0))
    omega_c = np.exp(refine_brackets(lambda v: log_magnitude(system, v), x[at], x[at + 1]))
    value = transfer_matrix(system, 1j * omega_c)[:, 0, 0]
    gain = [GainCrossover(float(w), float(np.degrees(a))) for w, a in zip(omega_c, np.angle(-value), strict=True)]
    # -L turns from pi to -pi here, through zero: the angle is its own residual.
    band = np.floor((curve.phase + np.pi) / (2.0 * np.pi))
    at = np.flatnonzero(band[1:] != band[:-1])

    def angle(v: FloatArray) -> FloatArray:
        return np.angle(-transfer_matrix(system, 1j * np.exp(v))[:, 0, 0])

    omega_p = np.exp(refine_brackets(angle, x[at], x[at + 1]))
    value = transfer_matrix(system, 1j * omega_p)[:, 0, 0]
    # Over a pole or zero of the axis the phase jumps: no crossing.
    true = np.abs(np.angle(-value)) < 1e-6
    phase = [PhaseCrossover(float(w), float(1.0 / abs(v))) for w, v in zip(omega_p[true], value[true], strict=True)]
    room = [float(np.mod(np.radians(c.PM_deg), 2 * np.pi) / c.omega) for c in gain]
    return gain, room, phase


def _peak(system: DelaySystem, curve: Curve, kind: str) -> tuple[float, float]:
    """Largest |S| or |T| on the curve, refined; (value, omega)."""

    def size_and_rate(omega: FloatArray) -> tuple[FloatArray, FloatArray]:
        value, slope = transfer_and_slope(system, (1j * omega).astype(complex))
        L, q = value[:, 0, 0], slope[:, 0, 0] / value[:, 0, 0]
        S = 1.0 / (1.0 + L)
        function = S if kind == "S" else L * S
        # d ln|S|/d omega = Im(T q), d ln|T|/d omega = -Im(S q).
        return np.abs(function), np.imag((L if kind == "S" else -1.0) * S * q)

    with np.errstate(divide="ignore", invalid="ignore"):
        size, rate = size_and_rate(curve.omega)
        best = int(np.nanargmax(size))
        top, where = float(size[best]), float(curve.omega[best])
        at = np.flatnonzero((rate[:-1] > 0) & (rate[1:] <= 0))
        at = at[np.argsort(np.maximum(size[at], size[at + 1]))[-8:]]
        x = np.log(curve.omega)
        omega = np.exp(refine_brackets(lambda v: size_and_rate(np.exp(v))[1], x[at], x[at + 1]))
        for w, value in zip(omega, size_and_rate(omega)[0], strict=True):
            if value > top:
                top, where = float(value), float(w)
    return top, where


_GAIN, _PHASE = ("GM", "GM_dB", "omega_180"), ("PM_deg", "omega_c", "delay_margin")


def _cuts(system: DelaySystem, curve: Curve) -> dict[str, str]:
    """What the end of the grid cuts off."""
    if not system.tau.size:
        return {}
    last = f"up to omega = {curve.omega[-1]:.4g}"
    reasons = {"phase_crossovers": f"the dead times may make infinitely many: listed {last}"}
    if curve.overrun:
        turns = "the dead times turn the curve more than 250 times before |L| falls below 1"
        reasons["gain_crossovers"] = f"{turns}: listed {last}"
    if curve.overrun or not curve.fading:
        reasons["Ms"] = reasons["Mt"] = f"the largest {last}"
    return reasons


def _size(L: float, kind: str) -> float:
    """|S| or |T| for a real L, infinite ones included."""
    if L == -1.0:
        return np.inf
    if np.isinf(L):
        return 1.0 if kind == "T" else 0.0
    return abs((1.0 if kind == "S" else L) / (1.0 + L))


def _peaks(system: DelaySystem, curve: Curve, at_rest: float, reasons: dict[str, str]) -> dict[str, float | None]:
    """Ms and Mt with their frequencies, the ends of the axis included."""
    out: dict[str, float | None] = {}
    ends = [(at_rest, 0.0)] if system.tau.size else [(at_rest, 0.0), (float(system.D11[0, 0]), np.inf)]
    for kind, name in (("S", "Ms"), ("T", "Mt")):
        size, where = _peak(system, curve, kind)
        for L, omega in ends:
            if _size(L, kind) >= size * (1 - 1e-12):
                size, where = _size(L, kind), omega
        out |= {name: size, f"omega_{name}": where}
        if not size < 1e8:
            out[name], reasons[name] = None, "infinite: the Nyquist curve passes through -1"
        if where == np.inf:
            out[f"omega_{name}"], reasons[f"omega_{name}"] = None, "approached at ever higher frequencies"
    return out


@lru_cache(maxsize=32)
def delay_margins(system: DelaySystem) -> Margins:
    r"""Margins of an open loop under unit negative feedback, dead times exact.

    .. math::

        \mathrm{GM} = \frac{1}{|L(i\omega_{180})|}, \quad \mathrm{PM} = 180^\circ + \arg L(i\omega_c), \quad
        M_s = \max_\omega \left|\frac{1}{1+L}\right|, \quad M_t = \max_\omega \left|\frac{L}{1+L}\right|

    Parameters
    ----------
    system : DelaySystem
        L, one input and one output.

    Returns
    -------
    Margins
        As ``frequency.margins`` has them. The lists end where \|L\| stays below 0.05, or where the dead times have
        turned the curve 250 times; ``reasons`` says where.

    Raises
    ------
    NoConvergence
        The dead times turn the phase too often.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 2.4.
    """
    stable = delay_verdict(feedback(system)).closed_loop_stable
    curve = follow(system)
    found: dict[str, float | None] = dict.fromkeys((*_GAIN, *_PHASE))
    if curve is None:
        why = dict.fromkeys(found, "undefined: the open loop is zero")
        at_zero = dict(Ms=1.0, omega_Ms=0.0, Mt=0.0, omega_Mt=0.0)
        return Margins(stable, gain_crossovers=(), phase_crossovers=(), reasons=why, **found, **at_zero)
    reasons = _cuts(system, curve)
    gain, room, phase = _crossings(system, curve)
    at_rest = np.inf if curve.origin_order > 0 else float(transfer_matrix(system, 0.0)[0, 0, 0].real)
    if at_rest < 0:
        phase.insert(0, PhaseCrossover(0.0, 1.0 / abs(at_rest)))
    if phase:
        nearest = min(phase, key=lambda c: abs(np.log(c.GM)))
        found |= {"GM": nearest.GM, "GM_dB": float(20 * np.log10(nearest.GM)), "omega_180": nearest.omega}
    else:
        reasons |= dict.fromkeys(_GAIN, "infinite: the phase never reaches -180 deg")
    if gain:
        tightest = min(gain, key=lambda c: abs(c.PM_deg))
        found |= {"PM_deg": tightest.PM_deg, "omega_c": tightest.omega}
        if stable:
            found["delay_margin"] = min(room)
        else:
            reasons["delay_margin"] = "undefined: the closed loop is not stable as it is"
    else:
        reasons |= dict.fromkeys(_PHASE, "infinite: the gain never reaches 1")
    peaks = _peaks(system, curve, at_rest, reasons)
    return Margins(
        stable, gain_crossovers=tuple(gain), phase_crossovers=tuple(phase), reasons=reasons, **found, **peaks
    )
