"""Control loops on nonlinear plants: by looplab, by scipy from sample to sample, and by python-control."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from looplab.bench.nonlinear_scenarios import SCENARIOS, ControlScenario
from looplab.bench.timing import WARM_UP_OF_SLOW, interleave
from looplab.engine.systems.polynomial import FloatArray

RTOL, ATOL = 1e-6, 1e-9
Work = Callable[[float], FloatArray]


def ours(s: ControlScenario, sampled: bool) -> Work:
    """y at the samples, as a function of Kc."""
    from looplab.engine.loop import PID
    from looplab.engine.nonlinear import compile_model
    from looplab.engine.nonlinear.control_loop import ControlLoop
    from looplab.engine.nonlinear.control_loop.simulation import simulate_control
    from looplab.engine.nonlinear.inputs import InputCourse

    model = compile_model(s.document)
    t = s.h * np.arange(s.samples + 1)
    output, moved, setpoint = model.state_names[s.output], model.input_names[0], InputCourse(s.setpoint)

    def work(Kc: float) -> FloatArray:
        controller = PID(Kc, s.tau_I, s.tau_D, s.alpha, action="direct")
        loop = ControlLoop(
            output, moved, setpoint, controller, u_min=s.u_min, u_max=s.u_max, anti_windup="back_calculation",
            T_t=s.tau_I, sampling_time=s.h if sampled else None,
        )  # fmt: skip
        return np.asarray(simulate_control(model, t, [loop], rtol=RTOL, atol=ATOL).y[:, s.output])

    return work


def by_scipy(s: ControlScenario) -> Work:
    """The usual loop: the controller's algorithm, then ``solve_ivp`` to the next sample."""
    from scipy.integrate import solve_ivp

    def work(Kc: float) -> FloatArray:
        filter_time = s.alpha * s.tau_D
        x: Any = list(s.x0)
        integral, derivative, last = s.u0, 0.0, s.setpoint - s.x0[s.output]
        ys = [s.x0[s.output]]
        for _ in range(s.samples):
            e = s.setpoint - x[s.output]
            derivative = (filter_time * derivative - Kc * s.tau_D * (e - last)) / (filter_time + s.h)
            integral -= Kc * s.h / s.tau_I * e
            v = integral - Kc * e + derivative
            u = min(max(v, s.u_min), s.u_max)
            integral += s.h / s.tau_I * (u - v)
            last = e
            x = solve_ivp(lambda t, x, u=u: s.rates(x, u), (0.0, s.h), x, rtol=RTOL, atol=ATOL).y[:, -1]
            ys.append(x[s.output])
        return np.array(ys)

    return work


def by_control(s: ControlScenario) -> Work:
    """A continuous PID and the plant, interconnected; the package has no sampled controller on a continuous plant."""
    import control

    t = s.h * np.arange(s.samples + 1)
    states = len(s.x0)

    def work(Kc: float) -> FloatArray:
        filter_time = s.alpha * s.tau_D

        def command(x: Sequence[float], e: float) -> tuple[float, float]:
            v = x[0] - Kc * e - Kc / s.alpha * (e - x[1])
            return v, min(max(v, s.u_min), s.u_max)

        def update(t: float, x: Sequence[float], signals: Sequence[float], params: Any) -> list[float]:
            e = signals[0]
            v, u = command(x, e)
            return [-Kc / s.tau_I * e + (u - v) / s.tau_I, (e - x[1]) / filter_time]

        plant = control.nlsys(
            lambda t, x, u, p: s.rates(x, u[0]), lambda t, x, u, p: [x[s.output]],
            name="plant", states=states, inputs=["u"], outputs=["y"],
        )  # fmt: skip
        pid = control.nlsys(
            update, lambda t, x, e, p: [command(x, e[0])[1]], name="pid", states=2, inputs=["e"], outputs=["u"]
        )
        error = control.summing_junction(["r", "-y"], "e")
        loop = control.interconnect([plant, pid, error], inputs=["r"], outputs=["y"])
        start = [*s.x0, s.u0, s.setpoint - s.x0[s.output]]
        found = control.input_output_response(
            loop, t, np.full(t.size, s.setpoint), start, solve_ivp_kwargs={"rtol": RTOL, "atol": ATOL}
        )
        return np.asarray(found.outputs).ravel()

    return work


COMPARISONS: tuple[tuple[str, str, bool, Callable[[ControlScenario], Work]], ...] = (
    ("sampled PID", "scipy, solve_ivp from sample to sample", True, by_scipy),
    ("continuous PID", "python-control, input_output_response", False, by_control),
)


STEPS = len(SCENARIOS) * len(COMPARISONS)


def measure(rounds: int, tick: Callable[[str], None]) -> list[dict[str, Any]]:
    """Time every comparison, and how far the two are apart."""
    results = []
    for s in SCENARIOS:
        for what, name, sampled, make in COMPARISONS:
            a, b = ours(s, sampled), make(s)
            gains = s.gains(rounds + WARM_UP_OF_SLOW)

            def advance(title: str = f"{s.name}: {what}") -> None:
                tick(title)

            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                apart = float(np.abs(a(gains[0]) - b(gains[0])).max())
                timed = interleave(a, b, gains, advance, WARM_UP_OF_SLOW)
            results.append(
                {"plant": s.name, "what": what, "peer_name": name, "goal": None, "difference": apart, **timed}
            )
    return results
