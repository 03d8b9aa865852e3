"""The answers of the /plants and /models families."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, Numbers, Reasons

ByName = Annotated[dict[str, Numbers], Field(description="One curve for each name.")]


PlantKind = Annotated[
    Literal["nonlinear", "transfer-matrix"],
    Field(description="A transfer matrix has no states, and its signals are deviations from where the plant ran."),
]


class PlantSummary(Answer):
    """One entry of the list of plants."""

    id: str
    kind: PlantKind
    title: str
    summary: str
    group: Annotated[str, Field(description="The shelf of the library.")]
    notes: Annotated[str, Field(description="Sections of the lecture notes.")]
    time_unit: str
    inputs: list[str]
    states: list[str]
    outputs: list[str]
    operating_points: list[str]
    drawing: Annotated[dict[str, Any] | None, Field(description="What draws the plant, see the schema of drawings.")]
    values: Annotated[dict[str, float], Field(description="Every signal at the plant's initial state.")]


class PlantList(Answer):
    """The plants there are."""

    plants: list[PlantSummary]


class EquationAnswer(Answer):
    """One equation as a formula."""

    path: Annotated[str, Field(description="Where it stands in the document, e.g. states[0].equation or entries[0][1]")]
    latex: str
    mathml: str


class PlantAnswer(Answer):
    """A plant: its document, which /models/simulate takes too unless it is a transfer matrix, and its equations."""

    kind: PlantKind
    document: dict[str, Any]
    equations: list[EquationAnswer]
    group: Annotated[str, Field(description="The shelf of the library.")]
    drawing: Annotated[dict[str, Any] | None, Field(description="What draws the plant, see the schema of drawings.")]
    values: Annotated[dict[str, float], Field(description="Every signal at the plant's initial state.")]
    time_scale: Annotated[
        float | None,
        Field(description="Slowest time constant about the initial state [time]; null without one."),
    ]


class ModelProblem(Answer):
    """One thing to repair, and where."""

    path: Annotated[str, Field(description="Place in the document, e.g. states[0].equation")]
    message: str
    hint: str | None
    column: Annotated[int | None, Field(description="Of the formula, from 1; null where it is not about a character.")]


class ModelValidation(Answer):
    """Whether a model can be computed at its nominal point, and what it says."""

    valid: bool
    problems: list[ModelProblem]
    equations: list[EquationAnswer]


class EventAnswer(Answer):
    """An event that has happened."""

    name: str
    message: str
    t: float
    states: dict[str, float]


class SimulationAnswer(Answer):
    """Curves over t; where the simulation was cut they end with the time of the cut."""

    time_unit: str
    horizon: float
    t: Numbers
    states: ByName
    outputs: ByName
    variables: Annotated[dict[str, Any], Field(description="One curve for each; null where it has no finite value.")]
    inputs: Annotated[dict[str, Numbers], Field(description="The new value at a jump.")]
    events: list[EventAnswer]
    truncated_at: float | None
    truncated_reason: str | None
    calls: Annotated[int, Field(description="Evaluations of the equations.")]


class LoopMetricsAnswer(Answer):
    """How well a loop has kept its setpoint; null with its reason."""

    IAE: float | None
    ISE: float | None
    ITAE: float | None
    TV: Annotated[float, Field(description="Ups and downs of u between the points of the answer.")]
    saturated_pct: Annotated[float, Field(description="Part of the points at which u is at a limit.")]
    overshoot_pct: float | None
    t_rise: float | None
    t_settle: float | None
    decay_ratio: float | None
    reasons: Reasons


class ModeAnswer(Answer):
    """From when on a loop is in a mode, to the next point of the answer."""

    t: float
    mode: str


class LoopAnswer(Answer):
    """Signals of one loop."""

    output: str
    input: str
    r: Numbers
    y_m: Annotated[Numbers, Field(description="What the controller sees, after sensor, dead time and noise.")]
    u_command: Annotated[Numbers, Field(description="The controller's output before saturation.")]
    u: Annotated[Numbers, Field(description="After saturation, before the valve.")]
    history_error: Annotated[
        float | None,
        Field(
            description="Estimated error of the past that the dead time of a continuous loop looks up; null where dead "
            "times are exact, or there is none."
        ),
    ]
    modes: list[ModeAnswer]
    metrics: LoopMetricsAnswer


class ControlAnswer(SimulationAnswer):
    """A simulation under control; ``inputs`` are what enters the plant, after the valves."""

    loops: list[LoopAnswer]
