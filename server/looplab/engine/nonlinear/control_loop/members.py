"""The loops at work in a simulation, each with the inputs it gives to the closed loop's model."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Protocol

import numpy as np

from looplab.engine.nonlinear.control_loop.agenda import measuring_times, sample_times
from looplab.engine.nonlinear.control_loop.history import History
from looplab.engine.nonlinear.control_loop.loop_model import LoopNames
from looplab.engine.nonlinear.control_loop.sampled_pid import Range, SampledPID
from looplab.engine.nonlinear.control_loop.settings import ControlLoop, MeasurementNoise
from looplab.engine.nonlinear.control_loop.start import LoopStart, within
from looplab.engine.nonlinear.inputs import InputCourse, noise
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation.right_hand_side import Course, RightHandSide, RunsAway
from looplab.engine.nonlinear.simulation.watch import LARGEST_STATE
from looplab.engine.response import InputSignal
from looplab.engine.systems.polynomial import FloatArray


class Held:
    """An input that keeps its value until it is given another."""

    def __init__(self, value: float) -> None:
        self.value = value

    def piece(self, start: float) -> float | Callable[[float], float]:
        """The value it has now."""
        del start
        return self.value


class Member(Protocol):
    """What the simulation needs of a loop."""

    loop: ControlLoop
    names: LoopNames
    limits: Range
    courses: dict[str, Course]
    histories: list[tuple[History, int]]

    def measure(self, out: Values) -> None:
        """The sensor is read."""

    def change_mode(self, t: float, x: FloatArray, rhs: RightHandSide, p: Values) -> FloatArray:
        """The next change of mode is due; the states after it."""

    def sample(self) -> None:
        """The controller's next sample is due."""

    def move_valve(self) -> None:
        """What the controller has put out reaches the valve."""

    def signals(self, t: float, out: Values) -> tuple[float, float, float, float]:
        """y_m, u before and after saturation, and 1 in auto or 0 in manual."""


class SampledMember:
    """A loop whose controller is a computer."""

    def __init__(
        self, loop: ControlLoop, start: LoopStart, names: LoopNames, model: CompiledModel, t: FloatArray
    ) -> None:
        self.loop, self.names, self.limits = loop, names, start.limits
        self.held = Held(start.u)
        given = names("u_given")
        self.courses: dict[str, Course] = {given if given in model.input_names else loop.input: self.held}
        self.histories: list[tuple[History, int]] = []
        self.pid = SampledPID(loop, start.limits, start.u, start.r, start.y)
        self.sensor = model.output_names.index(names("sensor"))
        samples = sample_times(loop, float(t[0]), float(t[-1]))
        self.setpoints = deque(loop.setpoint.values(samples).tolist())
        self.noise = deque(_noise(loop, samples).tolist())
        # Samples that would look before the start see what was there then.
        early = int(np.count_nonzero(measuring_times(loop, samples) < t[0]))
        self.measured = deque([start.y] * early)
        self.sent: deque[float] = deque()
        self.changes = deque(change for change in loop.modes if change.t >= t[0])
        self.y_m = start.y

    def measure(self, out: Values) -> None:
        """The sensor is read."""
        self.measured.append(out[self.sensor])

    def change_mode(self, t: float, x: FloatArray, rhs: RightHandSide, p: Values) -> FloatArray:
        """The next change of mode is due: the next sample follows it."""
        del t, rhs, p
        change = self.changes.popleft()
        self.pid.set_mode(change.mode == "auto", change.value)
        return x

    def sample(self) -> None:
        """The controller's next sample is due."""
        self.y_m = self.measured.popleft() + self.noise.popleft()
        u = self.pid.sample(self.setpoints.popleft(), self.y_m)
        if not abs(self.pid.v) < LARGEST_STATE:
            raise RunsAway(f"the controller's output grows beyond {LARGEST_STATE:g}: it runs away")
        self.sent.append(u)

    def move_valve(self) -> None:
        """What the controller has put out reaches the valve."""
        self.held.value = self.sent.popleft()

    def signals(self, t: float, out: Values) -> tuple[float, float, float, float]:
        """y_m, u before and after saturation, and 1 in auto or 0 in manual."""
        del t, out
        return self.y_m, self.pid.v, self.pid.u, float(self.pid.manual is None)


def _noise(loop: ControlLoop, samples: FloatArray) -> FloatArray:
    if loop.noise is None:
        return np.zeros(samples.size)
    if loop.noise.interval is None:
        return loop.noise.std * np.random.default_rng(loop.noise.seed).standard_normal(samples.size)
    end = float(samples[-1]) + loop.noise.interval
    return _held_noise(loop.noise, loop.noise.interval, float(samples[0]), end).value(samples)


def _held_noise(of: MeasurementNoise, interval: float, start: float, end: float) -> InputSignal:
    with within("noise"):
        return noise(of.std, interval, end, of.seed, max(start, 0.0))


class ContinuousMember:
    """A loop whose controller is part of the closed loop's equations."""

    def __init__(
        self, loop: ControlLoop, start: LoopStart, names: LoopNames, model: CompiledModel, t: FloatArray
    ) -> None:
        self.loop, self.names, self.limits, self.model = loop, names, start.limits, model
        self.auto, self.manual = Held(1.0), Held(start.u)
        part = InputCourse(0.0)
        if loop.noise is not None and loop.noise.interval is not None:
            part = part.plus(_held_noise(loop.noise, loop.noise.interval, float(t[0]), float(t[-1])))
        self.courses: dict[str, Course] = {
            names("r"): loop.setpoint,
            names("noise"): part,
            names("auto"): self.auto,
            names("manual"): self.manual,
        }
        self.place = {name: model.output_names.index(names(name)) for name in ("sensor", "out", "measured", "v")}
        self.integral = model.state_names.index(names("I"))
        self.histories: list[tuple[History, int]] = []
        if loop.sensor.theta:
            self._delay(names("sensor_past"), History(loop.sensor.theta, start.y), "sensor")
        if loop.valve.theta:
            given = names("u_given")
            self._delay(given if given in model.input_names else loop.input, History(loop.valve.theta, start.u), "out")
        self.changes = deque(change for change in loop.modes if change.t >= t[0])

    def _delay(self, name: str, history: History, of: str) -> None:
        self.courses[name] = history
        self.histories.append((history, self.place[of]))

    def change_mode(self, t: float, x: FloatArray, rhs: RightHandSide, p: Values) -> FloatArray:
        """The next change of mode is due; into auto the integral is set so that u goes on from where it is."""
        change = self.changes.popleft()
        was_manual = not self.auto.value
        u = self.model.outputs(t, x.tolist(), rhs.u(t), p)[self.place["out"]]
        if change.mode == "manual":
            self.auto.value, self.manual.value = 0.0, u if change.value is None else float(change.value)
        elif was_manual:
            self.auto.value = 1.0
            rhs.enter(t)
            v = self.model.outputs(t, x.tolist(), rhs.u(t), p)[self.place["v"]]
            x = x.copy()
            x[self.integral] += u - v
        return x

    def signals(self, t: float, out: Values) -> tuple[float, float, float, float]:
        """y_m, u before and after saturation, and 1 in auto or 0 in manual."""
        del t
        return out[self.place["measured"]], out[self.place["v"]], out[self.place["out"]], self.auto.value

    def measure(self, out: Values) -> None:
        """Nothing: it is always measuring."""

    def sample(self) -> None:
        """Nothing: it has no samples."""

    def move_valve(self) -> None:
        """Nothing: the valve follows at once."""
