"""The answers of the /labs family."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from looplab.api.answers.base import Answer
from looplab.labs.grading.result import Status


class LabSummary(Answer):
    """One entry of the list of labs."""

    id: str
    title: str
    level: str
    section: str
    summary: str
    minutes: int
    exercises: int


class LabList(Answer):
    """The labs there are."""

    labs: list[LabSummary]


class RenderedPart(Answer):
    """A step of a lab: texts as HTML with MathML, exercises without their answers."""

    id: str
    title: str
    settings: Annotated[dict[str, float | None] | None, Field(description="Settings the bench offers to take here.")]
    blocks: Annotated[list[dict[str, Any]], Field(description="Told apart by type: text, number, choice, ...")]


class RenderedLab(LabSummary):
    """A lab as its page shows it; it holds no answers."""

    objectives_html: list[str]
    bench: Annotated[dict[str, Any], Field(description="Plant, controller, sliders, panels and time unit.")]
    parts: list[RenderedPart]


class CheckAnswer(Answer):
    """One thing that was looked at: a field of the answer, or a specification."""

    name: str
    passed: bool
    measured: Annotated[float | None, Field(description="The student's own value; null where there is none.")]
    limit: Annotated[float | None, Field(description="The demand, where it is one that the student is told.")]
    text: str
    feedback_html: str


class GradedAnswer(Answer):
    """The verdict on an answer."""

    correct: bool
    status: Status | Literal["revealed"]
    score: Annotated[float, Field(ge=0, le=1, description="Share of the exercise's points.")]
    feedback_html: str
    checks: list[CheckAnswer]
    solution_html: Annotated[str | None, Field(description="Worked, once the answer is right or was asked for.")]


class LabProblem(Answer):
    """One thing to repair, and where in the lab's JSON."""

    path: str
    message: str


class LabTest(Answer):
    """One of the lab's own tests, run."""

    exercise: str
    case: str
    passed: bool
    message: str


class LabValidation(Answer):
    """Whether a lab can be used, and what its own tests say."""

    valid: bool
    problems: list[LabProblem]
    tests: list[LabTest]
