"""Gains against closed forms, python-control and Ackermann's formula at 60 digits; the loop against its definition."""

import control
import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import place_poles as scipy_place_poles

from looplab.engine.design.state_feedback import (
    ByPoles,
    ByWeights,
    DesignSettings,
    Faster,
    Push,
    design_state_feedback,
    linear_loop,
    linear_run,
    loop_transfer,
    lqr,
    place_poles,
    reference_gain,
    separated_poles,
    whole_loop_poles,
    with_integrators,
)
from looplab.engine.errors import InvalidInput
from looplab.engine.frequency import margins
from looplab.engine.state_space import StateSpaceModel

CART = StateSpaceModel([[0, 1], [0, 0]], [[0], [1]], [[1, 0]])


def random_model(seed: int, n: int, m: int, p: int) -> StateSpaceModel:
    rng = np.random.default_rng(seed)
    return StateSpaceModel(rng.normal(size=(n, n)), rng.normal(size=(n, m)), rng.normal(size=(p, n)))


def ackermann(A, B, poles):
    """K = (0 ... 0 1) C^-1 phi(A) in 60 digits."""
    n = len(poles)
    with mpmath.workdps(60):
        a, b = mpmath.matrix(A.tolist()), mpmath.matrix(B.tolist())
        columns, power, phi = [b], b, mpmath.eye(n)
        for _ in range(n - 1):
            power = a * power
            columns.append(power)
        C = mpmath.matrix(n, n)
        for j, column in enumerate(columns):
            for i in range(n):
                C[i, j] = column[i]
        for pole in poles:
            phi = phi * (a - mpmath.mpc(pole) * mpmath.eye(n))
        row = mpmath.matrix(1, n)
        row[n - 1] = 1
        K = row * C**-1 * phi
        return np.array([float(mpmath.re(K[j])) for j in range(n)])


def test_a_double_integrator_by_hand():
    # s^2 + k2 s + k1: (s + 1)^2 + 1, (s + 1)^2; the observer s^2 + l1 s + l2 = (s + 3)^2
    assert place_poles(CART.A, CART.B, [-1 + 1j, -1 - 1j]).K == pytest.approx(np.array([[2, 2]]), abs=1e-14)
    twice = place_poles(CART.A, CART.B, [-1, -1])
    assert twice.K == pytest.approx(np.array([[1, 2]]), abs=1e-14)
    assert twice.condition > 1e7
    assert place_poles(CART.A.T, CART.C.T, [-3, -3]).K == pytest.approx(np.array([[6, 9]]), abs=1e-13)
    # x1^2 + u^2: P = [[sqrt 2, 1], [1, sqrt 2]]
    best = lqr(CART.A, CART.B, np.diag([1.0, 0.0]), np.eye(1))
    assert best.K == pytest.approx(np.array([[1, np.sqrt(2)]]), abs=1e-13)
    assert best.P == pytest.approx(np.array([[np.sqrt(2), 1], [1, np.sqrt(2)]]), abs=1e-13)
    # y = x1 comes to rest at r where u = -k1 (x1 - r) - k2 x2
    assert reference_gain(CART, best.K, [0]) == pytest.approx(np.array([[1.0]]), abs=1e-14)


@pytest.mark.parametrize("seed", range(4))
def test_one_input_gives_the_gain_of_ackermann_at_high_precision(seed):
    n = 3 + 2 * seed
    model = random_model(seed, n, 1, 1)
    # a triple pole among them
    poles = [-1.0, -1.0, -1.0, *(q for k in range((n - 3) // 2) for q in (complex(-1 - k, 2), complex(-1 - k, -2)))]
    found = place_poles(model.A, model.B, poles)
    expected = ackermann(model.A, model.B, poles)
    assert found.K[0] == pytest.approx(expected, rel=1e-8, abs=1e-9 * np.abs(expected).max())
    assert np.poly(model.A - model.B @ found.K) == pytest.approx(np.poly(poles).real, rel=1e-6)


def test_several_inputs_give_the_poles_and_agree_with_python_control():
    model = random_model(7, 5, 2, 1)
    poles = [-2, -2, -1 + 1j, -1 - 1j, -4]
    found = place_poles(model.A, model.B, poles)
    assert np.poly(model.A - model.B @ found.K) == pytest.approx(np.poly(poles).real, rel=1e-9)
    assert found.error < 1e-6
    best = scipy_place_poles(model.A, model.B, np.array(poles), method="YT").gain_matrix
    # the freedom goes into the eigenvectors, about as well as the method of Tits and Yang spends it
    assert found.condition < 2 * np.linalg.cond(np.linalg.eig(model.A - model.B @ best)[1])
    with pytest.raises(InvalidInput, match="a pole stands 3 times"):
        place_poles(model.A, model.B, [-1, -1, -1, -2, -3])
    K, _, E = control.lqr(model.A, model.B, np.diag([1.0, 2, 3, 4, 5]), np.diag([1.0, 0.2]))
    best = lqr(model.A, model.B, np.diag([1.0, 2, 3, 4, 5]), np.diag([1.0, 0.2]))
    assert best.K == pytest.approx(np.array(K), rel=1e-9, abs=1e-9)
    assert np.sort_complex(best.poles) == pytest.approx(np.sort_complex(E), rel=1e-9)
    assert best.residual < 1e-12
    noisy = random_model(8, 4, 1, 2)
    L = control.lqe(noisy.A, np.eye(4), noisy.C, np.diag([1.0, 2, 3, 4]), np.diag([0.5, 2]))[0]
    filtered = lqr(noisy.A.T, noisy.C.T, np.diag([1.0, 2, 3, 4]), np.diag([0.5, 2]), dual=True)
    assert filtered.K.T == pytest.approx(np.array(L), rel=1e-9, abs=1e-9)


def test_inputs_that_say_the_same_count_as_one():
    B = np.array([[0.0, 0.0], [1.0, -2.0]])
    found = place_poles(CART.A, B, [-1, -1])
    assert np.poly(CART.A - B @ found.K) == pytest.approx([1, 2, 1], abs=1e-13)


def test_a_mode_that_no_input_moves_is_refused_by_name_and_can_be_kept():
    model = StateSpaceModel([[-1, 0, 0], [0, 0, 1], [0, 0, 0]], [[0], [0], [1]], [[1, 1, 0]])
    with pytest.raises(InvalidInput, match=r"the mode at s = -1 is uncontrollable") as caught:
        place_poles(model.A, model.B, [-2, -3, -4])
    assert caught.value.hint == "put -1 among the poles to keep it"
    found = place_poles(model.A, model.B, [-2, -1, -3])
    assert found.kept == pytest.approx(np.array([-1.0]))
    assert found.K == pytest.approx(np.array([[0, 6, 5]]), abs=1e-12)
    with pytest.raises(InvalidInput, match=r"the mode at s = 0 is unobservable"):
        place_poles(CART.A.T, np.array([[0.0], [1.0]]), [-1, -2], dual=True)
    with pytest.raises(InvalidInput, match="does not decay"):
        lqr(np.array([[1.0, 0], [0, -1]]), np.array([[0.0], [1]]), np.eye(2), np.eye(1))
    with pytest.raises(InvalidInput, match="costs nothing"):
        lqr(CART.A, CART.B, np.diag([0.0, 1.0]), np.eye(1))


@pytest.mark.parametrize("poles", [[-1], [-1, 2 + 1j], [-1e9, -1]])
def test_poles_that_cannot_be_meant_are_refused(poles):
    with pytest.raises(InvalidInput) as caught:
        place_poles(CART.A, CART.B, poles)
    assert caught.value.field == "poles"


@pytest.mark.parametrize("seed", range(3))
def test_feedback_and_observer_are_separate(seed):
    model = random_model(20 + seed, 4, 1 + seed % 2, 2)
    weights = ByWeights(np.eye(5), np.eye(model.inputs))
    found = design_state_feedback(model, DesignSettings(weights, Faster(3.0), (0, 1), (1,), True))
    loop = linear_loop(found)
    expected = separated_poles(found)
    assert whole_loop_poles(loop.A, found) == pytest.approx(expected, rel=1e-6, abs=1e-6)
    assert (expected.real < 0).all()
    # the observer's are those of A - L C by the definition
    assert np.poly(model.A - found.L @ model.C) == pytest.approx(np.poly(found.observer.obtained).real, rel=1e-8)


@pytest.mark.parametrize("seed", range(3))
def test_a_regulator_keeps_its_distance_and_an_observer_loses_it(seed):
    model = random_model(40 + seed, 3, 1, 1)
    weights = ByWeights(np.eye(3), np.eye(1))
    bare = loop_transfer(linear_loop(design_state_feedback(model, DesignSettings(weights, None, (), (), False))))
    omega = np.geomspace(1e-4, 1e4, 400)
    K = lqr(model.A, model.B, np.eye(3), np.eye(1)).K
    direct = np.array([(K @ np.linalg.solve(1j * w * np.eye(3) - model.A, model.B))[0, 0] for w in omega])
    assert bare.response(omega) == pytest.approx(direct, rel=1e-7, abs=1e-12)
    assert np.abs(1 + direct).min() >= 1 - 1e-9
    found = margins(bare)
    assert found.closed_loop_stable
    assert found.PM_deg is None or found.PM_deg >= 60 - 1e-6
    seen = DesignSettings(weights, Faster(10.0), (0,), (), False)
    watched = margins(loop_transfer(linear_loop(design_state_feedback(model, seen))))
    assert watched.closed_loop_stable
    assert watched.Ms > 1.05


def test_a_run_with_observer_integrator_setpoint_and_push_solves_its_equations():
    model = StateSpaceModel([[0, 1], [-2, -0.5]], [[0], [1]], [[1, 0]], [[0.3]])
    settings = DesignSettings(ByPoles((-1, -2 + 1j, -2 - 1j)), ByPoles((-5, -5)), (0,), (0,), True)
    found = design_state_feedback(model, settings)
    A, B, C, D = model.A, model.B[:, 0], model.C[0], 0.3

    def rhs(t, z, d):
        x, integral, estimate = z[:2], z[2], z[3:]
        u = -found.K[0] @ estimate + found.K_I[0, 0] * integral
        y = C @ x + D * (u + d)
        observed = A @ estimate + B * u + found.L[:, 0] * (y - C @ estimate - D * u)
        return [*(A @ x + B * (u + d)), 0.7 - y, *observed]

    t = np.linspace(0, 8, 41)
    z, states = np.array([0.5, -0.2, 0, 0, 0]), []
    for begin, end, d in ((0, 1.05, 0.0), (1.05, 2.5, 2.0), (2.5, 8.0, 0.0)):
        inside = t[(t >= begin) & (t < end)] if end < 8 else t[t >= begin]
        part = solve_ivp(rhs, (begin, end), z, "DOP853", np.unique([*inside, end]), args=(d,), rtol=1e-13, atol=1e-13)
        states.append(part.y[:, : inside.size])
        z = part.y[:, -1]
    expected = np.hstack(states).T
    run = linear_run(linear_loop(found), t, np.array([0.5, -0.2]), np.array([0.7]), [Push(np.array([2.0]), 1.05, 1.45)])
    assert run.x == pytest.approx(expected[:, :2], abs=1e-10)
    assert run.estimate == pytest.approx(expected[:, 3:], abs=1e-10)
    late = linear_run(
        linear_loop(found), np.array([0.0, 60.0]), np.zeros(2), np.array([0.7]), [Push(np.ones(1), 1, 99)]
    )
    # the integrator leaves no error behind a load that stays
    assert late.y[-1, 0] == pytest.approx(0.7, abs=1e-9)


def test_a_setpoint_is_met_by_the_gain_and_a_zero_at_the_origin_is_refused():
    model = random_model(3, 4, 2, 3)
    settings = DesignSettings(ByWeights(np.eye(4), np.eye(2)), None, (), (0, 2), False)
    loop = linear_loop(design_state_feedback(model, settings))
    run = linear_run(loop, np.array([0.0, 400.0]), np.zeros(4), np.array([1.0, -2.0]))
    assert run.y[-1, [0, 2]] == pytest.approx([1, -2], abs=1e-8)
    # y = the speed of a cart that a spring holds
    spring = StateSpaceModel([[0, 1], [-1, -1]], [[0], [1]], [[0, 1]])
    assert (
        "zero at s = 0"
        in design_state_feedback(spring, DesignSettings(ByPoles((-1, -2)), None, (), (0,), False)).N_reason
    )
    with pytest.raises(InvalidInput, match="zero at s = 0"):
        with_integrators(spring, [0])
