"""Reading a transfer function: text -> syntax tree, with the column of every mistake.

Grammar (``s`` is the Laplace variable; spaces are free)::

    sum     := product (("+" | "-") product)*
    product := unary (("*" | "/" | nothing) unary)*      # "nothing" is the implied product: 2 s (s+1)
    unary   := ("-" | "+") unary | power
    power   := atom (("^" | "**") unary)?
    atom    := NUMBER | "s" | "e" | "pi" | "exp" "(" sum ")" | "(" sum ")" | "{" sum "}" | "[" sum "]"
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from looplab.engine.errors import ParseError

MAX_CHARACTERS = 500
MAX_DEPTH = 40
MAX_TOKENS = 250

_NUMBER = r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
_TOKEN = re.compile(rf"\s*(?:{_NUMBER}|(?P<name>[A-Za-z_]\w*)|(?P<op>\*\*|[-+*/^(){{}}\[\]]))")
_PASTED = str.maketrans({"−": "-", "–": "-", "·": "*", "×": "*", "⋅": "*", "²": "^2", "³": "^3", "\u00a0": " "})
_CLOSING = {"(": ")", "{": "}", "[": "]"}


@dataclass(frozen=True)
class Node:
    """One node: kind in number, s, constant, exp, neg, +, -, *, /, ^ and group; column is 1-based."""

    kind: str
    children: tuple[Node, ...]
    column: int
    value: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    column: int


def _tokens(text: str) -> list[_Token]:
    out, at = [], 0
    while at < len(text.rstrip()):
        match = _TOKEN.match(text, at)
        if match is None:
            bad = text[at:].lstrip()[0]
            column = len(text) - len(text[at:].lstrip()) + 1
            hint = "write decimals with a point: 0.5" if bad in ",;" else "use s, numbers, + - * / ^ ( ) and exp( )"
            raise ParseError(f"{bad!r} cannot be read here", column=column, hint=hint)
        kind = str(match.lastgroup)
        out.append(_Token(kind, match.group(kind), match.start(kind) + 1))
        at = match.end()
    if len(out) > MAX_TOKENS:
        raise ParseError(f"the expression has more than {MAX_TOKENS} parts", column=out[MAX_TOKENS].column)
    return [*out, _Token("end", "", len(text.rstrip()) + 1)]


class _Parser:
    def __init__(self, text: str) -> None:
        self.tokens = _tokens(text)
        self.at = 0
        self.depth = 0

    @property
    def token(self) -> _Token:
        return self.tokens[self.at]

    def take(self) -> _Token:
        token = self.token
        self.at += 1
        return token

    def sum(self) -> Node:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise ParseError(f"brackets are nested deeper than {MAX_DEPTH}", column=self.token.column)
        left = self.product()
        while self.token.text in ("+", "-"):
            op = self.take()
            left = Node(op.text, (left, self.product()), op.column)
        self.depth -= 1
        return left

    def product(self) -> Node:
        left = self.unary()
        divided = False
        while True:
            token = self.token
            if token.text in ("*", "/"):
                self.take()
                left = Node(token.text, (left, self.unary()), token.column)
                divided = token.text == "/"
            elif token.kind in ("number", "name") or token.text in _CLOSING:
                if divided and token.text not in ("exp", "e"):
                    raise ParseError(
                        "is this factor above or below the line?",
                        column=token.column,
                        hint="put the denominator in brackets, 1/((s+1)(s+2)), or write * to multiply the fraction",
                    )
                left = Node("*", (left, self.unary()), token.column)
            else:
                return left

    def unary(self) -> Node:
        column, negative = self.token.column, False
        while self.token.text in ("+", "-"):
            negative ^= self.take().text == "-"
        node = self.power()
        return Node("neg", (node,), column) if negative else node

    def power(self) -> Node:
        base = self.atom()
        if self.token.text not in ("^", "**"):
            return base
        op = self.take()
        if base.name == "e" and self.token.text not in _CLOSING:
            raise ParseError("put the exponent in brackets", column=self.token.column, hint="write exp(-0.1 s)")
        negative = self.token.text == "-"
        if self.token.text in ("+", "-"):
            self.take()
        exponent = self.atom()
        if self.token.text in ("^", "**"):
            raise ParseError("a power of a power needs brackets", column=self.token.column)
        if negative:
            exponent = Node("neg", (exponent,), exponent.column)
        if base.name == "e":
            return Node("exp", (exponent,), base.column)
        return Node("^", (base, exponent), op.column)

    def atom(self) -> Node:
        token = self.take()
        if token.kind == "number":
            value = float(token.text)
            if value == float("inf"):
                raise ParseError("this number is too large", column=token.column)
            return Node("number", (), token.column, value=value, name=token.text)
        if token.text in _CLOSING:
            inner = self.sum()
            if self.token.text != _CLOSING[token.text]:
                raise ParseError(
                    f"the bracket {token.text!r} opened in column {token.column} is not closed",
                    column=self.token.column,
                )
            self.take()
            return Node("group", (inner,), token.column)
        if token.kind == "name":
            return self.name(token)
        if token.kind == "end":
            raise ParseError("the expression ends too early", column=token.column, hint="a factor is missing")
        raise ParseError(f"{token.text!r} cannot stand here", column=token.column, hint="expected is a number, s or (")

    def name(self, token: _Token) -> Node:
        if token.text in ("s", "S"):
            return Node("s", (), token.column)
        if token.text == "pi":
            return Node("number", (), token.column, value=3.141592653589793, name="pi")
        if token.text == "e":
            return Node("number", (), token.column, value=2.718281828459045, name="e")
        if token.text == "exp":
            if self.token.text not in _CLOSING:
                raise ParseError("exp needs brackets", column=self.token.column, hint="write exp(-0.1 s)")
            return Node("exp", (self.atom(),), token.column)
        hint = "only s, pi, e and exp( ) have a meaning here"
        if re.fullmatch(r"s\d+", token.text):
            hint = f"for a power write s^{token.text[1:]}"
        raise ParseError(f"unknown name {token.text!r}", column=token.column, hint=hint)


def parse_syntax(text: str) -> Node:
    """Parse text into a syntax tree.

    Raises
    ------
    ParseError
        With the 1-based column of the mistake and, where there is one, a way out.
    """
    if len(text) > MAX_CHARACTERS:
        raise ParseError(f"the text is longer than {MAX_CHARACTERS} characters", column=MAX_CHARACTERS + 1)
    if not text.strip():
        raise ParseError("the expression is empty", column=1, hint="try 1/(s+1)^3")
    parser = _Parser(text.translate(_PASTED))
    node = parser.sum()
    if parser.token.kind != "end":
        raise ParseError(f"{parser.token.text!r} closes a bracket that was not opened", column=parser.token.column)
    return node


def _strip(node: Node) -> Node:
    return _strip(node.children[0]) if node.kind == "group" else node


def syntax_to_latex(node: Node) -> str:
    """LaTeX of an expression the way its author wrote it."""
    kids = node.children
    if node.kind == "number":
        if node.name == "pi":
            return r"\pi"
        if "e" in node.name.lower() and node.name != "e":
            mantissa, exponent = node.name.lower().split("e")
            return rf"{mantissa} \cdot 10^{{{int(exponent)}}}"
        return node.name
    if node.kind == "s":
        return "s"
    if node.kind == "exp":
        return f"e^{{{syntax_to_latex(_strip(kids[0]))}}}"
    if node.kind == "group":
        return f"({syntax_to_latex(kids[0])})"
    if node.kind == "neg":
        return f"-{syntax_to_latex(kids[0])}"
    if node.kind == "/":
        return rf"\frac{{{syntax_to_latex(_strip(kids[0]))}}}{{{syntax_to_latex(_strip(kids[1]))}}}"
    if node.kind == "^":
        return f"{syntax_to_latex(kids[0])}^{{{syntax_to_latex(_strip(kids[1]))}}}"
    left, right = (syntax_to_latex(kid) for kid in kids)
    if node.kind == "*":
        numeric = _strip(kids[1]).kind in ("number", "neg")
        return rf"{left} \cdot {right}" if numeric else rf"{left}\,{right}"
    return f"{left} {node.kind} {right}"
