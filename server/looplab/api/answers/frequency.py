"""The answers of the frequency routes."""

from __future__ import annotations

from typing import Literal

from looplab.api.answers.base import Answer, ComplexPair, Numbers


class BandwidthAnswer(Answer):
    """Bandwidth [rad/time]; null with a reason where there is none."""

    omega: float | None
    reason: str | None


class CornerAnswer(Answer):
    """A corner of the straight-line sketch: the root s (of a pair the upper one) and what it does to both lines.

    Slopes are in units of 20 dB/decade; zeta is null for a real root.
    """

    omega: float
    kind: Literal["zero", "pole"]
    s: ComplexPair
    multiplicity: int
    zeta: float | None
    slope_change: int
    phase_change_deg: float
    phase_from: float
    phase_to: float


class AsymptotesAnswer(Answer):
    """Vertices of the straight lines of magnitude [dB] and phase [deg], and their corners."""

    omega: list[float]
    mag_dB: list[float]
    phase_omega: list[float]
    phase_deg: list[float]
    corners: list[CornerAnswer]
    initial_slope: int
    initial_phase_deg: float


class FrequencyAnswer(Answer):
    """Frequency response [dB, deg] over omega [rad/time]; re and im with the same points."""

    omega: Numbers
    mag_dB: Numbers
    phase_deg: Numbers
    bandwidth: BandwidthAnswer
    closed_loop_bandwidth: BandwidthAnswer
    asymptotes: AsymptotesAnswer
