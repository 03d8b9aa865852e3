"""Documents read strictly, and the functions of a model against formulas written by hand."""

import json
import math
from copy import deepcopy

import numpy as np
import pytest

from looplab.engine.errors import EngineError, InvalidInput, NonFinite, ParseError
from looplab.engine.nonlinear import BUILT_IN, Limits, compile_model, slowest_time_constant
from models import CSTR, model, parameters


@pytest.fixture(scope="module")
def cstr():
    return compile_model(CSTR)


def test_names_and_nominal_values(cstr):
    assert cstr.state_names == ("cA", "T")
    assert cstr.input_names == ("Fi", "cAi", "Ti", "Q")
    assert cstr.output_names == ("conversion", "T")
    assert cstr.variable_names == ("r", "k")
    assert (cstr.x0, cstr.u0) == ((1.0, 350.0), (100.0, 1.0, 350.0, 2e6))
    assert cstr.document.time_unit == "min"


def test_an_initial_state_follows_the_inputs(cstr):
    assert cstr.initial_state(cstr.inputs({"Ti": 400})) == (1.0, 400.0)


def test_equations_by_hand(cstr):
    cA, T, Fi, cAi, Ti, Q = 0.4, 420.0, 110.0, 1.1, 345.0, 1.5e6
    k = 7.2e10 * math.exp(-1e4 / T)
    point = (0.0, (cA, T), (Fi, cAi, Ti, Q), cstr.p0)
    expected = (Fi / 100 * (cAi - cA) - k * cA, Fi / 100 * (Ti - T) + 200 * k * cA - Q / 1e5)
    assert cstr.f(*point) == pytest.approx(expected, rel=1e-14)
    assert cstr.variables(*point) == pytest.approx((k * cA, k), rel=1e-14)
    assert cstr.outputs(*point) == pytest.approx((1 - cA / cAi, T), rel=1e-14)
    found = cstr.jacobians(*point)
    slope = k * 1e4 / T**2 * cA
    np.testing.assert_allclose(found.A, [[-Fi / 100 - k, -slope], [200 * k, -Fi / 100 + 200 * slope]], rtol=1e-13)
    np.testing.assert_allclose(
        found.B, [[(cAi - cA) / 100, Fi / 100, 0, 0], [(Ti - T) / 100, 0, Fi / 100, -1e-5]], rtol=1e-13
    )
    np.testing.assert_allclose(found.C, [[-1 / cAi, 0], [0, 1]], rtol=1e-14)
    np.testing.assert_allclose(found.D, [[0, cA / cAi**2, 0, 0], [0, 0, 0, 0]], rtol=1e-14)
    assert np.array_equal(cstr.state_jacobian(*point), found.A)
    assert cstr.sensitivity("k0")(*point) == pytest.approx((-k / 7.2e10 * cA, 200 * k / 7.2e10 * cA), rel=1e-13)
    assert cstr.sensitivity("V")(*point) == pytest.approx(
        (-Fi / 100**2 * (cAi - cA), -Fi / 100**2 * (Ti - T) + Q / 100**2 / 1000), rel=1e-13
    )


@pytest.mark.parametrize("T", [331.1, 385.1, 529.6])
def test_three_steady_states(cstr, T):
    """The values of the notes at Ti = 350 K: one digit, so f vanishes somewhere within half a unit of it."""

    def balance(temperature):
        k = 7.2e10 * math.exp(-1e4 / temperature)
        return cstr.f(0.0, (1 / (1 + k), temperature), cstr.u0, cstr.p0)

    below, above = balance(T - 0.05), balance(T + 0.05)
    assert abs(below[0]) < 1e-12 and abs(above[0]) < 1e-12
    assert below[1] * above[1] < 0


def test_variables_may_stand_in_any_order():
    document = model("a", variables=[
        {"name": "a", "expression": "2*b"}, {"name": "b", "expression": "c + 1"}, {"name": "c", "expression": "x^2"},
    ])  # fmt: skip
    compiled = compile_model(document)
    assert compiled.f(0.0, (3.0,), (), ()) == (20.0,)
    assert compiled.variables(0.0, (3.0,), (), ()) == (20.0, 10.0, 9.0)


def test_variables_in_a_circle_are_named():
    document = model("a", variables=[
        {"name": "free", "expression": "1"}, {"name": "a", "expression": "b + free"},
        {"name": "b", "expression": "c"}, {"name": "c", "expression": "a"},
    ])  # fmt: skip
    with pytest.raises(InvalidInput, match="a -> b -> c -> a") as caught:
        compile_model(document)
    assert caught.value.field == "variables[1].expression"
    with pytest.raises(InvalidInput, match="a -> a"):
        compile_model(model("a", variables=[{"name": "a", "expression": "a + 1"}]))


def test_branches_that_are_not_taken_do_not_matter():
    compiled = compile_model(model("if(x > 0, sqrt(x), x) + max(log(max(x, 1e-3)), -50)"))
    assert compiled.f(0.0, (-4.0,), (), ()) == (-4.0 + math.log(1e-3),)
    assert compiled.jacobians(0.0, (-4.0,), (), ()).A[0, 0] == 1.0


def test_the_slope_of_a_clipped_root_is_zero_where_it_is_clipped():
    compiled = compile_model(model("sqrt(max(x, 0))"))
    assert compiled.jacobians(0.0, (0.0,), (), ()).A[0, 0] == 0.0
    assert compiled.jacobians(0.0, (4.0,), (), ()).A[0, 0] == 0.25


@pytest.mark.parametrize(
    ("equation", "x", "words"),
    [
        ("1/(x - 1)", 1.0, "a division by zero"),
        ("log(x)", -2.0, "log of -2"),
        ("1 + sqrt(x - 3)*2", 2.0, "sqrt of -1"),
        ("x^0.5", -1.0, "-1 to the power 0.5"),
        ("exp(exp(x))", 7.0, "exp of 1097"),
        ("x*x", 1e200, r"1e\+200 to the power 2|too large"),
        ("min(log(x), 3)", -1.0, "log of -1"),
        ("if(log(x) < 0, 1, 2)", -1.0, "log of -1"),
        ("1e300*x - 1e300*x*2", 1e10, "too large"),
    ],
)
def test_where_an_equation_has_no_value_it_says_why(equation, x, words):
    compiled = compile_model(model(equation))
    with pytest.raises(NonFinite, match=words) as caught:
        compiled.f(2.5, (x,), (), ())
    assert caught.value.field == "states[0].equation"
    assert caught.value.t == 2.5
    assert "t = 2.5" in str(caught.value)


def test_a_derivative_without_a_value_is_refused():
    compiled = compile_model(model("sqrt(x)"))
    with pytest.raises(NonFinite, match="a derivative of"):
        compiled.jacobians(0.0, (0.0,), (), ())


def changed(path: str, value: object) -> dict:
    document = deepcopy(CSTR)
    *keys, last = [int(k) if k.isdigit() else k for k in path.split(".")]
    target = document
    for key in keys:
        target = target[key]
    target[last] = value
    return document


@pytest.mark.parametrize(
    ("path", "value", "field"),
    [
        ("id", "Not an id", "id"),
        ("id", 3, "id"),
        ("title", None, "title"),
        ("title", "x" * 201, "title"),
        ("time_unit", "fortnight", "time_unit"),
        ("nonsense", 1, None),
        ("states", [], "states"),
        ("states", "T", "states"),
        ("states", [1], "states[0]"),
        ("states.0.equation", None, "states[0].equation"),
        ("states.0.initial", "cA", "states[0].initial"),
        ("states.0.initial", True, "states[0].initial"),
        ("states.0.extra", 1, "states[0]"),
        ("states.1.name", "cA", "states[1].name"),
        ("states.1.name", "Q", "states[1].name"),
        ("states.1.name", "pi", "states[1].name"),
        ("states.1.name", "exp", "states[1].name"),
        ("states.1.name", "Tλ", "states[1].name"),
        ("states.1.name", "_T", "states[1].name"),
        ("states.1.name", "a b", "states[1].name"),
        ("states.1.min", "low", "states[1].min"),
        ("parameters.0.value", "100", "parameters[0].value"),
        ("parameters.0.value", math.nan, "parameters[0].value"),
        ("parameters.0.value", 10**400, "parameters[0].value"),
        ("parameters.0.min", 200, "parameters[0].value"),
        ("inputs.0.max", 50, "inputs[0].value"),
        ("variables.0.expression", 5, "variables[0].expression"),
        ("variables.0.expression", "q*cA", "variables[0].expression"),
        ("outputs.0.name", "T", "outputs[1].name"),
        ("operating_points", [{"name": "a", "inputs": {"Tj": 1}}], "operating_points[0].inputs.Tj"),
        ("operating_points", [{"name": "a", "near": {"T": "hot"}}], "operating_points[0].near.T"),
        ("events", [{"name": "e", "when": "T"}], "events[0].when"),
        ("events", [{"name": "e", "when": "T > 1", "action": "explode"}], "events[0].action"),
        ("inputs", parameters(**{f"u{i}": 1.0 for i in range(13)}), "inputs"),
    ],
)
def test_a_mistake_in_a_document_has_its_place(path, value, field):
    with pytest.raises(EngineError) as caught:
        compile_model(changed(path, value))
    assert caught.value.field == field, caught.value


@pytest.mark.parametrize("data", [None, 3, [], "x", {}, {1: 2}])
def test_what_is_no_document_is_refused(data):
    with pytest.raises(InvalidInput):
        compile_model(data)


def test_sizes_are_limited():
    with pytest.raises(InvalidInput, match="more than 12"):
        compile_model(model(["1"] * 13))
    many = [{"name": f"v{i}", "expression": "x"} for i in range(39)]
    with pytest.raises(InvalidInput, match="more than 40"):
        compile_model(model("x", variables=many))
    # Each doubles the operations of the one before: 2,000 are soon passed, the text stays short.
    growing = [{"name": "v0", "expression": "x"}] + [
        {"name": f"v{i}", "expression": " + ".join(f"sin({k}*v{i - 1})" for k in range(2, 30))} for i in range(1, 36)
    ]
    with pytest.raises(InvalidInput, match="2000 operations"):
        compile_model(model("v35", variables=growing))
    assert compile_model(model(["-x1"] + ["x1"] * 43), BUILT_IN).state_names[-1] == "x44"
    assert Limits().states == 12


def test_settings_are_checked(cstr):
    assert cstr.parameters({"V": 50}) == (50.0, 7.2e10, 1e4, 200.0, 1000.0)
    for bad in ({"W": 1}, {"V": "big"}, {"V": math.inf}):
        with pytest.raises(InvalidInput) as caught:
            cstr.parameters(bad)
        assert caught.value.field == f"parameters.{next(iter(bad))}"
    limited = compile_model(model("u", inputs=[{"name": "u", "value": 0, "min": -1, "max": 1}]))
    with pytest.raises(InvalidInput, match="at least -1 and at most 1"):
        limited.inputs({"u": 2})


def test_a_document_survives_json(cstr):
    again = compile_model(json.loads(json.dumps(CSTR)))
    assert again.document == cstr.document


def test_a_parse_error_keeps_its_column():
    with pytest.raises(ParseError) as caught:
        compile_model(changed("states.1.equation", "Fi/V*(Ti - T"))
    assert (caught.value.field, caught.value.column) == ("states[1].equation", 13)


@pytest.mark.parametrize(
    ("equations", "start", "tau"),
    [
        # s^2 + 4 s + 2: -2 + sqrt(2) and -2 - sqrt(2).
        (["x2 - x1", "x1 - 3*x2"], [1, 1], 1 / (2 - math.sqrt(2))),
        (["x2", "-x2/5"], [0, 0], 5.0),
        ("-x*x", 2, 0.25),
        (["x2", "-4*x1 - 0.4*x2"], [0, 0], 0.5),
        (["x2", "1"], [0, 0], None),
        ("sqrt(x)", 0, None),
    ],
)
def test_the_slowest_time_constant(equations, start, tau):
    """Of the poles written by hand: an integrator has none, nor has a slope that is not finite."""
    found = slowest_time_constant(compile_model(model(equations, start)))
    assert found == (None if tau is None else pytest.approx(tau, rel=1e-12))
