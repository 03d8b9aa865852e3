"""The Smith predictor beside PI and PID at the same peak of the sensitivity, and the plants it stands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.design import SmithAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import Arrays, json_response
from looplab.api.judged import judged_answer
from looplab.api.strict import StrictRoute
from looplab.api.tuning_request import controller_answer
from looplab.engine.design import (
    RANGES,
    Axis,
    MismatchLoop,
    Plane,
    known_failures,
    smith_loop,
    smith_tuning,
    stable_intervals,
    stable_region,
)
from looplab.engine.design.smith_tuning import nominal_peak
from looplab.engine.design.stable_region import AXES
from looplab.engine.errors import EngineError, InvalidInput, RuleNotApplicable
from looplab.engine.loop import PID
from looplab.engine.systems import TransferFunction
from looplab.engine.tuning import ComparedLoop, OptimalTuning, compare, optimal_tuning, perturbed_plant, plant_horizon
from looplab.labs.text import render_math
from looplab.schemas import AnyPID, Model, System, located

router = APIRouter(tags=["design"], route_class=StrictRoute)

Name = Literal["smith", "PI", "PID"]
NAMES: tuple[Name, ...] = ("smith", "PI", "PID")
# Factors up to which single changes of gain and dead time are followed.
FARTHEST = 10.0
# Sums of dead time and slowest lag in which responses settle; what stands for the lag of an integrating model.
SETTLED, INTEGRATING = 6.0, 4.0


class MismatchFactors(Model):
    """The plant's gain, time constants and dead time over those that the predictor knows."""

    K: Annotated[float, Field(ge=RANGES["K"][0], le=RANGES["K"][1])] = 1.0
    tau: Annotated[float, Field(ge=RANGES["tau"][0], le=RANGES["tau"][1])] = 1.0
    theta: Annotated[float, Field(ge=RANGES["theta"][0], le=RANGES["theta"][1])] = 1.0


class SmithRequest(Model):
    """What the predictor knows, what the plant is, and how robust the loops shall be."""

    model: System = Field(description="With its dead time: what every controller is tuned for.")
    plant: System | None = Field(default=None, description="The true plant; left out, the model.")
    mismatch: MismatchFactors = Field(default=MismatchFactors(), description="Changes the plant further.")
    controller: AnyPID | None = Field(
        default=None, description="Inside the predictor; left out, tuned so that the loop has the Ms asked for."
    )
    Ms_limit: Annotated[float, Field(ge=1.05, le=2.0, description="Of all three loops, without mismatch.")] = 1.6
    want: Annotated[list[Literal["loops", "region"]], Field(max_length=4)] = Field(default=["loops"])
    plane: Annotated[Plane, Field(description="Axes of the region: first that of the exact stretches.")] = "theta_K"
    region_rows: Annotated[int, Field(ge=5, le=81)] = 41
    horizon: Annotated[float | None, Field(gt=0, description="Length of the responses [time].")] = None
    points: Annotated[int, Field(ge=20, le=1000)] = 300
    arrays: Arrays = "list"


@dataclass(frozen=True)
class _Contestants:
    """The controllers, each with the reason where there is none, and how the predictor's was come by."""

    controllers: dict[Name, PID | str]
    tuning: dict[str, Any]


def _attempt(find: Callable[[], PID]) -> PID | str:
    try:
        return find()
    except EngineError as error:
        return error.message


def _best(model: TransferFunction, type: Literal["PI", "PID"], Ms: float) -> OptimalTuning:
    """What the predictor is compared with; cached by content."""
    return optimal_tuning(model, type, "IAE", "load", Ms)


def _contestants(request: SmithRequest, model: TransferFunction) -> _Contestants:
    plain: dict[Name, PID | str] = {
        name: _attempt(lambda name=name: _best(model, name, request.Ms_limit).controller)  # type: ignore[misc]
        for name in ("PI", "PID")
    }
    if request.controller is not None:
        with located("controller"):
            C = request.controller.to_engine()
            if not C.Kc:
                raise InvalidInput("a gain of zero closes no loop", field="Kc")
        given: dict[str, Any] = {"how": "as given", "tau_c": None, "Ms": None, "on_limit": None}
        return _Contestants({"smith": C, **plain}, given)
    try:
        found = smith_tuning(model, request.Ms_limit)
    except EngineError as error:
        fallback = plain["PI"]
        if not model.theta:
            raise
        if isinstance(fallback, str):
            raise RuleNotApplicable(
                f"there is no controller to put inside the predictor: {error.message}; and {fallback}",
                field="controller",
                hint="give one, or allow a larger Ms_limit",
            ) from error
        how = "the settings of the plain PI, for SIMC has none for this model"
        return _Contestants({"smith": fallback, **plain}, {"how": how, "tau_c": None, "Ms": None, "on_limit": None})
    how = (
        f"SIMC for the model without its dead time, tau_c = {found.tau_c:.4g}: the fastest with Ms = {found.Ms:.4g} "
        "where the model is right"
    )
    if not found.on_limit:
        how = f"SIMC for the model without its dead time, tau_c = {found.tau_c:.4g}; Ms stays below the limit"
    tuning: dict[str, Any] = {"how": how, "tau_c": found.tau_c, "Ms": found.Ms, "on_limit": found.on_limit}
    return _Contestants({"smith": found.controller, **plain}, tuning)


def _tolerated(loop: MismatchLoop, at: dict[Axis, float]) -> dict[str, Any]:
    """The stable stretch around the present plant along gain and dead time."""
    out: dict[str, Any] = {"reasons": {}}
    axes: tuple[Axis, ...] = ("K", "theta")
    for axis in axes:
        rest = {name: np.array([value]) for name, value in at.items() if name != axis}
        [stretches] = stable_intervals(loop, axis, rest, (0.0 if axis == "theta" else 1e-3, FARTHEST))
        out[axis] = next((list(s) for s in stretches if s[0] <= at[axis] <= s[1]), None)
        if out[axis] is None:
            out["reasons"][axis] = "the loop is not stable on this plant"
        elif out[axis][1] == FARTHEST:
            out["reasons"][axis] = f"looked at up to {FARTHEST:g} times"
    return out


@dataclass(frozen=True)
class _Case:
    """A request worked out as far as all its rows share."""

    request: SmithRequest
    model: TransferFunction
    base: TransferFunction
    plant: TransferFunction
    horizon: float

    @property
    def at(self) -> dict[Axis, float]:
        """Factors of the present plant."""
        found = self.request.mismatch
        return {"K": found.K, "tau": found.tau, "theta": found.theta}

    def loop(self, name: Name, controller: PID) -> ComparedLoop:
        """The loop judged on the plant."""
        if name == "smith":
            return smith_loop(controller, self.model, self.plant, self.horizon, self.request.points)
        [found] = compare(self.plant, [controller], self.horizon, self.request.points)
        return found

    def family(self, name: Name, controller: PID) -> MismatchLoop:
        """The same loop on all plants."""
        return MismatchLoop(controller, self.base, self.model if name == "smith" else None)


def _row(name: Name, controller: PID | str, case: _Case, nominal: float | None) -> dict[str, Any]:
    answer: dict[str, Any] = {"name": name, "valid": False, "reason": None, "Ms_nominal": nominal}
    empty = ("controller", "closed_loop_stable", "margins", "setpoint", "load", "responses", "tolerates")
    answer |= dict.fromkeys(empty)
    if isinstance(controller, str):
        return answer | {"reason": controller}
    try:
        answer |= judged_answer(case.loop(name, controller))
    except EngineError as error:
        return answer | {"reason": error.message}
    try:
        answer["tolerates"] = _tolerated(case.family(name, controller), case.at)
    except EngineError as error:
        answer["tolerates"] = {"K": None, "theta": None, "reasons": {"K": error.message, "theta": error.message}}
    return answer | {"valid": True, "controller": controller_answer(controller)}


def _region(case: _Case, controllers: dict[Name, PID | str]) -> dict[str, Any]:
    plane, count = case.request.plane, case.request.region_rows
    along, across, _ = AXES[plane]
    loops = []
    for name, controller in controllers.items():
        entry: dict[str, Any] = {"name": name, "intervals": None, "reason": None}
        if isinstance(controller, str):
            entry["reason"] = controller
        else:
            try:
                found = stable_region(case.family(name, controller), plane, case.at, count)
                entry["intervals"] = [[list(pair) for pair in row] for row in found.intervals]
            except EngineError as error:
                entry["reason"] = error.message
        loops.append(entry)
    return {
        "along": along,
        "across": across,
        "along_range": list(RANGES[along]),
        "across_range": list(RANGES[across]),
        "rows": np.linspace(*RANGES[across], count).tolist(),
        "loops": loops,
    }


def _nominal(name: Name, controller: PID | str, request: SmithRequest, model: TransferFunction) -> float | None:
    """Ms without mismatch: what the loops were tuned to."""
    if isinstance(controller, str):
        return None
    if name != "smith":
        return _best(model, name, request.Ms_limit).Ms
    return None if (model.poles.real > 0).any() else nominal_peak(controller, model)


def _horizon(model: TransferFunction) -> float:
    """Time in which loops of this robustness come to rest [time]."""
    slowest = max((1.0 / abs(p) for p in model.poles if p != 0), default=0.0)
    if model.origin_order > 0:
        slowest = max(slowest, INTEGRATING * model.theta)
    return float(f"{SETTLED * (model.theta + slowest):.2g}") or plant_horizon(model)


def _text(system: TransferFunction) -> dict[str, str]:
    latex = system.to_latex()
    return {"text": system.to_text(4), "latex": latex, "mathml": render_math(latex)}


MODEL = {"type": "fopdt", "K": 1, "tau": 2, "theta": 4}
EXAMPLES: dict[str, Any] = {
    "a dead time that grew": {"value": {"model": MODEL, "mismatch": {"theta": 1.25}, "points": 60}},
    "the plants it stands": {"value": {"model": MODEL, "want": ["region"], "region_rows": 9}},
    "an integrating process": {
        "value": {"model": {"type": "expr", "text": "0.5 exp(-2s)/s"}, "Ms_limit": 1.5, "points": 60}
    },
}


@router.post("/smith", summary="Smith predictor", responses={200: {"model": SmithAnswer}, **ERRORS})
def smith(request: Annotated[SmithRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """A Smith predictor beside the best PI and PID of the same Ms, on a plant that need not be the model.

    PI and PID have the smallest IAE after a load within Ms; the predictor's PI is SIMC's for the model without its dead
    time, with tau_c lowered until the predictor's own Ms is the same. Dead times are exact everywhere. The region holds
    the plants on which each loop is stable: the ends of every stretch are exact.
    """
    with located("model"):
        model = request.model.to_engine().require_proper()
    base = model
    if request.plant is not None:
        with located("plant"):
            base = request.plant.to_engine().require_proper()
    factors = request.mismatch
    case = _Case(
        request,
        model,
        base,
        perturbed_plant(base, factors.K, factors.tau, factors.theta),
        request.horizon or _horizon(model),
    )
    found = _contestants(request, model)
    reasons = {}
    if "region" not in request.want:
        reasons["region"] = "not asked for: name it in want"
    rows = []
    if "loops" in request.want:
        rows = [_row(n, C, case, _nominal(n, C, request, model)) for n, C in found.controllers.items()]
    inside = found.controllers["smith"]
    return json_response(
        {
            "time_unit": "s",
            "model": _text(model),
            "plant": _text(case.plant),
            "mismatch": case.at,
            "Ms_limit": request.Ms_limit,
            "tuning": found.tuning,
            "horizon": case.horizon,
            "rows": rows,
            "notes": [] if isinstance(inside, str) else list(known_failures(inside, model)),
            "region": _region(case, found.controllers) if "region" in request.want else None,
            "reasons": reasons,
        },
        request.arrays,
    )
