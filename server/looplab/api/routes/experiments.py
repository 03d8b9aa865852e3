"""Virtual experiments: a step test, the ultimate cycle and relay feedback, on linear and nonlinear plants."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from looplab.api.answers.experiments import RelayAnswer, StepTestAnswer, UltimateCycleAnswer
from looplab.api.docs import BUSY, ERRORS
from looplab.api.encode import json_response
from looplab.api.experiment_plant import library_point, linear_plant, require_horizon
from looplab.api.simulations import Workers
from looplab.api.strict import StrictRoute
from looplab.engine.errors import EngineError, RuleNotApplicable
from looplab.engine.experiments.linear_relay import linear_relay
from looplab.engine.experiments.relay import Relay
from looplab.engine.experiments.step_test import StepTest, linear_step_test
from looplab.engine.experiments.ultimate_cycle import Ringing, ring, ultimate_cycle
from looplab.engine.nonlinear.control_loop import Instrument
from looplab.engine.response.horizon import response_horizon
from looplab.engine.response.inputs import step
from looplab.engine.systems import TransferFunction
from looplab.engine.tuning.ultimate_point import stabilising_sign, ultimate_point
from looplab.jobs import experiments as tasks
from looplab.schemas import Model, PlantSystem, System, located
from looplab.schemas.control_loops import SensorShape

router = APIRouter(prefix="/experiments", tags=["experiments"], route_class=StrictRoute)

Horizon = Annotated[float | None, Field(ge=1e-9, le=1e9, description="Left out: chosen for a linear plant [time].")]
CSTR = {"type": "plant", "id": "cstr", "input": "Q", "output": "T", "operating_point": "middle"}
TANKS = {"type": "plant", "id": "two-tanks-interacting", "input": "Fi", "output": "h2"}
FOPDT_PLANT = {"type": "fopdt", "K": 1, "tau": 2, "theta": 1}


class StepTestRequest(Model):
    """An open-loop step test."""

    plant: System
    size: Annotated[float, Field(description="Change of the input [input].")] = 1.0
    start: Annotated[float, Field(ge=0, description="When it is made; moved to the next sample [time].")] = 0.0
    horizon: Horizon = None
    points: Annotated[int, Field(ge=20, le=5000)] = 200
    noise: Annotated[float, Field(ge=0, description="Standard deviation of the measurement noise [output].")] = 0.0
    seed: Annotated[int, Field(ge=0, le=2**31)] = 0
    drift: Annotated[float, Field(description="Slope added to the measurement [output/time].")] = 0.0
    u_min: float | None = None
    u_max: float | None = None

    def test(self, horizon: float) -> StepTest:
        """The same for the engine."""
        limits = (self.u_min, self.u_max)
        return StepTest(self.size, self.start, horizon, self.points, self.noise, self.seed, self.drift, *limits)


class UltimateCycleRequest(Model):
    """Proportional control with a given gain, or the search for the ultimate one."""

    plant: System
    Kc: Annotated[float | None, Field(description="One run with this gain; left out: Ku is searched.")] = None
    horizon: Horizon = None
    start: Annotated[
        float, Field(description="Gain, with its sign, that the search on a library plant begins with.")
    ] = 0.1
    bump: Annotated[
        float | None, Field(gt=0, description="Step of a library plant's setpoint; left out: a thousandth [output].")
    ] = None
    sensor: Annotated[SensorShape, Field(description="Lag and dead time of a library plant's sensor.")] = Field(
        default=SensorShape()
    )

    def instrument(self) -> Instrument:
        """The sensor for the engine."""
        with located("sensor.lag"):
            return Instrument(None if self.sensor.lag is None else self.sensor.lag.to_engine(), self.sensor.theta)


class RelayRequest(Model):
    """Relay feedback about the plant's point of rest."""

    plant: System
    amplitude: Annotated[float, Field(gt=0, description="d: half the height of the square wave [input].")] = 1.0
    hysteresis: Annotated[float, Field(ge=0, description="Half the width of the dead band [output].")] = 0.0
    negative_gain: Annotated[bool, Field(description="Of a library plant: its output falls as its input rises.")] = (
        False
    )
    horizon: Horizon = None


STEP_EXAMPLES: dict[str, Any] = {
    "with noise": {"value": {"plant": FOPDT_PLANT, "start": 1, "noise": 0.02, "seed": 3, "points": 60}},
    "on two tanks": {"value": {"plant": TANKS, "size": 0.2, "start": 1, "horizon": 20, "points": 60, "drift": 0.001}},
}
CYCLE_EXAMPLES: dict[str, Any] = {
    "search": {"value": {"plant": {"type": "expr", "text": "1/(s+1)^3"}}},
    "one gain": {"value": {"plant": {"type": "expr", "text": "exp(-0.1s)/(0.5s+1)"}, "Kc": 6}},
    "two tanks with a slow sensor": {
        "value": {"plant": TANKS, "Kc": 3, "horizon": 20, "sensor": {"lag": {"tau": 0.5}, "theta": 0.2}}
    },
}
RELAY_EXAMPLES: dict[str, Any] = {
    "a lag with dead time": {"value": {"plant": FOPDT_PLANT}},
    "two tanks": {"value": {"plant": TANKS, "amplitude": 0.3, "hysteresis": 0.02, "horizon": 60}},
}


@router.post(
    "/step-test", summary="An open-loop step test", responses={200: {"model": StepTestAnswer}, **ERRORS, **BUSY}
)
async def step_test(
    request: Annotated[StepTestRequest, Body(openapi_examples=STEP_EXAMPLES)], workers: Workers
) -> Response:
    """The record of a step of the input, with noise, drift and limits of the input; /identify takes its t, u and y."""
    if isinstance(request.plant, PlantSystem):
        test = request.test(require_horizon(request.horizon))
        return json_response(await workers.run(tasks.step_test, library_point(request.plant), test))
    plant = linear_plant(request.plant)
    horizon = request.horizon or request.start + response_horizon(plant.poles, step(1.0), plant.theta)
    found = await run_in_threadpool(linear_step_test, plant, request.test(horizon))
    return json_response(tasks.step_test_answer(found, 0.0, 0.0, "s"))


def _ringing(run: Ringing) -> dict[str, Any]:
    response, n = run.response, run.response.y.size
    seen = run.oscillation
    return {
        "Kc": run.Kc,
        "horizon": run.horizon,
        "t": response.t[:n],
        "r": np.ones(n),
        "u": response.u,
        "y": response.y,
        "turning_points": {"t": seen.t, "y": seen.y},
        "decay_ratio": seen.decay_ratio,
        "Pu": seen.Pu,
        "reason": None if seen.growth is not None else "there are too few swings to tell their decay",
        "truncated_at": response.truncated_at,
        "truncated_reason": response.truncated_reason,
    }


def _exact(plant: TransferFunction) -> dict[str, float] | None:
    try:
        return asdict(ultimate_point(plant))
    except EngineError:
        return None


def _linear_cycle(plant: TransferFunction, Kc: float | None, horizon: float | None) -> dict[str, Any]:
    empty = dict.fromkeys(("Ku", "Pu", "omega_180", "error_pct", "window"))
    if Kc is not None:
        exact = _exact(plant)
        notes = [] if exact else ["the plant has no ultimate gain"]
        about = {"time_unit": "s", "trials": [], "exact": exact, "notes": notes}
        return {**empty, **about, "run": _ringing(ring(plant, Kc, horizon))}
    found = ultimate_cycle(plant)
    low, high = found.window.low.K, found.window.high.K
    notes = []
    if low:
        notes.append(f"the plant is unstable without control: gains from {low:.6g} to {high:.6g} hold it")
    Ku, Pu = found.found.Ku, found.found.Pu
    return {
        "time_unit": "s",
        "Ku": Ku,
        "Pu": Pu,
        "omega_180": 2.0 * np.pi / Pu,
        "trials": [asdict(trial) for trial in found.found.trials],
        "exact": asdict(found.exact),
        "error_pct": 100.0 * (Ku / found.exact.Ku - 1.0),
        "window": {"low": low, "high": high},
        "notes": notes,
        "run": _ringing(found.ringing),
    }


@router.post(
    "/ultimate-cycle",
    summary="The ultimate cycle under proportional control",
    responses={200: {"model": UltimateCycleAnswer}, **ERRORS, **BUSY},
)
async def cycle(
    request: Annotated[UltimateCycleRequest, Body(openapi_examples=CYCLE_EXAMPLES)], workers: Workers
) -> Response:
    """How a loop rings with the gain Kc; without one, Ku and Pu searched from the decay of the responses alone.

    Beside the search stands the exact point of a linear plant. A plant without an ultimate gain is refused with the
    reason; of an unstable one the window of stable gains is told.
    """
    if isinstance(request.plant, PlantSystem):
        horizon, sensor = require_horizon(request.horizon), request.instrument()
        at = library_point(request.plant)
        answer = await workers.run(tasks.ultimate_cycle, at, request.Kc, request.start, request.bump, horizon, sensor)
        return json_response({**answer, "exact": None, "error_pct": None, "window": None})
    plant = linear_plant(request.plant)
    return json_response(await run_in_threadpool(_linear_cycle, plant, request.Kc, request.horizon))


def _linear_relay(plant: TransferFunction, amplitude: float, hysteresis: float) -> dict[str, Any]:
    relay = Relay(amplitude, hysteresis, int(stabilising_sign(plant)))
    found = linear_relay(plant, relay)
    exact = _exact(plant)
    known = exact is not None and found.point is not None
    return {
        **tasks.relay_answer(found, relay, "s"),
        "u0": 0.0,
        "y0": 0.0,
        "exact": exact,
        "Ku_bias_pct": 100.0 * (found.point.Ku / exact["Ku"] - 1.0) if known and exact and found.point else None,
        "Pu_bias_pct": 100.0 * (found.point.Pu / exact["Pu"] - 1.0) if known and exact and found.point else None,
        "notes": [],
    }


@router.post("/relay", summary="Relay feedback", responses={200: {"model": RelayAnswer}, **ERRORS, **BUSY})
async def relay(request: Annotated[RelayRequest, Body(openapi_examples=RELAY_EXAMPLES)], workers: Workers) -> Response:
    """The limit cycle of a relay with hysteresis, and Ku by its describing function.

    Of a linear plant every switch is exact, and the bias of the describing function against the exact ultimate point is
    told; /tune takes the answer's `relay`.
    """
    if isinstance(request.plant, PlantSystem):
        horizon = require_horizon(request.horizon)
        settings = Relay(request.amplitude, request.hysteresis, -1 if request.negative_gain else 1)
        answer = await workers.run(tasks.relay, library_point(request.plant), settings, horizon, horizon / 20.0)
        return json_response({**answer, "exact": None, "Ku_bias_pct": None, "Pu_bias_pct": None})
    plant = linear_plant(request.plant)
    if not plant.order:
        raise RuleNotApplicable("the plant has no poles: there is nothing that oscillates", field="plant")
    return json_response(await run_in_threadpool(_linear_relay, plant, request.amplitude, request.hysteresis))
