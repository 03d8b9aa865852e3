"""The answers of the /state-feedback family."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from looplab.api.answers.base import Answer, ComplexPair, Numbers
from looplab.api.answers.loop import MarginsAnswer
from looplab.api.answers.nonlinear import ByName, EventAnswer
from looplab.api.answers.state_space import Matrix


class FeedbackSignal(Answer):
    """A state, an input that the feedback moves, or an output, with its value at the steady state."""

    name: str
    unit: str
    meaning: str
    value: float


class GainAnswer(Answer):
    """The poles that a gain gives."""

    desired: Annotated[list[ComplexPair] | None, Field(description="null where weights were asked for.")]
    obtained: Annotated[list[ComplexPair], Field(description="Eigenvalues, in the order of those desired.")]
    error: Annotated[float | None, Field(description="Largest distance of the two, relative to the pole or 1.")]
    condition: Annotated[
        float | None, Field(description="Of the eigenvectors: how much the poles move with the gain; null: infinite.")
    ]
    kept: Annotated[list[ComplexPair], Field(description="Hidden modes, which stay where they are.")]
    residual: Annotated[float | None, Field(description="Of the Riccati equation; null where poles were asked for.")]


class StateFeedbackAnswer(Answer):
    """u = u0 - K (x - x0) + K_I x_I + N (r - y0), with x_I' = r - y, x an observer's estimate if there is one."""

    time_unit: str
    states: list[FeedbackSignal]
    inputs: list[FeedbackSignal]
    outputs: list[FeedbackSignal]
    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix
    poles: Annotated[list[ComplexPair], Field(description="Of the plant as it is.")]
    K: Matrix
    K_I: Matrix | None
    N: Matrix | None
    N_reason: Annotated[str | None, Field(description="Why no gain leads to the setpoint.")]
    L: Annotated[Matrix | None, Field(description="Of the measured outputs.")]
    feedback: GainAnswer
    observer: GainAnswer | None
    closed_loop_poles: Annotated[list[ComplexPair], Field(description="Eigenvalues of the whole loop's matrix.")]
    closed_loop_stable: bool
    separation_error: Annotated[
        float, Field(description="How far they are from those of feedback and observer, each designed alone.")
    ]
    margins: Annotated[MarginsAnswer | None, Field(description="Where the input enters the plant.")]
    margins_reason: str | None


class LinearFeedbackRun(Answer):
    """What the linear model says; inputs without limits and without the push."""

    t: Numbers
    states: ByName
    outputs: ByName
    inputs: ByName
    estimates: ByName | None


class NonlinearFeedbackRun(Answer):
    """What the plant does. Where the run was cut, the curves end with the time of the cut."""

    t: Numbers
    states: ByName
    outputs: ByName
    commands: Annotated[dict[str, Numbers], Field(description="What the feedback asks for.")]
    inputs: Annotated[dict[str, Numbers], Field(description="What the limits leave of it, without the push.")]
    estimates: ByName | None
    events: list[EventAnswer]
    outcome: Annotated[
        str, Field(description="caught, the name of the first event, stopped, or unsettled at the end of the horizon.")
    ]
    truncated_at: float | None
    truncated_reason: str | None


class FeedbackRunAnswer(Answer):
    """The linear prediction, and the nonlinear run where the plant is nonlinear."""

    time_unit: str
    horizon: float
    linear: LinearFeedbackRun | None
    linear_reason: str | None
    nonlinear: NonlinearFeedbackRun | None


class RegionAnswer(Answer):
    """How the run from each point of a grid ends: ``outcomes[row][column]`` from vertical[row], horizontal[column]."""

    horizontal: list[float]
    vertical: list[float]
    outcomes: list[list[str]]
