"""Several loops over time, against an integration of hand-written equations, and against what must hold."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from looplab.engine.delays.lattice import Lattice, common_time
from looplab.engine.delays.steps import Steps
from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
from looplab.engine.mimo import Change, MultiLoop, simulate_loops
from processes import library, matrix

# W. L. Luyben, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 654-660: BLT settings.
WOOD_BERRY = MultiLoop(library("wood-berry"), (0, 1), (PID(0.375, 8.29), PID(-0.075, 23.6)), (True, True))


def wood_berry_by_hand(horizon, r1):
    """Wood and Berry's column under two PI controllers after a step of r1: own equations, minute by minute.

    All dead times are whole minutes, so that u is smooth inside of every minute, and known where it is needed.
    """
    past = []

    def u(t):
        if t < 0:
            return np.zeros(2)
        # The minute that holds t, from its left end on.
        return past[min(int(t + 1e-12), len(past) - 1)](t)

    def outputs(x):
        return x[0] + x[1], x[2] + x[3]

    def rate(t, x, delayed):
        y1, y2 = outputs(x)
        a, b, c, d = delayed(t)
        return [
            (12.8 * a - x[0]) / 16.7,
            (-18.9 * b - x[1]) / 21.0,
            (6.6 * c - x[2]) / 10.9,
            (-19.4 * d - x[3]) / 14.4,
            r1 - y1,
            0.0 - y2,
        ]

    x, pieces = np.zeros(6), []
    for minute in range(horizon):
        middle = minute + 0.5

        def delayed(t, middle=middle):
            def at(theta, i):
                return past[int(middle - theta)](t - theta)[i] if middle > theta else 0.0

            return at(1, 0), at(3, 1), at(7, 0), at(3, 1)

        found = solve_ivp(
            rate, (minute, minute + 1), x, "DOP853", dense_output=True, rtol=1e-12, atol=1e-13, args=(delayed,)
        )
        x = found.y[:, -1]
        pieces.append(found.sol)

        def control(t, sol=found.sol):
            state = sol(t)
            y1, y2 = outputs(state)
            return np.array([0.375 * (r1 - y1 + state[4] / 8.29), -0.075 * (-y2 + state[5] / 23.6)])

        past.append(control)
    t = np.linspace(0, horizon, 8 * horizon + 1)[:-1]
    y = np.array([outputs(pieces[int(at)](at)) for at in t])
    return t, y, np.array([u(at) for at in t])


def test_two_loops_with_dead_times_against_equations_by_hand():
    t, y, u = wood_berry_by_hand(40, 0.8)
    found = simulate_loops(WOOD_BERRY, [Change("setpoint", 0, 0.8)], 40.0, 321)
    assert found.t[:-1] == pytest.approx(t)
    assert found.y[:-1] == pytest.approx(y, abs=1e-8)
    assert found.u[:-1] == pytest.approx(u, abs=1e-8)
    assert np.abs(y[:, 1]).max() > 0.1


@pytest.mark.parametrize("plant", ["ethanol-water", "vinante-luyben"])
def test_windows_and_breakpoints_agree(plant):
    process = library(plant)
    signs = np.sign(np.diagonal(process.gains()))
    loops = MultiLoop(process, (0, 1), (PID(0.4 * signs[0], 8.0, 1.0), PID(0.4 * signs[1], 9.0)), (True, True))
    windows, pieces = Lattice.of(loops.system, 25.0), Steps(loops.system, 25.0)
    assert windows is not None
    t = np.linspace(0, 25, 307)
    assert windows.outputs(t) == pytest.approx(pieces.outputs(t)[0], abs=1e-9)


def test_dead_times_without_a_common_divisor():
    assert common_time(np.array([2.6, 1.0, 9.2])) == pytest.approx(0.2)
    assert common_time(np.array([1.0, np.sqrt(2)])) is None
    process = matrix([["exp(-s)/(5s+1)", "0.3exp(-1.41421356237s)/(4s+1)"], ["0.2/(3s+1)", "exp(-0.7s)/(6s+1)"]])
    loops = MultiLoop(process, (0, 1), (PID(1.0, 5.0), PID(1.0, 6.0)), (True, True))
    assert Lattice.of(loops.system, 30.0) is None
    found = simulate_loops(loops, [Change("setpoint", 0, 1.0)], 60.0, 200)
    assert found.y[-1] == pytest.approx([1.0, 0.0], abs=5e-3)


def test_without_crossing_effects_each_loop_is_a_loop_of_its_own():
    process = matrix([["2exp(-s)/(5s+1)", "0"], ["0", "-1exp(-2s)/(3s+1)"]])
    controllers = (PID(0.8, 5.0, 0.4, beta=0.5), PID(0.6, 3.0, action="direct"))
    loops = MultiLoop(process, (0, 1), controllers, (True, True))
    changes = [Change("setpoint", 0, 1.0), Change("load", 1, 2.0, 10.0)]
    found = simulate_loops(loops, changes, 30.0, 301)
    for i, (path, own) in enumerate((("setpoint", 1.0), ("load", 2.0))):
        alone = closed_loop_step(FeedbackLoop(process.entries[i][i], controllers[i]), 30.0, 301)
        one = getattr(alone, path)
        late = 0 if i == 0 else 100
        assert found.y[late:, i] == pytest.approx(own * one.y[: 301 - late], abs=1e-9)
        assert found.u[late:, i] == pytest.approx(own * one.u[: 301 - late], abs=1e-9)
    assert (found.y[:100, 1] == 0).all()


def test_a_loop_in_manual_holds_its_input():
    half = WOOD_BERRY.with_loop(1, False)
    found = simulate_loops(half, [Change("setpoint", 0, 1.0), Change("manual", 1, 0.1, 5.0)], 200.0, 401)
    assert found.u[:10, 1] == pytest.approx(0.0) and found.u[10:, 1] == pytest.approx(0.1)
    # y1 ends at its setpoint, and y2 where the gains put it.
    u1 = (1.0 + 18.9 * 0.1) / 12.8
    assert found.y[-1] == pytest.approx([1.0, 6.6 * u1 - 1.94], abs=1e-4)
    with pytest.raises(InvalidInput, match="manual") as refused:
        simulate_loops(half, [Change("setpoint", 1, 1.0)], 10.0)
    assert refused.value.field == "changes[0].kind"


def test_pairing_across_is_another_order_of_the_inputs():
    process = library("quadruple-tank-crossed")
    controllers = (PID(0.8, 60.0), PID(0.7, 70.0))
    across = MultiLoop(process, (1, 0), controllers, (True, True))
    straight = MultiLoop(process.paired((1, 0)), (0, 1), controllers, (True, True))
    one = simulate_loops(across, [Change("setpoint", 0, 1.0), Change("load", 1, 0.5)], 400.0, 200)
    other = simulate_loops(straight, [Change("setpoint", 0, 1.0), Change("load", 0, 0.5)], 400.0, 200)
    assert one.y == pytest.approx(other.y, abs=1e-11) and one.u[:, ::-1] == pytest.approx(other.u, abs=1e-11)


def test_unstable_loops_are_cut_and_named():
    wild = MultiLoop(library("wood-berry"), (0, 1), (PID(5.0, 2.0), PID(-2.0, 2.0)), (True, True))
    assert wild.verdict.verdict == "unstable"
    found = simulate_loops(wild, [Change("setpoint", 0, 1.0)], 400.0, 200)
    assert found.truncated_at is not None and found.t[-1] < found.truncated_at and "unstable" in found.truncated_reason


def test_verdicts_of_integrating_processes():
    # Both entries of a level's row integrate: one integrator seen twice, and held by its loop.
    process = matrix([["1exp(-s)/s", "-0.5exp(-s)/s"], ["0.2/(2s+1)", "1/(3s+1)"]])
    loops = MultiLoop(process, (0, 1), (PID(0.2, 10.0), PID(1.0, 3.0)), (True, True))
    assert loops.verdict.closed_loop_stable
    assert loops.with_loop(0, False).verdict.verdict == "marginal"
