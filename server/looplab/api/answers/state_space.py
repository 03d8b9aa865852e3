"""The answer of POST /state-space."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, ComplexPair
from looplab.api.answers.loop import SystemText

Matrix = list[list[float]]


class StateVerdict(Answer):
    """Whether x' = A x comes to rest, stays bounded, or grows."""

    verdict: Literal["stable", "marginal", "unstable"]
    lyapunov_stable: Annotated[bool, Field(description="The states stay bounded; Jordan blocks on the axis decide.")]
    because: str


class RankAnswer(Answer):
    """Kalman's matrix, the singular values of its scaled form, and the rank they give."""

    matrix: Annotated[Matrix | None, Field(description="null where its numbers leave double precision.")]
    singular_values: list[float]
    rank: int
    full: Annotated[bool, Field(description="No mode hides; decided mode by mode.")]
    tolerance: Annotated[float, Field(description="Relative to the largest singular value.")]
    reason: Annotated[str | None, Field(description="Where rank and modes disagree.")]


class ModeAnswer(Answer):
    """A mode by the test of Popov, Belevitch and Hautus: smallest singular values of [A - pI, B] and [A - pI; C]."""

    pole: ComplexPair
    stable: bool
    controllable: bool
    observable: bool
    sigma_controllable: float
    sigma_observable: float


class GramiansAnswer(Answer):
    """Gramians and Hankel singular values; null with the reason."""

    controllability: Matrix | None
    observability: Matrix | None
    hankel_singular_values: list[float] | None
    reason: str | None


class CancelledMode(Answer):
    """A zero and a pole taken as equal."""

    pole: ComplexPair
    zero: ComplexPair
    distance: float
    stable: bool


class RemovedModeAnswer(Answer):
    """A mode that a minimal realisation leaves out."""

    pole: ComplexPair
    hidden_from: Annotated[Literal["input", "output"], Field(description="No input moves it, or no output shows it.")]
    stable: bool


class RemovedModes(Answer):
    """What a minimal realisation leaves out, and the singular values on either side of the tolerance."""

    order: int
    removed: list[RemovedModeAnswer]
    tolerance: float
    smallest_kept: float | None
    largest_removed: float | None


class MinimalRealizationAnswer(RemovedModes):
    """A model with the same transfer matrix in which no mode hides."""

    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix


class ChannelAnswer(Answer):
    """Transfer function of one input and output, with every mode and without those that cancel; null with a reason."""

    output: int
    input: int
    zeros: list[ComplexPair] | None
    gain: float | None
    system: SystemText | None
    minimal: SystemText | None
    minimal_order: int | None
    cancelled: list[CancelledMode]
    cancel_tolerance: float
    closest_kept: Annotated[float | None, Field(description="Distance of the closest zero and pole that were kept.")]
    reason: str | None


class StateSpaceAnswer(Answer):
    """Everything asked of a state-space model."""

    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix
    latex: str
    mathml: str
    poles: list[ComplexPair]
    stability: StateVerdict
    controllability: RankAnswer
    observability: RankAnswer
    modes: list[ModeAnswer]
    stabilizable: bool
    detectable: bool
    minimal: bool
    minimal_realization: MinimalRealizationAnswer
    gramians: GramiansAnswer
    transfer_functions: list[ChannelAnswer]
