"""Transfer functions as factored text and LaTeX."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache
from itertools import groupby

from looplab.engine.systems.polynomial import ComplexArray
from looplab.engine.systems.transfer_function import TransferFunction


def number(value: float, digits: int) -> str:
    """Shortest decimal with up to ``digits`` significant digits."""
    return f"{value + 0.0:.{digits}g}"


def latex_number(value: float, digits: int) -> str:
    r"""A number in LaTeX: 1.5e-07 becomes 1.5 \cdot 10^{-7}."""
    text = number(value, digits)
    if "e" not in text:
        return text
    mantissa, exponent = text.split("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}"


def _signed(value: float, digits: int, fmt: Callable[[float, int], str]) -> str:
    return f"{'-' if value < 0 else '+'} {fmt(abs(value), digits)}"


def _factors(roots: ComplexArray, digits: int, fmt: Callable[[float, int], str]) -> Iterable[tuple[str, int]]:
    """Factors (s - root) with their multiplicity, equal ones joined; conjugate pairs as quadratics."""
    names = []
    for root in roots:
        if root.imag < 0:
            continue
        if root.imag > 0:
            linear, constant = -2.0 * root.real, abs(root) ** 2
            middle = f" {_signed(linear, digits, fmt)} s" if number(linear, digits) != "0" else ""
            names.append(f"s^2{middle} + {fmt(constant, digits)}")
        elif root.real == 0:
            names.append("s")
        else:
            names.append(f"s {_signed(-root.real, digits, fmt)}")
    names.sort(key=lambda name: (name != "s", len(name), name))
    return ((name, len(list(group))) for name, group in groupby(names))


def _product(roots: ComplexArray, digits: int, latex: bool) -> str:
    fmt = latex_number if latex else number
    parts = []
    for name, times in _factors(roots, digits, fmt):
        body = name if name == "s" else f"({name})"
        parts.append(body if times == 1 else f"{body}^{{{times}}}" if latex else f"{body}^{times}")
    return " ".join(parts)


@lru_cache(maxsize=256)
def _products(unit: TransferFunction, digits: int, latex: bool) -> tuple[str, str]:
    """Numerator and denominator without the gain: a moved gain leaves them as they are."""
    return _product(unit.zeros, digits, latex), _product(unit.poles, digits, latex)


def to_text(system: TransferFunction, digits: int = 6) -> str:
    """Factored text that the parser reads back."""
    top, bottom = _products(system.unit, digits, False)
    gain = number(system.gain, digits)
    if top and gain == "1":
        head = top
    elif top and gain == "-1":
        head = f"-{top}"
    else:
        head = f"{gain} {top}".strip()
    if bottom:
        simple = " " not in bottom or (bottom.count("(") == 1 and bottom.startswith("(") and bottom.endswith(")"))
        head += f"/{bottom}" if simple else f"/({bottom})"
    if system.theta:
        head += f" exp(-{number(system.theta, digits)} s)"
    return head


def to_latex(system: TransferFunction, digits: int = 4) -> str:
    """Factored LaTeX."""
    top, bottom = _products(system.unit, digits, True)
    gain = latex_number(system.gain, digits)
    implied = bool(top) and gain in {"1", "-1"}
    head = (gain.removesuffix("1") if implied else gain + (r"\," if top else "")) + top
    if bottom:
        head = rf"\frac{{{head}}}{{{bottom}}}"
    if system.theta:
        theta = latex_number(system.theta, digits)
        head += r"\,e^{-s}" if theta == "1" else rf"\,e^{{-{theta} s}}"
    return head
