"""The answers of the identification and experiment routes."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field

from looplab.api.answers.base import Answer, Numbers


class MethodAnswer(Answer):
    """What one method found; all null, with the reason, where it does not apply."""

    method: str
    name: str
    source: str
    model: Annotated[
        dict[str, float] | None,
        Field(description="K, tau, theta of first order, as /tune takes it; zeta too of second; K, theta integrating."),
    ]
    system: Annotated[dict[str, Any] | None, Field(description="The same as every route takes a system.")]
    fit_pct: Annotated[
        float | None, Field(description="100 (1 - |y - y_hat|/|y - mean y|), Euclidean norms over the samples [%].")
    ]
    intervals: Annotated[dict[str, list[float]] | None, Field(description="95 % confidence intervals [low, high].")]
    intervals_note: Annotated[str, Field(description="What the intervals assume, or why there are none.")]
    estimated: Annotated[dict[str, float], Field(description="Level y0 and drift, where they are estimated.")]
    construction: Annotated[
        dict[str, float], Field(description="Times t0, t1, t2, levels, and the tangent, in the record's own time.")
    ]
    y_hat: Numbers | None
    residuals: Annotated[Any, Field(description="y - y_hat; null at samples without y.")]
    warnings: list[str]
    reason: str | None


class RecordAnswer(Answer):
    """The record as it was used."""

    t: Numbers
    u: Numbers
    y: Annotated[Any, Field(description="null at samples without a value.")]
    hold: str
    u_before: float
    time_unit: str | None
    names: dict[str, str]
    units: dict[str, str]
    notes: list[str]


class IdentifyAnswer(MethodAnswer):
    """The method asked for, at the top; all of them in ``methods`` where that was asked for."""

    record: RecordAnswer
    methods: list[MethodAnswer] | None


class StepTestAnswer(Answer):
    """The record of a step test; t, u and y are what /identify takes."""

    time_unit: str
    u0: float
    y0: float
    t: Numbers
    u: Numbers
    y: Annotated[Numbers, Field(description="As measured, with noise and drift.")]
    y_true: Numbers
    notes: list[str]
    truncated_at: float | None
    truncated_reason: str | None


class TurningPoints(Answer):
    """High and low points by turns."""

    t: Numbers
    y: Numbers


class RingingAnswer(Answer):
    """A run under proportional control."""

    Kc: float
    horizon: float
    t: Numbers
    r: Numbers
    u: Numbers
    y: Numbers
    turning_points: TurningPoints
    decay_ratio: Annotated[float | None, Field(description="Swing over the one a period before: 1 goes on for ever.")]
    Pu: float | None
    reason: str | None
    truncated_at: float | None
    truncated_reason: str | None


class TrialAnswer(Answer):
    """One run of the search."""

    Kc: float
    growth: Annotated[float | None, Field(description="Change of ln(swing) in a period; null: it died out.")]
    Pu: float | None


class ExactPoint(Answer):
    """The ultimate point from the frequency response of a linear plant."""

    Ku: float
    Pu: float
    omega_180: float


class GainWindow(Answer):
    """The stable gains that end in this oscillation, in size."""

    low: float | None
    high: float | None


class UltimateCycleAnswer(Answer):
    """The run, and where the gain was searched what was found, with the exact point of a linear plant beside it."""

    time_unit: str
    Ku: float | None
    Pu: float | None
    omega_180: float | None
    trials: list[TrialAnswer]
    exact: ExactPoint | None
    error_pct: Annotated[float | None, Field(description="Of the searched Ku against the exact one [%].")]
    window: GainWindow | None
    notes: list[str]
    run: RingingAnswer


class RelayReady(Answer):
    """What /tune takes as ``relay``."""

    amplitude: float
    swing: float
    Pu: float
    hysteresis: float


class RelayAnswer(Answer):
    """A relay experiment; the estimate is null with the reason where the cycle is not steady."""

    time_unit: str
    u0: float
    y0: float
    t: Numbers
    u: Annotated[Numbers, Field(description="In deviation from u0.")]
    y: Annotated[Numbers, Field(description="In deviation from y0.")]
    switches: Numbers
    swing: Annotated[float | None, Field(description="Half the height of y.")]
    Pu: float | None
    Ku: Annotated[float | None, Field(description="4 d/(pi sqrt(a^2 - epsilon^2)), taking y for a sine.")]
    relay: RelayReady | None
    exact: ExactPoint | None
    Ku_bias_pct: Annotated[float | None, Field(description="Of the describing function's Ku [%].")]
    Pu_bias_pct: float | None
    reason: str | None
    notes: list[str]
