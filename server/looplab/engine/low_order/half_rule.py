"""Skogestad's half rule: half of the largest neglected lag goes to the dead time, half to the lag that is kept."""

from __future__ import annotations

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.low_order.models import Lags, ModelType, second_order, time_constants
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.transfer_function import TransferFunction

NAME = "half rule (Skogestad)"
SOURCE = "S. Skogestad, J. Process Control 13 (2003) 291-309, sec. 2"
# Ratios are compared with a little slack: time constants are inverses of poles.
_CLOSE = 1.6 * (1.0 - 1e-9)
_ROUNDS = 30


def _partner(T: float, lags: list[float]) -> float:
    """The lag that a lead T is matched with: the next larger one, unless a smaller one is close."""
    larger = min((tau for tau in lags if tau >= T), default=None)
    smaller = max((tau for tau in lags if tau < T), default=None)
    if larger is None:
        assert smaller is not None
        return smaller
    if smaller is not None and T / smaller < larger / T and T / smaller < _CLOSE:
        return smaller
    return larger


def _without_leads(data: Lags, theta: float) -> tuple[float, list[float]]:
    """Gain and lags that remain when each lead is matched with a lag, for an effective dead time (rules T1 to T3)."""
    K, lags = data.K, list(data.lags)
    for T in data.leads:
        tau = _partner(T, lags)
        lags.remove(tau)
        if tau <= T:
            if tau >= theta:
                K *= T / tau
            elif theta <= T:
                K *= T / theta
            continue
        if 5.0 * theta <= T:
            K *= T / tau
            continue
        tilde = min(tau, 5.0 * theta)
        K *= tilde / tau
        if tilde > T:
            lags.append(tilde - T)
    return K, sorted(lags, reverse=True)


def _halve(data: Lags, lags: list[float], kept: int) -> tuple[list[float], float]:
    main = lags[:kept]
    rest = lags[kept:]
    theta = data.theta + sum(data.inverse) + sum(rest[1:])
    if rest:
        # Of an integrator (nothing else kept) half a lag more is nothing.
        if main:
            main[-1] += 0.5 * rest[0]
        theta += 0.5 * rest[0]
    return main, theta


def effective_lags(data: Lags, kept: int) -> Lags:
    """What the half rule leaves of a plant: ``kept`` lags, the effective gain and dead time, no zeros.

    Parameters
    ----------
    data : Lags
    kept : int
        Lags of the model; 0 where an integrator is all that is kept.

    Returns
    -------
    Lags

    Raises
    ------
    RuleNotApplicable
        After the zeros are matched there are too few lags left.
    """
    theta = data.theta + sum(data.inverse)
    seen: list[float] = []
    for _ in range(_ROUNDS):
        K, lags = _without_leads(data, theta)
        if len(lags) < kept:
            raise RuleNotApplicable(
                f"after its zeros are matched the plant has {len(lags)} lags, fewer than the model", field="plant"
            )
        main, new = _halve(data, lags, kept)
        # Where the rules switch back and forth, the round with the larger dead time is the careful one.
        if abs(new - theta) <= 1e-12 * max(new, theta) or (new in seen and new >= theta):
            break
        seen.append(new)
        theta = new
    return Lags(K, tuple(main), (), (), new)


def half_rule(plant: TransferFunction, type: ModelType) -> FOPDT | SOPDT:
    r"""First- or second-order model with dead time by the half rule.

    .. math::

        \tau_1 = \tau_{10} + \tfrac12\tau_{20},\quad
        \theta = \theta_0 + \tfrac12\tau_{20} + \sum_{i\ge3}\tau_{i0} + \sum_j T_j^{inv}

    for the first order; for the second, tau_2 takes half of the third lag. Left half-plane zeros are first matched
    with a neighbouring lag (rules T1 to T3, which depend on the dead time that results: iterated).

    Parameters
    ----------
    plant : TransferFunction
        Stable, with real poles and zeros.
    type : {"FOPDT", "SOPDT"}

    Returns
    -------
    FOPDT or SOPDT

    Raises
    ------
    RuleNotApplicable
        A root is complex, the plant does not settle, or it has too few lags left.

    References
    ----------
    .. [1] S. Skogestad, J. Process Control 13 (2003) 291-309, sec. 2.
    """
    found = effective_lags(time_constants(plant), 1 if type == "FOPDT" else 2)
    if type == "FOPDT":
        return FOPDT(found.K, found.lags[0], found.theta)
    return second_order(found.K, found.lags[0], found.lags[1], found.theta)
