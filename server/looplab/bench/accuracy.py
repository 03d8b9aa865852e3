"""Largest errors of y and u against an exact reference, looplab's and those of Pade fractions of several orders.

reference.json holds y and u of e^{-0.1 s}/(0.5 s + 1) under PI and PID (Cohen-Coon settings), computed by a method of
steps at 60 digits without looplab; tests/references/make/bench_reference.py writes it.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ORDERS = range(1, 11)
CASES: list[dict[str, Any]] = json.loads((Path(__file__).parent / "reference.json").read_text())["cases"]


def _largest(values: np.ndarray, reference: np.ndarray) -> float:
    return float(np.abs(values - reference).max())


def _ours(case: dict[str, Any], sides: dict[str, Any]) -> dict[str, float]:
    from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
    from looplab.engine.systems import TransferFunction

    plant = TransferFunction((), [-1.0 / case["tau"]], 1.0 / case["tau"], case["theta"])
    t = np.array(case["t"])
    loop = FeedbackLoop(plant, PID(**case["controller"]))
    result = closed_loop_step(loop, float(t[-1]), (t.size - 1) * case["subdivide"] + 1)
    at = np.argmin(np.abs(result.t[None, :] - t[:, None]), axis=1)
    if np.abs(result.t[at] - t).max() > 1e-9:
        raise RuntimeError("the engine's samples no longer meet the reference's")
    errors = {}
    for side, reference in sides.items():
        response = getattr(result, side)
        errors[f"{side} y"] = _largest(response.y[at], reference["y"])
        errors[f"{side} u"] = _largest(response.u[at], reference["u"])
    return errors


def _pade(case: dict[str, Any], sides: dict[str, Any], order: int) -> dict[str, float]:
    import control

    from looplab.bench.peer import Peer
    from looplab.bench.scenarios import Scenario

    c, t = case["controller"], np.array(case["t"])
    # A PI is the PID with a vanishing derivative time; python-control's fraction then has one far pole more.
    tau_D = c.get("tau_D", 0.0)
    s = Scenario(
        case["name"], (1.0 / case["tau"],), (-1.0 / case["tau"],), case["theta"], c["Kc"], c["tau_I"], tau_D or 1.0,
        c.get("alpha", 0.1), float(t[-1]),
    )  # fmt: skip
    peer = Peer(s, order=order)
    C = peer.controller(c["Kc"]) if tau_D else control.tf([c["Kc"] * c["tau_I"], c["Kc"]], [c["tau_I"], 0.0])
    step = control.step_response(peer.closed_loop(C), T=t)
    errors = {}
    for i, (side, reference) in enumerate(sides.items()):
        errors[f"{side} y"] = _largest(step.outputs[1, i], reference["y"])
        errors[f"{side} u"] = _largest(step.outputs[0, i], reference["u"])
    return errors


def measure(tick: Callable[[str], None]) -> list[dict[str, Any]]:
    """Largest errors by case, method and signal, over the samples of the reference."""
    results = []
    for case in CASES:
        sides = {side: {k: np.array(v) for k, v in case[side].items()} for side in ("setpoint", "load")}
        errors = {"looplab": _ours(case, sides)}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for order in ORDERS:
                errors[f"python-control, Pade {order}"] = _pade(case, sides, order)
        results.append({"loop": case["name"], "samples": len(case["t"]), "errors": errors})
        tick(f"accuracy: {case['name']}")
    return results
