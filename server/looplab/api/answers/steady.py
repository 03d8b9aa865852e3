"""The answers about steady states of nonlinear models."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, ComplexPair

Optional = Annotated[list[float | None], Field(description="null where undefined.")]
ByName = dict[str, float]
Curves = Annotated[dict[str, Optional], Field(description="One curve for each name.")]
Verdict = Literal["stable", "marginal", "unstable"]


class SteadyStateAnswer(Answer):
    """One steady state."""

    x: ByName
    outputs: dict[str, float | None]
    variables: dict[str, float | None]
    residual: Annotated[float, Field(description="Largest |f_i| there.")]
    eigenvalues: Annotated[list[ComplexPair], Field(description="Rightmost first [rad/time].")]
    verdict: Verdict
    because: str
    kind: Annotated[str, Field(description="Node, focus, saddle, centre or degenerate.")]
    free: Annotated[list[str], Field(description="States that may have any value here: a continuum.")]
    found_by: Annotated[int, Field(description="How many starts ended here.")]


class SettingAnswer(Answer):
    """What was computed with."""

    time_unit: str
    inputs: ByName
    parameters: ByName


class SteadyStatesAnswer(SettingAnswer):
    """The steady states that were found, sorted by the states."""

    box: dict[str, list[float]]
    steady_states: list[SteadyStateAnswer]
    starts: int
    converged: int
    remark: Annotated[str, Field(description="How far the search can be trusted.")]


class QuantityRange(Answer):
    """A quantity and its range."""

    name: str
    unit: str
    meaning: str
    low: float
    high: float


class OverAnswer(QuantityRange):
    """The quantity that steady states are followed over."""

    value: Annotated[float, Field(description="Where the model stands.")]


class Piece(Answer):
    """Points first to last of a branch, both included."""

    first: int
    last: int
    stable: bool


class BranchAnswer(Answer):
    """One curve of steady states in the order of its arc."""

    values: Optional
    states: Curves
    outputs: Curves
    stable: Annotated[list[bool], Field(description="From each point to the next.")]
    pieces: list[Piece]
    closed: bool
    ends: Annotated[list[str], Field(description="Why it ends at its first and at its last point.")]


class SpecialPointAnswer(Answer):
    """A point of a branch where it turns, or where stability changes."""

    branch: int
    index: int
    value: float
    states: ByName
    outputs: dict[str, float | None]
    determinant: Annotated[float, Field(description="Of A, relative: zero but for rounding where the curve turns.")]


class HopfPointAnswer(SpecialPointAnswer):
    """A point where a complex pair crosses the imaginary axis."""

    omega: Annotated[float, Field(description="[rad/time]")]
    period: Annotated[float, Field(description="2 pi/omega [time]")]


class ContinuationAnswer(Answer):
    """Steady states over an input or a parameter."""

    time_unit: str
    over: OverAnswer
    branches: list[BranchAnswer]
    turning_points: list[SpecialPointAnswer]
    hopf_points: list[HopfPointAnswer]
    branch_points: Annotated[list[SpecialPointAnswer], Field(description="Where another curve crosses.")]
    steady_states: Annotated[list[SteadyStateAnswer], Field(description="At the quantity's own value.")]
    remark: str


class SignalAnswer(Answer):
    """A state, an input or an output at the point."""

    name: str
    unit: str
    meaning: str
    latex: str
    value: float


class ChannelAnswer(Answer):
    """One input and one output of the linear model, and the systems to open it as elsewhere."""

    input: str
    output: str
    gain: Annotated[float | None, Field(description="G(0); null where it is infinite.")]
    gain_unit: str
    gain_reason: str | None
    zeros: list[ComplexPair]
    poles: list[ComplexPair]
    k: Annotated[float, Field(description="Ratio of leading coefficients.")]
    latex: str
    ss: dict[str, Any]
    zpk: dict[str, Any]
    plant: Annotated[dict[str, Any] | None, Field(description="null for a model that came with the request.")]


class ComparisonAnswer(Answer):
    """The output after a step, by the linear and by the nonlinear model."""

    size: float
    t: list[float]
    linear: list[float]
    nonlinear: list[float]
    largest_deviation: float
    at: float
    relative: Annotated[float | None, Field(description="Of the largest linear excursion.")]
    truncated_at: float | None
    truncated_reason: str | None


class LinearizeAnswer(SettingAnswer):
    """d(x - x0)/dt = f + A (x - x0) + B (u - u0), y - y0 = C (x - x0) + D (u - u0)."""

    x: ByName
    equilibrium: bool
    f: ByName
    remark: str | None
    states: list[SignalAnswer]
    input_signals: list[SignalAnswer]
    output_signals: list[SignalAnswer]
    A: list[list[float]]
    B: list[list[float]]
    C: list[list[float]]
    D: list[list[float]]
    poles: list[ComplexPair]
    verdict: Verdict
    because: str
    kind: str
    time_constants: Annotated[list[float], Field(description="1/|Re p|, slowest first [time].")]
    channel: ChannelAnswer | None
    channel_reason: Annotated[str | None, Field(description="Why there is no channel.")]
    responses: list[ComparisonAnswer]


class AxisAnswer(Answer):
    """One side of the window."""

    name: str
    unit: str
    low: float
    high: float


class FieldAnswer(Answer):
    """Rates of the two states on a grid: one row for each vertical value."""

    horizontal: list[float]
    vertical: list[float]
    d_horizontal: list[Optional]
    d_vertical: list[Optional]


class LineAnswer(Answer):
    """A line in the plane."""

    horizontal: list[float]
    vertical: list[float]
    closed: bool


class NullclineAnswer(Answer):
    """Where the rate of one state is zero."""

    state: str
    lines: list[LineAnswer]


class TrajectoryAnswer(Answer):
    """A solution in the plane."""

    t: list[float]
    horizontal: list[float]
    vertical: list[float]
    truncated_at: float | None
    truncated_reason: str | None


class PhasePlaneAnswer(SettingAnswer):
    """The phase plane of two states."""

    horizontal: AxisAnswer
    vertical: AxisAnswer
    held: ByName
    field: FieldAnswer
    nullclines: list[NullclineAnswer]
    trajectories: list[TrajectoryAnswer]
    steady_states: list[SteadyStateAnswer]
    remark: str | None


class BalanceBranchAnswer(Answer):
    """One curve over the state, the other states being at rest."""

    values: Optional
    states: Curves
    rate: Optional
    curves: Curves


class CurveAnswer(Answer):
    """A variable that is shown."""

    name: str
    unit: str
    meaning: str


class BalanceAnswer(SettingAnswer):
    """The rate of one state over its value, and variables such as the heats."""

    state: QuantityRange
    rate_unit: str
    branches: list[BalanceBranchAnswer]
    curves: list[CurveAnswer]
    steady_states: list[SteadyStateAnswer]
    remark: str
