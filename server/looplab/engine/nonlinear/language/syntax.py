"""Reading a formula: text -> syntax tree, with the column of every mistake.

Grammar (spaces are free)::

    expr  := sum
    sum   := prod (("+" | "-") prod)*
    prod  := unary (("*" | "/") unary)*
    unary := ("-" | "+") unary | power
    power := atom (("^" | "**") unary)?                   # right-associative, -x^2 = -(x^2)
    atom  := NUMBER | NAME | NAME "(" args ")" | "(" expr ")"
    cmp   := sum ("<" | "<=" | ">" | ">=") sum            # only as the first argument of if(cmp, a, b)
"""

from __future__ import annotations

from dataclasses import dataclass, field
from difflib import get_close_matches

from looplab.engine.errors import ParseError
from looplab.engine.nonlinear.language.functions import CALLABLE
from looplab.engine.nonlinear.language.limits import Limits
from looplab.engine.nonlinear.language.tokens import Token, tokenize

COMPARISONS = ("<", "<=", ">", ">=")
# How tightly an operator between two operands binds; a sign in front binds like _SIGN.
_BINDS = {"+": 10, "-": 10, "*": 20, "/": 20, "^": 40, "**": 40}
_SIGN = 30
_OTHER_NAMES = {"ln": "log", "arcsin": "asin", "arccos": "acos", "arctan": "atan", "fabs": "abs", "where": "if"}


@dataclass(frozen=True)
class Node:
    """One node of the syntax tree.

    Attributes
    ----------
    kind : str
        "number", "name", "call", "neg", one of + - * / ^, or a comparison < <= > >=.
    args : tuple of Node
        Operands or arguments.
    value : float
        Of a number.
    name : str
        Of a name or a called function.
    column : int
        1-based; no part of what makes two trees equal.
    """

    kind: str
    args: tuple[Node, ...] = ()
    value: float = 0.0
    name: str = ""
    column: int = field(default=0, compare=False)


class _Parser:
    def __init__(self, text: str, limits: Limits) -> None:
        self.tokens = tokenize(text, limits)
        self.at = 0
        self.depth = 0
        self.deepest = limits.depth

    @property
    def token(self) -> Token:
        return self.tokens[self.at]

    def take(self) -> Token:
        token = self.token
        self.at += 1
        return token

    def nested(self, binds: int) -> Node:
        """An operand one level deeper."""
        self.depth += 1
        if self.depth > self.deepest:
            raise ParseError(
                f"brackets, signs and powers are nested deeper than {self.deepest}",
                column=self.token.column,
                hint="move a part of it into a variable",
            )
        node = self.expression(binds)
        self.depth -= 1
        return node

    def expression(self, binds: int) -> Node:
        left = self.prefix()
        while (strength := _BINDS.get(self.token.text, 0)) > binds:
            operator = self.take()
            if strength > _SIGN:
                left = Node("^", (left, self.nested(_SIGN)), column=operator.column)
            else:
                left = Node(operator.text, (left, self.expression(strength)), column=operator.column)
        return left

    def prefix(self) -> Node:
        token = self.take()
        if token.kind == "number":
            return self.followed(Node("number", value=float(token.text), column=token.column))
        if token.kind == "name":
            return self.name(token)
        if token.text == "-":
            return Node("neg", (self.nested(_SIGN),), column=token.column)
        if token.text == "+":
            return self.nested(_SIGN)
        if token.text == "(":
            inner = self.nested(0)
            self.close(token)
            return self.followed(inner)
        if token.kind == "end":
            raise ParseError("the formula ends too early", column=token.column, hint="an operand is missing")
        raise ParseError(
            f"{token.text!r} cannot stand here", column=token.column, hint="expected is a number or a name"
        )

    def name(self, token: Token) -> Node:
        if self.token.text == "(":
            return self.followed(self.call(token))
        if token.text in CALLABLE:
            raise ParseError(
                f"{token.text} is a function", column=token.column, hint=f"write its arguments: {token.text}(...)"
            )
        return self.followed(Node("name", name=token.text, column=token.column))

    def followed(self, node: Node) -> Node:
        """The node itself, unless another operand follows without an operator."""
        token = self.token
        if token.kind in ("number", "name") or token.text == "(":
            hint = "write * to multiply"
            if token.text == "(" and node.kind == "name":
                hint = f"{node.name} is not a function; {hint}"
            raise ParseError(f"an operator is missing before {token.text!r}", column=token.column, hint=hint)
        return node

    def close(self, opened: Token) -> None:
        if self.token.text == ")":
            self.take()
            return
        if self.token.text in COMPARISONS:
            raise ParseError(
                "a comparison stands only first in if(a < b, then, else)", column=self.token.column, hint="use if(...)"
            )
        if self.token.text == ",":
            raise ParseError(
                "a comma has no meaning here", column=self.token.column, hint="write decimals with a point"
            )
        raise ParseError(
            f"the bracket opened in column {opened.column} is not closed", column=self.token.column, hint="add )"
        )

    def call(self, token: Token) -> Node:
        opened = self.take()
        if token.text not in CALLABLE:
            raise ParseError(
                f"{token.text[:40]!r} is not a function", column=token.column, hint=_function_hint(token.text)
            )
        args: list[Node] = []
        if self.token.text != ")":
            args.append(self.condition() if token.text == "if" else self.nested(0))
            while self.token.text == ",":
                self.take()
                args.append(self.nested(0))
        self.close(opened)
        fewest, most = CALLABLE[token.text]
        if not fewest <= len(args) <= most:
            wanted = f"{fewest}" if fewest == most else f"{fewest} to {most}"
            raise ParseError(
                f"{token.text} takes {wanted} argument{'s' if most > 1 else ''}, not {len(args)}",
                column=token.column,
                hint="if(a < b, then, else)" if token.text == "if" else None,
            )
        return Node("call", tuple(args), name=token.text, column=token.column)

    def condition(self) -> Node:
        left = self.nested(0)
        operator = self.token
        if operator.text not in COMPARISONS:
            raise ParseError(
                "a comparison is missing", column=operator.column, hint="compare with <, <=, > or >=: if(x > 0, x, 0)"
            )
        self.take()
        right = self.nested(0)
        return Node(operator.text, (left, right), column=operator.column)

    def end(self) -> None:
        token = self.token
        if token.kind == "end":
            return
        if token.text == ")":
            raise ParseError("this bracket closes none that is open", column=token.column)
        if token.text in COMPARISONS:
            raise ParseError(
                "a comparison stands only first in if(a < b, then, else)", column=token.column, hint="use if(...)"
            )
        raise ParseError(f"{token.text!r} cannot stand here", column=token.column, hint="write decimals with a point")


def _function_hint(name: str) -> str:
    if name.lower() in _OTHER_NAMES:
        return f"write {_OTHER_NAMES[name.lower()]}"
    near = get_close_matches(name.lower(), CALLABLE, n=2)
    return f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(CALLABLE)}; multiply with *"


def parse_expression(text: str, limits: Limits = Limits()) -> Node:  # noqa: B008 (frozen)
    """Syntax tree of one formula.

    Raises
    ------
    ParseError
        With the 1-based column of the mistake and, where there is one, a way out.
    """
    parser = _Parser(text, limits)
    node = parser.expression(0)
    parser.end()
    return node


def parse_condition(text: str, limits: Limits = Limits()) -> Node:  # noqa: B008 (frozen)
    """Syntax tree of one comparison, such as ``h <= 0``.

    Raises
    ------
    ParseError
        With the 1-based column of the mistake.
    """
    parser = _Parser(text, limits)
    node = parser.condition()
    parser.end()
    return node
