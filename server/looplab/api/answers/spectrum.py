"""The answer of POST /spectrum."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, Numbers, Reasons


class LineAnswer(Answer):
    """A sine of the signal, and where sampling shows it: |frequency - k rate|."""

    amplitude: float
    frequency: float
    seen_at: float
    k: int
    aliased: bool


class ParsevalAnswer(Answer):
    """The energy of the samples (under the window) and of the spectrum."""

    energy: float
    spectral_energy: float
    residual: Annotated[float, Field(description="Their difference over the energy.")]
    inverse_error: Annotated[float, Field(description="Largest error of the samples that the inverse gives back.")]


class SineCurves(Answer):
    """The signal between its samples, and the slowest signal with the same samples."""

    t: Numbers
    signal: Numbers
    seen: Numbers


class SpectrumAnswer(Answer):
    """Samples and spectrum; frequencies in cycles per time, omega in rad per time."""

    time_unit: str
    rate: Annotated[
        float, Field(description="Samples per time; with dead time in a loop it may exceed what was asked.")
    ]
    samples: int
    window: Literal["rectangular", "hann"]
    t: Numbers
    values: Numbers
    frequency: Numbers
    omega: Numbers
    amplitude: Annotated[Numbers, Field(description="Of the sine at each frequency.")]
    magnitude: Annotated[Numbers, Field(description="|U| with 1/sqrt(N) before the sum.")]
    phase_deg: Numbers
    resolution: Annotated[float, Field(description="rate/N [cycles/time]")]
    highest: Annotated[float, Field(description="rate/2 [cycles/time]")]
    parseval: ParsevalAnswer
    lines: list[LineAnswer] | None
    leakage_pct: Annotated[
        float | None, Field(description="Share of the energy that does not lie at the signal's frequencies.")
    ]
    curves: SineCurves | None
    expected: Annotated[Numbers | None, Field(description="Amplitudes of the noise alone, in the mean square.")]
    reasons: Reasons
