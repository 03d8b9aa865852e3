"""Frequency response: Bode, crossovers, margins, the Nyquist curve and its count."""

from looplab.engine.frequency.margins import GainCrossover, Margins, PhaseCrossover, margins
from looplab.engine.frequency.nyquist import NyquistCount, NyquistCurve, nyquist_count, nyquist_curve
from looplab.engine.frequency.response import Bode, bode, default_grid, frequency_grid, frequency_range

__all__ = [
    "Bode",
    "GainCrossover",
    "Margins",
    "NyquistCount",
    "NyquistCurve",
    "PhaseCrossover",
    "bode",
    "default_grid",
    "frequency_grid",
    "frequency_range",
    "margins",
    "nyquist_count",
    "nyquist_curve",
]
