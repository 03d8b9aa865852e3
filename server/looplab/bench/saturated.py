"""A saturated linear loop of 500 samples: by looplab, and by python-control's nonlinear simulator."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from looplab.bench.timing import WARM_UP_OF_SLOW, interleave
from looplab.engine.loop import PID, SaturatedLoop, simulate_saturated
from looplab.engine.systems import parse_transfer_function
from looplab.engine.systems.polynomial import FloatArray

SAMPLES, H, U_MAX, TAU_I, TAU_D, T_T = 500, 0.05, 1.3, 2.0, 0.5, 1.0
GOAL = 50.0
STEPS = 2
Work = Callable[[float], FloatArray]


def ours(delay: int) -> Work:
    """y at the samples, as a function of Kc."""
    plant = parse_transfer_function("1/(s+1)^3" + (f" * exp(-{delay * H}*s)" if delay else ""))

    def work(Kc: float) -> FloatArray:
        loop = SaturatedLoop(plant, PID(Kc, TAU_I, TAU_D), H, -U_MAX, U_MAX, "back_calculation", T_T)
        return simulate_saturated(loop, SAMPLES).y

    return work


def by_control(delay: int) -> Work:
    """The same samples: the plant discretised by the package, its delay as states, the controller as one system."""
    import control

    G = control.c2d(control.ss(control.tf([1.0], [1.0, 3.0, 3.0, 1.0])), H)
    if delay:
        shift = control.ss(np.eye(delay, k=-1), np.eye(delay)[:, :1], np.eye(delay)[-1:], [[0.0]], H)
        G = G * shift
    plant = control.ss(G, name="plant", inputs=["u"], outputs=["y"])
    filter_time = 0.1 * TAU_D
    t = H * np.arange(SAMPLES + 1)

    def work(Kc: float) -> FloatArray:
        def command(x: Any, e: float) -> tuple[float, float, float]:
            derivative = (filter_time * x[1] + Kc * TAU_D * (e - x[2])) / (filter_time + H)
            v = Kc * e + derivative + x[0] + Kc * H / TAU_I * e
            return v, min(max(v, -U_MAX), U_MAX), derivative

        def update(t: float, x: Any, signals: Any, params: Any) -> list[float]:
            e = signals[0]
            v, u, derivative = command(x, e)
            return [x[0] + Kc * H / TAU_I * e + H / T_T * (u - v), derivative, e]

        pid = control.nlsys(
            update, lambda t, x, e, p: [command(x, e[0])[1]],
            name="pid", states=3, inputs=["e"], outputs=["u"], dt=H,
        )  # fmt: skip
        error = control.summing_junction(["r", "-y"], "e", dt=H)
        loop = control.interconnect([plant, pid, error], inputs=["r"], outputs=["y"], dt=H)
        return np.asarray(control.input_output_response(loop, t, np.ones(t.size)).outputs).ravel()

    return work


def measure(rounds: int, tick: Callable[[str], None]) -> list[dict[str, Any]]:
    """Time both, without and with dead time, and how far they are apart."""
    results = []
    for delay in (0, 10):
        a, b = ours(delay), by_control(delay)
        gains = [4.0 * (1.0 + 0.2 * i / rounds) for i in range(rounds + WARM_UP_OF_SLOW)]
        what = f"dead time {delay * H:g}" if delay else "no dead time"

        def advance(title: str = f"saturated loop: {what}") -> None:
            tick(title)

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            apart = float(np.abs(a(gains[0]) - b(gains[0])).max())
            timed = interleave(a, b, gains, advance, WARM_UP_OF_SLOW)
        results.append(
            {
                "plant": f"1/(s+1)^3, {SAMPLES} samples",
                "what": what,
                "peer_name": "python-control, input_output_response",
                "goal": GOAL,
                "difference": apart,
                **timed,
            }
        )
    return results
