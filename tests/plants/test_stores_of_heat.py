"""Heater, room, thermometers and coolers: first order in closed form, and the second capacity that vanishes."""

import numpy as np
import pytest

from looplab.engine.nonlinear.simulation import simulate_open_loop
from looplab.plants import load_plant

FIRST_ORDER = {  # plant: input, step to, gain and time constant
    "heater": ("Q", 1400.0, 1 / 20, 10 * 4180 / 20),
    "heated-room": ("T_amb", -10.0, 1.0, 140 / 58.5),
    "thermometer": ("T_f", 100.0, 1.0, 6.0),
    "jacketed-cooler-thin-wall": ("Q", 30.0, 2.0, 418 / 0.5),
}


@pytest.mark.parametrize("name", FIRST_ORDER)
def test_a_step_is_an_exponential(name):
    model, (source, level, K, tau) = load_plant(name), FIRST_ORDER[name]
    rest = model.document.operating_points[0].near
    start = float(next(iter(rest.values())))
    moved = level - dict(zip(model.input_names, model.u0, strict=True))[source]
    t = np.linspace(0, 5 * tau, 51)
    found = simulate_open_loop(model, t, {source: level}, initial=[start], rtol=1e-11)
    assert found.x[:, 0] == pytest.approx(start + K * moved * (1 - np.exp(-t / tau)), rel=1e-9)


def test_water_boils():
    found = simulate_open_loop(load_plant("heater"), np.linspace(0, 10_000, 101), {"Q": 2000.0})
    assert "boils" in found.truncated_reason
    # 100 K to go, 80 K of them until it boils
    assert found.truncated_at == pytest.approx(2090 * np.log(100 / 20), rel=1e-6)


def test_airing_moves_gain_and_time_constant():
    room = load_plant("heated-room")
    poles = [room.state_jacobian(0.0, [20.0], room.inputs({"n": n}), room.p0)[0, 0] for n in (0.0, 0.5, 14.0)]
    assert poles == pytest.approx([-50 / 140, -58.5 / 140, -288 / 140], rel=1e-12)


THIN = [
    ("thermometer-glass", "C_g", "thermometer", "T_m", {"T_f": 80.0}, 30.0),
    ("jacketed-cooler", "m_w", "jacketed-cooler-thin-wall", "T", {"Tc": 280.0}, 3000.0),
]


@pytest.mark.parametrize(("thick", "capacity", "thin", "state", "inputs", "horizon"), THIN)
def test_a_second_capacity_that_vanishes_leaves_first_order(thick, capacity, thin, state, inputs, horizon):
    """The difference is proportional to the capacity, so a tenth of it leaves a tenth."""
    t = np.linspace(0, horizon, 41)
    model = load_plant(thick)
    limit = simulate_open_loop(load_plant(thin), t, inputs, rtol=1e-11).x[:, 0]
    gaps = []
    for value in (1e-2, 1e-3, 1e-4):
        found = simulate_open_loop(model, t, inputs, {capacity: value}, rtol=1e-11)
        gaps.append(np.abs(found.x[:, model.state_names.index(state)] - limit).max())
    assert gaps[0] < 0.5
    assert gaps[1] / gaps[0] == pytest.approx(0.1, rel=0.05)
    assert gaps[2] / gaps[1] == pytest.approx(0.1, rel=0.05)


def test_the_cooler_has_the_transfer_function_of_its_balances():
    """T/Tc = 1/((m cp/UA_i s)(m_w cp_w/UA_o s + 1 + UA_i/UA_o) + m_w cp_w/UA_o s + 1), both UA 1 kW/K."""
    model = load_plant("jacketed-cooler")
    linear = model.jacobians(0.0, model.x0, model.u0, model.p0)
    for omega in np.geomspace(1e-5, 1, 25):
        s = 1j * omega
        liquid, wall = 418.0 * s, 184.0 * s
        found = linear.C @ np.linalg.solve(s * np.eye(2) - linear.A, linear.B)
        assert found[0, 0] == pytest.approx(1 / (liquid * (wall + 2) + wall + 1), rel=1e-9)


def test_thick_glass_answers_flat_at_first():
    """Two stores in a row: no slope at the start, and overdamped."""
    model = load_plant("thermometer-glass")
    assert model.f(0.0, [20.0, 20.0], [100.0], model.p0)[1] == 0.0
    poles = np.linalg.eigvals(model.state_jacobian(0.0, [20.0, 20.0], model.u0, model.p0))
    # C_m C_g/(hA_i hA_o) s^2 + (C_m/hA_i + C_m/hA_o + C_g/hA_o) s + 1
    assert np.sort(poles) == pytest.approx(np.sort(np.roots([0.24 / 0.04, 8.0, 1.0])), rel=1e-12)


@pytest.mark.parametrize("name", ["jacketed-cooler", "jacketed-cooler-thin-wall"])
def test_heat_is_accounted_for(name):
    t = np.linspace(0, 2000, 2001)
    found = simulate_open_loop(load_plant(name), t, {"Q": 45.0}, rtol=1e-11)
    T = found.x[:, 0]
    Tw = found.x[:, 1] if found.x.shape[1] == 2 else (T + 290) / 2
    stored = 418 * (T[-1] - T[0]) + (184 * (Tw[-1] - Tw[0]) if name == "jacketed-cooler" else 0)
    away = Tw - 290
    carried = (t[2] - t[0]) / 6 * (away[:-2:2] + 4 * away[1:-1:2] + away[2::2]).sum()
    assert stored == pytest.approx(45 * 2000 - carried, rel=1e-8)
