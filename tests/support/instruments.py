"""Instruments and the level loop by hand: f(x, u, p) for real and complex numbers, as in ``plants``."""

import numpy as np


def trim(p, x):
    return {1: x, 2: np.exp((x - 1) * np.log(p["R_v"])), 3: x**0.5}[round(np.real(p["trim"]))]


def level_loop(x, u, p):
    """Linear: within the ends of the controller's output and the valve."""
    h, valve, v_valve, h_m, v_m, integral = x
    error = u["h_sp"] - h_m
    return [
        (u["Fi"] - p["K_v"] * valve) / p["A"],
        v_valve,
        (p["u_s"] - p["action"] * p["Kc"] * error + integral - valve) / p["tau_v"] ** 2
        - 2 * p["eta_v"] * v_valve / p["tau_v"],
        v_m,
        (p["K_m"] * h - h_m) / p["tau_m"] ** 2 - 2 * p["eta_m"] * v_m / p["tau_m"],
        -p["action"] * p["Kc"] * error / p["tau_I"],
    ]


def orifice(x, u, p):
    """Bernoulli from the pipe to the hole: q^2 = 2 dp/rho / (1/(C a)^2 - beta^4/(C a)^2)."""
    hole = p["C"] * np.pi * p["d"] ** 2 / 4
    return [(p["rho"] / 2 * (u["q"] / hole) ** 2 * (1 - (p["d"] / p["D"]) ** 4) - x[0]) / p["tau"]]


def rtd(x, u, p):
    return [(u["T_f"] - x[0]) / p["tau"]]


def dp_cell(x, u, p):
    return [x[1], ((u["p1"] - u["p2"]) * p["A"] - p["k"] * x[0] - p["c"] * x[1]) / (p["rho"] * p["A"] * p["L"])]


def control_valve(x, u, p):
    """The stem in metres, then as a part of its travel."""
    z, speed = p["X"] * x[0], p["X"] * x[1]
    force = 1e3 * p["A"] * (u["p"] - p["p_0"]) - p["k"] * z - p["c"] * speed
    return [speed / p["X"], force / p["M"] / p["X"]]


def pump_valve(x, u, p):
    """Newton's law for the liquid in the pipe, in SI units: rho L dw/dt = difference of pressure."""
    F = x[0]
    weight = p["rho"] * p["g"]
    valve = 1e5 * p["rho"] / 1000 * (F / (p["K_v"] * trim(p, u["x_v"]))) ** 2
    pressure = weight * (p["H_0"] - p["a"] * F**2 - p["H_s"] - p["k_l"] * F**2) - valve
    return [3600 * np.pi * p["d"] ** 2 / 4 * pressure / (p["rho"] * p["L"])]


def pressure_regulator(x, u, p):
    """The plug where spring and diaphragm balance; the flow of ISO 6358."""
    gap = p["A"] * 1e5 * (p["p_set"] - x[0]) / (p["k"] * p["X"])
    opening = 0 * gap if gap.real < 0 else gap if gap.real < 1 else 1 + 0 * gap
    supply = u["p_s"] + p["p_atm"]
    ratio = (x[0] + p["p_atm"]) / supply
    sonic = ratio.real <= np.real(p["b"])
    part = 1 if sonic else (1 - ((ratio - p["b"]) / (1 - p["b"])) ** 2) ** 0.5
    return [p["p_atm"] * (p["C"] * opening * supply * part - u["n"] * x[0]) / p["V"]]
