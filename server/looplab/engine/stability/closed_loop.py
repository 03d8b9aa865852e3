"""Closed-loop poles, with and without dead time, and the verdict they give."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from operator import attrgetter

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.crossings import crossings
from looplab.engine.frequency.nyquist import NyquistCount, nyquist_count
from looplab.engine.loop.equations import loop_equations
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.stability.dead_time_poles import dead_time_poles
from looplab.engine.stability.polish import polish_few
from looplab.engine.systems.polynomial import eigenvalues
from looplab.engine.systems.transfer_function import TransferFunction

ComplexArray = npt.NDArray[np.complex128]

# A pole counts as on the imaginary axis when its real part is below this fraction of its size.
AXIS_TOLERANCE = 1e-9
# Equal poles may be apart by this fraction of their size.
SCATTERED = 1e-6


@dataclass(frozen=True)
class ClosedLoopPoles:
    """Closed-loop poles, rightmost first [rad/time]; not ``complete`` where dead time makes them infinitely many."""

    poles: ComplexArray
    complete: bool
    reason: str | None = None


@dataclass(frozen=True)
class Verdict:
    """``verdict`` is "stable", "marginal" or "unstable"; ``because`` says it in a sentence.

    ``rhp_poles`` counts the closed-loop poles right of the imaginary axis; None when they are infinitely many.
    """

    verdict: str
    closed_loop_stable: bool
    because: str
    rhp_poles: int | None


def _sorted(poles: ComplexArray) -> ComplexArray:
    """Rightmost first; of those above one another the slowest first."""
    ordered = sorted(poles.tolist(), key=lambda p: (-round(p.real, 9), abs(p.imag), -p.imag))
    return np.array(ordered, dtype=complex)


@lru_cache(maxsize=32)
def closed_loop_poles(loop: FeedbackLoop) -> ClosedLoopPoles:
    r"""Roots of 1 + L(s) = 0, hidden (cancelled) modes included.

    Parameters
    ----------
    loop : FeedbackLoop

    Returns
    -------
    ClosedLoopPoles
        Without dead time all n of them, from the state matrix. With dead time the rightmost 24 of infinitely many: the
        delay line is collocated at Chebyshev points, and what that finds, with the chain of poles above it, is
        polished on the exact equation :math:`L_0(s) e^{-\theta s} = -1`.

    References
    ----------
    .. [1] D. Breda, S. Maset, R. Vermiglio, SIAM J. Sci. Comput. 27 (2005) 482-495 (pseudospectral collocation).
    """
    if loop.open_loop.gain == 0.0:
        # The loop is cut: the poles of plant and controller stay where they are.
        return ClosedLoopPoles(_sorted(loop.open_loop.poles), True)
    if loop.theta == 0.0:
        poles = eigenvalues(loop_equations(loop.lumped).closed_loop_matrix())
        return ClosedLoopPoles(_sorted(polish_few(loop.open_loop, poles)), True)
    reason = "dead time makes infinitely many closed-loop poles; the rightmost are listed"
    return ClosedLoopPoles(dead_time_poles(loop), False, reason)


def _number(value: float) -> str:
    return f"{value:.3g}"


def _pole_text(p: complex) -> str:
    if abs(p.imag) <= AXIS_TOLERANCE * abs(p):
        return _number(p.real)
    return f"{_number(p.real)} ± {_number(abs(p.imag))}j"


def _unscattered(poles: list[complex]) -> list[complex]:
    """Poles near the axis that lie together, on the real part of their mean.

    Rounding scatters m equal poles around their mean by about eps^(1/m), but hardly moves the mean.
    """
    near = [p for p in poles if abs(p.real) <= SCATTERED * abs(p)]
    if len(near) < 2:
        return poles
    out = list(poles)
    for i, p in enumerate(poles):
        if abs(p.real) <= SCATTERED * abs(p):
            together = [q.real for q in near if abs(q - p) <= SCATTERED * abs(p)]
            out[i] = complex(sum(together) / len(together), p.imag)
    return out


def verdict_from_poles(poles: ComplexArray, noun: str = "closed-loop pole", whole: str = "loop") -> Verdict:
    """The verdict where all poles are known; ``noun`` and ``whole`` say of what."""
    if not poles.size:
        return Verdict("stable", True, f"the {whole} has no dynamics: it answers at once", 0)
    # Eigenvalues of a cluster of m equal poles scatter by about eps^(1/m); a pole at the origin needs a scale.
    every = _unscattered(poles.tolist())
    least = max(1e-3 * max(map(abs, every)), 1e-300)
    by_size = [(p, AXIS_TOLERANCE * max(abs(p), least)) for p in every]
    right = [p for p, near in by_size if p.real > near]
    axis = [p for p, near in by_size if abs(p.real) <= near]
    if right:
        worst = max(right, key=attrgetter("real"))
        many = f"{len(right)} {noun}s lie" if len(right) > 1 else f"a {noun} lies"
        return Verdict(
            "unstable",
            False,
            f"{many} in the right half-plane, at {_pole_text(worst)}: the response grows",
            len(right),
        )
    if axis:
        if any(sum(abs(other - p) < 1e-6 * max(abs(p), 1e-6) for other in axis) > 1 for p in axis):
            return Verdict("unstable", False, f"a repeated {noun} lies on the imaginary axis", 0)
        at = max(axis, key=attrgetter("imag"))
        what = (
            f"a {noun} lies at the origin"
            if abs(at) < 1e-12
            else (
                f"a pair of {noun}s lies on the imaginary axis at ±{_number(abs(at.imag))}j: "
                f"the {whole} oscillates without end"
            )
        )
        return Verdict("marginal", False, what, 0)
    slowest = max(every, key=attrgetter("real"))
    many = f"all {len(every)} {noun}s lie" if len(every) > 1 else f"the {noun} lies"
    return Verdict("stable", True, f"{many} in the left half-plane; the rightmost at {_pole_text(slowest)}", 0)


@lru_cache(maxsize=32)
def closed_loop_verdict(loop: FeedbackLoop) -> Verdict:
    """Stable, marginal or unstable, and why.

    Parameters
    ----------
    loop : FeedbackLoop

    Returns
    -------
    Verdict
        Without dead time from all closed-loop poles (hidden ones too: this is internal stability); with dead time
        from Nyquist's count on the exact open loop, worded with the rightmost pole.
    """
    if loop.theta == 0.0 or loop.open_loop.gain == 0.0:
        return verdict_from_poles(closed_loop_poles(loop).poles)
    L = loop.open_loop
    count = nyquist_count(L)
    poles = closed_loop_poles(loop).poles
    if count.through_minus_one:
        right = int(np.count_nonzero(poles.real > 1e-6 * np.abs(poles)))
        if not right:
            w = _touching_frequency(L)
            at = "the origin" if w == 0 else f"±{_number(w)}j"
            return Verdict("marginal", False, f"closed-loop poles lie on the imaginary axis, at {at}", 0)
        count = NyquistCount(None, count.P, right)
    if count.Z is None:
        return Verdict("unstable", False, str(count.reason), None)
    rightmost = f" The rightmost pole is at {_pole_text(poles[0])}." if poles.size else ""
    if count.Z:
        many = f"{count.Z} closed-loop poles lie" if count.Z > 1 else "a closed-loop pole lies"
        return Verdict("unstable", False, f"{many} in the right half-plane (Nyquist: Z = N + P).{rightmost}", count.Z)
    return Verdict(
        "stable", True, f"no closed-loop pole lies in the right half-plane (Nyquist: Z = N + P = 0).{rightmost}", 0
    )


def _touching_frequency(L: TransferFunction) -> float:
    found = crossings(L)
    if not found.gain_omega.size:
        return 0.0
    miss = np.abs(np.mod(found.gain_phase, 2 * np.pi) - np.pi)
    return float(found.gain_omega[np.argmin(miss)])
