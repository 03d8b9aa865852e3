"""P, PI, PD and PID controllers with a filtered derivative, and the conversions between their forms."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import isfinite

import numpy as np

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.systems.polynomial import roots
from looplab.engine.systems.transfer_function import TransferFunction

FORMS = ("ideal", "series")


@dataclass(frozen=True)
class PID:
    r"""PID controller with filtered derivative.

    .. math::

        \text{ideal:}\quad G_c = K_c\left(1 + \frac{1}{\tau_I s} + \frac{\tau_D s}{\alpha\tau_D s + 1}\right)
        \qquad
        \text{series:}\quad G_c = K_c\left(1 + \frac{1}{\tau_I s}\right)\frac{\tau_D s + 1}{\alpha\tau_D s + 1}

    Parameters
    ----------
    Kc : float
        Controller gain [input/output].
    tau_I : float or None
        Integral time, > 0; None switches integral action off [time].
    tau_D : float or None
        Derivative time, >= 0; None or 0 switches derivative action off [time].
    alpha : float
        Filter time over derivative time, > 0 [-]. The unfiltered derivative (alpha = 0) is not causal.
    form : {"ideal", "series"}
    beta : float
        Setpoint weight: the proportional part acts on beta r - y [-].
    action : {"reverse", "direct"}
        "reverse" raises u when y is below r (for K > 0); "direct" flips the sign of the controller.

    Raises
    ------
    InvalidInput
        A setting is outside its range.
    ImproperSystem
        alpha is zero while the derivative acts.
    """

    Kc: float
    tau_I: float | None = None
    tau_D: float | None = None
    alpha: float = 0.1
    form: str = "ideal"
    beta: float = 1.0
    action: str = "reverse"

    def __post_init__(self) -> None:
        for name in ("Kc", "tau_I", "tau_D", "alpha", "beta"):
            value = getattr(self, name)
            if value is not None and not isfinite(value):
                raise InvalidInput(f"{name} must be a finite number", field=name)
        if self.tau_I is not None and self.tau_I <= 0:
            raise InvalidInput(
                "tau_I must be positive", field="tau_I", hint="to switch integral action off, give null instead of 0"
            )
        if self.tau_D is not None and self.tau_D < 0:
            raise InvalidInput("tau_D must be zero or positive", field="tau_D")
        if self.alpha < 0:
            raise InvalidInput("alpha must be positive", field="alpha", hint="0.1 is usual")
        if self.tau_D and self.alpha == 0:
            raise ImproperSystem(
                "a derivative without a filter (alpha = 0) is not causal: it would need the future of the error",
                field="alpha",
                hint="use a filter, alpha = 0.1 is usual",
            )
        if self.form not in FORMS:
            raise InvalidInput("form must be ideal or series", field="form")
        if self.action not in ("reverse", "direct"):
            raise InvalidInput("action must be reverse or direct", field="action")

    @classmethod
    def from_parallel(
        cls, Kp: float, Ki: float = 0.0, Kd: float = 0.0, alpha: float = 0.1, beta: float = 1.0, action: str = "reverse"
    ) -> PID:
        r"""The ideal form of Kp + Ki/s + Kd s/(alpha tau_D s + 1), with tau_I = Kp/Ki and tau_D = Kd/Kp.

        Raises
        ------
        InvalidInput
            Kp is zero while Ki or Kd is not, or the signs differ: the ideal form has no such controller.
        """
        if Kp == 0 and (Ki or Kd):
            raise InvalidInput(
                "the parallel form with Kp = 0 has no time constants", field="Kp", hint="type it as a transfer function"
            )
        for name, value in (("Ki", Ki), ("Kd", Kd)):
            if value * Kp < 0:
                raise InvalidInput(f"{name} must have the sign of Kp", field=name)
        return cls(Kp, Kp / Ki if Ki else None, Kd / Kp if Kd else None, alpha, beta=beta, action=action)

    @property
    def type(self) -> str:
        """P, PI, PD or PID."""
        return "P" + ("I" if self.tau_I is not None else "") + ("D" if self.tau_D else "")

    @property
    def sign(self) -> float:
        """+1 for reverse, -1 for direct action."""
        return 1.0 if self.action == "reverse" else -1.0

    def to_transfer_function(self) -> TransferFunction:
        """Gc(s) from the error e = r - y to u, as zeros, poles and gain."""
        return self.per_gain.with_gain(self.sign * self.Kc * self.per_gain.gain)

    @cached_property
    def per_gain(self) -> TransferFunction:
        """Gc(s) for Kc = 1 and reverse action: one object for all gains."""
        return _per_gain(self.tau_I, self.tau_D, self.alpha, self.form)

    def to_latex(self, digits: int = 4) -> str:
        """The controller with its numbers, in the form it is used."""
        from looplab.engine.systems.notation import latex_number

        def n(value: float) -> str:
            return latex_number(value, digits)

        integral = rf"\frac{{1}}{{{n(self.tau_I)}\,s}}" if self.tau_I is not None else ""
        head = n(self.sign * self.Kc)
        if not self.tau_D:
            return rf"{head}\left(1 + {integral}\right)" if integral else head
        filtered = rf"{n(self.alpha * self.tau_D)}\,s + 1"
        if self.form == "series":
            lead = rf"\frac{{{n(self.tau_D)}\,s + 1}}{{{filtered}}}"
            return rf"{head}\left(1 + {integral}\right){lead}" if integral else rf"{head}\,{lead}"
        terms = " + ".join(t for t in ("1", integral, rf"\frac{{{n(self.tau_D)}\,s}}{{{filtered}}}") if t)
        return rf"{head}\left({terms}\right)"


@lru_cache(maxsize=128)
def _per_gain(tau_I: float | None, tau_D: float | None, alpha: float, form: str) -> TransferFunction:
    """Gc(s) for Kc = 1."""
    gain = 1.0
    zeros: list[complex] = []
    poles: list[complex] = []
    if tau_D and form == "ideal" and tau_I is not None:
        zeros = list(roots(np.array([tau_I * tau_D * (1.0 + alpha), tau_I + alpha * tau_D, 1.0])))
        poles = [0.0, -1.0 / (alpha * tau_D)]
        gain = (1.0 + alpha) / alpha
    else:
        if tau_I is not None:
            zeros.append(-1.0 / tau_I)
            poles.append(0.0)
        if tau_D:
            lead = tau_D * (1.0 + alpha) if form == "ideal" else tau_D
            zeros.append(-1.0 / lead)
            poles.append(-1.0 / (alpha * tau_D))
            gain = lead / (alpha * tau_D)
    return TransferFunction(zeros, poles, gain)


def require_causal(C: TransferFunction) -> None:
    """Raise ImproperSystem where a controller differentiates; an unfiltered PD or PID is named, with its filtered form.

    Raises
    ------
    ImproperSystem
        C has more zeros than poles.
    """
    ideal = _unfiltered(C)
    if ideal is None:
        C.require_proper("controller")
        return
    Kc, tau_I, tau_D = ideal
    integral = f" + 1/({tau_I:.4g} s)" if tau_I is not None else ""
    raise ImproperSystem(
        "a derivative without a filter is not causal: it would need the future of the error",
        field="controller",
        hint=f"filter it: {Kc:.4g} (1{integral} + {tau_D:.4g} s/({0.1 * tau_D:.4g} s + 1)), the PID with alpha = 0.1",
    )


def _unfiltered(C: TransferFunction) -> tuple[float, float | None, float] | None:
    """Kc, tau_I and tau_D of an ideal PD or PID without a filter; None for anything else."""
    if C.theta or C.relative_degree != -1 or C.poles.any() or not C.gain:
        return None
    # Kc (1 + 1/(tau_I s) + tau_D s) = k (s^2 + b s + c)/s; without the integrator k (s + b).
    b = float(-C.zeros.sum().real)
    c = float(C.zeros.prod().real) if C.order else None
    if C.order > 1 or b <= 0 or (c is not None and c <= 0):
        return None
    return C.gain * b, None if c is None else b / c, 1.0 / b
