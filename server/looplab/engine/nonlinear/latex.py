"""The equations of a model as formulas to read."""

from __future__ import annotations

from dataclasses import dataclass

from looplab.engine.nonlinear.language import latex_name, to_latex
from looplab.engine.nonlinear.model import CompiledModel


@dataclass(frozen=True)
class LatexEquation:
    """One equation: where it stands in the document, and its LaTeX."""

    path: str
    latex: str


def latex_equations(model: CompiledModel) -> list[LatexEquation]:
    """Variables, differential equations and outputs, in the document's order.

    An output that is just a state or a variable of the same name is left out.
    """
    document = model.document
    symbols = {
        item.name: item.latex
        for kind in ("parameters", "inputs", "variables", "states")
        for item in getattr(document, kind)
        if item.latex
    }
    out = []
    for kind, what in (("variables", "expression"), ("states", "equation"), ("outputs", "expression")):
        for index, item in enumerate(getattr(document, kind)):
            path = f"{kind}[{index}].{what}"
            tree = model.syntax[path]
            if kind == "outputs" and tree.kind == "name" and tree.name == item.name:
                continue
            symbol = item.latex or symbols.get(item.name) or latex_name(item.name)
            left = rf"\frac{{d {symbol}}}{{dt}}" if kind == "states" else symbol
            out.append(LatexEquation(path, f"{left} = {to_latex(tree, symbols)}"))
    return out
