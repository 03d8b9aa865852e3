"""A distillation column by hand: balances of amounts M x, stage by stage."""

from collections.abc import Mapping
from typing import Any

import numpy as np


def column(x, u: Mapping[str, Any], p: Mapping[str, Any], feed_tray: int = 10):
    """dx/dt of M_B, M_1, ..., M_D, x_B, x_1, ..., x_D."""
    M, X = np.split(np.asarray(x), 2)
    dM, amounts = balances(M, X, u, p, feed_tray)
    return [*dM, *((amounts - X * dM) / M)]


def balances(M, X, u: Mapping[str, Any], p: Mapping[str, Any], feed_tray: int = 10):
    """dM/dt and d(M x)/dt of base, trays and drum."""
    light = p["alpha"] * X
    Y = light / (light + 1 - X)
    stage = np.arange(M.size)
    up = np.where(stage >= feed_tray, u["V"] + (1 - p["q"]) * u["F"], u["V"])[:-1]
    over = M - p["M_w"]
    down = p["k_w"] * (over * (over.real > 0)) ** 1.5
    D, B = (p[f"{s}_s"] + p[f"K_{s}"] * (M[i] - p[f"M_{s}_set"]) for s, i in (("D", -1), ("B", 0)))
    down = np.concatenate([[B if B.real > 0 else 0 * B], down[1:-1], [u["R"]]])
    dM, amounts = np.zeros((2, M.size), dtype=np.result_type(Y, down, up, D, *u.values()))
    dM[:-1] += down[1:] - up
    dM[1:] += up - down[1:]
    amounts[:-1] += down[1:] * X[1:] - up * Y[:-1]
    amounts[1:] += up * Y[:-1] - down[1:] * X[1:]
    for i, flow in ((0, down[0]), (-1, D if D.real > 0 else 0 * D)):
        dM[i] -= flow
        amounts[i] -= flow * X[i]
    dM[feed_tray] += u["F"]
    amounts[feed_tray] += u["F"] * u["z"]
    return dM, amounts
