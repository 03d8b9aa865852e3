"""The answers of POST /compare and POST /gain-map."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from looplab.api.answers.base import Answer, Numbers, Reasons
from looplab.api.answers.tune import PIDSettings
from looplab.engine.tuning import Aim, Criterion, TypeName


class ComparedMargins(Answer):
    """Robustness of one loop."""

    GM: float | None
    GM_dB: float | None
    PM_deg: float | None
    omega_c: float | None
    delay_margin: float | None
    Ms: float | None
    Mt: float | None
    reasons: Reasons


class SetpointMetrics(Answer):
    """Metrics of the setpoint step."""

    overshoot_pct: float | None
    t_rise: float | None
    t_settle: float | None
    decay_ratio: float | None
    offset: float | None
    IAE: float | None
    ISE: float | None
    ITAE: float | None
    TV: float | None
    reasons: Reasons


class LoadMetrics(Answer):
    """Metrics of the load step."""

    peak: float | None
    t_settle: float | None
    IAE: float | None
    ISE: float | None
    ITAE: float | None
    TV: float | None
    reasons: Reasons


class Curve(Answer):
    """One step response; cut where it grows without end."""

    t: Numbers
    y: Numbers
    u: Numbers
    truncated_at: float | None
    truncated_reason: str | None


class Curves(Answer):
    """Responses to both steps."""

    setpoint: Curve
    load: Curve


class SpreadCase(Answer):
    """One plant of the spread: the factors of gain, time constants and dead time, and the loop on it."""

    K: float
    tau: float
    theta: float
    closed_loop_stable: bool
    Ms: float | None
    IAE: float | None
    load_IAE: float | None


class SpreadBand(Answer):
    """Lowest and highest y over the stable cases."""

    low: Numbers
    high: Numbers


class Spread(Answer):
    """What a loop does over the spread of plants."""

    spread_pct: float
    t: Numbers
    setpoint: SpreadBand | None
    load: SpreadBand | None
    cases: int
    unstable: list[SpreadCase]
    worst_Ms: Annotated[SpreadCase | None, Field(description="Largest Ms over the stable cases.")]
    worst_IAE: Annotated[SpreadCase | None, Field(description="Largest IAE of the load step over the stable cases.")]
    reason: Annotated[str | None, Field(description="What the bands leave out.")]


class ComparedRow(Answer):
    """One controller on the plant; null with the reason where its rule refuses or there is no such loop."""

    label: str
    rule: str | None
    type: TypeName
    valid: bool
    reason: str | None
    controller: PIDSettings | None
    closed_loop_stable: bool | None
    margins: ComparedMargins | None
    setpoint: SetpointMetrics | None
    load: LoadMetrics | None
    responses: Curves | None
    sensitivity: Spread | None


class CompareAnswer(Answer):
    """The rows, and the time over which responses and integrals run."""

    horizon: float
    rows: list[ComparedRow]


class Boundary(Answer):
    """Settings exactly on the boundary of stability; null breaks the curve."""

    Kc: list[float | None]
    tau_I: list[float | None]


class GainMapAnswer(Answer):
    """Ms and a criterion over the plane of Kc and tau_I: one list per tau_I, null where the reasons say."""

    Kc: Numbers
    tau_I: Numbers
    criterion: Criterion
    aim: Aim
    Ms: list[list[float | None]]
    value: list[list[float | None]]
    boundary: Boundary
    reasons: Reasons
