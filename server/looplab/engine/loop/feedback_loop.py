"""The feedback loop: plant and controller under unit negative feedback, with a load entering the plant."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from looplab.engine.errors import IllPosedLoop
from looplab.engine.loop.controllers import PID, require_causal
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class FeedbackLoop:
    r"""u = C (r - y) + F r and y = P (u + d), with F = Kc (beta - 1) the feedforward of a setpoint weight.

    Parameters
    ----------
    plant : TransferFunction
        P, proper, with its dead time.
    controller : PID or TransferFunction
        C, proper; a controller given as a transfer function may have a dead time too (they add up in the loop).

    Raises
    ------
    ImproperSystem
        Plant or controller differentiates.
    IllPosedLoop
        1 + C(inf) P(inf) = 0 without dead time.
    """

    plant: TransferFunction
    controller: PID | TransferFunction
    C: TransferFunction = field(init=False, compare=False)

    def __post_init__(self) -> None:
        self.plant.require_proper("plant")
        C = self.controller.to_transfer_function() if isinstance(self.controller, PID) else self.controller
        require_causal(C)
        object.__setattr__(self, "C", C)
        product = C.high_frequency_gain * self.plant.high_frequency_gain
        if self.theta == 0 and abs(1.0 + product) < 1e-12:
            raise IllPosedLoop(
                "the loop has no solution at high frequency: C(inf) P(inf) = -1",
                field="controller",
                hint="change the gain a little, or give the plant a lag",
            )

    @property
    def theta(self) -> float:
        """Total dead time in the loop [time]."""
        return self.plant.theta + self.C.theta

    @cached_property
    def open_loop(self) -> TransferFunction:
        """L = P C with everything kept: nothing cancels."""
        return self.C * self.plant

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
            unit = PID(
                1.0, self.controller.tau_I, self.controller.tau_D, self.controller.alpha, self.controller.form
            ).to_transfer_function()
            return unit * self.plant
        return TransferFunction(self.C.zeros, self.C.poles, 1.0, self.C.theta) * self.plant
