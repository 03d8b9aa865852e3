r"""Ideal, series and parallel form of one PID controller, exactly, with and without its derivative filter.

All three are one transfer function, (b2 s^2 + b1 s + b0)/(s (Tf s + 1)), written in other numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, isfinite, sqrt

from looplab.engine.errors import InvalidInput, RuleNotApplicable


@dataclass(frozen=True)
class Gains:
    """Settings in ideal or series form: Kc [input/output], tau_I (None: no integral action) and tau_D [time]."""

    Kc: float
    tau_I: float | None = None
    tau_D: float = 0.0

    def __post_init__(self) -> None:
        if not isfinite(self.Kc):
            raise InvalidInput("Kc must be a finite number", field="Kc")
        if self.tau_I is not None and not (isfinite(self.tau_I) and self.tau_I > 0):
            raise InvalidInput("tau_I must be positive", field="tau_I", hint="null switches integral action off")
        if not (isfinite(self.tau_D) and self.tau_D >= 0):
            raise InvalidInput("tau_D must be zero or positive", field="tau_D")


@dataclass(frozen=True)
class ParallelGains:
    """Kp [input/output], Ki [input/output/time] and Kd [input/output*time]."""

    Kp: float
    Ki: float = 0.0
    Kd: float = 0.0


def _check_filter(Tf: float) -> None:
    if not (isfinite(Tf) and Tf >= 0):
        raise InvalidInput("the filter time must be zero or positive", field="Tf")


def series_to_ideal(series: Gains, Tf: float = 0.0) -> Gains:
    r"""The ideal form of a series controller; every series controller has one while its filter is faster than its lead.

    .. math::

        \tau_I = \tau_I' + \tau_D' - T_f, \qquad K_c = K_c'\,\frac{\tau_I}{\tau_I'}, \qquad
        \tau_D = \frac{\tau_I'\tau_D'}{\tau_I} - T_f

    Parameters
    ----------
    series : Gains
        Kc' (1 + 1/(tau_I' s)) (tau_D' s + 1)/(Tf s + 1).
    Tf : float
        Time constant of the derivative filter, the same in both forms; 0 for none [time].

    Returns
    -------
    Gains
        Kc (1 + 1/(tau_I s) + tau_D s/(Tf s + 1)).

    Raises
    ------
    InvalidInput
        Tf is negative.
    RuleNotApplicable
        The filter is slower than the lead: the ideal form would need a negative derivative time.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, Advanced PID Control, ISA 2006, sec. 3.3 (for Tf = 0).
    """
    _check_filter(Tf)
    Kc, tau_D = series.Kc, series.tau_D
    if not tau_D:
        return series
    if Tf > tau_D:
        raise RuleNotApplicable("the derivative filter is slower than the lead it filters", field="tau_D")
    if series.tau_I is None:
        return Gains(Kc, None, tau_D - Tf)
    # The filter is taken off the lead first: what is lost nowhere is the positive part.
    tau_I = series.tau_I + (tau_D - Tf)
    return Gains(Kc * (tau_I / series.tau_I), tau_I, (tau_D - Tf) * ((series.tau_I - Tf) / tau_I))


def ideal_to_series(ideal: Gains, Tf: float = 0.0) -> Gains:
    r"""The series form of an ideal controller, where its zeros are real.

    .. math::

        \tau_I',\,\tau_D' = \tfrac12\left(\tau_I + T_f \pm \sqrt{(\tau_I - T_f)^2 - 4\tau_I\tau_D}\right), \qquad
        K_c' = K_c\,\frac{\tau_I'}{\tau_I}

    Parameters
    ----------
    ideal : Gains
        Kc (1 + 1/(tau_I s) + tau_D s/(Tf s + 1)).
    Tf : float
        Time constant of the derivative filter, the same in both forms; 0 for none [time].

    Returns
    -------
    Gains
        The one with tau_I' >= tau_D'.

    Raises
    ------
    InvalidInput
        Tf is negative.
    RuleNotApplicable
        tau_I < 4 tau_D (without a filter): the zeros are complex, and a series controller has real ones.

    References
    ----------
    .. [1] K. J. Åström, T. Hägglund, Advanced PID Control, ISA 2006, sec. 3.3 (for Tf = 0).
    """
    _check_filter(Tf)
    Kc, tau_I, tau_D = ideal.Kc, ideal.tau_I, ideal.tau_D
    if not tau_D:
        return ideal
    if tau_I is None:
        return Gains(Kc, None, tau_D + Tf)
    rest = (tau_I - Tf) ** 2 - 4.0 * tau_I * tau_D
    # A double zero, but for rounding, is still real.
    if rest < -1e-12 * tau_I**2:
        limit = "tau_I < 4 tau_D" if not Tf else "(tau_I - Tf)^2 < 4 tau_I tau_D"
        raise RuleNotApplicable(
            f"{limit}: the controller's zeros are complex, and the series form has real ones only",
            field="tau_D",
            hint="use the ideal or the parallel form, or less derivative action",
        )
    slow = 0.5 * (tau_I + Tf + sqrt(max(rest, 0.0)))
    return Gains(Kc * (slow / tau_I), slow, tau_I * (tau_D + Tf) / slow)


def ideal_to_parallel(ideal: Gains) -> ParallelGains:
    r"""The parallel form.

    .. math:: K_p = K_c, \qquad K_i = K_c/\tau_I, \qquad K_d = K_c\,\tau_D

    Parameters
    ----------
    ideal : Gains

    Returns
    -------
    ParallelGains
        With the same filter on the derivative part.

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, sec. 8.2.
    """
    return ParallelGains(ideal.Kc, ideal.Kc / ideal.tau_I if ideal.tau_I is not None else 0.0, ideal.Kc * ideal.tau_D)


def parallel_to_ideal(parallel: ParallelGains) -> Gains:
    r"""The ideal form of a parallel controller.

    .. math:: K_c = K_p, \qquad \tau_I = K_p/K_i, \qquad \tau_D = K_d/K_p

    Parameters
    ----------
    parallel : ParallelGains
        All of one sign.

    Returns
    -------
    Gains

    Raises
    ------
    InvalidInput
        Kp is zero while Ki or Kd is not, or the signs differ: the ideal form has no such controller.

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, sec. 8.2.
    """
    Kp, Ki, Kd = parallel.Kp, parallel.Ki, parallel.Kd
    if Kp == 0 and (Ki or Kd):
        raise InvalidInput("the parallel form with Kp = 0 has no time constants", field="Kp")
    for name, value in (("Ki", Ki), ("Kd", Kd)):
        if value and copysign(1.0, value) != copysign(1.0, Kp):
            raise InvalidInput(f"{name} must have the sign of Kp", field=name)
    return Gains(Kp, Kp / Ki if Ki else None, Kd / Kp if Kd else 0.0)


def proportional_band(Kc: float) -> float:
    r"""Proportional band of a controller gain in normalised units (both signals as a share of their span).

    .. math:: \mathrm{PB} = \frac{100}{|K_c|}

    Parameters
    ----------
    Kc : float
        Not zero [% of output span per % of input span].

    Returns
    -------
    float
        [%]

    Raises
    ------
    InvalidInput
        Kc is zero: the band is infinitely wide.

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, sec. 8.2.1.
    """
    if Kc == 0 or not isfinite(Kc):
        raise InvalidInput("a gain of zero has no proportional band", field="Kc")
    return 100.0 / abs(Kc)
