"""The PID algorithm of a computer: one value of u for each sample."""

from __future__ import annotations

from dataclasses import dataclass

from looplab.engine.nonlinear.control_loop.settings import ControlLoop


@dataclass(frozen=True)
class Range:
    """Where u may be; an end that is infinite is none."""

    low: float
    high: float

    def clip(self, value: float) -> float:
        """The nearest value inside."""
        return min(max(value, self.low), self.high)


class SampledPID:
    r"""PID with the integral and the derivative taken from sample to sample.

    .. math::

        \text{backward:}\quad I_k = I_{k-1} + \frac{K_c h}{\tau_I} e_k, \quad
        D_k = \frac{T_f D_{k-1} + K_c\tau_D (d_k - d_{k-1})}{T_f + h}

        \text{tustin:}\quad I_k = I_{k-1} + \frac{K_c h}{2\tau_I}(e_k + e_{k-1}), \quad
        D_k = \frac{(2 T_f - h) D_{k-1} + 2 K_c\tau_D (d_k - d_{k-1})}{2 T_f + h}

    with e = r - y, d = gamma r - y and the filter time T_f = alpha tau_D.

    Parameters
    ----------
    loop : ControlLoop
        With a sampling time h.
    limits : Range
    u : float
        What u is before the first sample [input].
    r, y : float
        Setpoint and measurement before the first sample [output].

    Attributes
    ----------
    v, u : float
        Last output before and after saturation [input].
    integral : float
        I, the bias included [input].

    References
    ----------
    .. [1] K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 3rd ed., Prentice Hall 1997, sec. 8.5.
    """

    def __init__(self, loop: ControlLoop, limits: Range, u: float, r: float, y: float) -> None:
        h = loop.sampling_time or 0.0
        self.limits, self.beta, self.gamma, self.Kc = limits, loop.controller.beta, loop.gamma, loop.Kc
        self.clamping = loop.anti_windup == "clamping"
        # A tracking time below the sampling time would overshoot: one sample resets all.
        self.tracking = min(1.0, h / loop.tracking_time) if loop.anti_windup == "back_calculation" else 0.0
        tau_D, filter_time = loop.controller.tau_D or 0.0, loop.filter_time
        if loop.discretization == "tustin":
            self.now, self.last = 0.5 * h * loop.Ki, 0.5 * h * loop.Ki
            below = 2.0 * filter_time + h
            self.decay, self.slope = (2.0 * filter_time - h) / below, 2.0 * loop.Kc * tau_D / below
        else:
            self.now, self.last = h * loop.Ki, 0.0
            self.decay, self.slope = filter_time / (filter_time + h), loop.Kc * tau_D / (filter_time + h)
        self.reference = r
        self.integral, self.derivative = u, 0.0
        self.e, self.d = r - y, self.gamma * r - y
        self.v = self.u = u
        self.manual: float | None = None
        self.taken_over = False

    def set_mode(self, auto: bool, value: float | None) -> None:
        """Manual from the next sample on, at ``value`` or where u is; or auto."""
        if auto:
            self.taken_over = self.manual is not None
            self.manual = None
        else:
            self.manual = self.u if value is None else float(value)

    def sample(self, r: float, y: float) -> float:
        """u until the next sample."""
        e, d = r - y, self.gamma * r - y
        P = self.Kc * (e + (self.beta - 1.0) * (r - self.reference))
        self.derivative = self.decay * self.derivative + self.slope * (d - self.d)
        if self.manual is not None:
            self.v = self.manual
            self.u = self.limits.clip(self.v)
        else:
            if self.taken_over:
                # Bumpless: the integral is what makes u go on from where it is.
                self.integral, self.taken_over = self.u - P - self.derivative, False
            else:
                self._integrate(P + self.derivative, self.now * e + self.last * self.e)
            self.v = P + self.integral + self.derivative
            self.u = self.limits.clip(self.v)
            self.integral += self.tracking * (self.u - self.v)
        self.e, self.d = e, d
        return self.u

    def _integrate(self, rest: float, increment: float) -> None:
        v = rest + self.integral + increment
        pushed = (v > self.limits.high and increment > 0) or (v < self.limits.low and increment < 0)
        if not (self.clamping and pushed):
            self.integral += increment
