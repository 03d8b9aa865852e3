"""Measuring and actuating devices against their closed forms."""

import math

import numpy as np
import pytest

from looplab.engine.nonlinear.simulation import simulate_open_loop
from looplab.engine.nonlinear.steady_states import steady_state_near
from looplab.plants import load_plant
from looplab.schemas import PlantSystem

TRIMS = {1: lambda x: x, 2: lambda x: 50 ** (x - 1), 3: math.sqrt}


def at(plant_id, x, u=None, p=None):
    """Variables and outputs by name at a state."""
    model = load_plant(plant_id)
    u, p = model.inputs(u or {}), model.parameters(p or {})
    variables = dict(zip(model.variable_names, model.variables(0.0, x, u, p), strict=True))
    return variables | dict(zip(model.output_names, model.outputs(0.0, x, u, p), strict=True))


def settled(plant_id, horizon, u=None, p=None):
    return simulate_open_loop(load_plant(plant_id), np.linspace(0, horizon, 11), u or {}, p or {}, rtol=1e-12)


def test_an_orifice_by_bernoulli():
    """q = C/sqrt(1 - beta^4) pi/4 d^2 sqrt(2 dp/rho), beta = 1/2."""
    K = 0.6 / math.sqrt(1 - 1 / 16) * math.pi / 4 * 0.05**2 * math.sqrt(2 / 1000)
    for q in (0.0, 0.001, 0.004):
        run = settled("orifice", 10, {"q": q})
        assert run.x[-1, 0] == pytest.approx((q / K) ** 2, rel=1e-9)
        assert run.y[-1] == pytest.approx([q, (q / K) ** 2, 4 + 16 * (q / K) ** 2 / 20000], rel=1e-9, abs=1e-12)


def test_the_root_of_a_damped_pressure_leads_the_flow_down():
    """From q to 0 the pressure decays with tau, its root with 2 tau."""
    t = np.linspace(0, 2, 21)
    start = load_plant("orifice").x0[0]
    run = simulate_open_loop(load_plant("orifice"), t, {"q": 0.0}, initial={"dp_m": start}, rtol=1e-11)
    assert run.y[:, 0] == pytest.approx(0.005 * np.exp(-t / 0.4), rel=1e-8)


@pytest.mark.parametrize(("T", "R"), [(0, 100.0), (100, 138.5055), (200, 175.856), (400, 247.092), (850, 390.481)])
def test_platinum_by_the_table_of_the_standard(T, R):
    """IEC 60751:2008, table 1."""
    found = at("rtd", [float(T)])
    assert found["R"] == pytest.approx(R, abs=6e-4)
    assert found["T_read"] == pytest.approx(T, abs=1e-9)
    assert found["T_line"] == pytest.approx((R - 100) / 0.38505, abs=2e-3)


def test_a_resistance_thermometer_lags():
    t = np.linspace(0, 10, 21)
    run = simulate_open_loop(load_plant("rtd"), t, {"T_f": 100.0}, initial={"T": 20.0}, rtol=1e-11)
    assert run.y[:, 2] == pytest.approx(100 - 80 * np.exp(-t / 2), rel=1e-8)


def test_the_dp_cell_is_of_second_order():
    """x/p1 = A/(rho A L s^2 + c s + k): natural frequency, damping, and the step between."""
    mass, k, c = 950 * 0.0005 * 2, 5e4, 260.0
    omega, eta = math.sqrt(k / mass), c / (2 * math.sqrt(k * mass))
    found = at("dp-cell", [0.0, 0.0])
    assert [found["omega_n"], found["eta"]] == pytest.approx([omega, eta], rel=1e-12)
    t = np.linspace(0, 0.05, 51)
    cell, up = load_plant("dp-cell"), {"p1": 1.2e5, "p2": 1e5}
    run = simulate_open_loop(cell, t, up, initial={"x": 0.0}, rtol=1e-11, atol=1e-16)
    root = math.sqrt(1 - eta**2)
    decay = np.exp(-eta * omega * t) * (np.cos(root * omega * t) + eta / root * np.sin(root * omega * t))
    x = 2e-4 * (1 - decay)
    assert run.x[:, 0] == pytest.approx(x, abs=1e-11)
    assert run.x[:, 0].max() / 2e-4 - 1 == pytest.approx(math.exp(-math.pi * eta / root), rel=2e-3)
    assert at("dp-cell", [2e-4, 0.0])["signal"] == pytest.approx(4 + 16 * 0.4)


@pytest.mark.parametrize("trim", TRIMS)
@pytest.mark.parametrize("x", [0.1, 0.5, 1.0])
def test_trims_inherent_and_installed(trim, x):
    """Of 2 bar the valve and the line, 60 m^3/h at 1 bar, take what makes one flow through both."""
    found = at("control-valve", [x, 0.0], p={"trim": trim})
    K = 0.865 * 40 * TRIMS[trim](x)
    assert found["f"] == pytest.approx(TRIMS[trim](x), rel=1e-12)
    F = math.sqrt(2 / (1 / K**2 + 1 / 60**2))
    assert found["F"] == pytest.approx(F, rel=1e-12)
    assert found["dp_v"] + (F / 60) ** 2 == pytest.approx(2, rel=1e-12)


def test_an_equal_percentage_trim_gives_equal_parts():
    flows = [at("control-valve", [x, 0.0], p={"K_l": 1e6})["F"] for x in (0.3, 0.4, 0.5)]
    assert flows[1] / flows[0] == pytest.approx(flows[2] / flows[1], rel=1e-9)
    assert flows[1] / flows[0] == pytest.approx(50**0.1, rel=1e-9)


@pytest.mark.parametrize("trim", TRIMS)
def test_sizing(trim):
    """A valve of the coefficient that comes out passes the flow it was sized for."""
    need = at("control-valve", [0.8, 0.0], p={"trim": trim, "G_f": 0.9})["Cv_d"]
    # a line that takes nothing leaves the whole 1.5 bar to the valve
    large = {"trim": trim, "Cv": need, "dp_0": 1.5, "K_l": 1e6, "G_f": 0.9}
    assert at("control-valve", [0.8, 0.0], p=large)["F"] == pytest.approx(20, rel=1e-8)


def test_the_coefficient_is_gallons_and_psi():
    """Cv is the flow of water in US gal/min at 1 psi: the factor of IEC 60534-2-1 to three digits."""
    gallon, psi = 3.785411784e-3 * 60, 0.0689475729
    per_bar = at("control-valve", [1.0, 0.0], p={"Cv": 1})["K"]
    assert per_bar == pytest.approx(gallon / math.sqrt(psi), rel=1e-3)


def test_the_stem():
    """M z'' + c z' + k z = A (p - p_0): 3 to 15 psi move it from end to end, overdamped."""
    model = load_plant("control-valve")
    psi = 6.894757
    for pressure, x in ((3, 0.0), (9, 0.5), (15, 1.0)):
        assert settled("control-valve", 1, {"p": pressure * psi}).x[-1, 0] == pytest.approx(x, abs=2e-4)
    poles = np.linalg.eigvals(model.state_jacobian(0.0, model.x0, model.u0, model.p0))
    assert np.sort(poles) == pytest.approx(np.sort(np.roots([1.36, 612.9, 52538])), rel=1e-12)


@pytest.mark.parametrize("trim", TRIMS)
def test_the_pump_delivers_where_the_curves_meet(trim):
    """H_0 - a F^2 = H_s + k_l F^2 + F^2/(K_v f)^2/(rho g): a root in closed form; it moves with the stem."""
    pressures, flows = [], []
    for x_v in (0.2, 0.5, 0.9):
        valve = 1e5 / (1000 * 9.81) / (120 * TRIMS[trim](x_v)) ** 2
        F = math.sqrt(30 / (0.00625 + 0.005 + valve))
        run = settled("pump-valve", 30, {"x_v": x_v}, {"trim": trim})
        assert run.y[-1] == pytest.approx([F, 1000 * 9.81 * (40 - 0.00625 * F**2) / 1e5], rel=1e-9)
        flows.append(F), pressures.append(run.y[-1, 1])
    assert flows == sorted(flows) and pressures == sorted(pressures, reverse=True)


def test_the_pump_at_rest_leads_to_where_the_curves_meet():
    """Without flow no derivative is left to follow; in a loop the plant stands where the curves meet all the same."""
    model = load_plant("pump-valve")
    u, p = model.inputs({"x_v": 0.3}), model.parameters({"trim": 1})
    valve = 1e5 / (1000 * 9.81) / (120 * 0.3) ** 2
    found = steady_state_near(model, u, p, model.initial_state(u, p))
    assert found.x[0] == pytest.approx(math.sqrt(30 / (0.00625 + 0.005 + valve)), rel=1e-9)
    assert PlantSystem(type="plant", id="pump-valve", input="x_v", output="F").to_engine().dc_gain > 0


def test_a_closed_valve_leaks():
    run = settled("pump-valve", 5, {"x_v": 0.0}, {"trim": 1})
    assert run.x[-1, 0] == pytest.approx(0.12 * math.sqrt(30 * 9.81e3 / 1e5), rel=1e-4)


@pytest.mark.parametrize("n", [0.0, 0.5, 1.0])
def test_a_regulator_droops(n):
    """Sonic at the inlet: (p_set - p)/band C p_s = n p."""
    band = 20000 * 0.002 / 0.002 / 1e5
    supply = 0.5 * (7 + 1.01325)
    expected = 1.4 / (1 + n * band / supply)
    assert (expected + 1.01325) / 8.01325 < (0.3 if n else 0.31)
    p = settled("pressure-regulator", 60, {"n": n}).x[-1, 0]
    assert p == pytest.approx(expected, rel=1e-6 if n else 1e-4)


def test_a_regulator_that_is_open_passes_what_it_can():
    """Far too much consumption: the inlet is fully open, and C p_s,abs = n p."""
    run = settled("pressure-regulator", 60, {"n": 10.0})
    assert run.y[-1] == pytest.approx([0.5 * 8.01325 / 10, 0.5 * 8.01325], rel=1e-8)


def test_a_supply_that_is_too_weak_fills_no_further():
    """Nothing flows back: without consumption the outlet comes to the supply's pressure and stays."""
    assert settled("pressure-regulator", 100, {"n": 0.0, "p_s": 1.0}).x[-1, 0] == pytest.approx(1.0, abs=1e-5)
