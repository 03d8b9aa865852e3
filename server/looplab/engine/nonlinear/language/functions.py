"""The operations of the language as total functions on floats: where there is no real value they give nan or inf."""

from __future__ import annotations

import math
from collections.abc import Callable

NAN, INF = math.nan, math.inf


def _total(function: Callable[[float], float]) -> Callable[[float], float]:
    def total(a: float) -> float:
        try:
            return function(a)
        except OverflowError:
            return -INF if function is math.sinh and a < 0.0 else INF
        except ValueError:
            return NAN

    return total


def divide(a: float, b: float) -> float:
    """a / b; nan where b is zero."""
    return a / b if b else NAN


def power(a: float, b: float) -> float:
    """a to the power b; nan where that is not a real number."""
    try:
        return math.pow(a, b)
    except OverflowError:
        return INF
    except ValueError:
        return NAN


def minimum(a: float, b: float) -> float:
    """The smaller one; nan where either is nan."""
    return a if a < b else b if b <= a else NAN


def maximum(a: float, b: float) -> float:
    """The larger one; nan where either is nan."""
    return a if a > b else b if b >= a else NAN


def sign(a: float) -> float:
    """-1, 0 or 1; nan of nan."""
    return 1.0 if a > 0.0 else -1.0 if a < 0.0 else a * 0.0


def if_less(a: float, b: float, c: float, d: float) -> float:
    """c where a < b, else d; nan where they cannot be compared."""
    return c if a < b else d if a >= b else NAN


def if_less_or_equal(a: float, b: float, c: float, d: float) -> float:
    """c where a <= b, else d; nan where they cannot be compared."""
    return c if a <= b else d if a > b else NAN


# Functions of one argument that the standard library has under the same name.
PLAIN: dict[str, Callable[[float], float]] = {
    name: getattr(math, name)
    for name in (
        *("exp", "log", "log10", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan"),
        *("sinh", "cosh", "tanh"),
    )
}

# Every operation of the graph, by its name there.
TOTAL: dict[str, Callable[..., float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": divide,
    "neg": lambda a: -a,
    "pow": power,
    "abs": math.fabs,
    "sign": sign,
    "min": minimum,
    "max": maximum,
    "if<": if_less,
    "if<=": if_less_or_equal,
    **{name: _total(function) for name, function in PLAIN.items()},
}

# What a formula may call: name -> fewest and most arguments.
CALLABLE: dict[str, tuple[int, int]] = {
    **dict.fromkeys(PLAIN, (1, 1)),
    "abs": (1, 1),
    "sign": (1, 1),
    "min": (2, 8),
    "max": (2, 8),
    "pow": (2, 2),
    "clip": (3, 3),
    "if": (3, 3),
}
