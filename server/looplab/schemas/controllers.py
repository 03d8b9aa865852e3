"""A controller as JSON: PID in ideal, series or parallel form, or any proper system."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from looplab.engine.loop import PID
from looplab.schemas.base import Model
from looplab.schemas.state_space import StateSpaceSystem
from looplab.schemas.systems import ExpressionSystem, FOPDTSystem, PolynomialSystem, SOPDTSystem, ZPKSystem

Filter = Annotated[float, Field(ge=0, description="Derivative filter time over derivative time [-].")]
Weight = Annotated[float, Field(description="Setpoint weight: the proportional part acts on beta r - y [-].")]
Action = Annotated[
    Literal["reverse", "direct"],
    Field(description="reverse raises u when y is below r; direct flips the sign of the controller."),
]


class StandardPID(Model):
    """Kc (1 + 1/(tau_I s) + tau_D s/(alpha tau_D s + 1)), or the series form; null switches an action off."""

    type: Literal["pid"]
    form: Literal["ideal", "series"] = "ideal"
    Kc: float
    tau_I: Annotated[float, Field(gt=0)] | None = None
    tau_D: Annotated[float, Field(ge=0)] | None = None
    alpha: Filter = 0.1
    beta: Weight = 1.0
    action: Action = "reverse"

    def to_engine(self) -> PID:
        """The controller for the engine; raises EngineError naming the field."""
        return PID(self.Kc, self.tau_I, self.tau_D, self.alpha, self.form, self.beta, self.action)

    def to_latex(self) -> str:
        """The controller with its numbers."""
        return self.to_engine().to_latex()


class ParallelPID(Model):
    """Kp + Ki/s + Kd s/(alpha (Kd/Kp) s + 1)."""

    type: Literal["pid"]
    form: Literal["parallel"]
    Kp: float
    Ki: float = 0.0
    Kd: float = 0.0
    alpha: Filter = 0.1
    beta: Weight = 1.0
    action: Action = "reverse"

    def to_engine(self) -> PID:
        """The controller for the engine; raises EngineError naming the field."""
        return PID.from_parallel(self.Kp, self.Ki, self.Kd, self.alpha, self.beta, self.action)

    def to_latex(self) -> str:
        """The controller with its numbers, as the ideal form it equals."""
        return self.to_engine().to_latex()


def controller_tag(value: Any) -> str | None:
    """Which member of the union a request (or a model instance) means."""
    kind = value.get("type") if isinstance(value, dict) else getattr(value, "type", None)
    form = value.get("form", "ideal") if isinstance(value, dict) else getattr(value, "form", "ideal")
    if not isinstance(kind, str):
        return None
    return "pid-parallel" if kind == "pid" and form == "parallel" else kind


AnyPID = Annotated[
    Annotated[StandardPID, Tag("pid")] | Annotated[ParallelPID, Tag("pid-parallel")],
    Discriminator(controller_tag, custom_error_type="controller_type", custom_error_message="type must be 'pid'"),
]

Controller = Annotated[
    Annotated[StandardPID, Tag("pid")]
    | Annotated[ParallelPID, Tag("pid-parallel")]
    | Annotated[PolynomialSystem, Tag("tf")]
    | Annotated[ZPKSystem, Tag("zpk")]
    | Annotated[FOPDTSystem, Tag("fopdt")]
    | Annotated[SOPDTSystem, Tag("sopdt")]
    | Annotated[ExpressionSystem, Tag("expr")]
    | Annotated[StateSpaceSystem, Tag("ss")],
    Discriminator(
        controller_tag,
        custom_error_type="controller_type",
        custom_error_message="type must be one of 'pid', 'tf', 'zpk', 'fopdt', 'sopdt', 'expr', 'ss'",
    ),
]
