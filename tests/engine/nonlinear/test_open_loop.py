"""Simulations against closed forms and another integrator; events, bounds and inputs that jump."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from looplab.engine.errors import InvalidInput, NonFinite
from looplab.engine.nonlinear import compile_model
from looplab.engine.nonlinear.simulation import METHODS, InputCourse, noise, simulate_open_loop, table
from looplab.engine.response import held_samples, impulse, pulse, ramp, sine, step
from models import CSTR, model, parameters

TANK = model(
    "(F - beta*sqrt(x))/A", parameters=parameters(A=2.0, beta=0.5), inputs=parameters(F=0.0),
    events=[{"name": "empty", "when": "x <= 0", "action": "stop", "message": "the tank is empty"}],
)  # fmt: skip


@pytest.mark.parametrize("method", METHODS)
def test_a_draining_tank(method):
    """h = (1 - beta t/(2A))^2, empty at t = 2A/beta = 8; the slope vanishes there, so its time is loose."""
    found = simulate_open_loop(compile_model(TANK), np.linspace(0, 20, 401), method=method, rtol=1e-9)
    t = found.t[found.t < 7.9]
    np.testing.assert_allclose(found.x[: t.size, 0], (1 - t / 8) ** 2, atol=3e-8)
    assert found.truncated_at == pytest.approx(8.0, abs=1e-3)
    assert found.truncated_reason == "the tank is empty"
    assert [event.name for event in found.events] == ["empty"]
    assert found.t[-1] == found.truncated_at
    assert found.x.shape == (found.t.size, 1)


@pytest.mark.parametrize("method", METHODS)
def test_logistic_growth(method):
    found = simulate_open_loop(compile_model(model("x*(1 - x)", 0.01)), [0, 1, 5, 20], method=method, rtol=1e-10)
    exact = 0.01 * np.exp(found.t) / (1 + 0.01 * (np.exp(found.t) - 1))
    np.testing.assert_allclose(found.x[:, 0], exact, rtol=1e-7)
    assert found.truncated_at is None


def test_a_stiff_equation():
    """x' = -1e6 (x - cos t): after the first microseconds x = cos(t) + O(1e-6)."""
    t = np.linspace(0, 10, 101)
    found = simulate_open_loop(compile_model(model("-1e6*(x - cos(t))", 2.0)), t)
    L = 1e6
    exact = (L * L * np.cos(t) + L * np.sin(t)) / (L * L + 1) + (2 - L * L / (L * L + 1)) * np.exp(-L * t)
    np.testing.assert_allclose(found.x[:, 0], exact, atol=2e-8)
    assert found.calls < 2000


def test_reactor_against_another_integrator():
    compiled = compile_model(CSTR)
    course = InputCourse(350.0).plus(step(10.0, 3.0))
    t = np.linspace(0, 30, 301)
    found = simulate_open_loop(compiled, t, {"Ti": course}, rtol=1e-10)

    def f(Ti):
        def rhs(_, x):
            r = 7.2e10 * math.exp(-1e4 / x[1]) * x[0]
            return [1 - x[0] - r, Ti - x[1] + 200 * r - 20]

        return rhs

    first = solve_ivp(f(350), (0, 3), [1, 350], method="DOP853", rtol=1e-12, atol=1e-12, t_eval=t[t <= 3])
    second = solve_ivp(f(360), (3, 30), first.y[:, -1], method="DOP853", rtol=1e-12, atol=1e-12, t_eval=t[t >= 3])
    np.testing.assert_allclose(found.x, np.hstack([first.y, second.y[:, 1:]]).T, rtol=1e-8)
    assert found.u[29, 2] == 350 and found.u[30, 2] == 360
    np.testing.assert_allclose(found.y[:, 0], 1 - found.x[:, 0], rtol=1e-12)


def test_every_input_at_once_against_another_integrator():
    course = InputCourse(0.5).plus(
        step(0.2, 3.3), pulse(0.1, 1.0, 4.0), sine(0.05, 2.0, 30.0, 5.0), ramp(0.01, 7.0),
        noise(0.01, 0.7, 20.0, seed=3), held_samples([1.0, 2.5], [0.05, -0.02]),
    )  # fmt: skip
    compiled = compile_model(TANK)
    t = np.linspace(0, 20, 81)
    found = simulate_open_loop(compiled, t, {"F": course}, rtol=1e-11)
    edges = [0.0, *(b for b in course.breakpoints() if 0 < b < 20), 20.0]
    x, expected = 1.0, [1.0]
    for a, b in pairwise(edges):
        inside = np.unique(np.append(t[(t > a) & (t <= b)], b))

        def rhs(s, h, a=a, b=b):
            return (float(course.values(min(max(s, a + 1e-10), b - 1e-10))) - 0.5 * np.sqrt(h)) / 2

        run = solve_ivp(rhs, (a, b), [x], method="DOP853", rtol=1e-12, atol=1e-13, t_eval=inside)
        expected += [value for s, value in zip(run.t, run.y[0], strict=True) if s in t]
        x = run.y[0, -1]
    np.testing.assert_allclose(found.x[:, 0], expected, rtol=2e-9)
    np.testing.assert_array_equal(found.u[:, 0], course.values(t))


def test_a_table_is_absolute_and_holds_its_ends():
    held = table([1, 2, 3], [5, 7, 4])
    assert held.values([0, 1, 1.5, 2, 3, 9]).tolist() == [5, 5, 5, 7, 4, 4]
    joined = table([1, 2, 3], [5, 7, 4], hold="linear")
    assert joined.values([0, 1, 1.5, 2.5, 9]).tolist() == pytest.approx([5, 5, 6, 5.5, 4])
    x = simulate_open_loop(compile_model(model("u", 0.0, inputs=parameters(u=0.0))), [0, 1.5, 4], {"u": joined}).x
    np.testing.assert_allclose(x[:, 0], [0, 5 + 0.5 * 5.5, 5 + 6 + 5.5 + 4], rtol=1e-7)


def test_noise_is_the_same_for_the_same_seed_and_as_large_as_it_says():
    first, again, other = (noise(2.0, 0.1, 150.0, seed) for seed in (5, 5, 6))
    assert np.array_equal(first.starts, again.starts)
    assert not np.array_equal(first.starts, other.starts)
    samples = first.starts[:, 0]
    # 1500 samples: the standard deviation is within 4 of its own deviations, sigma/sqrt(2 n)
    assert abs(samples.std() - 2.0) < 4 * 2.0 / math.sqrt(2 * samples.size)
    assert abs(samples.mean()) < 4 * 2.0 / math.sqrt(samples.size)


def test_runs_are_repeatable():
    compiled, t = compile_model(CSTR), np.linspace(0, 20, 101)
    course = {"Ti": InputCourse(350.0).plus(noise(3.0, 0.5, 20.0, seed=1))}
    first, second = (simulate_open_loop(compiled, t, course) for _ in range(2))
    assert np.array_equal(first.x, second.x)
    assert first.calls == second.calls


@pytest.mark.parametrize("method", METHODS)
def test_a_reported_event_is_located(method):
    document = {**TANK, "events": [
        {"name": "half", "when": "x < 0.5"}, {"name": "quarter", "when": "0.25 >= x", "action": "report"},
    ]}  # fmt: skip
    found = simulate_open_loop(compile_model(document), [0, 7], method=method, rtol=1e-9)
    assert [event.name for event in found.events] == ["half", "quarter"]
    assert [event.t for event in found.events] == pytest.approx([8 * (1 - math.sqrt(0.5)), 4.0], abs=1e-6)
    assert [event.x[0] for event in found.events] == pytest.approx([0.5, 0.25], abs=1e-9)
    assert found.truncated_at is None
    assert found.x[-1, 0] == pytest.approx((1 - 7 / 8) ** 2, abs=1e-8)


def test_an_event_happens_each_time_it_turns_on():
    document = model(["x2", "-x1"], [0.0, 1.0], events=[{"name": "up", "when": "x1 > 0.5"}])
    found = simulate_open_loop(compile_model(document), np.linspace(0, 20, 201))
    assert [event.t for event in found.events] == pytest.approx(
        [math.pi / 6 + 2 * math.pi * k for k in range(4)], abs=1e-7
    )


def test_an_input_that_jumps_turns_an_event_on_at_once():
    document = model("0", inputs=parameters(u=0.0), events=[{"name": "high", "when": "u > 1", "action": "stop"}])
    found = simulate_open_loop(compile_model(document), [0, 1, 2, 3], {"u": InputCourse(0.0).plus(step(2.0, 1.7))})
    assert found.truncated_at == 1.7
    assert found.truncated_reason == "high: u > 1"
    assert found.t.tolist() == [0, 1, 1.7]


def test_an_event_that_is_on_from_the_start_has_not_happened():
    found = simulate_open_loop(compile_model({**TANK, "events": [{"name": "low", "when": "x < 2"}]}), [0, 1])
    assert found.events == ()


def test_a_state_is_kept_to_its_bounds():
    document = model("x", 1.0)
    document["states"][0] |= {"min": -1, "max": 10, "unit": "K"}
    found = simulate_open_loop(compile_model(document), np.linspace(0, 5, 51))
    assert found.truncated_at == pytest.approx(math.log(10), abs=1e-7)
    assert found.truncated_reason == "x passes its upper bound, 10 K"
    assert found.x[-1, 0] == pytest.approx(10, rel=1e-7)
    with pytest.raises(InvalidInput) as caught:
        simulate_open_loop(compile_model(document), [0, 1], initial={"x": 11})
    assert caught.value.field == "initial.x"


def test_short_steps_where_a_long_one_leaves_the_domain():
    """The solver's own step is long past the end of the horizon, where sqrt(x) has no value."""
    found = simulate_open_loop(compile_model({**TANK, "events": []}), np.linspace(0, 7.9, 80))
    assert found.truncated_at is None
    np.testing.assert_allclose(found.x[:, 0], (1 - found.t / 8) ** 2, atol=1e-7)


def test_parameters_and_initial_states():
    compiled = compile_model(TANK)
    found = simulate_open_loop(compiled, [0, 1], parameters={"A": 4.0}, initial={"x": 4.0})
    assert found.x[-1, 0] == pytest.approx((2 - 0.5 / 8) ** 2, rel=1e-8)
    assert np.array_equal(found.x, simulate_open_loop(compiled, [0, 1], parameters={"A": 4.0}, initial=[4.0]).x)


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({"times": [0]}, "times"),
        ({"times": [0, 0]}, "times"),
        ({"times": [0, math.nan]}, "times"),
        ({"times": np.linspace(0, 1, 5001)}, "times"),
        ({"inputs": {"Ti": math.inf}}, "inputs.Ti"),
        ({"inputs": {"Tj": 1.0}}, "inputs.Tj"),
        ({"inputs": {"Tj": InputCourse(1.0)}}, "inputs.Tj"),
        ({"parameters": {"q": 1.0}}, "parameters.q"),
        ({"initial": [1.0]}, "initial"),
        ({"initial": {"z": 1.0}}, "initial.z"),
        ({"method": "Euler"}, "method"),
        ({"rtol": 1.0}, "rtol"),
        ({"atol": -1.0}, "atol"),
    ],
)
def test_bad_arguments_are_named(arguments, field):
    with pytest.raises(InvalidInput) as caught:
        simulate_open_loop(compile_model(CSTR), **{"times": [0, 1], **arguments})
    assert caught.value.field == field


def test_signals_that_make_no_sense_are_refused():
    with pytest.raises(InvalidInput, match="an impulse has no meaning"):
        InputCourse(0.0).plus(impulse(1.0))
    with pytest.raises(InvalidInput, match="2000 samples"):
        noise(1.0, 0.001, 100.0)
    limited = compile_model(model("u", inputs=[{"name": "u", "value": 0, "min": -1, "max": 1}]))
    with pytest.raises(InvalidInput, match="at most 1"):
        simulate_open_loop(limited, [0, 1], {"u": InputCourse(0.0).plus(step(2.0, 0.5))})


def test_an_equation_without_a_value_at_the_start_is_an_error():
    with pytest.raises(NonFinite, match="log of -1"):
        simulate_open_loop(compile_model(model("log(x - 2)")), [0, 1])


def test_an_output_without_a_value_cuts_the_response():
    document = model("-1", 1.0, outputs=[{"name": "y", "expression": "log(x)"}])
    found = simulate_open_loop(compile_model(document), [0, 0.5, 0.9, 1.5, 2])
    assert found.t.tolist() == [0, 0.5, 0.9]
    assert found.y[:, 0] == pytest.approx(np.log([1, 0.5, 0.1]), rel=1e-7)
    assert found.truncated_at == 1.5
    assert "log of -0.5" in found.truncated_reason
