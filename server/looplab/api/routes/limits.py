"""Fundamental limits of a loop, and Bode's integral."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Annotated, Any, TypeVar

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.limits import BodeIntegralAnswer, LimitsAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import Arrays, complex_pairs, json_response
from looplab.api.strict import StrictRoute
from looplab.engine.errors import EngineError
from looplab.engine.frequency import closed_loop_bandwidth, margins
from looplab.engine.limits import (
    Demands,
    Limit,
    Mismatch,
    Spread,
    StepShape,
    Window,
    actuator_demand,
    bandwidth_window,
    bode_integral,
    ideal_delay_loop,
    interpolation_constraints,
    lemma_integrals,
    load_left,
    loop_step_shape,
    mismatch,
    noise_passed,
    peak_bounds,
    plant_step_shape,
)
from looplab.engine.limits.bode_integral import log_sensitivity
from looplab.engine.loop import FeedbackLoop
from looplab.engine.stability import Verdict, closed_loop_verdict, internal_stability
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.schemas import Loop, Model, located

router = APIRouter(tags=["limits"], route_class=StrictRoute)

Found = TypeVar("Found")
# Curves are cut there: at a pole on the axis they are infinite.
LARGEST = 1e9
Percent = Annotated[float, Field(ge=0, le=90, description="[%]")]


class SpreadShape(Model):
    """How far gain, time constants and dead time of the plant may be off, either way."""

    K_pct: Percent = 20.0
    tau_pct: Percent = 20.0
    theta_pct: Percent = 20.0


class LimitsRequest(Model):
    """A loop, and what is known of its surroundings; what is left out sets no limit."""

    loop: Loop
    u_limit: Annotated[float | None, Field(gt=0, description="Largest |u| for a unit of r; null: 10/|P(0)|.")] = None
    noise_omega: Annotated[float | None, Field(gt=0, description="From where on the sensor is noisy [rad/time].")] = (
        None
    )
    noise_gain: Annotated[float, Field(gt=0, lt=1, description="How much of the noise may reach y [-].")] = 0.1
    load_error: Annotated[float | None, Field(gt=0, description="Largest error a unit of load may leave.")] = None
    spread: SpreadShape = SpreadShape()
    arrays: Arrays = "list"

    def demands(self) -> Demands:
        """For the engine."""
        return Demands(
            self.u_limit, self.noise_omega, self.noise_gain, self.load_error, Spread(**self.spread.model_dump())
        )


class BodeIntegralRequest(Model):
    """A loop whose sensitivity is integrated."""

    loop: Loop
    arrays: Arrays = "list"


LAG = {"plant": {"type": "fopdt", "K": 1, "tau": 5, "theta": 1}, "controller": {"type": "pid", "Kc": 2, "tau_I": 5}}
UNSTABLE = {
    "plant": {"type": "expr", "text": "4(s+1)/((s-1)(s-2))"},
    "controller": {"type": "pid", "Kc": 2, "tau_I": 5},
}
ACTUATOR = {
    "plant": {"type": "expr", "text": "10/((s+10)(s+1))"},
    "controller": {"type": "expr", "text": "10(s+10)(s+1)/(s(s+12))"},
}
EXAMPLES: dict[str, Any] = {
    "a lag with dead time": {"value": {"loop": LAG, "u_limit": 4, "noise_omega": 20, "load_error": 0.5}},
    "a fast loop around a slow plant": {"value": {"loop": ACTUATOR}},
    "an unstable plant": {"value": {"loop": UNSTABLE}},
}
INTEGRAL_EXAMPLES: dict[str, Any] = {
    "two lags": {
        "value": {
            "loop": {"plant": {"type": "expr", "text": "1/(s(s+4))"}, "controller": {"type": "pid", "Kc": 1}},
        }
    },
    "with dead time": {"value": {"loop": LAG}},
    "an unstable plant": {"value": {"loop": UNSTABLE}},
}


def _met(limit: Limit, omega_c: float | None) -> bool | None:
    if limit.omega is None or omega_c is None:
        return None
    return omega_c >= limit.omega if limit.side == "lower" else omega_c <= limit.omega


def _window_words(found: Window) -> str:
    """What is left for omega_c, in one sentence."""
    low, high = found.low, found.high
    if not found.open:
        return (
            f"no bandwidth is left: it should be above {low:.4g} and below {high:.4g}"
            if low is not None
            else "no bandwidth is left: the actuator is too weak even at rest"
        )
    if low is None and high is None:
        return "nothing here limits the bandwidth"
    if low is None:
        return f"the crossover ωc should stay below {high:.4g}"
    where = f"be above {low:.4g}" if high is None else f"lie between {low:.4g} and {high:.4g}"
    return f"the crossover ωc should {where}"


def _curves(loop: FeedbackLoop, found: Mismatch) -> dict[str, Any]:
    omega = found.omega
    sizes = {"S": np.exp(log_sensitivity(loop.open_loop, omega)), "T": found.T, "model_error": found.weight}
    return {
        "omega": omega,
        **{name: np.minimum(values, LARGEST) for name, values in sizes.items()},
        "ideal_S": np.abs(ideal_delay_loop(loop.theta, omega)[0]) if loop.theta else None,
    }


def _step(found: StepShape) -> dict[str, Any]:
    return {name: value for name, value in asdict(found).items() if name != "reason"}


def _verdict(loop: FeedbackLoop) -> tuple[bool, str]:
    verdict: Verdict = closed_loop_verdict(loop)
    inside = internal_stability(loop)
    stable = verdict.closed_loop_stable and inside.internally_stable
    return stable, inside.because if verdict.closed_loop_stable else verdict.because


@router.post("/limits", summary="Fundamental limits", responses={200: {"model": LimitsAnswer}, **ERRORS})
def limits(request: Annotated[LimitsRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Which limits bind for a plant, what bandwidth is left between them, and what the loop makes of it.

    Unstable poles and loads ask for speed; zeros on the right, dead time, actuator, sensor noise and the model's error
    forbid it. With each root on the right come S and T there, the peaks that it costs, and the integrals of the loop's
    own step response that it fixes. Dead time is exact.
    """
    with located("loop"):
        loop = request.loop.to_engine()
    demands = request.demands()
    stable, because = _verdict(loop)
    reasons: dict[str, str] = {}

    def of_stable(name: str, compute: Callable[[], Found]) -> Found | None:
        """What only a stable loop has; where it cannot be computed, why."""
        try:
            if stable:
                return compute()
            reasons[name] = f"undefined: the loop is not stable, {because}"
        except EngineError as error:
            reasons[name] = error.message
        return None

    L, _ = split_hidden_modes(loop.open_loop)
    m, window, model = margins(loop.open_loop), bandwidth_window(loop, demands), mismatch(loop, demands.spread)
    reasons |= {f"peaks.{name}": m.reasons[name] for name in ("Ms", "Mt") if name in m.reasons}
    if m.omega_c is None:
        reasons["omega_c"] = m.reasons["omega_c"]
    u = of_stable("actuator", lambda: actuator_demand(loop))
    actuator = None
    if u is not None:
        actuator = {name: getattr(u, name) for name in ("initial", "final", "ratio")} | {
            "peak": asdict(u.peak),
            "plant_bandwidth": asdict(u.plant),
            "loop_bandwidth": asdict(u.loop),
        }
    heard = None
    if demands.noise_omega is None:
        reasons["noise_passed"] = "give noise_omega"
    else:
        omega_n = demands.noise_omega
        heard = of_stable("noise_passed", lambda: noise_passed(loop, omega_n))
    left = of_stable("load_left", lambda: load_left(loop))
    shape = of_stable("step", lambda: loop_step_shape(loop))
    alone = plant_step_shape(loop.plant)
    for name, seen in (("step", shape), ("plant_step", alone)):
        if seen is not None and seen.reason:
            reasons[name] = seen.reason
    Ms_bound, Mt_bound = peak_bounds(L)
    names = ("peak", "omega_peak", "robustly_stable", "worst_S")
    constraints = of_stable("constraints", lambda: interpolation_constraints(loop))
    integrals = of_stable("integrals", lambda: lemma_integrals(loop))
    answer = {
        "closed_loop_stable": stable,
        "omega_c": m.omega_c,
        "bandwidth": asdict(closed_loop_bandwidth(loop.open_loop)),
        "window": {"low": window.low, "high": window.high, "open": window.open, "because": _window_words(window)},
        "limits": [asdict(limit) | {"met": _met(limit, m.omega_c)} for limit in window.limits],
        "actuator": actuator,
        "noise_passed": heard,
        "load_left": None if left is None else {"value": left[0], "omega": left[1]},
        "mismatch": of_stable("mismatch", lambda: {name: getattr(model, name) for name in names}),
        "peaks": {"Ms": m.Ms, "Mt": m.Mt, "Ms_bound": Ms_bound, "Mt_bound": Mt_bound},
        "constraints": None
        if constraints is None
        else [
            asdict(c)
            | {name: [complex(getattr(c, name)).real, complex(getattr(c, name)).imag] for name in ("root", "S", "T")}
            for c in constraints
        ],
        "integrals": None if integrals is None else [asdict(i) for i in integrals],
        "step": None if shape is None else _step(shape),
        "plant_step": _step(alone),
        "curves": _curves(loop, model),
        "reasons": reasons,
    }
    return json_response(answer, request.arrays)


HOW = {
    "origin": "formula for L near 0",
    "middle": "Gauss's rule",
    "tail": "L beyond its corners",
}


@router.post("/bode-integral", summary="Bode's integral", responses={200: {"model": BodeIntegralAnswer}, **ERRORS})
def integral(request: Annotated[BodeIntegralRequest, Body(openapi_examples=INTEGRAL_EXAMPLES)]) -> Response:
    """The integral of ln|S| over all frequencies, in three pieces so that neither end is cut off, and the theorem.

    Null with the reason where the loop is not stable, or where L does not vanish at high frequencies.
    """
    with located("loop"):
        loop = request.loop.to_engine()
    found = bode_integral(loop)
    pieces = None
    if found.omega_low is not None and found.omega_high is not None:
        ends = [0.0, found.omega_low, found.omega_high, None]
        values = (found.origin, found.middle, found.tail)
        pieces = [
            {"name": name, "omega_from": ends[i], "omega_to": ends[i + 1], "value": values[i], "how": how}
            for i, (name, how) in enumerate(HOW.items())
        ]
    reasons = {} if found.reason is None else dict.fromkeys(("value", "pieces"), found.reason)
    if found.limit_sL is None:
        reasons["limit_sL"] = "infinite: L has as many zeros as poles"
    names = ("value", "theorem", "error", "area_below", "area_above", "limit_sL")
    return json_response(
        {name: getattr(found, name) for name in names}
        | {
            "difference": None if found.value is None or found.theorem is None else found.value - found.theorem,
            "pieces": pieces,
            "theta": loop.theta,
            "unstable_poles": complex_pairs(found.unstable_poles),
            "closed_loop_stable": closed_loop_verdict(loop).closed_loop_stable,
            "omega": found.omega,
            "ln_S": found.ln_S,
            "reasons": reasons,
        },
        request.arrays,
    )
