"""One loop on its way through the panels: what several of them need is computed once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import Any

from looplab.engine.frequency import frequency_range
from looplab.engine.frequency.sampled import Sampled, sampled
from looplab.engine.loop import ClosedLoopStep, FeedbackLoop, closed_loop_step, default_horizon
from looplab.engine.stability import Verdict, closed_loop_verdict
from looplab.engine.systems import TransferFunction


@dataclass(frozen=True)
class LoopContext:
    """A loop with the wishes of the request."""

    loop: FeedbackLoop
    wanted_horizon: float | None
    points: int
    wanted_omega: tuple[float, float] | None

    @cached_property
    def horizon(self) -> float:
        """The horizon asked for, or the one that suits the plant [time]."""
        return self.wanted_horizon if self.wanted_horizon is not None else default_horizon(self.loop)

    @cached_property
    def step(self) -> ClosedLoopStep:
        """Responses to setpoint and load steps."""
        return closed_loop_step(self.loop, self.horizon, self.points)

    @cached_property
    def verdict(self) -> Verdict:
        """Stable, marginal or unstable."""
        return closed_loop_verdict(self.loop)

    @cached_property
    def omega_range(self) -> tuple[float, float]:
        """Ends of the frequency axis [rad/time]."""
        return self.wanted_omega or frequency_range(self.loop.open_loop)

    @cached_property
    def open_loop(self) -> Sampled:
        """L over the frequencies of the Bode and sensitivity plots."""
        return sampled(self.loop.open_loop, *self.omega_range)

    @cached_property
    def locus_system(self) -> TransferFunction:
        """L per unit of the gain that the locus varies, with the sign of that gain."""
        system = self.loop.locus_system
        return system * -1.0 if self.loop.gain < 0 else system

    def loop_content(self) -> tuple[Any, ...]:
        """Everything that the loop is made of."""
        return (self._parts,)

    @cached_property
    def _parts(self) -> bytes:
        loop = self.loop
        others = (b"" if G is None else G.key for G in (loop.actuator, loop.sensor, loop.disturbance))
        return b"\0".join([loop.plant.key, loop.C.key, repr(loop.feedforward).encode(), *others])

    def step_content(self) -> tuple[Any, ...]:
        """The loop and the time axis."""
        return (*self.loop_content(), self.horizon, self.points)

    def frequency_content(self) -> tuple[Any, ...]:
        """The loop and the frequency axis."""
        return (*self.loop_content(), self.wanted_omega)

    def locus_content(self) -> tuple[Any, ...]:
        """The open loop up to its gain."""
        return (self.locus_system.key,)


def content_key(panel: str, content: tuple[Any, ...]) -> str:
    """Hash of a panel's name and content, 16 hexadecimal digits."""
    digest = blake2b(panel.encode(), digest_size=8)
    for part in content:
        digest.update(b"\0" + (part if isinstance(part, bytes) else repr(part).encode()))
    return digest.hexdigest()
