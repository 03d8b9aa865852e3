"""The gains that stabilise a loop: exact intervals, several where the loop is conditionally stable."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from looplab.engine.frequency.nyquist import nyquist_count
from looplab.engine.stability.cancellation import hidden_modes
from looplab.engine.stability.notions import pole_text
from looplab.engine.stability.real_axis import always_real, real_axis_frequencies, typical_size
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

AXIS = 1e-9
SAME = 1e-12
# Beyond this many pieces only those that may be stable are counted one by one.
MANY_PIECES = 16


@dataclass(frozen=True)
class GainEnd:
    """One end of a stable range.

    Attributes
    ----------
    K : float or None
        The gain, itself not in the range; None where the range goes on for ever.
    omega : tuple of float
        Frequencies at which closed-loop poles then lie on the imaginary axis, 0 for the origin [rad/time].
    reason : str
        What happens there, or why there is no end.
    """

    K: float | None
    omega: tuple[float, ...]
    reason: str


@dataclass(frozen=True)
class GainRange:
    """Every gain strictly between the ends gives a stable loop."""

    low: GainEnd
    high: GainEnd

    def __contains__(self, K: float) -> bool:
        return (self.low.K is None or K > self.low.K) and (self.high.K is None or K < self.high.K)


@dataclass(frozen=True)
class GainRanges:
    """All stable ranges, increasing; ``reason`` says why there is none or what else matters."""

    ranges: tuple[GainRange, ...]
    reason: str | None = None

    def __contains__(self, K: float) -> bool:
        return any(K in r for r in self.ranges)


def _number(value: float) -> str:
    return f"{value:.6g}"


def _stable(L: TransferFunction, K: float) -> bool:
    if K == 0.0:
        return bool((L.poles.real < -AXIS * np.abs(L.poles)).all())
    return nyquist_count(L * K).Z == 0


class _Candidates:
    """Gains at which stability can change, with what happens there."""

    def __init__(self) -> None:
        self.gains: list[float] = []
        self.omega: list[list[float]] = []
        self.reasons: list[str] = []

    def add(self, K: float, omega: float | None, reason: str) -> None:
        if not np.isfinite(K):
            return
        for i, other in enumerate(self.gains):
            if abs(other - K) <= SAME * abs(K):
                if omega is not None:
                    self.omega[i].append(omega)
                return
        self.gains.append(K)
        self.omega.append([] if omega is None else [omega])
        self.reasons.append(reason)

    def end(self, i: int) -> GainEnd:
        omega = tuple(sorted(self.omega[i]))
        reason = self.reasons[i]
        if not reason:
            names = [f"±{_number(w)}j" if w else "the origin" for w in omega]
            reason = f"closed-loop poles on the imaginary axis, at {' and '.join(names)}"
        return GainEnd(self.gains[i], omega, reason)


def _candidates(L: TransferFunction, negative: bool) -> tuple[_Candidates, str | None]:
    out, note = _Candidates(), None
    omega, complete = real_axis_frequencies(L)
    if not complete:
        note = "the dead time is long against the time constants: ranges at very high gains may be missing"
    on_axis = L.poles[np.abs(L.poles.real) <= AXIS * np.abs(L.poles)]
    if on_axis.size:
        out.add(0.0, None, "without feedback the poles on the imaginary axis stay there")
    elif negative and not _stable(L, 0.0):
        out.add(0.0, None, "without feedback the loop is unstable")
    value = L.response(omega).real if omega.size else np.zeros(0)
    for w, v in zip(omega, value, strict=True):
        out.add(-1.0 / float(v), float(w), "")
    if L.origin_order == 0:
        out.add(-1.0 / L.origin_gain, 0.0, "")
    if L.relative_degree == 0 and L.theta == 0.0:
        out.add(-1.0 / L.gain, None, "the loop is ill-posed: L(infinity) = -1")
    elif L.relative_degree == 0:
        for K in (1.0 / abs(L.gain), -1.0 / abs(L.gain)):
            out.add(K, None, "at infinite frequency |L| = 1: poles without end approach the imaginary axis")
    return out, note


def _no_ranges(L: TransferFunction) -> str | None:
    """Why no gain can stabilise the loop, where that is plain from its structure."""
    for mode in hidden_modes(L.zeros, L.poles):
        if mode.real >= -AXIS * abs(mode):
            return f"a zero cancels the pole at {pole_text(complex(mode))}: that mode stays, whatever the gain"
    if L.order and always_real(L):
        return "the loop has only even powers of s: closed-loop poles lie symmetric to the imaginary axis at every gain"
    return None


def _moved_right(L: TransferFunction, end: GainEnd) -> int | None:
    """How many closed-loop poles go to the right half-plane as the gain rises through an end; None if unclear."""
    if not end.omega or not end.K:
        return None
    moved = 0
    for w in end.omega:
        # K L(s) = -1 along a branch: ds/dK = -1/(K L'/L).
        with np.errstate(all="ignore"):
            rate = complex(-1.0 / (end.K * L.log_derivative(np.array([1j * w]))[0]))
        if not abs(rate.real) > 1e-6 * abs(rate):
            return None
        moved += (1 if w == 0 else 2) * (1 if rate.real > 0 else -1)
    return moved


def _surely_unstable(L: TransferFunction, pieces: list[tuple[GainEnd, GainEnd]]) -> set[int]:
    """Pieces that have closed-loop poles in the right half-plane, by walking away from K = 0 and adding up."""
    first = next(i for i, (_, high) in enumerate(pieces) if high.K is None or high.K > 0)
    out: set[int] = set()
    for step, start in ((1, first), (-1, first - 1)):
        Z: int | None = None
        i = start
        while 0 <= i < len(pieces):
            if Z is None:
                Z = nyquist_count(L * _inside(pieces[i][0].K, pieces[i][1].K, L)).Z
            if Z is not None and Z > 0:
                out.add(i)
            moved = _moved_right(L, pieces[i][1 if step > 0 else 0])
            Z = None if Z is None or moved is None else Z + step * moved
            i += step
    return out


@lru_cache(maxsize=256)
def gain_ranges(L: TransferFunction, negative: bool = False) -> GainRanges:
    r"""All gains K for which the loop with K L(s) is stable, dead time exact.

    .. math:: D(s) + K N(s)\, e^{-\theta s} = 0, \qquad K_i = -\frac{1}{L(i\omega_i)}, \quad \Im L(i\omega_i) = 0

    A closed-loop pole can change sides only at a gain that puts one on the imaginary axis, or through infinity. Those
    gains cut the line into pieces; Nyquist's count at one gain inside each piece decides it.

    Parameters
    ----------
    L : TransferFunction
        Proper open loop for K = 1, under negative feedback.
    negative : bool
        Look at negative gains too; otherwise ranges begin at K = 0 at the lowest.

    Returns
    -------
    GainRanges
        Open intervals; an end is None with a reason where there is no limit. Hidden modes count: where a zero cancels
        a pole that is not stable there is no range.

    Raises
    ------
    ImproperSystem
        L has more zeros than poles.

    References
    ----------
    .. [1] S. P. Bhattacharyya, A. Datta, L. H. Keel, Linear Control Theory, CRC Press 2009, ch. 1.
    """
    L.require_proper()
    unbounded = GainEnd(None, (), "stable however large the gain")
    below = GainEnd(None, (), "stable however negative the gain")
    positive_only = GainEnd(0.0, (), "only positive gains are looked at; the loop is stable without feedback too")
    if L.gain == 0.0:
        if not _stable(L, 0.0):
            return GainRanges((), "the loop is cut (its gain is zero) and its poles are not stable")
        return GainRanges(
            (GainRange(below if negative else positive_only, unbounded),), "the loop is cut: the gain changes nothing"
        )
    reduced, hidden = split_hidden_modes(L)
    if (hidden.real < -AXIS * np.abs(hidden)).all():
        # They stay where they are, and are stable.
        L = reduced
    why = _no_ranges(L)
    if why:
        return GainRanges((), why)
    if not L.order and not L.theta:
        points, note = _Candidates(), None
        points.add(-1.0 / L.gain, None, "the loop is ill-posed: 1 + K L = 0 has no solution for the signals")
    else:
        points, note = _candidates(L, negative)
    lowest = -np.inf if negative else 0.0
    order = [i for i in np.argsort(points.gains) if points.gains[i] > lowest]
    ends = [points.end(i) for i in order]
    start = below
    if not negative:
        zero = [points.end(i) for i, K in enumerate(points.gains) if K == 0.0]
        start = zero[0] if zero else positive_only
    cuts = [start, *ends, unbounded]
    found: list[GainRange] = []
    pieces = list(pairwise(cuts))
    hopeless = _surely_unstable(L, pieces) if len(pieces) > MANY_PIECES else set()
    for i, (low, high) in enumerate(pieces):
        if i not in hopeless and _stable(L, _inside(low.K, high.K, L)):
            found.append(GainRange(low, high))
    reason = note if found else "no gain stabilises the loop" + (f"; {note}" if note else "")
    return GainRanges(tuple(found), reason)


def _inside(low: float | None, high: float | None, L: TransferFunction) -> float:
    """A gain well inside the piece, in ratio where the ends have one sign."""
    if low is None and high is None:
        return 0.5 / max(abs(L.gain), 1e-300) * typical_size(L) ** L.relative_degree
    if low is None or high is None:
        edge = high if low is None else low
        assert edge is not None
        out = -1.0 if low is None else 1.0
        if edge == 0.0:
            return out / abs(L.gain) * typical_size(L) ** L.relative_degree
        return edge * 2.0 if edge * out > 0 else edge + out * abs(edge) * 3.0
    if low * high > 0:
        return float(np.sign(low) * np.sqrt(low * high))
    return 0.5 * (low + high)
