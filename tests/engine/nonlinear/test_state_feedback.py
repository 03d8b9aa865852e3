"""The cart-pendulum under state feedback, against its equations written by hand."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from looplab.engine.design.state_feedback import (
    ByPoles,
    DesignSettings,
    Faster,
    Push,
    design_state_feedback,
    linear_loop,
    linear_run,
)
from looplab.engine.nonlinear.state_feedback.simulation import FeedbackLoop, explore_region, run_feedback
from looplab.engine.nonlinear.steady_states import linearize, steady_state_near
from looplab.engine.state_space import StateSpaceModel
from looplab.plants import load_plant

PENDULUM = load_plant("cart-pendulum")
UPRIGHT = linearize(PENDULUM, (0.0,) * 4, PENDULUM.u0, PENDULUM.p0)
J = UPRIGHT.jacobians
MODEL = StateSpaceModel(J.A, J.B, J.C, J.D)
POLES = ByPoles((-2 + 1j, -2 - 1j, -5, -6))


def loop(observer=None, integral=False, limit=None, controlled=(1,), x_end=1.2):
    settings = DesignSettings(
        POLES if not integral else ByPoles((*POLES.poles, -1)), observer, (0, 1), controlled, integral
    )
    point = linearize(PENDULUM, (0.0,) * 4, PENDULUM.u0, PENDULUM.parameters({"x_end": x_end}))
    limits = None if limit is None else np.array([[-limit, limit]])
    return FeedbackLoop(PENDULUM, point, design_state_feedback(MODEL, settings), (0,), limits)


def by_hand(x, F):
    """Newton and Euler for cart and rod: two equations for the two accelerations, solved by Cramer's rule."""
    M, m, mu, length, J, gamma, g = 0.5, 0.2, 0.1, 0.3, 0.006, 0.01, 9.8
    _, v, phi, omega = x
    # (M + m) a + m l cos(phi) alpha = p and m l cos(phi) a + (J + m l^2) alpha = q
    a11, a12, a22 = M + m, m * length * np.cos(phi), J + m * length**2
    p = F - mu * v + m * length * omega**2 * np.sin(phi)
    q = m * g * length * np.sin(phi) - gamma * omega
    det = a11 * a22 - a12 * a12
    return [v, (p * a22 - a12 * q) / det, omega, (a11 * q - a12 * p) / det]


def test_the_upright_poles_are_those_of_the_notes():
    assert np.sort(MODEL.poles.real) == pytest.approx([-5.876, -0.143, 0.0, 5.307], abs=1e-3)


@pytest.mark.parametrize("observer", [None, Faster(2.0)])
def test_it_is_caught_from_fifteen_degrees(observer):
    under = loop(observer, limit=20.0)
    K, L = under.found.K[0], under.found.L
    tilt = np.deg2rad(15)
    t = np.linspace(0, 7, 141)

    def force(z):
        return -K @ (z[:4] if L is None else z[4:])

    def rhs(_, z, d):
        F = force(z)
        plant = by_hand(z[:4], F + d)
        return plant if L is None else [*plant, *(J.A @ z[4:] + J.B[:, 0] * F + L @ (z[[2, 0]] - z[[6, 4]]))]

    start = np.zeros(4 if L is None else 8)
    start[2] = tilt
    parts, z = [], start
    for begin, end, d in ((0, 2.0, 0.0), (2.0, 2.1, 3.0), (2.1, 7.0, 0.0)):
        inside = t[(t >= begin) & (t < end)] if end < 7 else t[t >= begin]
        found = solve_ivp(rhs, (begin, end), z, "DOP853", np.unique([*inside, end]), args=(d,), rtol=1e-12, atol=1e-13)
        parts.append(found.y[:, : inside.size])
        z = found.y[:, -1]
    expected = np.hstack(parts).T
    run = run_feedback(under, t, {"phi": tilt}, pushes=[Push(np.array([3.0]), 2.0, 0.1)], rtol=1e-11)
    assert run.outcome == "caught"
    assert np.abs(run.u).max() < 20
    assert run.x == pytest.approx(expected[:, :4], abs=1e-8)
    assert run.u[:, 0] == pytest.approx([force(z) for z in expected], abs=1e-7)
    if L is not None:
        assert run.estimate == pytest.approx(expected[:, 4:], abs=1e-8)


def test_from_sixty_degrees_it_runs_off_the_track_or_falls():
    tilt = {"phi": np.deg2rad(60)}
    t = np.linspace(0, 6, 301)
    rail = run_feedback(loop(limit=20.0), t, tilt)
    assert rail.outcome == "end_of_track"
    assert abs(rail.x[-1, 0]) == pytest.approx(1.2, abs=1e-9)
    assert run_feedback(loop(limit=10.0), t, tilt).outcome == "fallen"


def test_the_limits_cut_the_force_and_the_linear_prediction_is_near_for_small_tilts():
    t = np.linspace(0, 4, 201)
    cut = run_feedback(loop(limit=5.0), t, {"phi": 0.26})
    assert np.abs(cut.u).max() == pytest.approx(5.0, abs=1e-12)
    assert np.abs(cut.command).max() > 6
    small = run_feedback(loop(), t, {"phi": 0.01}, np.array([0.02]))
    linear = linear_run(linear_loop(loop().found), t, np.array([0, 0, 0.01, 0]), np.array([0.02]))
    # what is left out is of third order
    assert np.abs(small.x - linear.x).max() < 3e-5
    assert small.x[-1, 0] == pytest.approx(linear.x[-1, 0], abs=1e-6)


def test_integrators_hold_the_cart_against_a_push_that_stays():
    t = np.linspace(0, 15, 151)
    push = [Push(np.array([1.0]), 1.0, 100.0)]
    held = run_feedback(loop(integral=True), t, {}, np.array([0.3]), push)
    assert held.x[-1] == pytest.approx([0.3, 0, 0, 0], abs=1e-3)
    assert abs(run_feedback(loop(), t, {}, np.array([0.3]), push).x[-1, 0] - 0.3) > 0.2


def test_the_region_agrees_with_runs_by_hand():
    under = loop(limit=10.0)
    K = under.found.K[0]
    starts = [(0.2, 0.0), (0.6, 0.0), (0.9, 0.0), (1.05, 0.0), (0.9, -5.0), (-0.5, 5.0), (-0.5, -5.0)]

    def end(_, z):
        return abs(z[0]) - 1.2

    def fall(_, z):
        return np.cos(z[2])

    end.terminal = True
    names, expected = ("end_of_track", "fallen"), []
    for phi, omega in starts:
        found = solve_ivp(
            lambda _, z: by_hand(z, np.clip(-K @ z, -10, 10)), (0, 6), [0, 0, phi, omega], "DOP853",
            events=[end, fall], rtol=1e-9, atol=1e-9, max_step=0.02,
        )  # fmt: skip
        happened = sorted((times[0], name) for times, name in zip(found.t_events, names, strict=True) if times.size)
        expected.append(happened[0][1] if happened else "caught")
    assert set(expected) == {"caught", "end_of_track", "fallen"}
    assert explore_region(under, 6.0, ("phi", "omega"), starts) == expected


def test_what_begins_at_rest_is_caught_where_rest_is_known_to_rounding():
    reactor = load_plant("cstr")
    at = reactor.document.operating_points[0]
    u, p = reactor.inputs(at.inputs), reactor.parameters(at.parameters)
    point = linearize(reactor, steady_state_near(reactor, u, p, reactor.states(at.near, reactor.x0)).x, u, p)
    assert (point.poles.real > 0).any()
    Q = [reactor.input_names.index("Q")]
    model = StateSpaceModel(point.jacobians.A, point.jacobians.B[:, Q], point.jacobians.C, point.jacobians.D[:, Q])
    found = design_state_feedback(model, DesignSettings(ByPoles((-2, -3)), None, (), (), False))
    under = FeedbackLoop(reactor, point, found, tuple(Q), np.array([[0, 2e7]]))
    T = point.x[reactor.state_names.index("T")]
    assert explore_region(under, 6.0, ("T", "cA"), [(T, point.x[0]), (T + 20, point.x[0])]) == ["caught", "caught"]
