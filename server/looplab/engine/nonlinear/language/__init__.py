"""The formula language of models: read, differentiated exactly, and turned into fast functions."""

from looplab.engine.nonlinear.language.build import RESERVED, add_condition, add_expression, nearest_hint
from looplab.engine.nonlinear.language.codegen import Function, Point, Values, compile_function
from looplab.engine.nonlinear.language.derivatives import Differentiator
from looplab.engine.nonlinear.language.diagnosis import evaluate, explain
from looplab.engine.nonlinear.language.graph import Graph
from looplab.engine.nonlinear.language.limits import BUILT_IN, Limits
from looplab.engine.nonlinear.language.printer import latex_name, to_latex, to_text
from looplab.engine.nonlinear.language.syntax import Node, parse_condition, parse_expression

__all__ = [
    "BUILT_IN",
    "RESERVED",
    "Differentiator",
    "Function",
    "Graph",
    "Limits",
    "Node",
    "Point",
    "Values",
    "add_condition",
    "add_expression",
    "compile_function",
    "evaluate",
    "explain",
    "latex_name",
    "nearest_hint",
    "parse_condition",
    "parse_expression",
    "to_latex",
    "to_text",
]
