"""What a first- or second-order system is: time constant, damping, overshoot, decay ratio, period."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.laplace import ExponentialSum, LaplaceInput, inverse_transform, partial_fractions
from looplab.engine.low_order.models import steady_gain
from looplab.engine.systems.transfer_function import TransferFunction

Classification = Literal[
    "stable", "overdamped", "critically damped", "underdamped", "undamped", "integrating", "unstable"
]
# A damping ratio this close to 1 (or 0) is 1 (or 0): the rest is rounding.
_CRITICAL = 1e-14
_UNDAMPED = 1e-12
_SETTLED = 1.0 - math.exp(-1.0)
NUMBERS = (
    "K", "tau", "tau_1", "tau_2", "zeta", "omega_n", "omega_d", "period",
    "t_63", "t_peak", "overshoot_pct", "decay_ratio", "initial_slope",
)  # fmt: skip


@dataclass(frozen=True)
class Character:
    r"""A first- or second-order system in the terms of its step response; None is explained in ``reasons``.

    .. math:: \frac{K e^{-\theta s}}{\tau s + 1} \quad\text{or}\quad
        \frac{K e^{-\theta s}}{\tau^2 s^2 + 2 \zeta \tau s + 1}, \qquad \omega_n = \frac{1}{\tau}

    Attributes
    ----------
    order : int
        1 or 2.
    classification : str
        "stable" (first order), "overdamped", "critically damped", "underdamped", "undamped", "integrating" or
        "unstable".
    K : float or None
        Steady-state gain [output/input].
    tau, tau_1, tau_2 : float or None
        Time constant (second order: 1/omega_n); slow and fast lag of real poles [time].
    zeta, omega_n, omega_d : float or None
        Damping ratio [-], natural and damped frequency [rad/time].
    period : float or None
        2 pi tau/sqrt(1 - zeta^2) [time].
    t_63, t_peak : float or None
        When the step response first reaches 63.2 % of its final value; when it peaks; dead time included [time].
    overshoot_pct, decay_ratio : float or None
        Of the step response [%], [-].
    initial_slope : float or None
        Slope of the step response when it starts [output/time].
    theta : float
        Dead time [time].
    """

    order: int
    classification: Classification
    theta: float
    K: float | None = None
    tau: float | None = None
    tau_1: float | None = None
    tau_2: float | None = None
    zeta: float | None = None
    omega_n: float | None = None
    omega_d: float | None = None
    period: float | None = None
    t_63: float | None = None
    t_peak: float | None = None
    overshoot_pct: float | None = None
    decay_ratio: float | None = None
    initial_slope: float | None = None
    reasons: dict[str, str] = field(default_factory=dict)


def _first_crossing(y: ExponentialSum, level: float, horizon: float) -> float | None:
    """First time after the dead time at which y reaches a level, by sampling and bisection [time]."""
    t = y.theta + np.linspace(0.0, horizon, 4001)
    reached = np.flatnonzero(y(t) >= level) if level > 0 else np.flatnonzero(y(t) <= level)
    if not reached.size:
        return None
    if reached[0] == 0:
        return y.theta
    low, high = float(t[reached[0] - 1]), float(t[reached[0]])
    for _ in range(80):
        middle = 0.5 * (low + high)
        past = (float(y(middle)) >= level) == (level > 0)
        low, high = (low, middle) if past else (middle, high)
    return high


def _step(system: TransferFunction, K: float | None, out: dict[str, float | None], why: dict[str, str]) -> None:
    """What is read off the exact step response: its slope at the start and its 63.2 % point."""
    y = inverse_transform(partial_fractions(system, LaplaceInput("step")))
    # Two lags start flat; the sum of exponentials would leave a rounding.
    out["initial_slope"] = float(y.derivative()(system.theta)) if system.relative_degree < 2 else 0.0
    if system.order == 1 and not system.zeros.size and K is not None:
        out["t_63"] = system.theta + float(-1.0 / system.poles[0].real)
    elif K is None:
        why["t_63"] = "undefined: the step response has no final value"
    elif K == 0:
        why["t_63"] = "undefined: the step response ends where it began"
    else:
        out["t_63"] = _first_crossing(y, _SETTLED * K, 12.0 / float(-system.poles.real.max()))


def _first_order(system: TransferFunction, out: dict[str, float | None], why: dict[str, str]) -> Classification:
    pole = float(system.poles[0].real)
    for name in ("zeta", "omega_n", "omega_d", "period", "overshoot_pct", "decay_ratio", "t_peak"):
        why[name] = "undefined: a first-order system does not oscillate"
    why["tau_2"] = "undefined: a first-order system has one time constant"
    if pole == 0:
        why["tau"] = why["tau_1"] = "undefined: an integrator has no time constant"
        return "integrating"
    out["tau"] = out["tau_1"] = -1.0 / pole
    return "stable" if pole < 0 else "unstable"


def _second_order(system: TransferFunction, out: dict[str, float | None], why: dict[str, str]) -> Classification:
    p, q = (complex(v) for v in system.poles)
    product, total = (p * q).real, (p + q).real
    if product == 0:
        for name in ("tau", "zeta", "omega_n", "omega_d", "period"):
            why[name] = "undefined: an integrator has no natural frequency"
        if total < 0:
            out["tau_1"] = -1.0 / total
        return "integrating" if total < 0 else "unstable"
    if product < 0:
        for name in ("tau", "zeta", "omega_n", "omega_d", "period"):
            why[name] = "undefined: the poles are real with opposite signs"
        return "unstable"
    omega_n = math.sqrt(p.real) * math.sqrt(q.real) if not p.imag and p.real > 0 else math.sqrt(product)
    zeta = -total / (2.0 * omega_n)
    if abs(zeta) <= _UNDAMPED:
        zeta = 0.0
    out["tau"], out["omega_n"], out["zeta"] = 1.0 / omega_n, omega_n, zeta
    critical = abs(abs(zeta) - 1.0) <= _CRITICAL
    if not p.imag or critical:
        for name in ("omega_d", "period"):
            why[name] = "undefined: real poles do not oscillate"
        if zeta > 0:
            lags = sorted((-1.0 / p.real, -1.0 / q.real), reverse=True)
            out["tau_1"], out["tau_2"] = lags
    else:
        out["omega_d"] = abs(p.imag)
        out["period"] = 2.0 * math.pi / abs(p.imag)
    if zeta <= 0:
        return "unstable" if zeta < 0 else "undamped"
    if critical:
        return "critically damped"
    return "overdamped" if not p.imag else "underdamped"


def _oscillation(
    system: TransferFunction, kind: Classification, out: dict[str, float | None], why: dict[str, str]
) -> None:
    """Overshoot, decay ratio and peak time of a second-order step response without zeros."""
    names = ("overshoot_pct", "decay_ratio", "t_peak")
    if system.zeros.size:
        why |= dict.fromkeys(names, "the formula is for a system without zeros: a zero changes the overshoot")
    elif kind in ("overdamped", "critically damped"):
        out["overshoot_pct"] = 0.0
        why |= dict.fromkeys(names[1:], "undefined: the step response does not overshoot")
    elif kind == "underdamped":
        omega_d = out["omega_d"]
        assert omega_d is not None
        # zeta/sqrt(1 - zeta^2), without the difference of two numbers near 1.
        slant = float(-system.poles[0].real) / omega_d
        out["overshoot_pct"] = 100.0 * math.exp(-math.pi * slant)
        out["decay_ratio"] = math.exp(-2.0 * math.pi * slant)
        out["t_peak"] = system.theta + math.pi / omega_d
    elif kind == "undamped":
        assert out["omega_d"] is not None
        out["overshoot_pct"], out["decay_ratio"] = 100.0, 1.0
        out["t_peak"] = system.theta + math.pi / out["omega_d"]
    else:
        why |= dict.fromkeys(names, "undefined: the step response has no final value")


def characterize(system: TransferFunction) -> Character:
    r"""Read a first- or second-order system.

    .. math::

        \text{overshoot} = e^{-\pi\zeta/\sqrt{1-\zeta^2}}, \qquad
        \text{decay ratio} = e^{-2\pi\zeta/\sqrt{1-\zeta^2}}, \qquad
        \text{period} = \frac{2\pi\tau}{\sqrt{1-\zeta^2}}

    Parameters
    ----------
    system : TransferFunction
        One or two poles, proper; zeros are allowed, but then overshoot, decay ratio and peak time are not given.

    Returns
    -------
    Character

    Raises
    ------
    InvalidInput
        The system has no poles or more than two.
    ImproperSystem
        More zeros than poles.

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, secs. 5.2 and 5.4.
    """
    system.require_proper()
    if not 1 <= system.order <= 2:
        raise InvalidInput(
            f"the system has order {system.order}: this reading is for one or two poles",
            field="system",
            hint="approximate it first by a low-order model",
        )
    out: dict[str, float | None] = dict.fromkeys(NUMBERS)
    why: dict[str, str] = {}
    kind = (_first_order if system.order == 1 else _second_order)(system, out, why)
    K = steady_gain(system)
    if math.isfinite(K) and kind not in ("unstable", "integrating"):
        out["K"] = K
    else:
        why["K"] = f"undefined: the system is {kind}, it has no steady state"
    _step(system, None if kind in ("unstable", "integrating", "undamped") else out["K"], out, why)
    if system.order == 2:
        _oscillation(system, kind, out, why)
    for name in ("tau", "tau_1", "tau_2"):
        if out[name] is None and name not in why:
            complex_pair = bool(system.poles.imag.any())
            why[name] = f"undefined: the poles are {'complex' if complex_pair else 'not two stable lags'}"
    return Character(system.order, kind, system.theta, **out, reasons={k: v for k, v in why.items() if out[k] is None})
