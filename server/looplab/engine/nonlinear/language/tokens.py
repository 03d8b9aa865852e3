"""Text of a formula taken apart into numbers, names and signs, each with its column."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from looplab.engine.errors import ParseError
from looplab.engine.nonlinear.language.limits import Limits

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<sign>\*\*|<=|>=|[-+*/^(),<>]))",
    re.ASCII,
)
_BLANK = re.compile(r"\s*", re.ASCII)
_HINTS = {
    "=": "compare with <, <=, > or >=",
    "−": "write the minus sign of the keyboard: -",
    "–": "write the minus sign of the keyboard: -",
    "·": "multiply with *",
    "×": "multiply with *",
    "²": "write ^2",
    "³": "write ^3",
    "[": "group with round brackets",
    "{": "group with round brackets",
    ";": "separate the arguments of a function with a comma",
}


@dataclass(frozen=True)
class Token:
    """One part: its kind (number, name, sign or end), its text and its 1-based column."""

    kind: str
    text: str
    column: int


def tokenize(text: str, limits: Limits) -> list[Token]:
    """The parts of a formula, the last one of kind "end".

    Raises
    ------
    ParseError
        Too long, empty, a character without a meaning, or a number too large for a float.
    """
    if len(text) > limits.characters:
        raise ParseError(
            f"the formula is longer than {limits.characters} characters",
            column=limits.characters + 1,
            hint="move a part of it into a variable",
        )
    out: list[Token] = []
    at, end = 0, len(text.rstrip(" \t\r\n\f\v"))
    while at < end:
        match = _TOKEN.match(text, at)
        if match is None:
            column = _column_after_blank(text, at)
            bad = text[column - 1]
            hint = _HINTS.get(bad, "use numbers, names, + - * / ^ ( ) and the functions")
            raise ParseError(f"{bad!a} cannot be read here", column=column, hint=hint)
        kind = str(match.lastgroup)
        token = Token(kind, match.group(kind), match.start(kind) + 1)
        if kind == "number" and math.isinf(float(token.text)):
            raise ParseError("this number is too large", column=token.column, hint="numbers reach to 1.8e308")
        out.append(token)
        if len(out) > limits.tokens:
            raise ParseError(
                f"the formula has more than {limits.tokens} parts",
                column=token.column,
                hint="move a part of it into a variable",
            )
        at = match.end()
    if not out:
        raise ParseError("the formula is empty", column=1, hint="write a number or an expression such as k*(u - x)")
    return [*out, Token("end", "", end + 1)]


def _column_after_blank(text: str, at: int) -> int:
    blank = _BLANK.match(text, at)
    return (blank.end() if blank else at) + 1
