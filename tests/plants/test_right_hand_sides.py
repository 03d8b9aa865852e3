"""Every plant against its equations written by hand: derivatives by a complex step, runs by another integrator."""

import numpy as np
import pytest

from looplab.engine.nonlinear.simulation import InputCourse, simulate_open_loop
from looplab.engine.response import step
from looplab.plants import load_plant
from plants import RUNS, integrate

H = 1e-30


def values(model, inputs, parameters):
    u, p = model.inputs(inputs), model.parameters(parameters)
    named = (dict(zip(names, v, strict=True)) for names, v in ((model.input_names, u), (model.parameter_names, p)))
    return u, p, *named


def slope(function, at, name):
    """d function / d at[name] by a complex step."""
    return np.imag(function({**at, name: complex(at[name], H)})) / H


def states_to_try(model, run):
    """The states of the run: with its inputs, at its start, in between and at its end."""
    x = integrate(run, model, np.array([0.0, 0.31 * run.at, run.at, 0.5 * (run.at + run.horizon), run.horizon]))
    return [(x[1], run.inputs), (x[3], run.inputs | run.later), (x[4], run.inputs | run.later)]


def check_derivatives(model, run, x, inputs):
    u, p, named_u, named_p = values(model, inputs, run.parameters)
    named_x = dict(zip(model.state_names, x, strict=True))
    found = model.jacobians(0.0, x.tolist(), u, p)
    f = np.array(run.f(x, named_u, named_p))
    assert np.array(model.f(0.0, x.tolist(), u, p)) == pytest.approx(f, rel=1e-10, abs=1e-12 * np.abs(f).max())
    A = [slope(lambda at: run.f(list(at.values()), named_u, named_p), named_x, name) for name in named_x]
    B = [slope(lambda at: run.f(x, at, named_p), named_u, name) for name in named_u]
    assert found.A == pytest.approx(np.array(A).T, rel=1e-10, abs=1e-13 * np.abs(A).max())
    assert found.B == pytest.approx(np.array(B).T, rel=1e-10, abs=1e-13 * np.abs(B).max())
    for name in named_p:
        by_step = slope(lambda at: run.f(x, named_u, at), named_p, name)
        exact = model.sensitivity(name)(0.0, x.tolist(), u, p)
        # what is left where the terms of a balance cancel
        rounding = 1e-14 * np.abs(A).max() * np.abs(x).max() / abs(named_p[name])
        assert exact == pytest.approx(by_step, rel=1e-10, abs=rounding), name


@pytest.mark.parametrize("plant_id", RUNS)
def test_derivatives(plant_id):
    model, run = load_plant(plant_id), RUNS[plant_id]
    for x, inputs in states_to_try(model, run):
        check_derivatives(model, run, x, inputs)


@pytest.mark.parametrize("plant_id", RUNS)
def test_a_run(plant_id):
    model, run = load_plant(plant_id), RUNS[plant_id]
    times = np.union1d(np.linspace(0.0, run.horizon, 61), [run.at])
    nominal = dict(zip(model.input_names, model.u0, strict=True)) | run.inputs
    courses = {
        name: InputCourse(float(level)).plus(step(run.later.get(name, level) - level, run.at))
        for name, level in nominal.items()
    }
    found = simulate_open_loop(
        model, times, courses, run.parameters, run.start or None, rtol=1e-12, atol=1e-14, budget=10**7
    )
    assert found.truncated_reason is None
    expected = integrate(run, model, times)
    assert (np.abs(found.x - expected).max(axis=0) / np.abs(expected).max(axis=0)).max() < 1e-8


@pytest.mark.parametrize("plant_id", RUNS)
def test_operating_points_are_steady(plant_id):
    """Newton's method from ``near`` stays near, and balances the equations written by hand."""
    model = load_plant(plant_id)
    points = model.document.operating_points
    assert points
    for point in points:
        u, p, named_u, named_p = values(model, point.inputs, point.parameters)
        assert set(point.near) == set(model.state_names)
        near = np.array(model.states(point.near, model.x0))
        x = near.copy()
        for _ in range(50):
            # least squares: a reactor rests at any volume, a cart anywhere on its track
            f = np.array(model.f(0.0, x.tolist(), u, p))
            x -= np.linalg.lstsq(model.state_jacobian(0.0, x.tolist(), u, p), f, rcond=1e-12)[0]
        assert np.abs(x - near) == pytest.approx(0.0, abs=0.02 * np.abs(near).max()), point.name
        scale = max(1.0, np.abs(x).max()) * np.abs(model.state_jacobian(0.0, x.tolist(), u, p)).max()
        assert np.array(RUNS[plant_id].f(x, named_u, named_p)) == pytest.approx(0.0, abs=1e-13 * scale), point.name
