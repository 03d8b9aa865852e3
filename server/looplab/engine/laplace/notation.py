"""Time functions and partial fractions as text and as LaTeX."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from looplab.engine.laplace.inverse import ExponentialSum, Mode
from looplab.engine.laplace.partial_fractions import PartialFractions
from looplab.engine.systems.notation import latex_number, number
from looplab.engine.systems.polynomial import FloatArray

# A part this much smaller than its partners, each at its own largest, is left out of the writing (not of the values).
_INVISIBLE = 1e-12


@dataclass(frozen=True)
class Style:
    """How one language writes products, brackets, powers, fractions and functions."""

    number: Callable[[float, int], str]
    space: str
    left: str
    right: str
    power: Callable[[str, int], str]
    exp: Callable[[str], str]
    cos: str
    sin: str
    fraction: Callable[[str, str], str]
    delta: str


TEXT = Style(
    number=number, space=" ", left="(", right=")",
    power=lambda base, k: base if k == 1 else f"{base}^{k}",
    exp=lambda argument: f"e^({argument})", cos="cos", sin="sin",
    fraction=lambda top, bottom: f"{top}/{bottom}", delta="delta",
)  # fmt: skip
LATEX = Style(
    number=latex_number, space=r"\,", left=r"\left(", right=r"\right)",
    power=lambda base, k: base if k == 1 else f"{base}^{{{k}}}",
    exp=lambda argument: f"e^{{{argument}}}", cos=r"\cos", sin=r"\sin",
    fraction=lambda top, bottom: rf"\frac{{{top}}}{{{bottom}}}", delta=r"\delta",
)  # fmt: skip

Addend = tuple[float, str]


def _scaled(c: float, body: str, style: Style, digits: int) -> str:
    size = style.number(abs(c), digits)
    if not body:
        return size
    return body if size == "1" else f"{size}{style.space}{body}"


def _sum(addends: list[Addend], style: Style, digits: int) -> str:
    text = ""
    for c, body in addends:
        sign = ("-" if c < 0 else "") if not text else (" - " if c < 0 else " + ")
        text += sign + _scaled(c, body, style, digits)
    return text or "0"


def _argument(rate: float, t: str, style: Style, digits: int) -> str:
    """rate t without a factor 1."""
    return ("-" if rate < 0 else "") + _scaled(rate, t, style, digits)


def _addends(mode: Mode, t: str, style: Style, digits: int) -> list[Addend]:
    """t^k cos(bt) and t^k sin(bt) with their factors; the exponential is left to the caller."""
    out: list[Addend] = []
    rate = abs(mode.pole) or 1.0

    def size(k: int, factor: float) -> float:
        # ln of the fraction behind t^k: k! grows faster than any t^k falls, and large powers count late.
        return math.log(abs(factor)) + math.lgamma(k + 1.0) - k * math.log(rate) if factor else -math.inf

    visible = math.log(_INVISIBLE) + max((size(k, abs(c)) for k, c in enumerate(mode.coefficients)), default=0.0)
    angle = _argument(mode.pole.imag, t, style, digits)
    if angle.startswith(style.left) and angle.endswith(style.right):
        angle = angle[len(style.left) : -len(style.right)]
    for k, c in enumerate(mode.coefficients):
        powers = style.power(t, k) if k else ""
        waves = [(c.real, style.cos), (-c.imag, style.sin)] if mode.pole.imag else [(c.real, "")]
        for factor, wave in waves:
            if size(k, factor) > visible:
                called = f"{wave}{style.left}{angle}{style.right}" if wave else ""
                out.append((factor, " ".join(part for part in (powers, called) if part)))
    return out


def _mode(mode: Mode, t: str, style: Style, digits: int) -> list[Addend]:
    inner = _addends(mode, t, style, digits)
    if not mode.pole.real:
        return inner
    exp = style.exp(_argument(mode.pole.real, t, style, digits))
    if len(inner) == 1:
        c, body = inner[0]
        # t e^(-t), but e^(-t) cos(2 t), as one writes them.
        parts = [body, exp] if not mode.pole.imag else [exp, body]
        return [(c, " ".join(part for part in parts if part))]
    if not inner:
        return []
    sign = -1.0 if inner[0][0] < 0 else 1.0
    bracket = _sum([(sign * c, body) for c, body in inner], style, digits)
    return [(sign, f"{exp} {style.left}{bracket}{style.right}")]


def time_function(y: ExponentialSum, style: Style, digits: int) -> str:
    """y(t) in one line; after a dead time t becomes (t - theta) and the whole is multiplied by 1(t - theta)."""
    delay = style.number(y.theta, digits)
    t = f"{style.left}t - {delay}{style.right}" if y.theta else "t"
    addends = [addend for mode in y.modes for addend in _mode(mode, t, style, digits)]
    body = _sum(addends, style, digits)
    bare = f"(t - {delay})" if y.theta else "(t)"
    if y.theta and addends:
        single = len(addends) == 1 and addends[0][0] > 0
        step = f"1{bare}"
        if addends == [(1.0, "")]:
            body = step
        else:
            body = f"{body}{style.space}{step}" if single else f"{style.left}{body}{style.right}{style.space}{step}"
    if y.impulse:
        pulse = _sum([(y.impulse, style.delta + bare)], style, digits)
        if not addends:
            return pulse
        body = f"{pulse} - {body[1:]}" if body.startswith("-") else f"{pulse} + {body}"
    return body


def _factor(root: complex, style: Style, digits: int) -> str:
    """(s - root), or the real quadratic of a pair, in brackets unless it is s alone."""
    if root.imag:
        addends = [(1.0, style.power("s", 2))]
        if abs(root.real) > _INVISIBLE * abs(root):
            addends.append((-2.0 * root.real, "s"))
        return f"{style.left}{_sum([*addends, (abs(root) ** 2, '')], style, digits)}{style.right}"
    return "s" if root == 0 else f"{style.left}{_sum([(1.0, 's'), (-root.real, '')], style, digits)}{style.right}"


def _bottom(pole: complex, power: int, style: Style, digits: int) -> str:
    factor = _factor(pole, style, digits)
    if power == 1 and style is LATEX and factor.startswith(style.left):
        return factor[len(style.left) : -len(style.right)]
    return style.power(factor, power)


def _pair_numerators(pole: complex, terms: list[tuple[int, complex]]) -> list[tuple[int, FloatArray]]:
    """(power, [B, C]) of (B s + C)/(quadratic)^power for a pair of poles, from the fractions of the upper one.

    The common numerator is written in powers of w^2 + 1, with w = (s - Re(pole))/Im(pole).
    """
    a, b = pole.real, pole.imag
    m = max(power for power, _ in terms)
    quadratic, upper, lower = np.array([1.0, 0.0, 1.0]), np.array([1.0, -1j]), np.array([1.0, 1j])
    numerator = np.zeros(1)
    for power, c in terms:
        top = np.array([2.0 * c * b**-power])
        for factor in [upper] * (m - power) + [lower] * m:
            top = np.polymul(top, factor)
        numerator = np.polyadd(numerator, top.real)
    out = []
    for power in range(m, 0, -1):
        numerator, rest = np.polydiv(numerator, quadratic)
        slope, constant = np.concatenate([np.zeros(2), rest])[-2:]
        B, C = slope * b ** (2 * power - 1), constant * b ** (2 * power)
        out.append((power, np.array([B, C - B * a])))
    return out[::-1]


def _pair(pole: complex, terms: list[tuple[int, complex]], style: Style, digits: int) -> list[Addend]:
    out: list[Addend] = []
    rows = _pair_numerators(pole, terms)
    rate = math.log(abs(pole))

    def size(power: int, degree: int, factor: float) -> float:
        # ln of the term where |s| is that of the pole.
        return math.log(abs(factor)) + (degree - 2 * power) * rate if factor else -math.inf

    sizes = [max(size(power, 1, float(B)), size(power, 0, float(C))) for power, (B, C) in rows]
    visible = math.log(_INVISIBLE) + max(sizes)
    for power, (B, C) in rows:
        parts = [(1, float(B), "s"), (0, float(C), "")]
        addends = [(factor, body) for degree, factor, body in parts if size(power, degree, factor) > visible]
        if addends:
            sign = -1.0 if addends[0][0] < 0 else 1.0
            top = _sum([(sign * c, body) for c, body in addends], style, digits)
            if len(addends) > 1 and style is TEXT:
                top = f"({top})"
            out.append((sign, style.fraction(top, _bottom(pole, power, style, digits))))
    return out


def fractions_sum(fractions: PartialFractions, style: Style, digits: int) -> str:
    """Y(s) as a sum of fractions, conjugate pairs joined to real quadratics."""
    addends: list[Addend] = [(fractions.direct, "")] if fractions.direct else []
    upper = [term for term in fractions.terms if term.pole.imag >= 0]
    for pole, group in groupby(upper, key=lambda term: term.pole):
        terms = [(term.power, term.coefficient) for term in group]
        if pole.imag:
            addends += _pair(pole, terms, style, digits)
            continue
        for power, c in terms:
            top = style.number(abs(c.real), digits)
            bottom = _bottom(pole, power, style, digits)
            addends.append((1.0 if c.real > 0 else -1.0, style.fraction(top, bottom)))
    body = _sum(addends, style, digits)
    if not fractions.theta:
        return body
    lag = style.exp(_argument(-fractions.theta, "s", style, digits))
    if addends == [(1.0, "")]:
        return lag
    if len(addends) > 1:
        body = f"{style.left}{body}{style.right}"
    return f"{body}{style.space}{lag}"
