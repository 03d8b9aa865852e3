"""A syntax tree written out again, as text that reads back to the same tree and as LaTeX."""

from __future__ import annotations

from collections.abc import Mapping

from looplab.engine.nonlinear.language.syntax import COMPARISONS, Node

_SUM, _PRODUCT, _SIGN, _POWER, _ATOM = range(5)
_STRENGTH = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT, "neg": _SIGN, "^": _POWER}
_LATEX_FUNCTIONS = {
    "log": r"\ln",
    "log10": r"\log_{10}",
    "asin": r"\arcsin",
    "acos": r"\arccos",
    "atan": r"\arctan",
    "sign": r"\operatorname{sign}",
    "clip": r"\operatorname{clip}",
    **{name: rf"\{name}" for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "min", "max")},
}


def _strength(node: Node) -> int:
    return _STRENGTH.get(node.kind, _ATOM)


def to_text(node: Node) -> str:
    """The formula with no more brackets than it needs; reading it gives the same tree."""

    def inner(child: Node, least: int) -> str:
        text = to_text(child)
        return text if _strength(child) >= least else f"({text})"

    kind, args = node.kind, node.args
    if kind == "number":
        return repr(node.value).removesuffix(".0")
    if kind == "name":
        return node.name
    if kind == "call":
        return f"{node.name}({', '.join(to_text(arg) for arg in args)})"
    if kind == "neg":
        return f"-{inner(args[0], _SIGN)}"
    if kind == "^":
        return f"{inner(args[0], _ATOM)}^{inner(args[1], _SIGN)}"
    if kind in COMPARISONS:
        return f"{to_text(args[0])} {kind} {to_text(args[1])}"
    own = _strength(node)
    left, right = inner(args[0], own), inner(args[1], own + 1)
    return f"{left} {kind} {right}" if own == _SUM else f"{left}{kind}{right}"


def to_latex(node: Node, symbols: Mapping[str, str]) -> str:
    """LaTeX of the formula.

    Parameters
    ----------
    node : Node
    symbols : mapping
        LaTeX of the names; a name that is missing is made from its letters.
    """
    return _latex(_signs_in_front(node), symbols)


def _signs_in_front(node: Node) -> Node:
    """The same formula with minus signs drawn out of products and fractions, and into sums."""
    args = tuple(_signs_in_front(arg) for arg in node.args)
    bare = tuple(arg.args[0] if arg.kind == "neg" else arg for arg in args)
    negative = [arg.kind == "neg" for arg in args]
    if node.kind in ("*", "/") and any(negative):
        product = Node(node.kind, bare)
        return product if all(negative) else Node("neg", (product,))
    if node.kind in ("+", "-") and negative[1]:
        return Node("-" if node.kind == "+" else "+", (args[0], bare[1]))
    if node.kind == "neg" and negative[0]:
        return bare[0]
    return Node(node.kind, args, node.value, node.name)


def _latex(node: Node, symbols: Mapping[str, str]) -> str:
    def write(child: Node) -> str:
        return _latex(child, symbols)

    def inner(child: Node, least: int) -> str:
        text = write(child)
        return text if _strength(child) >= least else rf"\left({text}\right)"

    kind, args = node.kind, node.args
    if kind == "number":
        return _latex_number(node.value)
    if kind == "name":
        return r"\pi" if node.name == "pi" else symbols.get(node.name) or latex_name(node.name)
    if kind == "call":
        return _latex_call(node, symbols)
    if kind == "neg":
        return f"-{inner(args[0], _PRODUCT)}"
    if kind == "/":
        return rf"\frac{{{write(args[0])}}}{{{write(args[1])}}}"
    if kind == "^":
        return f"{_latex_base(args[0], symbols)}^{{{write(args[1])}}}"
    if kind in COMPARISONS:
        sign = {"<=": r"\le", ">=": r"\ge"}.get(kind, kind)
        return f"{write(args[0])} {sign} {write(args[1])}"
    own = _strength(node)
    if kind == "*":
        dot = r"\cdot" if _starts_with_number(args[1]) else r"\,"
        # A fraction needs no brackets, on either side of a product.
        return f"{inner(args[0], own)} {dot} {inner(args[1], own if args[1].kind == '/' else own + 1)}"
    return f"{inner(args[0], own)} {kind} {inner(args[1], own + 1)}"


def _latex_base(node: Node, symbols: Mapping[str, str]) -> str:
    text = _latex(node, symbols)
    bare = node.kind == "name" or (node.kind == "number" and "cdot" not in text)
    return f"{{{text}}}" if bare else rf"\left({text}\right)"


def _latex_call(node: Node, symbols: Mapping[str, str]) -> str:
    written = [_latex(arg, symbols) for arg in node.args]
    if node.name == "exp":
        return f"e^{{{written[0]}}}"
    if node.name == "sqrt":
        return rf"\sqrt{{{written[0]}}}"
    if node.name == "abs":
        return rf"\left|{written[0]}\right|"
    if node.name == "pow":
        return f"{_latex_base(node.args[0], symbols)}^{{{written[1]}}}"
    if node.name == "if":
        return (
            rf"\begin{{cases}} {written[1]} & \text{{if }} {written[0]} \\ {written[2]} & \text{{else}} \end{{cases}}"
        )
    return rf"{_LATEX_FUNCTIONS[node.name]}\left({', '.join(written)}\right)"


def _starts_with_number(node: Node) -> bool:
    while node.kind in ("*", "^"):
        node = node.args[0]
    return node.kind == "number"


def _latex_number(value: float) -> str:
    if value == 0.0 or 1e-3 <= value < 1e6:
        return f"{value:.12g}"
    mantissa, exponent = f"{value:.11e}".split("e")
    mantissa = mantissa.rstrip("0").rstrip(".")
    power = f"10^{{{int(exponent)}}}"
    return power if mantissa == "1" else rf"{mantissa} \cdot {power}"


def latex_name(name: str) -> str:
    """LaTeX of a name that has no symbol of its own: the part after the first _ as an index."""
    first, _, rest = name.partition("_")
    if not first:
        rest = rest.strip("_")
        return rf"\mathrm{{{rest}}}" if rest else r"\_"
    symbol = first if len(first) == 1 else rf"\mathrm{{{first}}}"
    return rf"{symbol}_{{\mathrm{{{rest.replace('_', ' ')}}}}}" if rest.strip("_") else symbol
