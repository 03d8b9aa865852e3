"""Settings for several loops: each by a rule for its own entry, and all of them detuned together (BLT)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import log

import numpy as np

from looplab.engine.errors import EngineError, RuleNotApplicable
from looplab.engine.loop import PID
from looplab.engine.mimo.loops import MultiLoop
from looplab.engine.mimo.process import ProcessMatrix
from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.engine.tuning import RULES, KnownPlant, Options, TypeName, ultimate_point

LARGEST_FACTOR, SMALLEST_FACTOR = 1000.0, 0.2
GRID = 1200


@dataclass(frozen=True)
class LoopSettings:
    """Settings of one loop, None with the reason where the rule does not apply to its entry."""

    controller: PID | None
    reason: str | None


@dataclass(frozen=True)
class BLTSettings:
    """Settings of all loops by the biggest log modulus.

    Attributes
    ----------
    controllers : tuple of PID
    factor : float
        F: gains are those of Ziegler-Nichols over F, integral times F times theirs [-].
    log_modulus_dB, omega : float
        Its peak, and where [dB, rad/time].
    """

    controllers: tuple[PID, ...]
    factor: float
    log_modulus_dB: float
    omega: float


def tune_alone(process: ProcessMatrix, rule: str, type: TypeName, options: Options) -> tuple[LoopSettings, ...]:
    """Each loop by a rule for its own entry, as if the others were in manual.

    Parameters
    ----------
    process : ProcessMatrix
        With the loops on the diagonal (``paired``).
    rule : str
        Of ``looplab.engine.tuning.RULES``.
    type : {"P", "PI", "PD", "PID"}
    options : Options

    Returns
    -------
    tuple of LoopSettings
    """
    found = []
    for i in range(process.size):
        try:
            settings = KnownPlant.of(process.entries[i][i]).tune(RULES[rule], type, options)
        except EngineError as error:
            found.append(LoopSettings(None, error.message))
        else:
            found.append(LoopSettings(PID(settings.Kc, settings.tau_I, settings.tau_D or None, settings.alpha), None))
    return tuple(found)


def _log_modulus(G: ComplexArray, C: ComplexArray) -> FloatArray:
    r"""20 log \|W/(1 + W)\| with W = det(I + G C) - 1, shape (N,)."""
    whole = np.linalg.det(np.eye(G.shape[-1]) + G * C[:, None, :])
    with np.errstate(divide="ignore"):
        return np.asarray(20.0 * np.log10(np.abs((whole - 1.0) / whole)))


def blt(process: ProcessMatrix) -> BLTSettings:
    r"""PI settings of several loops by the biggest log modulus.

    .. math::

        K_{c,i} = \frac{K_{u,i}}{2.2\, F}, \quad \tau_{I,i} = \frac{F P_{u,i}}{1.2}, \quad
        \max_\omega 20 \log_{10} \left|\frac{W}{1 + W}\right| = 2n, \quad W = \det(I + G C) - 1

    Parameters
    ----------
    process : ProcessMatrix
        Of stable entries, n by n, with the loops on the diagonal (``paired``).

    Returns
    -------
    BLTSettings

    Raises
    ------
    RuleNotApplicable
        An entry is not stable, a loop has no ultimate gain, or the loops are unstable by their pairing.

    References
    ----------
    .. [1] W. L. Luyben, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 654-660.
    """
    if not process.all_stable:
        raise RuleNotApplicable("BLT tuning is for processes whose entries are stable", field="plant")
    points = []
    for i in range(process.size):
        try:
            points.append(ultimate_point(process.entries[i][i]))
        except RuleNotApplicable as error:
            raise RuleNotApplicable(f"loop {i + 1}: {error.message}", field="plant", hint=error.hint) from None
    Ku = np.array([point.Ku for point in points])
    Pu = np.array([point.Pu for point in points])
    fastest = max(point.omega_180 for point in points)
    omega = np.geomspace(1e-4 * fastest, 10.0 * fastest, GRID)
    G = process.response(omega)

    def controllers(factor: float, at: FloatArray) -> ComplexArray:
        return np.asarray(Ku / (2.2 * factor) * (1.0 + 1.0 / (1j * at[:, None] * factor * Pu / 1.2)))

    def peak(factor: float) -> tuple[float, float]:
        size = _log_modulus(G, controllers(factor, omega))
        best = int(np.argmax(size))
        fine = np.geomspace(omega[max(best - 1, 0)], omega[min(best + 1, GRID - 1)], 60)
        finer = _log_modulus(process.response(fine), controllers(factor, fine))
        at = int(np.argmax(finer))
        return float(finer[at]), float(fine[at])

    goal = 2.0 * process.size

    def excess(x: float) -> float:
        return peak(float(np.exp(x)))[0] - goal

    # From far detuned towards tight: the first crossing is that of the calmest loops.
    steps = np.linspace(log(LARGEST_FACTOR), log(SMALLEST_FACTOR), 90)
    crossing = next((pair for pair in pairwise(steps.tolist()) if excess(pair[0]) <= 0 < excess(pair[1])), None)
    if crossing is None:
        raise RuleNotApplicable(
            f"the log modulus does not pass {goal:g} dB for any factor from {SMALLEST_FACTOR:g} to {LARGEST_FACTOR:g}",
            field="plant",
        )
    from scipy.optimize import brentq  # late: a server that does not need it is 26 MB smaller

    factor = float(np.exp(brentq(excess, *crossing, xtol=1e-10)))
    size, where = peak(factor)
    settings = tuple(PID(float(k / (2.2 * factor)), float(p * factor / 1.2)) for k, p in zip(Ku, Pu, strict=True))
    order = tuple(range(process.size))
    if not MultiLoop(process, order, settings, (True,) * process.size).verdict.closed_loop_stable:
        raise RuleNotApplicable(
            "with this pairing the loops are unstable however far they are detuned",
            field="pairing",
            hint="choose one with positive relative gains and a positive Niederlinski index",
        )
    return BLTSettings(settings, factor, size, where)
