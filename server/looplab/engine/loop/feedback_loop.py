"""The feedback loop: controller, actuator, plant and sensor under negative feedback, with a load entering the plant."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np

from looplab.engine.errors import IllPosedLoop, InvalidInput
from looplab.engine.loop.controllers import PID, require_causal
from looplab.engine.systems.transfer_function import TransferFunction


@lru_cache(maxsize=64)
def _in_series(first: TransferFunction, second: TransferFunction) -> TransferFunction:
    """One object for all gains: what is kept of it is found at once."""
    return first * second


@dataclass(frozen=True)
class FeedbackLoop:
    r"""u = C (r - y_m) + F r, y = P (A u + d) and y_m = H y, with F = Kc (beta - 1) of a setpoint weight.

    Parameters
    ----------
    plant : TransferFunction
        P, proper, with its dead time.
    controller : PID or TransferFunction
        C, proper; a controller given as a transfer function may have a dead time too (they add up in the loop).
    actuator, sensor : TransferFunction or None
        A between controller and plant, H between plant and controller, proper, with dead times of their own; None is 1.
    disturbance : TransferFunction or None
        Gd, proper: the load then enters as y = P A u + Gd d instead of at the plant input.

    Raises
    ------
    ImproperSystem
        One of them differentiates.
    InvalidInput
        Gd has a pole in the right half-plane.
    IllPosedLoop
        1 + L(inf) = 0 without dead time.
    """

    plant: TransferFunction
    controller: PID | TransferFunction
    actuator: TransferFunction | None = None
    sensor: TransferFunction | None = None
    disturbance: TransferFunction | None = None
    C: TransferFunction = field(init=False, compare=False)

    def __post_init__(self) -> None:
        self.plant.require_proper("plant")
        C = self.controller.to_transfer_function() if isinstance(self.controller, PID) else self.controller
        require_causal(C)
        object.__setattr__(self, "C", C)
        for name in ("actuator", "sensor", "disturbance"):
            system = getattr(self, name)
            if system is not None:
                system.require_proper(name)
        if self.disturbance is not None and (self.disturbance.poles.real > 1e-9 * np.abs(self.disturbance.poles)).any():
            raise InvalidInput(
                "the disturbance grows by itself: it has a pole in the right half-plane, which no controller reaches",
                field="disturbance",
                hint="a load on an unstable plant shares the plant's poles: leave the disturbance out, and the load "
                "enters at the plant input",
            )
        product = C.high_frequency_gain * self.path.high_frequency_gain
        if self.theta == 0 and abs(1.0 + product) < 1e-12:
            raise IllPosedLoop(
                "the loop has no solution at high frequency: L(inf) = -1",
                field="controller",
                hint="change the gain a little, or give the plant a lag",
            )

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        """A loop is the key of several caches."""
        return hash((self.plant, self.controller, self.actuator, self.sensor, self.disturbance))

    @property
    def theta(self) -> float:
        """Total dead time in the loop [time]."""
        return self.path.theta + self.C.theta

    @property
    def forward(self) -> TransferFunction:
        """From the controller's output to y: A P."""
        return self.plant if self.actuator is None else self.actuator * self.plant

    @cached_property
    def path(self) -> TransferFunction:
        """From the controller's output back to what it measures: A P H, or the plant alone."""
        return self.forward if self.sensor is None else self.sensor * self.forward

    @cached_property
    def open_loop(self) -> TransferFunction:
        """L = C A P H with everything kept: nothing cancels."""
        return self.C * self.path

    @property
    def load_path(self) -> TransferFunction:
        """From the load to y without control: Gd, or the plant."""
        return self.plant if self.disturbance is None else self.disturbance

    @property
    def has_one_dead_time(self) -> bool:
        """Whether there is nothing but plant and controller, and no dead time but the plant's."""
        return not self.C.theta and self.actuator is self.sensor is self.disturbance is None

    @cached_property
    def lumped(self) -> FeedbackLoop:
        """The loop with actuator, plant and sensor as one plant: its open loop, and so its poles, are the same."""
        if self.actuator is None and self.sensor is None:
            return self
        return FeedbackLoop(self.path, self.controller)

    @property
    def feedforward(self) -> float:
        """F: gain from r to u beside C (r - y); zero unless the setpoint weight differs from 1."""
        if isinstance(self.controller, PID):
            return self.controller.sign * self.controller.Kc * (self.controller.beta - 1.0)
        return 0.0

    @property
    def gain(self) -> float:
        """The gain that the root locus varies: Kc of a PID (with its sign), the gain of a typed controller."""
        if isinstance(self.controller, PID):
            return self.controller.sign * self.controller.Kc
        return self.C.gain

    @cached_property
    def locus_system(self) -> TransferFunction:
        """L per unit of that gain: what the root locus is drawn for."""
        if isinstance(self.controller, PID):
            return _in_series(self.controller.per_gain, self.path)
        return TransferFunction(self.C.zeros, self.C.poles, 1.0, self.C.theta) * self.path
