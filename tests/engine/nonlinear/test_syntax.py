"""The grammar: what a formula means, and where a mistake is."""

import math

import pytest

from looplab.engine.errors import ParseError
from looplab.engine.nonlinear import Limits, compile_model
from looplab.engine.nonlinear.language import parse_expression, to_latex, to_text
from models import model, parameters

# Values computed by hand or with the standard library.
VALUES = {
    "1 + 2*3": 7.0,
    "-2^2": -4.0,
    "2^3^2": 512.0,
    "2**3**2": 512.0,
    "2^-1": 0.5,
    "2^-2^2": 1 / 16,
    "(-2)^3": -8.0,
    "8/4/2": 1.0,
    "8 - 4 - 2": 2.0,
    "2*-3": -6.0,
    "1 - -1": 2.0,
    "+-+2": -2.0,
    "1e3": 1000.0,
    ".5 + 5.": 5.5,
    "1.5E-2": 0.015,
    "pi": math.pi,
    "log(exp(2))": 2.0,
    "log10(1000)": 3.0,
    "sqrt(2)*sqrt(2)": math.sqrt(2) ** 2,
    "sin(1)^2 + cos(1)^2": math.sin(1) ** 2 + math.cos(1) ** 2,
    "tan(0.5)": math.tan(0.5),
    "asin(0.5) + acos(0.5) + atan(0.5)": math.asin(0.5) + math.acos(0.5) + math.atan(0.5),
    "sinh(1) + cosh(1) + tanh(1)": math.sinh(1) + math.cosh(1) + math.tanh(1),
    "abs(-3) + sign(-3) + sign(0)": 2.0,
    "min(3, 1, 2) + max(3, 1, 2)": 4.0,
    "pow(2, 10)": 1024.0,
    "clip(5, 0, 1) + clip(-5, 0, 1) + clip(0.5, 0, 1)": 1.5,
    "if(1 < 2, 10, 20)": 10.0,
    "if(2 <= 1, 10, 20)": 20.0,
    "if(1 > 1, 10, 20)": 20.0,
    "if(1 >= 1, 10, 20)": 10.0,
    "if(0 < 1, if(0 > 1, 1, 2), 3)": 2.0,
    "0*x + 7": 7.0,
}


@pytest.mark.parametrize("text", VALUES)
def test_a_formula_means_what_the_grammar_says(text):
    compiled = compile_model(model(text))
    assert compiled.f(0.0, (1.0,), (), ()) == (VALUES[text],)
    # Not folded: the same with every number an operand that is only known when it is computed.
    names = {f"c{i}": float(i) for i in range(6)}
    variable = compile_model(model(f"({text}) + x - x", parameters=parameters(**names)))
    assert variable.f(0.0, (1.0,), (), tuple(names.values()))[0] == pytest.approx(VALUES[text], rel=1e-15)


@pytest.mark.parametrize(
    ("text", "column", "words"),
    [
        ("", 1, "empty"),
        ("   ", 1, "empty"),
        ("2x", 2, "operator is missing"),
        ("x x", 3, "operator is missing"),
        ("2 (x)", 3, "operator is missing"),
        ("x(2)", 1, "not a function"),
        ("1 +", 4, "ends too early"),
        ("(1 + 2", 7, "not closed"),
        ("1 + 2)", 6, "closes none"),
        ("1 + * 2", 5, "cannot stand here"),
        ("k*(u - x", 9, "not closed"),
        ("1 < 2", 3, "comparison"),
        ("(1 < 2)", 4, "comparison"),
        ("if(1, 2, 3)", 5, "comparison is missing"),
        ("if(1 < 2, 3)", 1, "takes 3 arguments"),
        ("if(1 < 2 < 3, 4, 5)", 10, "comparison"),
        ("sin()", 1, "takes 1 argument"),
        ("sin(1, 2)", 1, "takes 1 argument"),
        ("min(1)", 1, "takes 2 to 8"),
        ("exp", 1, "is a function"),
        ("exp + 1", 1, "is a function"),
        ("1,5", 2, "cannot stand here"),
        ("max(1; 2)", 6, "cannot be read"),
        ("x = 2", 3, "cannot be read"),
        ("x²", 2, "cannot be read"),
        ("2 − x", 3, "cannot be read"),
        ("x.y", 2, "cannot be read"),
        ("__import__('os')", 12, "cannot be read"),
        ("x[0]", 2, "cannot be read"),
        ("lambda: 0", 7, "cannot be read"),
        ("1e999", 1, "too large"),
        ("9^9^9", 2, "leave the range"),
        ("1 + 1e308*10", 10, "leave the range"),
        ("1/0", 2, "leave the range"),
        ("log(0*1)", 1, "leave the range"),
        ("sqrt(-1)", 1, "leave the range"),
        ("if(x > 0, 1/0, 1)", 12, "leave the range"),
        ("y + 1", 1, "unknown name"),
        ("x + 1\ny", 7, "operator is missing"),
    ],
)
def test_a_mistake_has_a_column(text, column, words):
    with pytest.raises(ParseError, match=words) as caught:
        compile_model(model(text))
    assert caught.value.column == column, caught.value
    assert caught.value.field == "states[0].equation"


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("gian*x", "did you mean gain?"),
        ("Gain*x", "did you mean gain?"),
        ("q*x", "declared are t, gain, x"),
        ("ln(x)", "write log"),
        ("sinus(x)", "did you mean sin"),
        ("x = 2", "compare with"),
        ("2x", "write * to multiply"),
    ],
)
def test_a_mistake_has_a_way_out(text, hint):
    with pytest.raises(ParseError) as caught:
        compile_model(model(text, parameters=parameters(gain=1.0)))
    assert hint in str(caught.value.hint)


def nested(n: int) -> str:
    return "(" * n + "x" + ")" * n


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ("x + " + "1" * 496, "x + " + "1" * 497),
        ("+".join(["x"] * 100), "+".join(["x"] * 101)),
        (nested(40), nested(41)),
        ("-" * 40 + "x", "-" * 41 + "x"),
        ("^".join(["x"] * 41), "^".join(["x"] * 42)),
        ("abs(" * 40 + "x" + ")" * 40, "abs(" * 41 + "x" + ")" * 41),
    ],
    ids=["characters", "tokens", "brackets", "signs", "powers", "functions"],
)
def test_limits_of_one_formula(good, bad):
    with pytest.raises(ParseError, match=r"longer than 500|more than 200|deeper than 40"):
        compile_model(model(bad))
    if not good.endswith("1"):
        compile_model(model(good))
    else:
        with pytest.raises(ParseError, match="too large"):
            compile_model(model(good))


def test_larger_limits_are_for_code_that_writes_models():
    text = "+".join(["x"] * 101)
    assert compile_model(model(text), Limits(tokens=201)).f(0.0, (2.0,), (), ()) == (202.0,)


@pytest.mark.parametrize(
    ("text", "again"),
    [
        ("((x))", "x"),
        ("a-(b-c)", "a - (b - c)"),
        ("(a-b)-c", "a - b - c"),
        ("a*(b/c)", "a*(b/c)"),
        ("a*b/c", "a*b/c"),
        ("-(x^2)", "-x^2"),
        ("(-x)^2", "(-x)^2"),
        ("x**-y", "x^-y"),
        ("(a^b)^c", "(a^b)^c"),
        ("a^(b^c)", "a^b^c"),
        ("-(a*b)", "-(a*b)"),
        ("1e20*x + 0.1", "1e+20*x + 0.1"),
        ("if(a<=b,c,d)", "if(a <= b, c, d)"),
        ("+x", "x"),
    ],
)
def test_the_printer_writes_no_needless_brackets(text, again):
    assert to_text(parse_expression(text)) == again
    assert parse_expression(again) == parse_expression(text)


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("k0*exp(-E/(R*T))", r"k_{0} \, e^{-\frac{E}{R \, T}}"),
        ("beta*sqrt(h)", r"\beta \, \sqrt{h}"),
        ("(a + b)^2", r"\left(a + b\right)^{2}"),
        ("2*3", r"2 \cdot 3"),
        ("7.2e10*x", r"7.2 \cdot 10^{10} \, x"),
        ("a*(-b)/c - -d", r"-\frac{a \, b}{c} + d"),
        ("-(a*b) + -c", r"-a \, b - c"),
        ("-a/-b", r"\frac{a}{b}"),
        ("--a", "a"),
        ("(-a)^2 - (b - c)", r"\left(-a\right)^{2} - \left(b - c\right)"),
        ("a*(b + c)/2*3", r"\frac{a \, \left(b + c\right)}{2} \cdot 3"),
        ("-(a + b)", r"-\left(a + b\right)"),
        ("abs(x) - log(y)", r"\left|x\right| - \ln\left(y\right)"),
        ("cA", r"\mathrm{cA}"),
        ("tau_1", r"\mathrm{tau}_{\mathrm{1}}"),
        ("if(x > 0, x, 0)", r"\begin{cases} x & \text{if } x > 0 \\ 0 & \text{else} \end{cases}"),
    ],
)
def test_latex(text, latex):
    assert to_latex(parse_expression(text), {"k0": "k_{0}", "beta": r"\beta"}) == latex
