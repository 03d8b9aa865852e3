"""The distillation column: what goes in comes out, its rest, its gains, and McCabe and Thiele's lines."""

import math

import numpy as np
import pytest
from scipy.optimize import root

from column import balances, column
from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import BUILT_IN, compile_model
from looplab.engine.nonlinear.simulation import InputCourse, simulate_open_loop
from looplab.engine.response import step
from looplab.plants import load_plant
from looplab.plants.distillation import DISTURBANCES, NOMINAL, compositions_at_rest, distillation

# Luyben (1990), chapter 5: x_B, x_1, ..., x_20, x_D
PRINTED = [
    *(0.02, 0.035, 0.05719, 0.08885, 0.1318, 0.18622, 0.24951, 0.31618, 0.37948, 0.43391, 0.47688),
    *(0.51526, 0.56295, 0.61896, 0.68052, 0.74345, 0.80319, 0.85603, 0.89995, 0.93458, 0.96079, 0.98),
]


def named(model, u=None, p=None):
    pairs = (model.input_names, u or model.u0), (model.parameter_names, p or model.p0)
    return [dict(zip(names, values, strict=True)) for names, values in pairs]


def at_rest(model, u, p, near):
    """By hand: the equations of ``column`` solved by MINPACK."""
    found = root(lambda x: np.array(column(x, u, p)), near, tol=1e-14)
    assert np.abs(column(found.x, u, p)).max() < 1e-9
    return found.x


def nominal_near(model):
    return np.array(model.states(model.document.operating_points[0].near, model.x0))


def test_the_profile_of_the_book():
    assert compositions_at_rest(20, 10, 2.0, 1.0, **NOMINAL) == pytest.approx(PRINTED, abs=1.5e-5)


def test_the_products_of_another_column():
    """Skogestad and Postlethwaite's column A: 39 trays, alpha 1.5, products 0.99 and 0.01."""
    x = compositions_at_rest(39, 20, 1.5, 1.0, R=2.70629, V=3.20629, F=1.0, z=0.5)
    assert [x[0], x[-1]] == pytest.approx([0.01, 0.99], abs=1e-6)


@pytest.mark.parametrize("q", [1.0, 0.6])
def test_what_goes_in_comes_out_at_any_state(q):
    model, random = load_plant("distillation"), np.random.default_rng(3)
    u, p = model.u0, model.parameters({"q": q})
    M, X = random.uniform(2, 120, 22), random.uniform(0, 1, 22)
    f = np.array(model.f(0.0, [*M, *X], u, p))
    named_u, named_p = named(model, u, p)
    dM, amounts = balances(M, X, named_u, named_p)
    flows = dict(zip(model.variable_names, model.variables(0.0, [*M, *X], u, p), strict=True))
    D, B = flows["D"], flows["B"]
    assert f[:22].sum() == pytest.approx(100 - D - B, rel=1e-9)
    assert (M * f[22:] + X * f[:22]).sum() == pytest.approx(50 - D * X[-1] - B * X[0], rel=1e-9)
    assert f[:22] == pytest.approx(dM, rel=1e-10) and M * f[22:] + X * f[:22] == pytest.approx(amounts, rel=1e-9)


def test_what_goes_in_comes_out_of_a_run():
    """Inflow less outflow, integrated beside the states, is the change of what is held: both components."""
    document = distillation()
    for name, rate in (("all", "F - D - B"), ("light", "F*z - D*x_D - B*x_B")):
        document["states"].append({"name": name, "initial": 0, "equation": rate})
    model = compile_model(document, BUILT_IN)
    u = {
        name: InputCourse(NOMINAL[name]).plus(step(size, 2.0)) for name, size in (("V", 15.0), ("F", 10.0), ("z", -0.1))
    }
    run = simulate_open_loop(model, np.linspace(0, 30, 61), u, rtol=1e-12, atol=1e-13)
    M, X = run.x[:, :22], run.x[:, 22:44]
    assert run.truncated_at is None and np.abs(run.x[-1, 44:]).min() > 1
    assert M.sum(axis=1) - M[0].sum() == pytest.approx(run.x[:, 44], abs=1e-9)
    assert (M * X).sum(axis=1) - (M[0] * X[0]).sum() == pytest.approx(run.x[:, 45], abs=1e-9)


def test_a_start_up_ends_at_rest():
    model = load_plant("distillation")
    run = simulate_open_loop(model, np.linspace(0, 1500, 16), rtol=1e-11)
    assert run.x[0, 22:] == pytest.approx(0.5)
    expected = at_rest(model, *named(model), nominal_near(model))
    assert run.x[-1] == pytest.approx(expected, rel=1e-7)
    assert run.x[-1, 22:] == pytest.approx(PRINTED, abs=1.5e-5)


def test_a_disturbance_ends_at_its_operating_point():
    model = load_plant("distillation")
    points = {point.name: point for point in model.document.operating_points}
    assert set(points) == {"nominal", *DISTURBANCES}
    x_D, x_B = model.state_names.index("x_D"), model.state_names.index("x_B")
    start = nominal_near(model)
    up = {"reflux-up": 1, "steam-up": -1, "feed-rate-up": 1, "feed-composition-down": -1}
    for name, (_, inputs) in DISTURBANCES.items():
        run = simulate_open_loop(model, np.linspace(0, 1000, 11), inputs, initial=points["nominal"].near)
        assert run.x[-1] == pytest.approx(model.states(points[name].near, model.x0), rel=2e-5), name
        # more reflux or feed makes the bottoms lighter, more steam or poorer feed heavier
        assert np.sign(run.x[-1, x_B] - start[x_B]) == up[name], name
    assert points["reflux-up"].near["x_D"] > start[x_D] > points["steam-up"].near["x_D"]


def test_gains_are_differences_of_rests():
    model = load_plant("distillation")
    u, p = named(model)
    rest = at_rest(model, u, p, nominal_near(model))
    linear = model.jacobians(0.0, rest.tolist(), model.u0, model.p0)
    gains = -linear.C @ np.linalg.solve(linear.A, linear.B) + linear.D
    for j, name in enumerate(model.input_names):
        h = 1e-5 * u[name]
        high, low = (at_rest(model, u | {name: u[name] + s * h}, p, rest)[[43, 22]] for s in (1, -1))
        assert gains[:2, j] == pytest.approx((high - low) / (2 * h), rel=1e-5)


@pytest.mark.parametrize("q", [1.0, 0.6, 0.0])
def test_the_lines_of_mccabe_and_thiele(q):
    """At rest the stages step between the equilibrium curve and two straight lines, which meet on the q-line."""
    model = load_plant("distillation")
    u, p = named(model, None, model.parameters({"q": q}))
    V = 178.01 - (1 - q) * 100
    u |= {"V": V}
    X = compositions_at_rest(20, 10, 2.0, q, **u)
    Y = 2 * X / (1 + X)
    top, D = V + (1 - q) * 100, V + (1 - q) * 100 - 128.01
    B, liquid = 100 - D, 128.01 + q * 100
    rectifying = lambda x: (128.01 * x + D * X[-1]) / top  # noqa: E731
    stripping = lambda x: (liquid * x - B * X[0]) / V  # noqa: E731
    assert Y[10:21] == pytest.approx(rectifying(X[11:]), abs=1e-10)
    assert Y[:10] == pytest.approx(stripping(X[1:11]), abs=1e-10)
    assert D * X[-1] + B * X[0] == pytest.approx(50, abs=1e-10)
    x = (D * X[-1] / top + B * X[0] / V) / (liquid / V - 128.01 / top)
    assert (1 - q) * rectifying(x) + q * x == pytest.approx(0.5, abs=1e-10)
    # and the column rests there
    M = at_rest(model, u, p, np.array([*nominal_near(model)[:22], *X]))
    assert M[22:] == pytest.approx(X, abs=1e-10)


def test_too_much_reflux_dries_the_drum():
    """D = M - 50 falls to zero at ln(71.99/21.99), then the drum loses 21.99 mol/min: 49 mol to the last one."""
    model = load_plant("distillation")
    run = simulate_open_loop(model, np.linspace(0, 10, 101), {"R": 200.0}, rtol=1e-10)
    assert run.truncated_reason == "the reflux drum runs dry"
    assert run.truncated_at == pytest.approx(math.log(71.99 / 21.99) + 49 / 21.99, abs=1e-6)


@pytest.mark.parametrize(
    ("N", "feed_tray", "field"), [(0, 1, "N"), (59, 10, "N"), (20, 0, "feed_tray"), (5, 6, "feed_tray")]
)
def test_a_column_has_trays_and_one_of_them_is_fed(N, feed_tray, field):
    with pytest.raises(InvalidInput) as refused:
        distillation(N, feed_tray)
    assert refused.value.field == field


@pytest.mark.parametrize("u", [{"V": 230.0}, {"V": 120.0}])
def test_flows_that_leave_no_product_have_no_rest(u):
    with pytest.raises(InvalidInput):
        compositions_at_rest(20, 10, 2.0, 1.0, **(NOMINAL | u))
