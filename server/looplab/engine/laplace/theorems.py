"""Initial- and final-value theorems, with their conditions checked."""

from __future__ import annotations

import math
from dataclasses import dataclass

from looplab.engine.laplace.partial_fractions import PartialFractions


@dataclass(frozen=True)
class LimitValue:
    """A limit of y(t), or None with the reason; ``formula`` is what the limit of s Y(s) gives all the same.

    ``formula`` is None where s Y(s) has no finite limit.
    """

    value: float | None
    reason: str | None
    formula: float | None


def _at_origin(fractions: PartialFractions) -> float | None:
    """Limit of s Y(s) for s to 0."""
    powers = {term.power: term.coefficient.real for term in fractions.terms if term.pole == 0}
    return None if any(power > 1 for power in powers) else powers.get(1, 0.0)


def initial_value(fractions: PartialFractions) -> LimitValue:
    r"""Initial-value theorem.

    .. math:: y(0^+) = \lim_{s \to \infty} s\,Y(s)

    Parameters
    ----------
    fractions : PartialFractions
        Of Y(s).

    Returns
    -------
    LimitValue
        None where Y is not strictly proper: y then has an impulse at t = 0. With dead time the value is 0.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, appendix A.
    """
    if fractions.theta:
        return LimitValue(0.0, None, 0.0)
    if fractions.direct:
        reason = "no initial value: Y(s) is not strictly proper, so y(t) has an impulse at t = 0"
        return LimitValue(None, reason, None)
    value = math.fsum(term.coefficient.real for term in fractions.terms if term.power == 1)
    size = math.fsum(abs(term.coefficient) for term in fractions.terms if term.power == 1)
    # The coefficients of a function that starts at 0 add up to 0 but for rounding.
    value = 0.0 if abs(value) <= max(1e-13, 10.0 * fractions.residual) * size else value
    return LimitValue(value, None, value)


def _pole(p: complex) -> str:
    if p.imag == 0:
        return f"{p.real:+.3g}" if p.real else "0"
    imaginary = "j" if abs(p.imag) == 1 else f"{abs(p.imag):.3g}j"
    return f"{p.real:.3g} ± {imaginary}" if p.real else f"±{imaginary}"


def final_value(fractions: PartialFractions) -> LimitValue:
    r"""Final-value theorem.

    .. math:: \lim_{t \to \infty} y(t) = \lim_{s \to 0} s\,Y(s)
        \quad\text{if every pole of } s\,Y(s) \text{ has a negative real part}

    Parameters
    ----------
    fractions : PartialFractions
        Of Y(s); poles that a zero hides do not count.

    Returns
    -------
    LimitValue
        None with the offending pole in the reason; ``formula`` then shows what the theorem used blindly would claim.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, appendix A.
    """
    formula = _at_origin(fractions)
    blocking = [
        t for t in fractions.terms if t.pole.imag >= 0 and t.pole.real >= 0 and not (t.pole == 0 and t.power == 1)
    ]
    if not blocking:
        return LimitValue(formula, None, formula)
    worst = max(blocking, key=lambda term: (term.pole.real, term.power))
    where, times = _pole(worst.pole), worst.power
    if worst.pole.real > 0:
        reason = f"no final value: pole at {where}, in the right half-plane: y(t) grows without bound"
    elif worst.pole == 0:
        how = "" if times == 2 else f"^{times - 1}"
        reason = f"no final value: pole of order {times} at 0: y(t) grows like t{how}"
    elif times > 1:
        reason = f"no final value: repeated pole at {where}: y(t) oscillates and grows"
    else:
        reason = f"no final value: pole at {where}: y(t) oscillates for ever"
    return LimitValue(None, reason, formula)
