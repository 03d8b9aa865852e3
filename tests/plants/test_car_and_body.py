"""The car and the body: numbers of their sources, and what they hold against."""

import numpy as np
import pytest

from looplab.engine.nonlinear.simulation import simulate_open_loop
from looplab.plants import load_plant

CAR, BODY = load_plant("cruise-control"), load_plant("body-temperature")


def body(inputs, hours=20.0, **more):
    """States and named variables where the body has come to rest."""
    found = simulate_open_loop(BODY, np.linspace(0, 60 * hours, 241), inputs, **more)
    assert found.truncated_reason is None
    u, p = BODY.inputs(inputs), BODY.parameters(more.get("parameters", {}))
    values = BODY.variables(0.0, found.x[-1].tolist(), u, p)
    return found, dict(zip(BODY.variable_names, values, strict=True))


def test_the_car_is_that_of_the_book():
    """Astrom and Murray, Example 6.11 (1st ed.: 5.11): u = 0.1687 at 20 m/s; dv/dt = -0.0101 v + 1.32 u - 9.8 theta."""
    assert CAR.u0[0] == pytest.approx(0.1687, abs=5e-5)
    linear = CAR.jacobians(0.0, [20.0], CAR.u0, CAR.p0)
    assert linear.A[0, 0] == pytest.approx(-0.0101, abs=5e-5)
    assert linear.B[0] == pytest.approx([1.3203, -9.8], abs=5e-4)


@pytest.mark.parametrize(("gear", "ratio"), [(1, 40), (2, 25), (3, 16), (4, 12), (5, 10)])
def test_every_gear(gear, ratio):
    values = CAR.variables(0.0, [10.0], [1.0, 0.0], CAR.parameters({"gear": gear}))
    named = dict(zip(CAR.variable_names, values, strict=True))
    assert named["omega"] == 10.0 * ratio
    assert named["force"] == pytest.approx(ratio * 190 * (1 - 0.4 * (10 * ratio / 420 - 1) ** 2), rel=1e-12)


def test_the_work_of_the_engine_is_kinetic_energy_height_and_loss():
    t = np.linspace(0, 40, 4001)
    found = simulate_open_loop(CAR, t, {"throttle": 0.7, "slope": 0.04}, rtol=1e-11)
    v = found.x[:, 0]
    force = 12 * 0.7 * 190 * (1 - 0.4 * (12 * v / 420 - 1) ** 2)
    held = 1600 * 9.8 * (np.sin(0.04) + 0.01) + 0.5 * 1.3 * 0.32 * 2.4 * v**2
    power = (force - held) * v
    work = (t[2] - t[0]) / 6 * (power[:-2:2] + 4 * power[1:-1:2] + power[2::2]).sum()
    assert 800 * (v[-1] ** 2 - v[0] ** 2) == pytest.approx(work, rel=1e-8)


def test_a_car_that_rests_says_so():
    found = simulate_open_loop(CAR, np.linspace(0, 300, 301), {"throttle": 0.0, "slope": 0.1})
    assert found.truncated_reason == "the car has come to rest"
    assert found.x[-1, 0] == pytest.approx(0.0, abs=1e-9)


def test_the_core_is_held_while_the_room_is_not():
    """Homeostasis: 40 K of room move the core by less than 0.6 K; without its regulators by ten times as much."""
    cores = [body({"T_amb": float(T)})[0].x[-1, 0] for T in (0, 10, 25, 40)]
    assert np.all((np.array(cores) > 36.5) & (np.array(cores) < 37.2))
    off = {"c_sw": 0.0, "c_dil": 0.0, "c_str": 0.0, "c_sh": 0.0}
    cold, warm = (simulate_open_loop(BODY, np.linspace(0, 600, 61), {"T_amb": T}, off).x[-1, 0] for T in (10.0, 40.0))
    assert warm - cold > 5


def test_each_regulator_works_where_it_should():
    _, cold = body({"T_amb": 5.0})
    _, warm = body({"T_amb": 38.0})
    assert cold["shiver"] > 0.1
    assert cold["sweat"] == 0.0
    assert warm["shiver"] == 0.0
    assert warm["sweat"] > 0.1
    assert warm["bloodflow"] > 10 * cold["bloodflow"]


def test_a_fever_is_a_higher_set_point():
    well, ill = (body({"T_amb": 20.0, "fever": F})[0].x[-1, 0] for F in (0.0, 2.0))
    assert 1.5 < ill - well < 2.1


@pytest.mark.parametrize("inputs", [{"T_amb": 5.0}, {"T_amb": 25.0}, {"M": 150.0}])
def test_at_rest_what_is_made_is_lost(inputs):
    _, v = body(inputs, hours=60, rtol=1e-10)
    made = inputs.get("M", 58.2) + v["M_sh"]
    assert v["Q_breath"] + v["Q_dry"] + v["E_skin"] == pytest.approx(made, rel=1e-7)


def test_heat_stroke_and_hypothermia_are_reported():
    hot = simulate_open_loop(BODY, np.linspace(0, 600, 301), {"T_amb": 48.0, "M": 200.0})
    assert "heat stroke" in hot.events[0].message
    numb = simulate_open_loop(BODY, np.linspace(0, 1200, 301), {"T_amb": -10.0}, {"c_sh": 0.0})
    assert "hypothermia" in numb.events[0].message
