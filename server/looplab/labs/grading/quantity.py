"""Numbers as people write, compare and print them."""

import math
import re

from looplab.labs.schema import Tolerance

LONGEST = 40
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]{1,3})?")


def read_number(text: str, unit: str = "") -> float | None:
    """The number a student typed, with a decimal comma or the field's own unit behind it if they like; else None."""
    text = text.strip().replace("\N{MINUS SIGN}", "-")
    if unit and text.endswith(unit):
        text = text.removesuffix(unit).rstrip()
    if text.count(",") == 1 and "." not in text:
        text = text.replace(",", ".")
    if len(text) > LONGEST or not _NUMBER.fullmatch(text):
        return None
    value = float(text)
    return value if math.isfinite(value) else None


def is_near(value: float, expected: float, tolerance: Tolerance) -> bool:
    if tolerance.absolute is not None:
        width = tolerance.absolute
    else:
        assert tolerance.relative is not None
        width = tolerance.relative * abs(expected)
    # The edge itself is in: 1 % of 8 is 0.08, and 8.08 - 8 is a little more than that in floating point.
    return abs(value - expected) <= width * (1 + 1e-9)


def tolerance_text(tolerance: Tolerance, unit: str = "") -> str:
    if tolerance.relative is not None:
        return f"within {show(100 * tolerance.relative)} %"
    assert tolerance.absolute is not None
    return f"within {show(tolerance.absolute)} {unit}".strip()


def show(value: float, digits: int = 3) -> str:
    """A number with so many significant digits, never in powers of ten where a person would not."""
    if value == 0 or not math.isfinite(value):
        return "0" if value == 0 else "infinite"
    if 1e-4 <= abs(value) < 1e6:
        text = f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"
        return (text.rstrip("0").rstrip(".") if "." in text else text).replace("-", "\N{MINUS SIGN}")
    return f"{value:.{digits - 1}e}".replace("-", "\N{MINUS SIGN}")


def show_beside(value: float, limit: float) -> str:
    """A number with enough digits to see on which side of a limit it lies: 25.003 beside 25, not 25."""
    for digits in range(3, 9):
        text = show(value, digits)
        if text != show(limit, digits) or value == limit:
            return text
    return text
