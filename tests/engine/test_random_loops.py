"""Five hundred random loops: margins by their definitions, the locus by its equation, Nyquist's Z by counted roots.

Orders 1 to 12, all forms of the controller, with and without dead time, stable and unstable, integrators, zeros in the
right half-plane, resonances, repeated poles (tests/support/random_loops.py). Every number that the engine states is put
back into L(s) as it is evaluated there, from the factors each loop was made of.

Cheap checks look at every loop. The curves of the locus are drawn for every second loop without dead time and every
fifth with it; LOOPLAB_EXAMPLES=500 draws them all, a larger number makes more loops.
"""

import os
from collections import Counter
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from independent import count_in_box, from_roots, proved_rhp_roots, rhp_closed_loop_poles
from looplab.engine.frequency import Margins, margins, nyquist_count
from looplab.engine.stability import axis_crossings, breakaway_points, closed_loop_verdict, root_locus
from looplab.engine.stability.locus import departure_angles, real_axis_segments
from random_loops import FORMS, KINDS, RandomLoop, random_loops

WANTED = int(os.environ.get("LOOPLAB_EXAMPLES", "0"))
LOOPS = random_loops(max(500, WANTED))
DRAWN = [r for i, r in enumerate(LOOPS) if WANTED or i % (5 if r.plant.theta else 2) == 0]

ROUNDING = 8 * np.finfo(float).eps
OMEGA = np.logspace(-4, 4, 4001)
EXACT = 1e-9


@cache
def found(r: RandomLoop) -> Margins:
    return margins(r.loop.open_loop)


@cache
def on_grid(r: RandomLoop) -> np.ndarray:
    return r.open_loop(1j * OMEGA)


@cache
def counted(r: RandomLoop) -> int | None:
    """Closed-loop poles in the right half-plane without the engine; None: one is too near to the axis to say."""
    zeros, poles, gain = r.roots
    if r.plant.theta:
        return rhp_closed_loop_poles(zeros, poles, gain * r.loop.gain, r.plant.theta)
    return proved_rhp_roots(zeros, poles, gain * r.loop.gain)


def test_the_sample_has_every_kind() -> None:
    seen = Counter((r.kind, r.form) for r in LOOPS)
    assert all(seen[kind, form] >= 3 for kind in KINDS for form in FORMS)
    assert {len(r.roots[1]) for r in LOOPS} == set(range(1, 13))
    assert sum(r.plant.theta > 0 for r in LOOPS) >= 150
    assert sum(counted(r) == 0 for r in LOOPS) >= 100
    assert sum((counted(r) or 0) > 0 for r in LOOPS) >= 100
    assert sum(len(found(r).gain_crossovers) > 1 for r in LOOPS) >= 20
    assert sum(not found(r).gain_crossovers for r in LOOPS) >= 20
    assert sum(any(p.real > 0 for p in r.roots[1]) for r in LOOPS) >= 50
    assert sum(any(z.real > 0 for z in r.roots[0]) for r in LOOPS) >= 50
    assert sum(len(set(r.plant.poles)) < len(r.plant.poles) for r in LOOPS) >= 50


def test_gain_crossovers() -> None:
    """|L| = 1 and PM = 180 deg + arg L."""
    for r in LOOPS:
        for c in found(r).gain_crossovers:
            value = r.open_loop(np.array(1j * c.omega))
            assert abs(abs(value) - 1) <= EXACT, (r, c)
            miss = c.PM_deg - 180 - np.degrees(np.angle(value))
            assert abs(miss - 360 * round(miss / 360)) <= EXACT, (r, c)
            assert -180 < c.PM_deg <= 180, (r, c)


def test_phase_crossovers() -> None:
    """L is real and negative, and GM |L| = 1."""
    for r in LOOPS:
        for c in found(r).phase_crossovers:
            value = r.open_loop(np.array(1j * c.omega))
            assert value.real < 0, (r, c)
            assert abs(value.imag) <= EXACT * abs(value), (r, c)
            assert abs(c.GM * abs(value) - 1) <= EXACT, (r, c)


def test_the_margins_are_those_of_the_nearest_crossovers() -> None:
    for r in LOOPS:
        m = found(r)
        if m.phase_crossovers:
            assert abs(np.log(m.GM)) == min(abs(np.log(c.GM)) for c in m.phase_crossovers), r
            assert abs(m.GM_dB - 20 * np.log10(m.GM)) <= EXACT, r
        else:
            assert m.GM is None and m.reasons["GM"], r
        if m.gain_crossovers:
            assert abs(m.PM_deg) == min(abs(c.PM_deg) for c in m.gain_crossovers), r
        else:
            assert m.PM_deg is None and m.reasons["PM_deg"], r


def test_no_crossover_is_missed() -> None:
    """Every change of sign on a grid of its own is listed (with dead time: phase crossovers up to GM = 20)."""
    for r in LOOPS:
        m, value = found(r), on_grid(r)
        slow = np.diff(OMEGA) * r.plant.theta < 0.5  # elsewhere the grid does not follow the dead time
        size = np.log(np.abs(value))
        gain = slow & (size[1:] * size[:-1] < 0)
        axis = slow & (value.imag[1:] * value.imag[:-1] < 0) & (value.real[1:] < 0) & (value.real[:-1] < 0)
        axis &= (np.abs(value.imag) > EXACT * np.abs(value))[1:]  # neither on the axis all along
        if r.plant.theta:
            axis &= np.abs(value[1:]) > 0.051
            if len(r.roots[0]) == len(r.roots[1]):
                axis &= OMEGA[1:] * r.plant.theta < 100  # they go on for ever
        for changes, listed in ((gain, m.gain_crossovers), (axis, m.phase_crossovers)):
            omega = np.array([c.omega for c in listed])
            for i in np.flatnonzero(changes):
                between = (omega >= OMEGA[i] * (1 - EXACT)) & (omega <= OMEGA[i + 1] * (1 + EXACT))
                assert between.any(), (r, OMEGA[i])


def test_sensitivity_peaks() -> None:
    """No |S| or |T| of the grid is above its peak, and the peak is attained where it is said to be."""
    for r in LOOPS:
        m, L = found(r), on_grid(r)
        for name, size in (("Ms", np.abs(1 / (1 + L))), ("Mt", np.abs(L / (1 + L)))):
            peak, omega = getattr(m, name), getattr(m, f"omega_{name}")
            if peak is None:
                assert "through -1" in m.reasons[name], r
                assert nyquist_count(r.loop.open_loop).through_minus_one, r
                continue
            assert size.max() <= peak * (1 + EXACT), (r, name)
            at = {None: 1e12, 0.0: 1e-12}.get(omega, omega)  # its limits
            there = r.open_loop(np.array(1j * at))
            value = abs((1 if name == "Ms" else there) / (1 + there))
            assert abs(value - peak) <= EXACT * peak, (r, name, omega)


def test_delay_margin() -> None:
    """PM/omega of the first crossover that a growing dead time brings to -180 deg; only of a stable loop."""
    for r in LOOPS:
        m = found(r)
        if not m.closed_loop_stable or not m.gain_crossovers:
            assert m.delay_margin is None, r
            assert m.reasons["delay_margin"], r
            continue
        expected = min(np.radians(c.PM_deg % 360) / c.omega for c in m.gain_crossovers)
        assert abs(m.delay_margin - expected) <= EXACT * expected, r


def test_nyquist_counts_the_closed_loop_poles() -> None:
    on_axis = 0
    for r in LOOPS:
        count, verdict = nyquist_count(r.loop.open_loop), closed_loop_verdict(r.loop)
        assert count.P == sum(p.real > 0 for p in r.roots[1]), r
        if counted(r) is None:
            on_axis += 1
            assert count.through_minus_one, r
            assert verdict.verdict == "marginal", r
            continue
        assert count.Z == counted(r), r
        assert verdict.rhp_poles == counted(r), r
        assert verdict.closed_loop_stable == found(r).closed_loop_stable == (counted(r) == 0), r
    assert on_axis <= len(LOOPS) // 100


def residual(r: RandomLoop, K: np.ndarray, s: np.ndarray) -> np.ndarray:
    """|1 + K L0| / (1 + |K L0|) less what eight roundings of s change it by; 0 on a root itself.

    There K L0 is 0/0 to the last digit: the distance of the pole from the root must be below the rounding of s.
    """
    zeros, poles, gain = (np.array(x) for x in r.roots)
    roots = np.concatenate([zeros, poles])
    with np.errstate(all="ignore"):
        value = K * r.per_gain(s)
        spread = ROUNDING * np.abs(s) * (1 / np.abs(s[:, None] - roots)).sum(axis=1)
        out = np.abs(1 + value) / (1 + np.abs(value)) - spread
    for i in np.flatnonzero(~(spread < 0.1)):
        root = roots[np.argmin(np.abs(roots - s[i]))]
        near = [np.abs(x - root) <= 64 * ROUNDING * abs(root) for x in (zeros, poles)]
        m = int(near[1].sum()) - int(near[0].sum())
        rest = abs(K[i] * gain * np.exp(-r.plant.theta * root))
        rest *= np.prod(np.abs(root - zeros[~near[0]])) / np.prod(np.abs(root - poles[~near[1]]))
        hidden = m == 0
        out[i] = 0.0 if hidden or rest ** (1 / m) <= 64 * ROUNDING * abs(root) else np.inf
    return out


@pytest.mark.parametrize("part", range(4))
def test_locus_points_solve_the_equation(part: int) -> None:
    """1 + K L0(s) = 0 at every point; as many branches as poles, and each another one."""
    for r in DRAWN[part::4]:
        L, locus = r.loop.locus_system, root_locus(r.loop.locus_system)
        zeros, poles, gain = r.roots
        K = np.broadcast_to(locus.gains, locus.branches.shape)
        there = np.isfinite(locus.branches) & (K > 0)
        assert residual(r, K[there], locus.branches[there]).max() <= EXACT, r
        assert locus.complete, r
        if r.plant.theta:
            (left, right), (_, top) = locus.view
            D, N = from_roots(poles), from_roots(zeros, gain)
            for i in np.linspace(1, locus.gains.size - 1, 5).astype(int):
                s = locus.branches[:, i]
                inside = (s.real > left) & (s.real < right) & (np.abs(s.imag) < top)
                k = locus.gains[i]
                box = count_in_box(D, lambda s, N=N, k=k: k * N(s), r.plant.theta, left, right, top)  # type: ignore[misc]
                assert box == np.count_nonzero(inside), (r, k)
            continue
        assert there.sum() == L.order * (locus.gains.size - 1), r
        assert locus.branches.shape[0] == len(poles), r
        # The coefficient of s^(n-1): were two branches on one pole, their sum would be off.
        leading = {0: 1 + locus.gains * gain}.get(len(poles) - len(zeros), 1.0)
        moved = {0: locus.gains * gain * sum(zeros), 1: -locus.gains * gain}.get(len(poles) - len(zeros), 0.0)
        gap = np.abs(locus.branches.sum(axis=0) - (sum(poles) + moved) / leading)
        # A sum that passes through zero keeps the rounding of its terms.
        scale = np.abs(locus.branches).sum(axis=0) + sum(np.abs(poles))
        assert (gap <= EXACT * scale).all(), r


def visible(r: RandomLoop) -> tuple[np.ndarray, np.ndarray]:
    """Zeros and poles of L0 less the pairs that cancel."""
    zeros, poles = list(r.roots[0]), list(r.roots[1])
    for z in r.roots[0]:
        if z in poles:
            zeros.remove(z)
            poles.remove(z)
    return np.array(zeros, dtype=complex), np.array(poles, dtype=complex)


def test_breakaways() -> None:
    """dL0/ds = 0 and 1 + K L0 = 0; on each piece of the real axis between two neighbours as many as there must be."""
    for r in LOOPS:
        zeros, poles = visible(r)
        breaks = breakaway_points(r.loop.locus_system)
        for b in breaks:
            terms = np.concatenate([1 / (b.s - zeros), -1 / (b.s - poles), [-r.plant.theta]])
            assert abs(terms.sum()) <= EXACT * np.abs(terms).sum(), (r, b)
            assert b.K > 0, (r, b)
            assert abs(1 + b.K * r.per_gain(np.array(b.s))) <= EXACT, (r, b)
        assert all(any(abs(b.s.conjugate() - c.s) <= EXACT * abs(b.s) for c in breaks) for b in breaks), r
        real = np.unique(np.concatenate([x[x.imag == 0].real for x in (zeros, poles)]))
        for left, right in pairwise(real):
            if right - left < 1e-6 * abs(left) or r.per_gain(np.array(0.5 * (left + right) + 0j)).real > 0:
                continue
            between = sum(b.s.imag == 0 and left < b.s.real < right for b in breaks)
            assert between % 2 == (np.isin([left, right], poles.real).sum() != 1), (r, left, right)


def test_axis_crossings_and_segments() -> None:
    for r in LOOPS:
        L = r.loop.locus_system
        for c in axis_crossings(L):
            assert abs(1 + c.K * r.per_gain(np.array(1j * c.omega))) <= EXACT, (r, c)
        segments = real_axis_segments(L)
        real = np.unique([x.real for x in [*r.roots[0], *r.roots[1]] if x.imag == 0])
        for left, right in pairwise(real):
            if right - left < 1e-6 * abs(left):
                continue
            at = 0.5 * (left + right)
            on = any((a is None or a < at) and (b is None or at < b) for a, b in segments)
            assert on == (r.per_gain(np.array(at + 0j)).real < 0), (r, at)


def test_departure_angles() -> None:
    """A step away from the pole in that direction L0 is negative real, up to the curvature of the branch."""
    for r in LOOPS:
        roots = np.array([*r.roots[0], *r.roots[1]])
        for a in departure_angles(r.loop.locus_system):
            others = np.abs(roots - a.s)
            step = 1e-6 * others[others > 1e-9].min(initial=1.0)
            value = r.per_gain(np.array(a.s + step * np.exp(1j * np.radians(a.angle_deg))))
            assert abs(np.angle(-value)) < 1e-4, (r, a)
