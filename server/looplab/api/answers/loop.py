"""The answer of POST /loop."""

from __future__ import annotations

from typing import Literal

from looplab.api.answers.base import Answer, ComplexPair, Numbers, Reasons
from looplab.api.answers.frequency import AsymptotesAnswer


class SystemText(Answer):
    """A system in words a person reads."""

    text: str
    latex: str
    mathml: str


class PlantText(SystemText):
    """A plant (or another part of the loop), with its order and dead time [time]."""

    order: int
    theta: float


class VerdictPanel(Answer):
    """Stable, marginal or unstable; rhp_poles is null when there are infinitely many."""

    key: str
    verdict: Literal["stable", "marginal", "unstable"]
    closed_loop_stable: bool
    because: str
    rhp_poles: int | None


class StepResponse(Answer):
    """y and u after a unit step, shorter than t where the response was cut; y_m is what a sensor makes of y."""

    y: Numbers
    u: Numbers
    y_m: Numbers | None
    final_y: float | None
    truncated_at: float | None
    truncated_reason: str | None


class StepPanel(Answer):
    """Responses to unit steps of the setpoint and of the load."""

    key: str
    horizon: float
    t: Numbers
    setpoint: StepResponse
    load: StepResponse


class BodeCurve(Answer):
    """Magnitude [dB] and phase [deg], anchored at low frequency."""

    mag_dB: Numbers
    phase_deg: Numbers


class BodePanel(Answer):
    """Bode data over omega [rad/time]; a system that is zero is null."""

    key: str
    omega: Numbers
    L: BodeCurve | None
    P: BodeCurve | None
    C: BodeCurve | None


class AsymptotesPanel(AsymptotesAnswer):
    """Straight lines of the Bode diagram of L."""

    key: str


class IndentationArcAnswer(Answer):
    """A pole of L at j omega (omega >= 0), passed on its right: the large arc of L [deg], clockwise by turn_deg."""

    omega: float
    multiplicity: int
    start_deg: float
    end_deg: float
    turn_deg: float


class BodeCriterionAnswer(Answer):
    """Verdict by |L| < 1 at the phase crossover, whether its conditions are met, and Nyquist's verdict beside it."""

    stable: bool | None
    applies: bool
    unmet: list[str]
    omega_180: float | None
    magnitude: float | None
    nyquist_stable: bool | None
    agrees: bool | None
    explanation: str


class NyquistAnswer(Answer):
    """L(j omega) for omega > 0, and Z = N + P; N and Z are null when infinite or not defined."""

    omega: Numbers
    re: Numbers
    im: Numbers
    N: int | None
    P: int
    Z: int | None
    closed_loop_stable: bool
    explanation: str
    arcs: list[IndentationArcAnswer]
    bode_criterion: BodeCriterionAnswer


class NyquistPanel(NyquistAnswer):
    """The same, with its key."""

    key: str


class Branch(Answer):
    """One branch of the locus; its k-th point belongs to gains[first + k], of its own gains where it has them."""

    first: int
    re: Numbers
    im: Numbers
    gains: Numbers | None = None


class Asymptotes(Answer):
    """Where the asymptotes meet, their directions [deg], and with dead time the heights of horizontal ones."""

    centroid: float | None
    angles_deg: list[float]
    horizontal: list[float]


class AngleAt(Answer):
    """Direction in which a branch leaves a complex pole or arrives at a complex zero."""

    s: ComplexPair
    angle_deg: float


class BreakawayPoint(Answer):
    """Branches meet at s for the gain K."""

    s: ComplexPair
    K: float


class AxisCrossingPoint(Answer):
    """A branch crosses the imaginary axis at j omega for the gain K."""

    omega: float
    K: float


class View(Answer):
    """A window that shows what matters."""

    re: list[float]
    im: list[float]


class RootLocusAnswer(Answer):
    """Closed-loop poles over the controller's gain; only available and reason where it cannot be drawn.

    In a window that was asked for, branches are pieces with gains of their own, and gains is null.
    """

    available: bool
    reason: str | None
    gains: Numbers | None = None
    branches: list[Branch] | None = None
    open_loop_poles: list[ComplexPair] | None = None
    open_loop_zeros: list[ComplexPair] | None = None
    asymptotes: Asymptotes | None = None
    breakaways: list[BreakawayPoint] | None = None
    imaginary_axis_crossings: list[AxisCrossingPoint] | None = None
    departure_angles: list[AngleAt] | None = None
    arrival_angles: list[AngleAt] | None = None
    real_axis_segments: list[list[float | None]] | None = None
    view: View | None = None
    complete: bool | None = None


class RootLocusPanel(RootLocusAnswer):
    """The same, with its key."""

    key: str


class PolesPanel(Answer):
    """Closed-loop poles at the gain K."""

    key: str
    K: float
    poles: list[ComplexPair]
    complete: bool
    reason: str | None


class GainCrossoverPoint(Answer):
    """|L| = 1."""

    omega: float
    PM_deg: float


class PhaseCrossoverPoint(Answer):
    """L real and negative."""

    omega: float
    GM: float


class MarginsAnswer(Answer):
    """Margins; null with a reason when infinite or undefined."""

    closed_loop_stable: bool
    GM: float | None
    GM_dB: float | None
    omega_180: float | None
    PM_deg: float | None
    omega_c: float | None
    delay_margin: float | None
    Ms: float | None
    omega_Ms: float | None
    Mt: float | None
    omega_Mt: float | None
    gain_crossovers: list[GainCrossoverPoint]
    phase_crossovers: list[PhaseCrossoverPoint]
    reasons: Reasons


class MarginsPanel(MarginsAnswer):
    """The same, with its key."""

    key: str


class StepMetricsAnswer(Answer):
    """Metrics of one step response; null with a reason when undefined."""

    final_value: float | None
    offset: float | None
    overshoot_pct: float | None
    peak: float | None
    t_peak: float | None
    t_rise: float | None
    t_settle: float | None
    decay_ratio: float | None
    IAE: float | None
    ISE: float | None
    ITAE: float | None
    TV: float | None
    reasons: Reasons


class MetricsPanel(Answer):
    """Metrics of the setpoint and of the load step."""

    key: str
    setpoint: StepMetricsAnswer
    load: StepMetricsAnswer


class SensitivityPanel(Answer):
    """The gang of six over omega [rad/time], magnitudes [dB]; one that is zero is null.

    CFS: r to u, (C + F) S; TF: r to y, P (C + F) S, with the feedforward F = Kc (beta - 1) in
    u = C (r - y) + F r. They are CS and T where F is zero.
    """

    key: str
    omega: Numbers
    S_dB: Numbers | None
    PS_dB: Numbers | None
    CS_dB: Numbers | None
    T_dB: Numbers | None
    CFS_dB: Numbers | None
    TF_dB: Numbers | None
    feedforward: float


class GangStepsPanel(Answer):
    """Unit-step responses of the gang of six over t [time]; an array is shorter than t where it was cut."""

    key: str
    t: Numbers
    S: Numbers
    PS: Numbers
    CS: Numbers
    T: Numbers
    CFS: Numbers
    TF: Numbers
    truncated_reason: str | None
    feedforward: float


class LoopPanels(Answer):
    """The panels that were asked for and have changed."""

    verdict: VerdictPanel | None = None
    step: StepPanel | None = None
    bode: BodePanel | None = None
    nyquist: NyquistPanel | None = None
    root_locus: RootLocusPanel | None = None
    poles: PolesPanel | None = None
    margins: MarginsPanel | None = None
    metrics: MetricsPanel | None = None
    sensitivity: SensitivityPanel | None = None
    asymptotes: AsymptotesPanel | None = None
    gang_steps: GangStepsPanel | None = None
    root_locus_negative: RootLocusPanel | None = None


class LoopAnswer(Answer):
    """Everything asked for about one loop."""

    time_unit: str
    plant: PlantText
    controller: SystemText
    actuator: PlantText | None
    sensor: PlantText | None
    disturbance: PlantText | None
    unchanged: list[str]
    panels: LoopPanels
