"""The plants once more, written by hand from their balances, and runs of them: what the documents are held against.

Each right-hand side is f(x, u, p) with inputs and parameters by name. It takes complex numbers, so that a complex step
gives its derivatives to rounding: d/dx Re f(x) = Im f(x + ih)/h.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import instruments
from column import column
from looplab.engine.nonlinear import CompiledModel

Values = Mapping[str, Any]


def _above(value: Any) -> Any:
    """max(0, value), also of complex numbers near the real axis."""
    return value if value.real > 0 else 0 * value


def _below(value: Any, limit: Any) -> Any:
    return value if value.real < np.real(limit) else limit + 0 * value


def heater(x, u, p):
    stored = p["m"] * p["cp"]
    return [u["Q"] / stored - p["UA"] / stored * (x[0] - u["T_amb"])]


def heated_room(x, u, p):
    walls, air = p["UA"] * (u["T_amb"] - x[0]), p["rho_cp"] * p["V"] * u["n"] * (u["T_amb"] - x[0])
    return [(u["Q"] + walls + air) / p["C"]]


def thermometer(x, u, p):
    return [p["hA"] / p["C_m"] * (u["T_f"] - x[0])]


def thermometer_glass(x, u, p):
    glass, mercury = x
    return [
        (p["hA_o"] * u["T_f"] + p["hA_i"] * mercury - (p["hA_o"] + p["hA_i"]) * glass) / p["C_g"],
        p["hA_i"] / p["C_m"] * (glass - mercury),
    ]


def cstr(x, u, p):
    """As much flows out as in."""
    return cstr_variable_volume([p["V"], *x], {**u, "F": u["Fi"]}, p)[1:]


def cstr_variable_volume(x, u, p):
    """From the amounts n_A = cA V and the heat V T: the product rule gives what the document states."""
    V, cA, T = x
    reacted = V * p["k0"] * np.exp(-p["EbyR"] / T) * cA
    dV = u["Fi"] - u["F"]
    amount = u["Fi"] * u["cAi"] - u["F"] * cA - reacted
    heat = u["Fi"] * u["Ti"] - u["F"] * T + (-p["dHr"] * reacted - u["Q"]) / (p["rho"] * p["cp"])
    return [dV, (amount - cA * dV) / V, (heat - T * dV) / V]


def jacketed_cstr(x, u, p):
    cA, T = x
    reacted = p["k0"] * np.exp(-p["EbyR"] / T) * cA
    return [
        (u["cAi"] - cA) * u["F"] / p["V"] - reacted,
        (u["Ti"] - T) * u["F"] / p["V"]
        + (-p["dHr"] * reacted + p["UA"] / p["V"] * (u["Tc"] - T)) / (p["rho"] * p["cp"]),
    ]


def cart_pendulum(x, u, p):
    """Lagrange's two equations, solved for the accelerations by Cramer's rule."""
    _, v, phi, omega = x
    ml = p["m"] * p["l"]
    a, b, d = p["M"] + p["m"], ml * np.cos(phi), p["J"] + ml * p["l"]
    force = u["F"] - p["mu"] * v + ml * np.sin(phi) * omega * omega
    torque = ml * p["g"] * np.sin(phi) - p["gamma"] * omega
    return [v, (d * force - b * torque) / (a * d - b * b), omega, (a * torque - b * force) / (a * d - b * b)]


def gravity_drained_tank(x, u, p):
    return [u["Fi"] / p["A"] - p["beta"] / p["A"] * x[0] ** 0.5]


def two_tanks(x, u, p):
    return [u["Fi"] / p["A1"] - x[0] / (p["A1"] * p["R1"]), x[0] / (p["A2"] * p["R1"]) - x[1] / (p["A2"] * p["R2"])]


def two_tanks_interacting(x, u, p):
    between = x[0] / p["R1"] - x[1] / p["R1"]
    return [u["Fi"] / p["A1"] - between / p["A1"], between / p["A2"] - x[1] / (p["A2"] * p["R2"])]


def five_tanks(x, u, p):
    upstream = [u["c_0"], *x[:-1]]
    return [(before - here) * u["F"] / (p["V"] / len(x)) for before, here in zip(upstream, x, strict=True)]


def jacketed_cooler(x, u, p):
    T, Tw = x
    return [
        u["Q"] / (p["m"] * p["cp"]) - p["UA_i"] / (p["m"] * p["cp"]) * (T - Tw),
        (p["UA_i"] * T + p["UA_o"] * u["Tc"] - (p["UA_i"] + p["UA_o"]) * Tw) / (p["m_w"] * p["cp_w"]),
    ]


def jacketed_cooler_thin_wall(x, u, p):
    return [(u["Q"] - (x[0] - u["Tc"]) / (1 / p["UA_i"] + 1 / p["UA_o"])) / (p["m"] * p["cp"])]


def cruise_control(x, u, p):
    """A car that rolls forward."""
    alpha = [40, 25, 16, 12, 10][round(np.real(p["gear"])) - 1]
    torque = p["T_m"] * _above(1 - p["beta"] * (alpha * x[0] / p["omega_m"] - 1) ** 2)
    gravity = p["m"] * p["g"] * (np.sin(u["slope"]) + p["C_r"])
    return [(alpha * u["throttle"] * torque - gravity - 0.5 * p["rho"] * p["C_d"] * p["A"] * x[0] ** 2) / p["m"]]


def body_temperature(x, u, p):
    """Two-node model of Gagge; pressures in torr and coefficients as in ASHRAE Standard 55-2020, Appendix D."""
    core, skin = x
    torr = 0.133322
    core_error, skin_error = core - p["T_core_set"] - u["fever"], skin - p["T_skin_set"]
    blood = (6.3 + p["c_dil"] * _above(core_error)) / (1 + p["c_str"] * _above(-skin_error))
    blood = 0.5 + _above(_below(blood, 90.0) - 0.5)
    body_error = p["share"] * skin_error + (1 - p["share"]) * core_error
    sweat = _below(p["c_sw"] * _above(body_error) * np.exp(_above(skin_error) / 10.7), 500.0)
    shiver = _below(p["c_sh"] * _above(-core_error) * _above(-skin_error), p["M_sh_max"])
    p_air = p["humidity"] * np.exp(18.6686 - 4030.183 / (u["T_amb"] + 235.0))
    p_skin = np.exp(18.6686 - 4030.183 / (skin + 235.0))
    made = u["M"] + shiver
    breath = made * (0.0014 * (34 - u["T_amb"]) + 0.0173 * (5.87 - torr * p_air))
    to_skin = (p["K_cond"] + p["c_bl"] * blood) * (core - skin)
    area = 1 + 0.15 * p["clo"]
    dry = (skin - u["T_amb"]) / (0.155 * p["clo"] + 1 / (area * p["h"]))
    lewis = 16.5 * torr
    wet = _above(p_skin - p_air) / (0.155 * p["clo"] / (0.45 * lewis) + 1 / (lewis * area * 3.0))
    sweat_heat = _below(0.68 * sweat, wet)
    vapour = sweat_heat + 0.06 * (1 - sweat_heat / wet) * wet
    stored = p["mass"] * p["c_b"] / p["A_D"]
    return [(made - breath - to_skin) / ((1 - p["share"]) * stored), (to_skin - dry - vapour) / (p["share"] * stored)]


@dataclass(frozen=True)
class Run:
    """From the model's start (but for ``start``) with these inputs, of which ``later`` hold from ``at`` on."""

    f: Callable[[Any, Values, Values], list[Any]]
    horizon: float
    at: float
    later: dict[str, float]
    inputs: dict[str, float] = field(default_factory=dict)
    start: dict[str, float] = field(default_factory=dict)
    parameters: dict[str, float] = field(default_factory=dict)


RUNS = {
    "heater": Run(heater, 6000, 3000, {"Q": 1500, "T_amb": 283.15}),
    "heated-room": Run(heated_room, 12, 6, {"n": 10, "T_amb": -5}),
    "thermometer": Run(thermometer, 40, 20, {"T_f": 10}, inputs={"T_f": 100}),
    "thermometer-glass": Run(thermometer_glass, 40, 20, {"T_f": 10}, inputs={"T_f": 100}),
    "cstr": Run(cstr, 10, 3, {"Ti": 360, "cAi": 1.1}, {"Q": 1.9e6}),
    "cstr-variable-volume": Run(cstr_variable_volume, 10, 3, {"F": 102, "Ti": 360, "cAi": 1.1}, {"F": 99}),
    "jacketed-cstr": Run(jacketed_cstr, 6, 1, {"Tc": 305, "F": 105}),
    "cart-pendulum": Run(cart_pendulum, 5, 0.5, {"F": 0.5}, parameters={"x_end": 100}),
    "gravity-drained-tank": Run(gravity_drained_tank, 20, 8, {"Fi": 0.3}, {"Fi": 0.6}),
    "two-tanks": Run(two_tanks, 10, 4, {"Fi": 1.5}, {"Fi": 0.7}),
    "two-tanks-interacting": Run(two_tanks_interacting, 10, 4, {"Fi": 1.2}, {"Fi": 0.7}, {"h1": 0.2, "h2": 1.6}),
    "tanks-in-series": Run(five_tanks, 12, 6, {"F": 0.5, "c_0": 0.2}, {"F": 1.5}, {"c_1": 0.9, "c_4": 0.1}),
    "jacketed-cooler": Run(jacketed_cooler, 4000, 1500, {"Q": 40, "Tc": 280}),
    "jacketed-cooler-thin-wall": Run(jacketed_cooler_thin_wall, 4000, 1500, {"Q": 40, "Tc": 280}),
    "cruise-control": Run(cruise_control, 120, 20, {"slope": 0.06, "throttle": 0.6}, parameters={"gear": 3}),
    "body-temperature": Run(body_temperature, 240, 90, {"T_amb": 5, "M": 80}, {"T_amb": 38, "M": 120}),
    "distillation": Run(column, 3, 1, {"R": 120, "V": 180, "F": 110, "z": 0.4}, parameters={"q": 0.8}),
    "level-loop": Run(instruments.level_loop, 8, 1, {"h_sp": 1.05, "Fi": 0.6}, {"Fi": 0.45}, {"v_m": 0.1}),
    "orifice": Run(instruments.orifice, 2, 1, {"q": 0.001}, start={"dp_m": 5000}),
    "rtd": Run(instruments.rtd, 20, 5, {"T_f": 100}, start={"T": 60}),
    "dp-cell": Run(instruments.dp_cell, 0.1, 0.02, {"p1": 90000, "p2": 110000}, start={"x": 0}),
    "control-valve": Run(instruments.control_valve, 0.1, 0.04, {"p": 90}, {"p": 30}, {"x": 0.6}),
    "pump-valve": Run(instruments.pump_valve, 0.8, 0.5, {"x_v": 0.5}, start={"F": 5}),
    "pressure-regulator": Run(instruments.pressure_regulator, 4, 2, {"p_s": 4, "n": 1.5}),
}


def integrate(run: Run, model: CompiledModel, times: np.ndarray) -> np.ndarray:
    """The run by Dormand and Prince's method of order 8: states, shape (count, n); ``times`` hold run.at."""
    p = dict(zip(model.parameter_names, model.parameters(run.parameters), strict=True))
    names = model.input_names
    before = dict(zip(names, model.inputs(run.inputs), strict=True))
    x0 = model.states(run.start, model.initial_state(tuple(before.values()), tuple(p.values())))
    pieces = [(times[times <= run.at], before), (times[times >= run.at], before | run.later)]
    rows = [np.array([x0])]
    for span, u in pieces:
        found = solve_ivp(
            lambda t, x, u=u: run.f(x, u, p),
            (span[0], span[-1]),
            rows[-1][-1],
            method="DOP853",
            t_eval=span,
            rtol=1e-12,
            atol=1e-14,
        )
        assert found.success, found.message
        rows.append(found.y.T[1:])
    return np.concatenate(rows)
