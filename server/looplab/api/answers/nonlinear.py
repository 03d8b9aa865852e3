"""The answers of the /plants and /models families."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field

from looplab.api.answers.base import Answer, Numbers

ByName = Annotated[dict[str, Numbers], Field(description="One curve for each name.")]


class PlantSummary(Answer):
    """One entry of the list of plants."""

    id: str
    title: str
    summary: str
    notes: Annotated[str, Field(description="Sections of the lecture notes.")]
    time_unit: str
    inputs: list[str]
    states: list[str]
    outputs: list[str]
    operating_points: list[str]


class PlantList(Answer):
    """The plants there are."""

    plants: list[PlantSummary]


class EquationAnswer(Answer):
    """One equation as a formula."""

    path: Annotated[str, Field(description="Where it stands in the document, e.g. states[0].equation")]
    latex: str
    mathml: str


class PlantAnswer(Answer):
    """A plant: its document, which /models/simulate takes too, and its equations."""

    document: dict[str, Any]
    equations: list[EquationAnswer]


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
    inputs: Annotated[dict[str, Numbers], Field(description="The new value at a jump.")]
    events: list[EventAnswer]
    truncated_at: float | None
    truncated_reason: str | None
    calls: Annotated[int, Field(description="Evaluations of the equations.")]
