"""Models that come with the request: judged, and simulated."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body, Request
from starlette.responses import Response

from looplab.api.answers.nonlinear import ControlAnswer, ModelValidation, SimulationAnswer
from looplab.api.docs import BUSY, ERRORS
from looplab.api.encode import json_response
from looplab.api.simulations import ControlRequest, SimulationRequest, Workers, control_loops, open_loop_settings
from looplab.api.strict import StrictRoute
from looplab.engine.errors import InvalidInput
from looplab.jobs.tasks import ModelSource, control, simulate, validate
from looplab.labs.text import render_math
from looplab.schemas import NonlinearModel

router = APIRouter(tags=["models"], route_class=StrictRoute)

PREDATOR_PREY: dict[str, Any] = {
    "id": "predator-prey",
    "title": "Predators and their prey",
    "time_unit": "d",
    "parameters": [{"name": "a", "value": 1}, {"name": "b", "value": 0.5}, {"name": "c", "value": 0.8}],
    "inputs": [{"name": "hunt", "value": 0, "min": 0, "max": 1}],
    "states": [
        {"name": "prey", "initial": 2, "equation": "a*prey - b*prey*predators"},
        {"name": "predators", "initial": 1, "equation": "b*prey*predators - (c + hunt)*predators"},
    ],
}
SIMULATE_EXAMPLES: dict[str, Any] = {
    "predators and prey": {"value": {"model": PREDATOR_PREY, "horizon": 30, "points": 101}},
    "hunting begins, with noise": {
        "value": {
            "model": PREDATOR_PREY,
            "horizon": 30,
            "points": 101,
            "parameters": {"a": 1.2},
            "initial": {"prey": 3},
            "inputs": {
                "hunt": {
                    "level": 0.1,
                    "add": [
                        {"type": "step", "amplitude": 0.2, "start": 10},
                        {"type": "noise", "std": 0.01, "interval": 1, "seed": 7},
                    ],
                }
            },
        }
    },
    "it runs away": {
        "value": {
            "model": {"id": "escape", "title": "x' = x^2", "states": [{"name": "x", "initial": 1, "equation": "x^2"}]},
            "horizon": 2,
        }
    },
}
VALIDATE_EXAMPLES: dict[str, Any] = {
    "in order": {"value": PREDATOR_PREY},
    "a name mistyped": {
        "value": {
            "id": "tank",
            "title": "Tank",
            "parameters": [{"name": "beta", "value": 0.5}],
            "states": [{"name": "h", "initial": 1, "equation": "-bta*sqrt(h)"}],
        }
    },
}


TANK: dict[str, Any] = {
    "id": "tank",
    "title": "Tank drained by gravity",
    "time_unit": "min",
    "inputs": [{"name": "Fi", "value": 0.5, "unit": "m^3/min", "min": 0, "max": 5}],
    "states": [{"name": "h", "initial": 1, "unit": "m", "equation": "(Fi - 0.5*sqrt(max(h, 0)))/2"}],
}
# A rod of 0.6 m and 0.2 kg on a cart of 0.5 kg.
PENDULUM: dict[str, Any] = {
    "id": "pendulum",
    "title": "Pendulum on a cart",
    "parameters": [{"name": "M", "value": 0.5}, {"name": "m", "value": 0.2}, {"name": "l", "value": 0.3}],
    "inputs": [{"name": "F", "value": 0, "unit": "N", "min": -50, "max": 50}],
    "variables": [
        {"name": "J", "expression": "4/3*m*l^2"},
        {"name": "push", "expression": "F - 0.1*v + m*l*omega^2*sin(phi)"},
        {"name": "turn", "expression": "9.81*m*l*sin(phi) - 0.01*omega"},
        {"name": "D", "expression": "(M + m)*J - (m*l*cos(phi))^2"},
    ],
    "states": [
        {"name": "x", "initial": 0, "unit": "m", "equation": "v"},
        {"name": "v", "initial": 0, "unit": "m/s", "equation": "(J*push - m*l*cos(phi)*turn)/D"},
        {"name": "phi", "initial": 0.1, "unit": "rad", "equation": "omega"},
        {"name": "omega", "initial": 0, "unit": "rad/s", "equation": "((M + m)*turn - m*l*cos(phi)*push)/D"},
    ],
    "events": [{"name": "fallen", "when": "cos(phi) <= 0", "action": "stop", "message": "the pendulum has fallen"}],
}
CONTROL_EXAMPLES: dict[str, Any] = {
    "a level whose integral winds up": {
        "value": {
            "model": TANK,
            "horizon": 100,
            "points": 201,
            "loops": [
                {
                    "output": "h",
                    "input": "Fi",
                    "setpoint": {"table": {"times": [0, 5, 45], "values": [1, 1.6, 1]}},
                    "controller": {"type": "pid", "Kc": 1.5, "tau_I": 6},
                    "u_max": 0.65,
                    "anti_windup": "none",
                }
            ],
        }
    },
    "a pendulum held upright by a computer": {
        "value": {
            "model": PENDULUM,
            "horizon": 3,
            "points": 151,
            "loops": [
                {
                    "output": "phi",
                    "input": "F",
                    "setpoint": 0,
                    "controller": {"type": "pid", "Kc": 40, "tau_I": 1, "tau_D": 0.15, "action": "direct"},
                    "sampling_time": 0.02,
                    "discretization": "tustin",
                    "anti_windup": "clamping",
                }
            ],
        }
    },
}


class ModelSimulationRequest(SimulationRequest):
    """A model, and how it is simulated."""

    model: NonlinearModel


class ModelControlRequest(ControlRequest):
    """A model, and how it is controlled."""

    model: NonlinearModel


@router.post(
    "/models/validate", summary="Validate a model", responses={200: {"model": ModelValidation}, **ERRORS, **BUSY}
)
async def validate_model(
    document: Annotated[dict[str, Any], Body(openapi_examples=VALIDATE_EXAMPLES)], request: Request, workers: Workers
) -> Response:
    """What has to be repaired in a model, with its place and the column in the formula; if nothing, its equations.

    A model is in order when it can be read and computed at its nominal point.
    """
    # As it was sent: a draft may be nested deeper than can be written out again.
    verdict = await workers.run(validate, await request.body())
    for equation in verdict["equations"]:
        equation["mathml"] = _mathml(equation["latex"])
    return json_response(verdict)


@router.post(
    "/models/simulate", summary="Simulate a model", responses={200: {"model": SimulationAnswer}, **ERRORS, **BUSY}
)
async def simulate_model(
    request: Annotated[ModelSimulationRequest, Body(openapi_examples=SIMULATE_EXAMPLES)], workers: Workers
) -> Response:
    """States, outputs and inputs of a model over time. It is cut, with the reason, where it cannot go on."""
    settings = open_loop_settings(request, request.model)
    answer = await workers.run(simulate, ModelSource.document(request.model.to_document()), settings)
    return json_response(answer, request.arrays)


@router.post("/models/control", summary="Control a model", responses={200: {"model": ControlAnswer}, **ERRORS, **BUSY})
async def control_model(
    request: Annotated[ModelControlRequest, Body(openapi_examples=CONTROL_EXAMPLES)], workers: Workers
) -> Response:
    """A model with up to three PID loops. An algebraic loop is refused; one that runs away is cut, with the reason."""
    settings = open_loop_settings(request, request.model)
    source = ModelSource.document(request.model.to_document())
    answer = await workers.run(control, source, settings, control_loops(request))
    return json_response(answer, request.arrays)


def _mathml(latex: str) -> str:
    """MathML; empty where the author's symbols are no LaTeX, or the formula is too deep to be shown."""
    try:
        return render_math(latex, display=True)
    except InvalidInput:
        return ""
