"""What a control loop on a nonlinear model is made of: controller, valve, sensor, saturation, and who is in charge."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.controllers import PID
from looplab.engine.nonlinear.inputs import InputCourse

ANTI_WINDUP = ("none", "back_calculation", "clamping")
DISCRETIZATIONS = ("backward", "tustin")
MODES = ("auto", "manual")
MAX_MODE_CHANGES = 50
LONGEST = 1e9
LARGEST_GAIN = 1e12


def _time(value: float, name: str, zero: bool = False) -> None:
    if not (math.isfinite(value) and (value > 0 or (zero and value == 0)) and value <= LONGEST):
        raise InvalidInput(f"{name} must be {'zero or ' if zero else ''}a positive time up to {LONGEST:g}", field=name)


def _number(value: float | None, name: str) -> None:
    if value is not None and not math.isfinite(value):
        raise InvalidInput(f"{name} must be a finite number", field=name)


@dataclass(frozen=True)
class Lag:
    r"""A lag of a valve or a sensor, with unit gain.

    .. math:: \tau\dot y = u - y \qquad \text{or} \qquad \tau^2\ddot y + 2\zeta\tau\dot y + y = u

    Attributes
    ----------
    tau : float
        Time constant [time].
    zeta : float or None
        Damping of a second-order lag; None is a first-order one [-].
    rate : float or None
        Fastest change of a first-order lag's output [signal/time].
    """

    tau: float
    zeta: float | None = None
    rate: float | None = None

    def __post_init__(self) -> None:
        _time(self.tau, "tau")
        if self.zeta is not None and not 0 <= self.zeta <= 1e3:
            raise InvalidInput("zeta must be from 0 to 1000", field="zeta")
        if self.rate is not None:
            if not (math.isfinite(self.rate) and self.rate > 0):
                raise InvalidInput("rate must be positive", field="rate")
            if self.zeta is not None:
                raise InvalidInput("only a first-order lag has a limited rate", field="rate", hint="leave zeta out")


@dataclass(frozen=True)
class MeasurementNoise:
    """Normal noise on the measurement, held from value to value.

    Attributes
    ----------
    std : float
        Standard deviation [output].
    interval : float or None
        Time from value to value; None is the sampling time [time].
    seed : int
    """

    std: float
    interval: float | None = None
    seed: int = 0


@dataclass(frozen=True)
class Instrument:
    """A valve or a sensor: a lag, then a dead time (a valve: a dead time, then a lag).

    Attributes
    ----------
    lag : Lag or None
    theta : float
        Dead time [time].
    """

    lag: Lag | None = None
    theta: float = 0.0

    def __post_init__(self) -> None:
        _time(self.theta, "theta", zero=True)


@dataclass(frozen=True)
class ModeChange:
    """From ``t`` on the loop is in ``mode``; ``value`` is what an operator sets, None the controller's last output."""

    t: float
    mode: str
    value: float | None = None

    def __post_init__(self) -> None:
        _time(self.t, "t", zero=True)
        _number(self.value, "value")
        if self.mode not in MODES:
            raise InvalidInput(f"mode must be {' or '.join(MODES)}", field="mode")
        if self.mode == "auto" and self.value is not None:
            raise InvalidInput("in auto the controller decides: a value is for manual only", field="value")


@dataclass(frozen=True)
class ControlLoop:
    r"""A PID controller between an output and an input of a model.

    .. math::

        v = \bar u + K_c\Big(r - y_m + (\beta - 1)(r - r_0) + \frac{1}{\tau_I}\int (r - y_m)\,dt
            + \frac{\tau_D s}{\alpha\tau_D s + 1}(\gamma r - y_m)\Big),
        \qquad u = \min(\max(v, u_{min}), u_{max})

    Attributes
    ----------
    output, input : str
        What is measured, and what the controller moves.
    setpoint : InputCourse
        r [output].
    controller : PID
        In the ideal form; beta weighs changes of the setpoint from r_0, where it was before the start.
    gamma : float
        Setpoint weight of the derivative: 1 acts on the error, 0 on the measurement alone [-].
    bias : float or None
        u before the controller acts; None is the input's nominal value [input].
    u_min, u_max : float or None
        Saturation; None is the input's own range [input].
    anti_windup : str
        none, back_calculation or clamping (the integrator stands still while u is saturated and the error would drive
        it further).
    T_t : float or None
        Tracking time of back-calculation; None is sqrt(tau_I tau_D), or tau_I without a derivative [time].
    sampling_time : float or None
        None is a continuous controller [time].
    discretization : str
        backward or tustin: how a sampled controller integrates and differentiates.
    valve, sensor : Instrument
    noise : MeasurementNoise or None
    modes : tuple of ModeChange
        In order of time; auto before the first. A sampled controller changes with its next sample.
    """

    output: str
    input: str
    setpoint: InputCourse
    controller: PID
    gamma: float = 1.0
    bias: float | None = None
    u_min: float | None = None
    u_max: float | None = None
    anti_windup: str = "none"
    T_t: float | None = None
    sampling_time: float | None = None
    discretization: str = "backward"
    valve: Instrument = field(default_factory=Instrument)
    sensor: Instrument = field(default_factory=Instrument)
    noise: MeasurementNoise | None = None
    modes: tuple[ModeChange, ...] = ()

    def __post_init__(self) -> None:
        for name in ("gamma", "bias", "u_min", "u_max"):
            _number(getattr(self, name), name)
        for name in ("T_t", "sampling_time"):
            value = getattr(self, name)
            if value is not None:
                _time(value, name)
        if abs(self.controller.Kc) > LARGEST_GAIN:
            raise InvalidInput(f"Kc must be at most {LARGEST_GAIN:g}", field="controller.Kc")
        if self.controller.form != "ideal":
            raise InvalidInput(
                "the controller of a nonlinear loop has the ideal form",
                field="controller.form",
                hint="convert the series form, or type the ideal one",
            )
        if self.anti_windup not in ANTI_WINDUP:
            raise InvalidInput(f"anti_windup must be one of {', '.join(ANTI_WINDUP)}", field="anti_windup")
        if self.discretization not in DISCRETIZATIONS:
            raise InvalidInput(f"discretization must be one of {', '.join(DISCRETIZATIONS)}", field="discretization")
        if self.sensor.lag is not None and self.sensor.lag.rate is not None:
            raise InvalidInput("a sensor has no rate limit", field="sensor.lag.rate")
        if len(self.modes) > MAX_MODE_CHANGES:
            raise InvalidInput(f"there are at most {MAX_MODE_CHANGES} changes of mode", field="modes")
        for index in range(1, len(self.modes)):
            if not self.modes[index].t > self.modes[index - 1].t:
                raise InvalidInput("the changes of mode must be in order of time", field=f"modes[{index}].t")
        if self.noise is not None and self.noise.interval is None and self.sampling_time is None:
            raise InvalidInput(
                "the noise of a continuous controller needs an interval",
                field="noise.interval",
                hint="a tenth of the fastest time constant, say",
            )

    @property
    def Kc(self) -> float:
        """Gain with the sign of its action [input/output]."""
        return self.controller.sign * self.controller.Kc

    @property
    def Ki(self) -> float:
        """Gain over integral time; 0 without integral action [input/(output time)]."""
        return 0.0 if self.controller.tau_I is None else self.Kc / self.controller.tau_I

    @property
    def filter_time(self) -> float:
        """alpha tau_D; 0 without derivative action [time]."""
        return self.controller.alpha * (self.controller.tau_D or 0.0)

    @property
    def tracking_time(self) -> float:
        """T_t, or its usual choice; infinite without integral action [time]."""
        tau_I, tau_D = self.controller.tau_I, self.controller.tau_D
        if tau_I is None:
            return math.inf
        return self.T_t or (math.sqrt(tau_I * tau_D) if tau_D else tau_I)
