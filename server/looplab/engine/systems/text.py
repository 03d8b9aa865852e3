"""Text -> TransferFunction: ``(s+3)/(s^2 (s+2)) exp(-0.1 s)``, kept in the factors it was written in."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from looplab.engine.errors import EngineError, ParseError
from looplab.engine.systems.polynomial import roots, trim
from looplab.engine.systems.syntax import Node, parse_syntax, syntax_to_latex
from looplab.engine.systems.transfer_function import MAX_ORDER, TransferFunction

Polynomial = tuple[float, ...]


@dataclass(frozen=True)
class _Rational:
    """k * prod(num) / prod(den) * exp(-theta s), with polynomial factors left unexpanded."""

    k: float = 1.0
    num: Counter[Polynomial] = field(default_factory=Counter)
    den: Counter[Polynomial] = field(default_factory=Counter)
    theta: float = 0.0

    def degree(self) -> int:
        return max(sum((len(p) - 1) * n for p, n in side.items()) for side in (self.num, self.den))

    def times(self, other: _Rational) -> _Rational:
        return _Rational(self.k * other.k, self.num + other.num, self.den + other.den, self.theta + other.theta)

    def inverse(self) -> _Rational:
        return _Rational(1.0 / self.k, self.den, self.num, -self.theta)

    def power(self, n: int) -> _Rational:
        if n < 0:
            return self.inverse().power(-n)
        raised = [Counter({p: m * n for p, m in side.items()}) for side in (self.num, self.den)]
        return _Rational(self.k**n, raised[0], raised[1], self.theta * n)

    @property
    def constant(self) -> float | None:
        return self.k if not self.num and not self.den and self.theta == 0.0 else None


def _expand(factors: Counter[Polynomial]) -> np.ndarray:
    out = np.ones(1)
    for polynomial, times in factors.items():
        for _ in range(times):
            out = np.convolve(out, polynomial)
    return out


def _from_polynomial(coefficients: np.ndarray, column: int) -> _Rational:
    c = trim(coefficients)
    with np.errstate(over="ignore", invalid="ignore"):
        monic = c / c[0] if c[0] else c
    if not np.isfinite(monic).all():
        raise ParseError("the numbers of this sum are too far apart", column=column)
    if c.size == 1:
        return _Rational(float(c[0]))
    return _Rational(float(c[0]), Counter({tuple(float(v) for v in monic): 1}))


def _add(left: _Rational, right: _Rational, sign: float, column: int) -> _Rational:
    if left.k == 0.0:
        return _Rational(sign * right.k, right.num, right.den, right.theta)
    if right.k == 0.0:
        return left
    if left.theta != right.theta:
        raise ParseError(
            "terms with different dead times cannot be added here",
            column=column,
            hint="one dead time for the whole expression: (s+1)/(s^2+s+1) exp(-0.1 s)",
        )
    common_den = left.den & right.den
    top_left = _expand(left.num + (right.den - common_den)) * left.k
    top_right = _expand(right.num + (left.den - common_den)) * (sign * right.k)
    total = np.polyadd(top_left, top_right)
    # An exact cancellation leaves rounding noise in the leading coefficients.
    noise = 4e-16 * np.polyadd(np.abs(top_left), np.abs(top_right))
    total = np.where(np.abs(total) <= noise, 0.0, total)
    top = _from_polynomial(total, column)
    if top.k == 0.0:
        return top
    return _Rational(top.k, top.num, left.den | right.den, left.theta)


def _integer(node: Node, value: _Rational) -> int:
    constant = value.constant
    if constant is None or constant != round(constant):
        raise ParseError("a power must be a whole number", column=node.column, hint="for dead time write exp(-0.1 s)")
    if abs(constant) > MAX_ORDER:
        raise ParseError(f"the power is larger than {MAX_ORDER}", column=node.column)
    return int(constant)


def _exponential(node: Node, argument: _Rational) -> _Rational:
    c = argument.k * _expand(argument.num)
    if argument.den or argument.theta or c.size > 2:
        raise ParseError("the argument of exp must be a multiple of s", column=node.column, hint="write exp(-0.1 s)")
    slope, constant = (c[0], c[1]) if c.size == 2 else (0.0, c[0])
    if slope > 0:
        raise ParseError(
            "exp with a positive multiple of s is a prediction, not a dead time",
            column=node.column,
            hint=f"did you mean exp(-{slope:g} s)?",
        )
    try:
        factor = math.exp(constant)
    except OverflowError:
        raise ParseError("this number is too large", column=node.column) from None
    return _Rational(factor, theta=-slope)


def _evaluate(node: Node) -> _Rational:
    kids = [_evaluate(kid) for kid in node.children]
    match node.kind:
        case "number":
            return _Rational(node.value)
        case "s":
            return _Rational(1.0, Counter({(1.0, 0.0): 1}))
        case "group":
            return kids[0]
        case "neg":
            out = kids[0].times(_Rational(-1.0))
        case "exp":
            out = _exponential(node, kids[0])
        case "+" | "-":
            out = _add(kids[0], kids[1], 1.0 if node.kind == "+" else -1.0, node.column)
        case "*":
            out = kids[0].times(kids[1])
        case "/":
            if kids[1].k == 0.0:
                raise ParseError("division by zero", column=node.children[1].column)
            out = kids[0].times(kids[1].inverse())
        case _:
            n = _integer(node.children[1], kids[1])
            if n < 0 and kids[0].k == 0.0:
                raise ParseError("division by zero", column=node.column)
            if abs(n) * kids[0].degree() > MAX_ORDER:
                raise ParseError(f"the order exceeds the limit of {MAX_ORDER}", column=node.column)
            try:
                out = kids[0].power(n)
            except OverflowError:
                raise ParseError("this number is too large", column=node.column) from None
    if not math.isfinite(out.k):
        raise ParseError("this number is too large", column=node.column)
    if out.degree() > 2 * MAX_ORDER:
        raise ParseError(f"the order exceeds the limit of {MAX_ORDER}", column=node.column)
    return out


def _roots(factors: Counter[Polynomial]) -> np.ndarray:
    parts = [np.tile(roots(np.array(p)), n) for p, n in factors.items()]
    return np.concatenate(parts) if parts else np.zeros(0, dtype=complex)


@lru_cache(maxsize=1024)
def parse_transfer_function(text: str) -> TransferFunction:
    r"""Read a transfer function from text.

    Accepted are numbers, ``s``, ``+ - * / ^``, brackets, implied products, ``exp(-theta s)``, ``e^(-theta s)``; for
    example ``(s+3)/(s^2*(s+2)) exp(-0.1 s)`` or ``1/(s+1)^3``. Factors stay factors: (s+1)^10 has ten exact poles.
    Only a written-out sum such as s^3+3s^2+3s+1 is rooted numerically.

    Parameters
    ----------
    text : str
        At most 500 characters.

    Returns
    -------
    TransferFunction
        Zeros and poles [rad/time], gain and dead time [time]. It may be improper (PD controllers are typed too);
        whoever simulates it checks.

    Raises
    ------
    ParseError
        The text cannot be read; the message has the column, ``hint`` a way out.
    """
    value = _evaluate(parse_syntax(text))
    if value.theta < 0:
        raise ParseError(
            "dividing by a dead time predicts the future", column=1, hint="multiply by exp(-theta s) instead"
        )
    if value.degree() > MAX_ORDER:
        raise ParseError(f"the order exceeds the limit of {MAX_ORDER}", column=1)
    try:
        return TransferFunction(_roots(value.num), _roots(value.den), value.k, value.theta)
    except EngineError as error:
        raise ParseError(error.message, column=1, hint=error.hint) from None


@lru_cache(maxsize=1024)
def expression_latex(text: str) -> str:
    """LaTeX of a transfer function the way its author typed it. Raises ParseError as the parser does."""
    return syntax_to_latex(parse_syntax(text))
