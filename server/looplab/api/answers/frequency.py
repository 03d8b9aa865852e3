"""The answers of the frequency routes."""

from __future__ import annotations

from typing import Literal

from looplab.api.answers.base import Answer, Numbers


class BandwidthAnswer(Answer):
    """Bandwidth [rad/time]; null with a reason where there is none."""

    omega: float | None
    reason: str | None


class CornerAnswer(Answer):
    """A corner of the straight-line sketch."""

    omega: float
    slope_change: int
    kind: Literal["zero", "pole"]


class AsymptotesAnswer(Answer):
    """Vertices of the straight-line magnitude, and its corners."""

    omega: list[float]
    mag_dB: list[float]
    corners: list[CornerAnswer]
    initial_slope: int


class FrequencyAnswer(Answer):
    """Frequency response [dB, deg] over omega [rad/time]; re and im with the same points."""

    omega: Numbers
    mag_dB: Numbers
    phase_deg: Numbers
    bandwidth: BandwidthAnswer
    closed_loop_bandwidth: BandwidthAnswer
    asymptotes: AsymptotesAnswer
