"""A binary distillation column of N trays: its document, and its compositions at rest."""

from __future__ import annotations

from typing import Any

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import BUILT_IN
from looplab.engine.systems.polynomial import FloatArray

LUYBEN = "Luyben, Process Modeling, Simulation, and Control for Chemical Engineers, 2nd ed., 1990, chapter 5"
NOMINAL = {"R": 128.01, "V": 178.01, "F": 100.0, "z": 0.5}
# name -> title, inputs: each a step from the nominal point, and the point where the column comes to rest after it.
DISTURBANCES: dict[str, tuple[str, dict[str, float]]] = {
    "reflux-up": ("after a step of 1 % in the reflux", {"R": 129.29}),
    "steam-up": ("after a step of 1 % in the steam", {"V": 179.79}),
    "feed-rate-up": ("after a step of 10 % in the feed", {"F": 110.0}),
    "feed-composition-down": ("after a step from 0.50 to 0.45 in the feed's composition", {"z": 0.45}),
}
MAX_TRAYS = (BUILT_IN.states - 4) // 2
ALPHA, Q, K_W, M_W, HOLDUP, PRODUCT, K_LEVEL = 2.0, 1.0, 11.45, 5.0, 100.0, 50.0, 1.0
NEWTON_STEPS = 60


def compositions_at_rest(
    N: int, feed_tray: int, alpha: float, q: float, R: float, V: float, F: float, z: float
) -> FloatArray:
    r"""Liquid compositions of a column at rest, by Newton's method on the component balances of all stages.

    .. math:: L_{i+1} x_{i+1} + V_{i-1} y_{i-1} - L_i x_i - V_i y_i + F_i z = 0, \quad
        y_i = \frac{\alpha x_i}{1 + (\alpha - 1) x_i}

    Parameters
    ----------
    N, feed_tray : int
        Number of trays, and the one that is fed, counted from the bottom.
    alpha, q : float
        Relative volatility, liquid fraction of the feed [-].
    R, V, F : float
        Reflux, vapour from the base, feed [mol/time].
    z : float
        Composition of the feed [-].

    Returns
    -------
    ndarray, shape (N + 2,)
        x_B, x_1, ..., x_N, x_D.

    Raises
    ------
    InvalidInput
        The flows leave nothing for one of the products, or there is no rest near.

    References
    ----------
    .. [1] W. L. Luyben, Process Modeling, Simulation, and Control for Chemical Engineers, 2nd ed., McGraw-Hill, 1990,
       chapters 3 and 5.
    """
    stage = np.arange(N + 2)
    vapour = np.where(stage < feed_tray, V, V + (1.0 - q) * F)
    vapour[-1] = 0.0
    liquid = np.where(stage <= feed_tray, R + q * F, R)
    liquid[0] -= V
    # Reflux and distillate leave the drum together.
    out_of_drum = vapour[-2]
    if liquid[0] <= 0.0 or out_of_drum <= R:
        raise InvalidInput("these flows leave no bottoms or no distillate", field="V")
    leaving = liquid.copy()
    leaving[-1] = out_of_drum
    feed = np.where(stage == feed_tray, F * z, 0.0)
    x = np.linspace(0.02, 0.98, N + 2)
    for _ in range(NEWTON_STEPS):
        D = 1.0 + (alpha - 1.0) * x
        y, slope = alpha * x / D, alpha / D**2
        f = feed - leaving * x - vapour * y
        f[:-1] += liquid[1:] * x[1:]
        f[1:] += (vapour * y)[:-1]
        J = np.diag(-leaving - vapour * slope) + np.diag(liquid[1:], 1) + np.diag((vapour * slope)[:-1], -1)
        move = np.linalg.solve(J, -f)
        x = np.clip(x + move, 0.0, 1.0)
        if np.abs(move).max() < 1e-13:
            return x
    raise InvalidInput("no composition at rest was found for these flows", field="R")


def _state_names(N: int) -> list[str]:
    stages = ["B", *map(str, range(1, N + 1)), "D"]
    return [f"{kind}_{stage}" for kind in ("M", "x") for stage in stages]


def _near(N: int, feed_tray: int, u: dict[str, float]) -> dict[str, float]:
    """The column at rest with the inputs u, to six digits."""
    R, V, F = u["R"], u["V"], u["F"]
    D, B = V + (1.0 - Q) * F - R, R + Q * F - V
    below, above = (M_W + (L / K_W) ** (2 / 3) for L in (R + Q * F, R))
    trays = [below] * feed_tray + [above] * (N - feed_tray)
    M = [HOLDUP + (B - PRODUCT) / K_LEVEL, *trays, HOLDUP + (D - PRODUCT) / K_LEVEL]
    x = compositions_at_rest(N, feed_tray, ALPHA, Q, **u).tolist()
    return {name: float(f"{value:.6g}") for name, value in zip(_state_names(N), [*M, *x], strict=True)}


def _parameters() -> list[dict[str, Any]]:
    level = "chosen: fast beside the compositions"
    weir = "holds 10 mol on a tray above the feed, as the book does"
    rows: list[tuple[str, float, str, float, float, str, str, str]] = [
        ("alpha", ALPHA, "-", 1.01, 20, r"\alpha", "relative volatility", LUYBEN),
        ("q", Q, "-", 0, 1, "q", "liquid fraction of the feed", f"{LUYBEN}: boiling liquid"),
        ("k_w", K_W, "mol^-0.5/min", 0.1, 1000, "k_w", "flow over the weir at 1 mol above its edge", weir),
        ("M_w", M_W, "mol", 0, 100, "M_w", "holdup of a tray up to the edge of its weir", "chosen: half of the 10 mol"),
        ("M_D_set", HOLDUP, "mol", 1, 1000, r"M_{D,\mathrm{sp}}", "setpoint of the drum's holdup", LUYBEN),
        ("M_B_set", HOLDUP, "mol", 1, 1000, r"M_{B,\mathrm{sp}}", "setpoint of the base's holdup", LUYBEN),
        ("D_s", PRODUCT, "mol/min", 0, 1000, "D_s", "distillate at the setpoint of its level", LUYBEN),
        ("B_s", PRODUCT, "mol/min", 0, 1000, "B_s", "bottoms at the setpoint of its level", LUYBEN),
        ("K_D", K_LEVEL, "1/min", 0, 100, "K_D", "gain of the drum's level controller, P only", level),
        ("K_B", K_LEVEL, "1/min", 0, 100, "K_B", "gain of the base's level controller, P only", level),
    ]
    fields = ("name", "value", "unit", "min", "max", "latex", "meaning", "source")
    return [dict(zip(fields, row, strict=True)) for row in rows]


def _inputs() -> list[dict[str, Any]]:
    flows = {"R": ("reflux", 1000.0), "V": ("vapour that the steam boils up", 1000.0), "F": ("feed", 500.0)}
    rows = [
        {"name": name, "value": NOMINAL[name], "unit": "mol/min", "min": 0, "max": most, "latex": name}
        | {"meaning": meaning, "source": LUYBEN}
        for name, (meaning, most) in flows.items()
    ]
    z = {"name": "z", "value": NOMINAL["z"], "unit": "-", "min": 0, "max": 1, "latex": "z"}
    return [*rows, z | {"meaning": "mole fraction of the lighter component in the feed", "source": LUYBEN}]


def _variables(N: int, feed_tray: int) -> list[dict[str, Any]]:
    def one(name: str, expression: str, unit: str, meaning: str) -> dict[str, Any]:
        head, _, tail = name.partition("_")
        latex = f"{head}_{{{tail}}}" if tail else head
        return {"name": name, "expression": expression, "unit": unit, "meaning": meaning, "latex": latex}

    liquid = [
        one(f"L_{i}", f"k_w*max(M_{i} - M_w, 0)^1.5", "mol/min", f"liquid over the weir of tray {i}")
        for i in range(1, N + 1)
    ]
    vapour = [
        one(f"y_{i}", f"alpha*x_{i}/(1 + (alpha - 1)*x_{i})", "-", f"vapour from {place}, at equilibrium")
        for i, place in [("B", "the base"), *((str(i), f"tray {i}") for i in range(1, N + 1))]
    ]
    return [
        one("V_T", "V + (1 - q)*F", "mol/min", f"vapour from tray {feed_tray}, the feed's, to the condenser"),
        one("D", "max(D_s + K_D*(M_D - M_D_set), 0)", "mol/min", "distillate, which holds the drum's level"),
        one("B", "max(B_s + K_B*(M_B - M_B_set), 0)", "mol/min", "bottoms, which hold the base's level"),
        *liquid,
        *vapour,
    ]


def _states(N: int, feed_tray: int) -> list[dict[str, Any]]:
    """Holdups and compositions; d(M x)/dt less x dM/dt leaves no flow that goes out of the stage but the vapour."""

    def pair(stage: str, place: str, M0: str, dM: str, amount: str) -> tuple[dict[str, Any], dict[str, Any]]:
        M, x = f"M_{stage}", f"x_{stage}"
        holdup = {"name": M, "initial": M0, "equation": dM, "unit": "mol", "min": 0, "max": 1e5}
        part = {"name": x, "initial": "z", "equation": f"({amount})/{M}", "unit": "-", "min": -0.001, "max": 1.001}
        return (
            holdup | {"meaning": f"liquid {place}", "latex": f"M_{{{stage}}}"},
            part | {"meaning": f"mole fraction of the lighter component {place}", "latex": f"x_{{{stage}}}"},
        )

    pairs = [pair("B", "in the base", "M_B_set", "L_1 - B - V", "L_1*(x_1 - x_B) - V*(y_B - x_B)")]
    for i in range(1, N + 1):
        above, below = ("R", "x_D") if i == N else (f"L_{i + 1}", f"x_{i + 1}"), "B" if i == 1 else str(i - 1)
        rising = "V" if i <= feed_tray else "V_T"
        flow = "R + q*F" if i <= feed_tray else "R"
        dM = f"{above[0]} - L_{i}" + (" + q*F" if i == feed_tray else "")
        amount = f"{above[0]}*({above[1]} - x_{i}) + {rising}*(y_{below} - y_{i})"
        if i == feed_tray:
            amount += f" + F*(z - x_{i}) - (1 - q)*F*(y_{i} - x_{i})"
        pairs.append(pair(str(i), f"on tray {i}", f"M_w + (({flow})/k_w)^(2/3)", dM, amount))
    pairs.append(pair("D", "in the reflux drum", "M_D_set", "V_T - R - D", f"V_T*(y_{N} - x_D)"))
    return [state for kind in zip(*pairs, strict=True) for state in kind]


def distillation(N: int = 20, feed_tray: int = 10) -> dict[str, Any]:
    r"""A column that parts two components: N trays, total condenser, base with boiler; 2N + 4 states.

    Constant molar overflow, equilibrium with constant relative volatility, liquid over a Francis weir. The levels of
    drum and base are held by D and B; reflux R and vapour V are left for the compositions.

    .. math:: \frac{dM_i}{dt} = L_{i+1} - L_i + q F_i, \quad
        \frac{d(M_i x_i)}{dt} = L_{i+1} x_{i+1} + V_{i-1} y_{i-1} - L_i x_i - V_i y_i + F_i z, \quad
        L_i = k_w (M_i - M_w)^{3/2}

    Parameters
    ----------
    N : int
        Number of trays; tray 1 is the lowest.
    feed_tray : int
        Which of them is fed.

    Returns
    -------
    dict
        A model document. Its initial state is a start-up: the column runs full of liquid of the feed's composition.
        Its operating points are the nominal one and those where each of DISTURBANCES leads from there.

    Raises
    ------
    InvalidInput
        N is not in 1 .. 58, or there is no such tray.

    References
    ----------
    .. [1] W. L. Luyben, Process Modeling, Simulation, and Control for Chemical Engineers, 2nd ed., McGraw-Hill, 1990,
       chapters 3 and 5.
    """
    if not 1 <= N <= MAX_TRAYS:
        raise InvalidInput(f"there must be 1 to {MAX_TRAYS} trays", field="N")
    if not 1 <= feed_tray <= N:
        raise InvalidInput(f"the feed goes to a tray from 1 to {N}", field="feed_tray")
    points = {"nominal": ("both products at rest", {}), **DISTURBANCES}
    return {
        "id": "distillation",
        "title": "Binary distillation column",
        "summary": f"Vapour rises through {N} trays of boiling liquid, and each makes it richer in the lighter of two "
        "components. Reflux and steam set how pure both products are, each of them moves both, and the purer they are "
        "the less the column is linear. The column starts full of liquid of the feed's composition.",
        "notes": "13.1.2",
        "time_unit": "min",
        "parameters": _parameters(),
        "inputs": _inputs(),
        "variables": _variables(N, feed_tray),
        "states": _states(N, feed_tray),
        "outputs": [
            {
                "name": "x_D",
                "expression": "x_D",
                "unit": "-",
                "meaning": "composition of the distillate",
                "latex": "x_D",
            },
            {"name": "x_B", "expression": "x_B", "unit": "-", "meaning": "composition of the bottoms", "latex": "x_B"},
            {"name": "D", "expression": "D", "unit": "mol/min", "meaning": "distillate", "latex": "D"},
            {"name": "B", "expression": "B", "unit": "mol/min", "meaning": "bottoms", "latex": "B"},
        ],
        "operating_points": [
            {"name": name, "title": title, "inputs": u, "near": _near(N, feed_tray, NOMINAL | u)}
            for name, (title, u) in points.items()
        ],
        "events": [
            {"name": "drum_dry", "when": "M_D <= 1", "action": "stop", "message": "the reflux drum runs dry"},
            {"name": "base_dry", "when": "M_B <= 1", "action": "stop", "message": "the base runs dry"},
        ],
    }
