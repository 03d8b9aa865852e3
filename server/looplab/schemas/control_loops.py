"""Control loops on a nonlinear model as JSON."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.control_loop import ControlLoop, Instrument, Lag, MeasurementNoise, ModeChange
from looplab.engine.nonlinear.control_loop.settings import MAX_MODE_CHANGES
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.schemas.base import Model, located
from looplab.schemas.controllers import ParallelPID, StandardPID, controller_tag
from looplab.schemas.courses import Course, course_kind

Name = Annotated[str, Field(max_length=32)]
Theta = Annotated[float, Field(ge=0, le=1e9, description="Dead time [time].")]
Controller = Annotated[
    Annotated[StandardPID, Tag("pid")] | Annotated[ParallelPID, Tag("pid-parallel")],
    Discriminator(
        controller_tag,
        custom_error_type="controller_type",
        custom_error_message="the controller of a nonlinear model is of type 'pid'",
    ),
]
Setpoint = Annotated[
    Annotated[float, Tag("number")] | Annotated[Course, Tag("course")],
    Discriminator(course_kind),
    Field(description="r: a number, or what it does over time, with its level or table."),
]


class LagShape(Model):
    """A lag with unit gain: of first order, or of second with ``zeta``."""

    tau: Annotated[float, Field(gt=0, le=1e9, description="Time constant [time].")]
    zeta: Annotated[float | None, Field(ge=0, description="Damping of a second-order lag.")] = None

    def to_engine(self) -> Lag:
        """The lag for the engine; raises EngineError naming the field."""
        return Lag(self.tau, self.zeta)


class ValveLagShape(LagShape):
    """A lag of a valve, whose speed may be limited."""

    rate: Annotated[float | None, Field(gt=0, description="Fastest change, of a first-order lag [input/time].")] = None

    def to_engine(self) -> Lag:
        """The lag for the engine; raises EngineError naming the field."""
        return Lag(self.tau, self.zeta, self.rate)


class SensorShape(Model):
    """A sensor: a lag, then a dead time."""

    lag: LagShape | None = None
    theta: Theta = 0.0


class ValveShape(Model):
    """A valve: a dead time, then a lag."""

    lag: ValveLagShape | None = None
    theta: Theta = 0.0


class MeasurementNoiseShape(Model):
    """Normal noise on the measurement, held from value to value."""

    std: Annotated[float, Field(ge=0, description="Standard deviation [output].")]
    interval: Annotated[
        float | None, Field(gt=0, description="Time from value to value; left out: the sampling time [time].")
    ] = None
    seed: Annotated[int, Field(ge=0, le=2**31, description="The same seed gives the same noise.")] = 0

    def to_engine(self) -> MeasurementNoise:
        """The noise for the engine."""
        return MeasurementNoise(self.std, self.interval, self.seed)


class ModeChangeShape(Model):
    """Who is in charge from ``t`` on. From manual to auto u goes on from where it is."""

    t: Annotated[float, Field(ge=0, le=1e9)]
    mode: Literal["auto", "manual"]
    value: Annotated[float | None, Field(description="u in manual; left out: as it is then [input].")] = None

    def to_engine(self) -> ModeChange:
        """The change for the engine; raises EngineError naming the field."""
        return ModeChange(self.t, self.mode, self.value)


class ControlLoopShape(Model):
    """A PID controller that measures an output and moves an input."""

    output: Name
    input: Name
    setpoint: Setpoint
    controller: Annotated[Controller, Field(description="In the ideal or the parallel form.")]
    gamma: Annotated[
        float, Field(description="Setpoint weight of the derivative: 1 acts on the error, 0 on the output alone.")
    ] = 1.0
    bias: Annotated[float | None, Field(description="u at the start; left out: nominal [input].")] = None
    u_min: Annotated[float | None, Field(description="Left out: that of the input's range [input].")] = None
    u_max: Annotated[float | None, Field(description="Left out: that of the input's range [input].")] = None
    anti_windup: Annotated[
        Literal["none", "back_calculation", "clamping"],
        Field(description="clamping: the integral stands still while it would drive u further beyond a limit."),
    ] = "none"
    T_t: Annotated[
        float | None,
        Field(gt=0, description="Of back-calculation; left out: sqrt(tau_I tau_D), or tau_I without tau_D [time]."),
    ] = None
    sampling_time: Annotated[float | None, Field(gt=0, description="null: a continuous controller [time].")] = None
    discretization: Annotated[
        Literal["backward", "tustin"], Field(description="How a sampled controller integrates and differentiates.")
    ] = "backward"
    valve: ValveShape = Field(default=ValveShape())
    sensor: SensorShape = Field(default=SensorShape())
    noise: MeasurementNoiseShape | None = None
    modes: Annotated[
        list[ModeChangeShape], Field(max_length=MAX_MODE_CHANGES, description="In order of time; auto before.")
    ] = Field(default=[])

    def to_engine(self, horizon: float) -> ControlLoop:
        """The loop for the engine; raises EngineError naming the field."""
        with located("setpoint"):
            setpoint = self._setpoint(horizon)
        with located("controller"):
            controller = self.controller.to_engine()
        return ControlLoop(
            self.output,
            self.input,
            setpoint,
            controller,
            self.gamma,
            self.bias,
            self.u_min,
            self.u_max,
            self.anti_windup,
            self.T_t,
            self.sampling_time,
            self.discretization,
            self._valve(),
            self._sensor(),
            None if self.noise is None else self.noise.to_engine(),
            self._modes(),
        )

    def _setpoint(self, horizon: float) -> InputCourse:
        if not isinstance(self.setpoint, Course):
            return InputCourse(float(self.setpoint))
        if self.setpoint.level is None and self.setpoint.table is None:
            raise InvalidInput("a setpoint has a level or a table", field="level")
        return self.setpoint.to_engine(0.0, horizon)

    def _valve(self) -> Instrument:
        with located("valve.lag"):
            return Instrument(None if self.valve.lag is None else self.valve.lag.to_engine(), self.valve.theta)

    def _sensor(self) -> Instrument:
        with located("sensor.lag"):
            return Instrument(None if self.sensor.lag is None else self.sensor.lag.to_engine(), self.sensor.theta)

    def _modes(self) -> tuple[ModeChange, ...]:
        out = []
        for index, change in enumerate(self.modes):
            with located(f"modes[{index}]"):
                out.append(change.to_engine())
        return tuple(out)
