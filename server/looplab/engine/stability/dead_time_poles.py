"""Closed-loop poles of a loop with dead time: the rightmost of infinitely many, on the exact equation."""

from __future__ import annotations

import cmath
from collections.abc import Iterable
from functools import lru_cache
from math import ceil, inf, isfinite, log, pi
from operator import attrgetter

import numpy as np
import numpy.typing as npt

from looplab.engine.frequency.crossings import Crossings, crossings
from looplab.engine.frequency.nyquist import nyquist_count
from looplab.engine.frequency.scalar import TINY, ScalarLoop, scalar_loop
from looplab.engine.loop.equations import loop_equations
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.stability.delay_line import delay_line_matrix
from looplab.engine.stability.polish import EPSILON, polish_closed_loop_poles
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.polynomial import eigenvalues
from looplab.engine.systems.transfer_function import SMALL_ORDER, TransferFunction

ComplexArray = npt.NDArray[np.complex128]

# Nodes of the delay line: from FEW to ENOUGH for the first pole of the chain, more per theta omega of the fastest gain
# crossover.
FEW, ENOUGH, PER_TURN = 12, 20, 1.5
MOST = 120
# Poles that are wanted, and pairs of them that are kept at most.
LISTED, MOST_PAIRS = 24, 60
STEPS = 8
# Where the chain begins in dead times left of the axis, at most.
DEEPEST = 200.0
# Poles closer than this, relative to their size, are one; a part smaller than AXIS of it is none.
SAME, AXIS = 1e-7, 1e-9


def dead_time_poles(loop: FeedbackLoop) -> ComplexArray:
    """The rightmost closed-loop poles of a loop with dead time, hidden modes included: rightmost first, then slowest.

    The lowest are eigenvalues of the collocated delay line, brought onto the exact equation; from the highest of them a
    chain leads up to the others. As many must lie in the right half-plane as Nyquist counts there: where few nodes do
    not show them, more are taken.
    """
    L, hidden = split_hidden_modes(loop.open_loop)
    found = crossings(L)
    turns = loop.theta * max(found.gain_omega.tolist(), default=0.0)
    first = _first_of_chain(L)
    # A polynomial follows exp(x) over a length |x| with about |x|/2 terms, and a few more for digits.
    nodes = min(max(ceil(6.0 + 0.55 * loop.theta * abs(first)), FEW), ENOUGH)
    poles = _poles(loop, L, found, first, min(ceil(nodes + PER_TURN * turns), MOST))
    right = nyquist_count(L).Z
    if nodes < ENOUGH and right is not None and right != _many(s for s in poles if s.real > 0.0):
        poles = _poles(loop, L, found, first, min(ceil(ENOUGH + PER_TURN * turns), MOST))
    poles += [s for s in hidden.tolist() if s.imag >= 0.0]
    if hidden.size:
        poles.sort(key=_order)
    return np.array([p for s in poles for p in ((s, s.conjugate()) if s.imag else (s,))][:LISTED])


def _first_of_chain(L: TransferFunction) -> complex:
    """About where the chain has a pole one turn of the dead time above the real axis."""
    unit, gain, depth = scalar_loop(L.unit), abs(L.gain), 0.0
    for _ in range(3):
        # Left of the axis by depth/theta, where the dead time makes up for |L|.
        value, _ = unit.value_and_rate(complex(-depth, 2.0 * pi) / L.theta, gain)
        depth = min(max(depth - log(abs(value) or TINY), 0.0), DEEPEST)
    return complex(-depth, 2.0 * pi) / L.theta


def _poles(loop: FeedbackLoop, L: TransferFunction, found: Crossings, first: complex, nodes: int) -> list[complex]:
    """Of each pair the one above the real axis, rightmost first."""
    theta = loop.theta
    # The collocation resolves about half a wave per node; what it cannot resolve is noise.
    top, left = 0.75 * nodes / theta, -2.0 * nodes / theta
    every = eigenvalues(delay_line_matrix(loop_equations(loop.lumped), theta, nodes)).tolist()
    poles = _distinct(_on_equation(L, [s for s in every if 0.0 <= s.imag < top and s.real > left]))
    highest = max((s for s in poles if 0.0 < s.imag < top), key=attrgetter("imag"), default=0j)
    chain = _chain(L, highest, LISTED - _many(poles)) if highest else []
    if not chain:
        # The highest was none of the chain.
        for s in _on_equation(L, [first]):
            chain = [*_chain(L, s, LISTED, down=True), s, *_chain(L, s, LISTED)]
    poles += chain
    end = max([0.25 * top, highest.imag, *(s.imag for s in chain)])
    # Where the chain ends each phase crossover may have a pole left of it, where the dead time makes up for |L|: so it
    # begins anew. Resonances have poles beside the chain.
    resonant = 2.0 * max((r.imag for r in [*L.zeros.tolist(), *L.poles.tolist()]), default=0.0)
    for m, w in zip(found.phase_log_magnitude.tolist(), found.phase_omega.tolist(), strict=True):
        if isfinite(m) and m / theta > left and (w > end or 0.25 * top < w < resonant):
            missing = LISTED - _many(s for s in poles if s.real >= m / theta)
            if missing <= 0:
                continue
            beside = _on_equation(L, [complex(m / theta, w)])
            poles += beside
            if beside and w > end:
                poles += _chain(L, beside[0], missing, down=True)
                poles += _chain(L, beside[0], missing)
                end = max(poles[-1].imag, w)
    return _distinct([*poles, *_unmoved(L)])[:MOST_PAIRS]


def _chain(L: TransferFunction, start: complex, most: int, down: bool = False) -> list[complex]:
    """Poles above or below one of them, for as long as one follows the other by a turn of the dead time.

    From one to the next ln(-L) changes by 2 pi j. They end with so many left of the imaginary axis.
    """
    unit, gain, s = scalar_loop(L.unit), abs(L.gain), start
    out: list[complex] = []
    _, rate, bend = unit.value_and_rates(s, gain)
    while rate and (s.real > 0.0 or 2 * len(out) < most) and len(out) < MOST_PAIRS:
        turned = -2j * pi / rate
        step, turn = (-turned, -turned * bend / rate) if down else (turned, turned * bend / rate)
        # Where the dead time rules, the next pole is above this one.
        if not (abs(turn) < 0.5 and turned.imag > 0.5 * abs(turned)):
            break
        ahead = s + step / (1.0 + 0.5 * turn)
        if abs(ahead.imag) < 0.25 * abs(step):
            # The lowest is real; otherwise it is its own conjugate that comes next.
            ahead = complex(ahead.real)
        found = _polished(unit, gain, ahead) if ahead.imag >= 0.0 else None
        if found is None or not abs(found[0] - ahead) < 0.3 * abs(step):
            break
        s, rate, bend = found
        out.append(s)
    return out


def _many(poles: Iterable[complex]) -> int:
    """How many they are with those below the real axis."""
    return sum(2 if s.imag else 1 for s in poles)


def _on_equation(L: TransferFunction, start: list[complex]) -> list[complex]:
    """Those of the approximate poles that lead to a pole nearby."""
    if max(L.order, L.zeros.size) > SMALL_ORDER:
        poles, good = polish_closed_loop_poles(L, np.array(start, dtype=complex), steps=STEPS)
        return poles[good].tolist()
    unit, gain = scalar_loop(L.unit), abs(L.gain)
    polished = (_polished(unit, gain, s) for s in start)
    return [p[0] for p in polished if p is not None]


def _polished(unit: ScalarLoop, gain: float, start: complex) -> tuple[complex, complex, complex] | None:
    """Halley's method on ln(-L) = 0, on plain numbers: the pole, and L'/L and its slope a last step before it.

    None where no pole is near the start.
    """
    s, reach = start, 0.3 * abs(start) + 1e-6
    miss, knowable, rate, bend = inf, 0.0, 0j, 0j
    for _ in range(STEPS):
        value, rate, bend = unit.value_and_rates(s, gain)
        if not (value and rate and isfinite(abs(value))):
            return None
        level = cmath.log(-value)
        step = level / rate
        # How much the rate changes over the step, relative to it.
        turn = step * bend / rate
        s -= step / (1.0 - 0.5 * turn) if abs(turn) < 1.0 else step
        if not abs(s - start) <= reach:
            return None
        miss, rounding = abs(level), EPSILON * abs(s)
        # Next to an open-loop pole L cannot be known better than the rounding of s allows.
        knowable = 8.0 * rounding * abs(rate)
        # Halley's misses shrink as their cubes.
        if (abs(turn) ** 2 * abs(step) <= rounding and abs(turn) < 0.01) or abs(step) <= 4.0 * rounding:
            return s, rate, bend
    return (s, rate, bend) if miss < max(1e-8, min(knowable, 0.1)) else None


def _order(pole: complex) -> tuple[float, float]:
    return -round(pole.real, 9), pole.imag


def _distinct(poles: list[complex]) -> list[complex]:
    """In order, all on or above the real axis, those that are one but for rounding once."""
    kept: list[complex] = []
    for s in sorted((s if s.imag >= 0.0 else s.conjugate() for s in poles), key=_order):
        near = SAME * max(abs(s), 1e-12)
        if s.imag <= AXIS * abs(s):
            s = complex(s.real)
        for other in reversed(kept):
            if other.real - s.real > near:
                kept.append(s)
                break
            if abs(other - s) <= near:
                break
        else:
            kept.append(s)
    return kept


@lru_cache(maxsize=64)
def _simple_real_poles(unit: TransferFunction) -> list[tuple[float, float]]:
    """Real poles p that are not repeated, and ln|c| of 1 + c/(s - p) = 0 next to them for the unit gain."""
    zeros, poles = unit.zeros.tolist(), unit.poles.tolist()
    out = []
    for p in poles:
        if p.imag == 0.0 and poles.count(p) == 1 and p not in zeros:
            size = sum(log(abs(p - z)) for z in zeros) - sum(log(abs(p - other)) for other in poles if other != p)
            out.append((p.real, size - unit.theta * p.real))
    return out


def _unmoved(L: TransferFunction) -> list[complex]:
    """Open-loop poles that the loop moves by less than rounding: s = p - c."""
    gain = log(abs(L.gain))
    return [complex(p) for p, size in _simple_real_poles(L.unit) if p and gain + size < log(1e-12 * abs(p))]
