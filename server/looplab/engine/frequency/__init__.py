"""Frequency response: Bode, crossovers, margins, the Nyquist curve and its count."""

from looplab.engine.frequency.asymptotes import BodeAsymptotes, Corner, bode_asymptotes
from looplab.engine.frequency.bandwidth import Bandwidth, bandwidth, closed_loop_bandwidth
from looplab.engine.frequency.bode import Bode, bode
from looplab.engine.frequency.margins import GainCrossover, Margins, PhaseCrossover, margins
from looplab.engine.frequency.nyquist import NyquistCount, NyquistCurve, nyquist_count, nyquist_curve
from looplab.engine.frequency.response import default_grid, frequency_grid, frequency_range

__all__ = [
    "Bandwidth",
    "Bode",
    "BodeAsymptotes",
    "Corner",
    "GainCrossover",
    "Margins",
    "NyquistCount",
    "NyquistCurve",
    "PhaseCrossover",
    "bandwidth",
    "bode",
    "bode_asymptotes",
    "closed_loop_bandwidth",
    "default_grid",
    "frequency_grid",
    "frequency_range",
    "margins",
    "nyquist_count",
    "nyquist_curve",
]
