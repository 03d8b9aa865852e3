r"""Is a system with dead times stable? The argument principle on det H(s), exact with every dead time in it.

With n states and :math:`\delta(s) = \det(I - D_{22}\Delta)`, f(s) = det H(s)/(s + a)^n is analytic right of the
imaginary axis and f/delta tends to 1 far out. So the poles right of the axis are

.. math:: Z = -\frac{1}{\pi} \left[\arg \frac{f}{\delta}(j\omega)\right]_0^\infty

The phase is followed up to a frequency beyond which the loops have a gain below 1; from there it is known.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from looplab.engine.delays.poles import rightmost_poles
from looplab.engine.delays.resolvent import characteristic_phase, transfer_matrix
from looplab.engine.delays.structure import echo, in_loops
from looplab.engine.delays.system import DelaySystem
from looplab.engine.errors import NoConvergence
from looplab.engine.stability.closed_loop import AXIS_TOLERANCE, Verdict, verdict_from_poles
from looplab.engine.stability.notions import pole_text
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

MAX_POINTS = 120_000
MAX_ROUNDS = 40
LARGEST_TURN = 0.5
# The measured turn of a step and the one its end slopes promise may differ by this much.
SURPRISE = 0.1
GAIN = 0.95


def _inner(system: DelaySystem) -> DelaySystem:
    """From the delayed signals w to the signals z, without the delays between them."""
    k = system.tau.size
    return DelaySystem(system.A, system.B2, system.C2, system.D22, np.zeros(0)) if k else system


def _angles(matrix: ComplexArray) -> float:
    """Sum of the angles of the eigenvalues of I - matrix, each between -pi/2 and pi/2 for a radius below 1."""
    return float(np.angle(1.0 - np.linalg.eigvals(matrix)).sum())


def _last_frequency(system: DelaySystem, shift: float, above: float) -> tuple[float, bool]:
    """Beyond which frequency the loops through the delays have a gain below 1, and whether \\|D22\\| leaves room."""
    inner = _inner(system)
    k = system.tau.size
    size = max(float(np.abs(system.A).sum(axis=1).max(initial=0.0)), float((1.0 / system.tau).max()), shift)
    marks = np.abs(np.linalg.eigvals(system.A))
    low = 1e-3 * min(float(marks[marks > 0].min(initial=size)), float((1.0 / system.tau).min()))
    omega = np.geomspace(low, 1e4 * size, int(40 * np.log10(1e4 * size / low)) + 1)
    gain = transfer_matrix(inner, shift + 1j * omega)
    gain = np.where(np.isfinite(gain), gain, 1e300)
    simple = above < 0.9
    if simple:
        radius = np.abs(np.linalg.eigvals(np.abs(gain))).max(axis=1)
    else:
        # Jumps come back with hardly a loss: what counts is what the states add to them.
        rng = np.random.default_rng(1)
        phases = np.exp(1j * rng.uniform(0, 2 * np.pi, (400, 1, k)))
        worst = np.linalg.norm(np.linalg.inv(np.eye(k) - system.D22 * phases), 2, axis=(1, 2)).max()
        radius = 1.5 * worst * np.linalg.norm(gain - system.D22, 2, axis=(1, 2))
    loud = np.flatnonzero(radius >= GAIN)
    if loud.size and loud[-1] == omega.size - 1:
        raise NoConvergence("the gain around the dead times does not fall below 1", field="systems")
    last = float(omega[loud[-1] + 1]) if loud.size else float(omega[0])
    # Poles of the rational part beside the axis must lie below.
    eigenvalues = np.linalg.eigvals(system.A)
    beside = np.abs(eigenvalues[np.abs(eigenvalues.real) < 0.1 * np.abs(eigenvalues)])
    return max(last, 1.1 * float(beside.max(initial=0.0))), simple


def _grid(system: DelaySystem, last: float, poles: ComplexArray) -> FloatArray:
    marks = np.abs(np.linalg.eigvals(system.A))
    low = 1e-2 * min(float(marks[marks > 1e-12].min(initial=last)), last)
    points = [np.zeros(1), np.geomspace(low, last, int(30 * np.log10(last / low)) + 2)]
    step = np.pi / (6.0 * system.tau.sum())
    if last / step > MAX_POINTS / 2:
        raise NoConvergence(
            f"the dead times turn the phase more than {MAX_POINTS // 24} times before the loops' gain falls below 1",
            field="systems",
            hint="lower the gain",
        )
    points.append(np.arange(0.0, last, step))
    near = poles[np.abs(poles.real) < 0.3 * np.abs(poles)]
    spread = np.array([-4, -2, -1, -0.5, 0, 0.5, 1, 2, 4])
    points.append((near.imag[:, None] + np.abs(near.real)[:, None] * spread).ravel())
    grid = np.unique(np.concatenate(points))
    return grid[(grid >= 0) & (grid <= last)]


def count_right_of(system: DelaySystem, shift: float = 0.0) -> int | None:
    r"""Poles right of a vertical line, dead times exact.

    .. math:: Z = -\frac{1}{\pi} \left[\arg \frac{\det H(s)}{(s+a)^n \delta(s)}\right]_{s = c}^{c + j\infty}

    Parameters
    ----------
    system : DelaySystem
        Jumps that come back through delays alone must die out (``echo`` below 1).
    shift : float
        c, >= 0: where the line stands [rad/time].

    Returns
    -------
    int or None
        None where a pole lies on the line, as near as the phase can be followed.

    Raises
    ------
    NoConvergence
        The dead times turn the phase too often before the gain of the loops falls below 1.

    References
    ----------
    .. [1] G. Stepan, Retarded Dynamical Systems, Longman 1989, ch. 2 (the argument principle for delayed systems).
    """
    system = system.balanced
    n, k = system.order, system.tau.size
    last, simple = _last_frequency(system, shift, echo(system)[1])
    omega = _grid(system, last, rightmost_poles(system).poles)
    a = last

    def follow(w: FloatArray) -> tuple[ComplexArray, FloatArray]:
        s = (shift + 1j * w).astype(complex)
        sign, slope = characteristic_phase(system, s)
        return sign * np.exp(-1j * n * np.angle(s + a)), (1j * (slope - n / (s + a))).imag

    value, rate = follow(omega)
    for _ in range(MAX_ROUNDS):
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = np.angle(value[1:] / value[:-1])
            promised = 0.5 * (rate[1:] + rate[:-1]) * np.diff(omega)
        coarse = np.flatnonzero(~((np.abs(turn) < LARGEST_TURN) & (np.abs(turn - promised) < SURPRISE)))
        if not coarse.size:
            break
        if omega.size + coarse.size > MAX_POINTS or (value == 0).any():
            return None
        middle = 0.5 * (omega[coarse] + omega[coarse + 1])
        more, slopes = follow(middle)
        omega = np.insert(omega, coarse + 1, middle)
        value, rate = np.insert(value, coarse + 1, more), np.insert(rate, coarse + 1, slopes)
    else:
        return None
    total = float(turn.sum())
    # From here to infinity: (s - p)/(s + a) for each pole p of the rational part, and loops with a gain below 1.
    s = shift + 1j * last
    ends = np.append(np.linalg.eigvals(system.A), np.full(n, -a)) if n else np.zeros(0)
    weights = np.append(np.ones(n), -np.ones(n))
    total -= float((weights * np.angle((s - ends) / 1j)).sum())
    delta = np.exp(-s * system.tau)
    gain = transfer_matrix(_inner(system), np.array([s]))[0]
    if simple:
        total -= _angles(gain * delta)
    else:
        jumps = np.eye(k) - system.D22 * delta
        total -= _angles(system.D22 * delta) + _angles(np.linalg.solve(jumps, (gain - system.D22) * delta))
    count = -total / np.pi
    if abs(count - round(count)) > 0.05:
        return None
    return round(count)


def _axis_poles(system: DelaySystem) -> ComplexArray:
    poles = rightmost_poles(system).poles
    size = np.maximum(np.abs(poles), 1e-6 * np.abs(poles).max(initial=0.0))
    return poles[np.abs(poles.real) <= AXIS_TOLERANCE * size]


@lru_cache(maxsize=64)
def delay_verdict(system: DelaySystem) -> Verdict:
    """Stable, marginal or unstable, and why: of the system itself, every mode counted, hidden ones too.

    Parameters
    ----------
    system : DelaySystem

    Returns
    -------
    Verdict
        ``closed_loop_stable`` is that of the system. ``rhp_poles`` is None where they are infinitely many: where a jump
        that passes delays alone comes back as large as it was, or larger (a neutral system past its limit).

    Raises
    ------
    NoConvergence
        The dead times turn the phase too often before the gain of the loops falls below 1.
    """
    system = system.balanced
    if not in_loops(system).any():
        return verdict_from_poles(rightmost_poles(system).poles, "pole", "system")
    below, _ = echo(system)
    if below >= 1.0 - 1e-9:
        where = "right of the imaginary axis" if below > 1.0 + 1e-9 else "at the imaginary axis"
        return Verdict(
            "unstable",
            False,
            f"a jump that goes around the dead times comes back {below:.4g} times as large, for dead times as near to "
            f"these as you like: a chain of infinitely many poles lies {where}",
            None,
        )
    found = rightmost_poles(system).poles
    rightmost = f" The rightmost pole is at {pole_text(complex(found[0]))}." if found.size else ""
    on_axis = _axis_poles(system)
    if on_axis.size:
        return _on_the_axis(system, on_axis, rightmost)
    count = count_right_of(system)
    if count is None:
        raise NoConvergence("a pole lies too near to the imaginary axis to tell its side", field="systems")
    if count:
        many = f"{count} poles lie" if count > 1 else "a pole lies"
        because = f"{many} in the right half-plane (argument principle on det H).{rightmost}"
        return Verdict("unstable", False, because, count)
    because = f"no pole lies in the right half-plane (argument principle on det H).{rightmost}"
    return Verdict("stable", True, because, 0)


def _on_the_axis(system: DelaySystem, on_axis: ComplexArray, rightmost: str) -> Verdict:
    """Poles on the imaginary axis: how many lie right of it, and whether one of these is repeated."""
    scale = max(float(np.abs(on_axis).max()), 1e-3 / float(system.tau.max()))
    count = count_right_of(system, 1e-6 * scale)
    if count is None or count:
        many = "poles lie" if count is None or count > 1 else "a pole lies"
        return Verdict("unstable", False, f"{many} in the right half-plane.{rightmost}", count)
    for p in on_axis:
        # Around a pole of multiplicity m the logarithmic derivative of det H is m/(s - p).
        circle = p + 1e-4 * scale * np.exp(2j * np.pi * np.arange(16) / 16)
        _, slope = characteristic_phase(system, circle.astype(complex))
        if round(float(np.mean(slope * (circle - p)).real)) > 1:
            return Verdict("unstable", False, "a repeated pole lies on the imaginary axis", 0)
    p = complex(on_axis[np.argmax(on_axis.imag)])
    at = "at the origin" if abs(p) <= 1e-9 * scale else f"on the imaginary axis at ±{abs(p.imag):.3g}j"
    return Verdict("marginal", False, f"a pole lies {at}, none in the right half-plane", 0)
