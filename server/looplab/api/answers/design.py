"""The answers of POST /pole-placement and POST /smith."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, ComplexPair, Reasons
from looplab.api.answers.compare import ComparedMargins, Curves, LoadMetrics, SetpointMetrics
from looplab.api.answers.loop import SystemText
from looplab.api.answers.tune import PIDSettings

Interval = Annotated[list[float], Field(min_length=2, max_length=2, description="[low, high]")]


class DesignedController(SystemText):
    """C = P/L, expanded in latex and mathml, in factors as text."""

    num: list[float]
    den: list[float]
    zeros: list[ComplexPair]
    poles: list[ComplexPair]
    relative_degree: int
    stable: bool
    because: Annotated[str, Field(description="Of the controller itself, not of the loop.")]
    integrators: int
    pid: Annotated[PIDSettings | None, Field(description="The same controller as a PID, where it is one.")]


class Equation(Answer):
    """A L + B P = D, coefficients from the highest power down."""

    A: list[float]
    B: list[float]
    L: list[float]
    P: list[float]
    D: list[float]


class ApproximatedDeadTime(Answer):
    """What stood for the dead time in the design."""

    theta: float
    order: int


class PolePlacementAnswer(Answer):
    """The controller, and how good the solution is; what is null has its reason."""

    time_unit: str
    C: DesignedController
    equation: Equation
    plant_poles: Annotated[list[ComplexPair], Field(description="Of the plant the poles are placed for.")]
    plant_zeros: list[ComplexPair]
    wanted: Annotated[list[ComplexPair], Field(description="The poles that were placed.")]
    added: Annotated[list[ComplexPair], Field(description="Those of them that were chosen here.")]
    required: Annotated[int, Field(description="Number of poles that this plant and controller need.")]
    residual: Annotated[float, Field(description="Of the equation, relative, in exact arithmetic.")]
    condition: Annotated[float, Field(description="Of Sylvester's matrix with s measured in `scale`.")]
    scale: float
    closed_loop_poles: Annotated[list[ComplexPair], Field(description="Of the loop with the design plant.")]
    pole_error: Annotated[float, Field(description="Largest distance from a wanted pole, relative to its size.")]
    verdict: Literal["stable", "marginal", "unstable"]
    because: Annotated[str, Field(description="Of the loop with the plant as given, dead time exact.")]
    static_gain: Annotated[float | None, Field(description="T(0), from r to y.")]
    offset_pct: float | None
    reference_gain: Annotated[float | None, Field(description="1/T(0): multiply r by it, and y reaches r.")]
    approximation: ApproximatedDeadTime | None
    reasons: Reasons


class SmithTuningAnswer(Answer):
    """How the controller inside the predictor was come by."""

    how: str
    tau_c: float | None
    Ms: Annotated[float | None, Field(description="Of the predictor's loop without mismatch.")]
    on_limit: bool | None


class Tolerated(Answer):
    """Stretch of factors around the present plant on which the loop stays stable, one at a time."""

    K: Interval | None
    theta: Interval | None
    reasons: Reasons


class SmithRow(Answer):
    """One loop on the plant; null with the reason where there is no such loop."""

    name: Literal["smith", "PI", "PID"]
    valid: bool
    reason: str | None
    controller: PIDSettings | None
    Ms_nominal: Annotated[float | None, Field(description="On the model itself.")]
    closed_loop_stable: bool | None
    margins: ComparedMargins | None
    setpoint: SetpointMetrics | None
    load: LoadMetrics | None
    responses: Curves | None
    tolerates: Tolerated | None


class RegionLoop(Answer):
    """For each row of the plane the stable stretches of its first axis."""

    name: Literal["smith", "PI", "PID"]
    intervals: list[list[Interval]] | None
    reason: str | None


class SmithRegion(Answer):
    """Stable plants of a plane; factors are those of plant over model."""

    along: Literal["K", "tau", "theta"]
    across: Literal["K", "tau", "theta"]
    along_range: Interval
    across_range: Interval
    rows: list[float]
    loops: list[RegionLoop]


class Mismatch(Answer):
    """Factors of plant over model."""

    K: float
    tau: float
    theta: float


class SmithAnswer(Answer):
    """The predictor beside PI and PID tuned for the same Ms; what is null has its reason."""

    time_unit: str
    model: SystemText
    plant: SystemText
    mismatch: Mismatch
    Ms_limit: float
    tuning: SmithTuningAnswer
    horizon: float
    rows: list[SmithRow]
    notes: Annotated[list[str], Field(description="What a Smith predictor cannot do with this model.")]
    region: SmithRegion | None
    reasons: Reasons
