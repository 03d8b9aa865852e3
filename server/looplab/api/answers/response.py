"""The answer of POST /response."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from looplab.api.answers.base import Answer, Numbers, Reasons
from looplab.api.answers.loop import PlantText


class ImpulseInOutput(Answer):
    """An impulse in y, which samples cannot show."""

    t: float
    area: float


class StepTerm(Answer):
    """The answer to one step of the staircase."""

    amplitude: float
    start: float
    y: Numbers


class SuperpositionAnswer(Answer):
    """The response as a sum: free response and one term for each step."""

    terms: list[StepTerm]
    free: Numbers
    total: Numbers
    error: Annotated[float, Field(description="Largest difference to y, relative to the largest term.")]


class ConvolutionAnswer(Answer):
    """The response from rest as a sum of impulse responses, one for each slice of the input."""

    times: Annotated[Numbers, Field(description="Middle of each slice [time].")]
    weights: Annotated[Numbers, Field(description="u there times the slice's width [input*time].")]
    h: Annotated[Numbers, Field(description="Impulse response.")]
    total: Numbers
    exact: Numbers
    error: Annotated[float, Field(description="Largest difference of total and exact.")]


class ResponseAnswer(Answer):
    """t, u and y; y is shorter than t where the response was cut."""

    time_unit: str
    system: PlantText
    horizon: float
    t: Numbers
    u: Numbers
    y: Numbers
    states: Annotated[list[Numbers] | None, Field(description="One curve for each state, where asked for.")]
    initial_state: list[float]
    impulses: list[ImpulseInOutput]
    final_value: float | None
    truncated_at: float | None
    truncated_reason: str | None
    superposition: SuperpositionAnswer | None
    convolution: ConvolutionAnswer | None
    reasons: Reasons
