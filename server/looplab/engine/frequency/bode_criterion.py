"""Bode's stability criterion with its conditions, and Nyquist's verdict beside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.frequency.crossings import OFTEN, crossings
from looplab.engine.frequency.indentation import indentation_arcs
from looplab.engine.frequency.nyquist import nyquist_count, right_half_plane
from looplab.engine.frequency.response import AXIS_GAP, phase_rad
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

# |ln GM| below which L passes through -1.
ON_THE_LIMIT = 1e-9


@dataclass(frozen=True)
class BodeCriterion:
    """Two verdicts on one loop.

    Attributes
    ----------
    stable : bool or None
        What Bode's criterion says when it is applied without a look at its conditions; None on the limit itself, or
        where the crossovers could not be listed.
    applies : bool
        The conditions are met, so that this verdict is a proof.
    unmet : tuple of str
        The conditions that are not met, each in words.
    omega_180 : float or None
        The phase crossover that decided, the one with the largest \\|L\\| [rad/time]; None where there is none.
    magnitude : float or None
        \\|L\\| there [-].
    nyquist_stable : bool or None
        Nyquist's verdict, Z = 0; None on the limit: the curve passes through -1, or a mode that it does not know of
        lies on the imaginary axis.
    agrees : bool or None
        Both say the same; None where one of them says nothing.
    """

    stable: bool | None
    applies: bool
    unmet: tuple[str, ...]
    omega_180: float | None
    magnitude: float | None
    nyquist_stable: bool | None
    agrees: bool | None


def _times(n: int, one: str, many: str) -> str:
    return one if n == 1 else f"{n} {many}"


def _unmet(L: TransferFunction) -> list[str]:
    found = crossings(L)
    out = []
    if P := right_half_plane(L.poles):
        out.append(f"L has {_times(P, 'one pole', 'poles')} in the right half-plane")
    for arc in indentation_arcs(L):
        if arc.omega > 0:
            out.append(f"L has poles on the imaginary axis, at +-{arc.omega:.4g}i")
        elif arc.multiplicity > 1:
            out.append(f"L has {arc.multiplicity} poles at the origin")
    if L.gain and L.origin_gain < 0:
        out.append("the feedback is positive at low frequencies: the phase starts half a turn lower")
    if L.gain and L.relative_degree == 0 and (L.order or L.theta):
        out.append("L is not strictly proper: |L| does not fade at high frequencies")
    if _undamped_hidden_mode(L):
        out.append("a mode that the loop does not reach lies on the imaginary axis: it does not decay")
    # On which turn each crossing lies: -180 deg is 0, -540 deg is -1.
    turn = np.round((phase_rad(L, found.phase_omega) + np.pi) / (2 * np.pi))
    here = int(np.count_nonzero(turn >= 0))
    if here > 1:
        out.append(f"there are {here} phase crossovers")
    if found.gain_omega.size > 1:
        out.append(f"there are {found.gain_omega.size} gain crossovers")
    return out


def _undamped_hidden_mode(L: TransferFunction) -> bool:
    """Whether a cancelled mode, or any where L is zero, lies on the imaginary axis."""
    hidden = split_hidden_modes(L)[1] if L.gain else L.poles
    return any(abs(p.real) <= AXIS_GAP * abs(p) for p in hidden.tolist())


def bode_criterion(L: TransferFunction) -> BodeCriterion:
    r"""Verdict by Bode's criterion: the loop is stable if the amplitude ratio is below 1 where the phase is -180 deg.

    .. math:: |L(j\omega_{180})| < 1, \quad \arg L(j\omega_{180}) = -180^\circ

    It is a proof for an L that is strictly proper, has no pole in the right half-plane or on the imaginary axis but
    a single one at the origin, a positive gain at low frequencies, one phase crossover and one gain crossover (or
    none). Further crossovers that dead time makes on later turns (-540 deg ...) do not count: \|L\| is smaller there.

    Parameters
    ----------
    L : TransferFunction
        Proper open loop under unit negative feedback, dead time exact.

    Returns
    -------
    BodeCriterion

    References
    ----------
    .. [1] D. E. Seborg et al., Process Dynamics and Control, 3rd ed., Wiley 2011, ch. 14.
    .. [2] J. Hahn, T. Edison, T. F. Edgar, A note on stability analysis using Bode plots, Chemical Engineering
       Education 35 (2001) 208-211.
    """
    found, count = crossings(L), nyquist_count(L)
    nyquist: bool | None = count.Z == 0
    if count.through_minus_one or (nyquist and _undamped_hidden_mode(L)):
        nyquist = None
    if found.overrun:
        return BodeCriterion(None, False, (f"the phase crosses -180 deg {OFTEN}",), None, None, nyquist, None)
    listed = np.isfinite(found.phase_log_magnitude)
    places = list(zip(found.phase_omega[listed], found.phase_log_magnitude[listed], strict=True))
    if L.origin_order == 0 and L.origin_gain < 0:
        places.insert(0, (0.0, np.log(-L.origin_gain)))
    omega_180 = magnitude = None
    stable: bool | None = True
    if places:
        where, log_magnitude = max(places, key=lambda place: place[1])
        omega_180, magnitude = float(where), float(np.exp(log_magnitude))
        stable = None if abs(log_magnitude) < ON_THE_LIMIT else bool(log_magnitude < 0)
    unmet = tuple(_unmet(L))
    agrees = None if stable is None or nyquist is None else stable == nyquist
    return BodeCriterion(stable, not unmet, unmet, omega_180, magnitude, nyquist, agrees)
