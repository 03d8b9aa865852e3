"""Random formulas: values and derivatives against mpmath, the printer against the parser."""

import math
import operator

import mpmath
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from looplab.engine.errors import EngineError, NonFinite, ParseError
from looplab.engine.nonlinear import compile_model
from looplab.engine.nonlinear.language import (
    Differentiator,
    Graph,
    Node,
    add_expression,
    evaluate,
    parse_condition,
    parse_expression,
    to_text,
)
from models import model, parameters
from strategies import effort

NAMES = ("a", "b", "x")
UNARY = ("exp", "log", "log10", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "abs")
COMPARE = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
numbers = st.floats(0.01, 9.99).map(lambda v: Node("number", value=float(f"{v:.3g}")))
leaves = numbers | st.sampled_from([Node("name", name=name) for name in NAMES])


def call(name: str, *args: Node) -> Node:
    return Node("call", args, name=name)


def grown(child: st.SearchStrategy[Node]) -> st.SearchStrategy[Node]:
    pair = st.tuples(child, child)
    condition = st.builds(lambda kind, ab: Node(kind, ab), st.sampled_from(list(COMPARE)), pair)
    return st.one_of(
        st.builds(lambda kind, ab: Node(kind, ab), st.sampled_from("+-*/^"), pair),
        st.builds(lambda a: Node("neg", (a,)), child),
        st.builds(call, st.sampled_from([*UNARY, "sign"]), child),
        st.builds(lambda name, ab: call(name, *ab), st.sampled_from(["min", "max", "pow"]), pair),
        st.builds(lambda abc: call("clip", *abc), st.tuples(child, child, child)),
        st.builds(lambda test, ab: call("if", test, *ab), condition, pair),
    )


expressions = st.recursive(leaves, grown, max_leaves=12)
points = st.tuples(*[st.floats(0.1, 3.0).map(lambda v: float(f"{v:.4g}"))] * 3)


class NotReal(Exception):
    pass


def exact(node: Node, at: dict[str, mpmath.mpf]) -> mpmath.mpf:
    """The value of a syntax tree in mpmath, by the definition of each node."""
    if node.kind == "number":
        return mpmath.mpf(node.value)
    if node.kind == "name":
        return at[node.name]
    if node.name == "if":
        test, then, otherwise = node.args
        left, right = (exact(arg, at) for arg in test.args)
        if abs(left - right) < 1e-6:
            raise NotReal  # too near to a corner for a derivative
        return exact(then if COMPARE[test.kind](left, right) else otherwise, at)
    args = [exact(arg, at) for arg in node.args]
    if node.name in ("min", "max", "clip"):
        if any(abs(p - q) < 1e-6 for i, p in enumerate(args) for q in args[:i]):
            raise NotReal
        return min(max(args[0], args[1]), args[2]) if node.name == "clip" else {"min": min, "max": max}[node.name](args)
    if node.name in ("abs", "sign", "sqrt") and abs(args[0]) < 1e-6:
        raise NotReal
    try:
        if node.kind in "+-*/":
            value = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}[node.kind](*args)
        elif node.kind == "neg":
            value = -args[0]
        elif node.kind == "^" or node.name == "pow":
            value = mpmath.power(*args)
        else:
            value = getattr(mpmath, {"abs": "fabs"}.get(node.name, node.name))(args[0])
    except (ZeroDivisionError, ValueError, OverflowError) as error:
        raise NotReal from error
    if not isinstance(value, mpmath.mpf) or not mpmath.isfinite(value) or abs(value) > 1e100:
        raise NotReal
    return value


def in_mpmath(graph: Graph, node: int, leaves: dict[int, mpmath.mpf]) -> mpmath.mpf:
    """The value of a node of the graph, every operation done in mpmath."""
    values: dict[int, mpmath.mpf] = {}
    for each in graph.reachable([node]):
        kind, *rest = graph.nodes[each]
        if each in leaves:
            values[each] = leaves[each]
        elif kind == "const":
            values[each] = mpmath.mpf(rest[0])
        else:
            values[each] = OPERATIONS[kind](*(values[operand] for operand in graph.operands(each)))
    return values[node]


def choose(test: bool, then: mpmath.mpf, otherwise: mpmath.mpf) -> mpmath.mpf:
    return then if test else otherwise


def divided(a: mpmath.mpf, b: mpmath.mpf) -> mpmath.mpf:
    return a / b if b else mpmath.nan


OPERATIONS = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": divided, "neg": operator.neg,
    "pow": lambda a, b: mpmath.power(a, b) if a or b > 0 else mpmath.mpf(b == 0) if b == 0 else mpmath.nan,
    "min": min, "max": max, "sign": mpmath.sign,
    "if<": lambda a, b, c, d: choose(a < b, c, d), "if<=": lambda a, b, c, d: choose(a <= b, c, d),
    **{name: getattr(mpmath, {"abs": "fabs"}.get(name, name)) for name in UNARY},
}  # fmt: skip
# In a branch that is not taken mpmath may have no value.
OPERATIONS["log"] = lambda a: mpmath.log(a) if a else mpmath.nan


def slope(node: Node, at: dict[str, mpmath.mpf], name: str) -> mpmath.mpf:
    """A central difference with 60 digits: its error is 1e-30 times the third derivative."""
    h = mpmath.mpf(10) ** -15
    ahead, behind = (exact(node, {**at, name: at[name] + s * h}) for s in (1, -1))
    return (ahead - behind) / (2 * h)


@given(expressions)
@effort(120)
def test_what_is_printed_reads_back(node):
    assert parse_expression(to_text(node)) == node


@given(expressions, points)
@effort(150)
def test_derivatives_are_exact(node, point):
    graph = Graph(10_000)
    leaves = {name: graph.leaf("x", i) for i, name in enumerate(NAMES)}
    with mpmath.workdps(60):
        at = {name: mpmath.mpf(value) for name, value in zip(NAMES, point, strict=True)}
        try:
            value = add_expression(graph, node, leaves)
            slopes = {name: slope(node, at, name) for name in NAMES}
        except (NotReal, ParseError):
            assume(False)
        assume(max(abs(s) for s in slopes.values()) < 1e30)
        gradient = Differentiator(graph, list(leaves.values())).gradient(value)
        numbers = {leaves[name]: at[name] for name in NAMES}
        for name in NAMES:
            found = in_mpmath(graph, gradient[leaves[name]], numbers) if leaves[name] in gradient else 0
            assert abs(found - slopes[name]) <= 1e-10 * (1 + abs(slopes[name])), (to_text(node), name)


@given(expressions, points)
@effort(120)
def test_the_generated_code_computes_the_formula(node, point):
    a, b, x = point
    try:
        compiled = compile_model(model(to_text(node), inputs=parameters(a=1.0), parameters=parameters(b=1.0)))
        found = compiled.f(0.0, (x,), (a,), (b,))[0]
    except (ParseError, NonFinite):
        assume(False)
    at = {"a": mpmath.mpf(a), "b": mpmath.mpf(b), "x": mpmath.mpf(x)}
    with mpmath.workdps(60):
        try:
            value = exact(node, at)
            # What a change in the last digits of the arguments does: double precision cannot be held to more.
            moved = max(abs(exact(node, {**at, name: at[name] * (1 + mpmath.mpf(2) ** -50)}) - value) for name in at)
        except NotReal:
            assume(False)
    assert abs(found - value) <= 20 * moved + 1e-12 * (1 + abs(value)), to_text(node)


characters = st.sampled_from("xabt0123456789.eE+-*/^(),<>= \t\npisqrtloghmfc_²λ;'\"[]{}\x00\ud800")
words = st.sampled_from(["x", "a", "9", "2.5", "1e300", *"+-*/^(),<", ">=", "if(", "exp(", "min(", "log("])
texts = st.text(characters, max_size=60) | st.text(max_size=40) | st.lists(words, max_size=40).map("".join)


@given(texts)
@effort(300)
def test_any_text_is_read_or_refused_with_a_column(text):
    for parse in (parse_expression, parse_condition):
        try:
            node = parse(text)
        except ParseError as error:
            assert 1 <= error.column <= len(text) + 1
        else:
            assert parse(to_text(node)) == node
    try:
        found = compile_model(model(text, parameters=parameters(a=2.0))).f(0.0, (1.5,), (), (2.0,))
    except EngineError as error:
        assert error.field == "states[0].equation"
    else:
        assert math.isfinite(found[0])


@given(expressions, st.tuples(*[st.sampled_from([-1e200, -2.0, -1.0, -0.0, 0.0, 0.5, 1.0, 1e-200, 1e200])] * 3))
@effort(150)
def test_at_any_point_the_value_is_finite_or_refused(node, point):
    """The fast code and the safe interpreter agree to the bit, and only what an ``if`` discards may be not finite."""
    a, b, x = point
    try:
        compiled = compile_model(model(to_text(node), inputs=parameters(a=1.0), parameters=parameters(b=1.0)))
    except ParseError:
        assume(False)
    graph, equation = compiled.graph, compiled.equations.states[0]
    value = evaluate(graph, [equation], 0.0, (x,), (a,), (b,))[equation]
    try:
        found = compiled.f(0.0, (x,), (a,), (b,))[0]
    except NonFinite as error:
        assert not math.isfinite(value)
        assert error.field == "states[0].equation"
    else:
        assert found == pytest.approx(value, rel=1e-14)
