"""Controllers side by side on one plant, on another than they were tuned for, and over a spread of plants."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.responses import Response

from looplab.api.answers.compare import CompareAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import Arrays, json_response
from looplab.api.judged import judged_answer
from looplab.api.strict import StrictRoute
from looplab.api.tuning_request import RuleOptions, controller_answer
from looplab.engine.errors import EngineError
from looplab.engine.loop import PID
from looplab.engine.systems import TransferFunction
from looplab.engine.tuning import (
    RULES,
    Band,
    Case,
    KnownPlant,
    RuleName,
    TypeName,
    compare,
    plant_horizon,
    sensitivity,
)
from looplab.schemas import AnyPID, Model, System, located

router = APIRouter(tags=["tuning"], route_class=StrictRoute)

MOST, MOST_WITH_SPREAD = 12, 4


class Entry(Model):
    """One row: a rule with its type of controller, or a controller with a label of its own."""

    rule: RuleName | None = None
    type: TypeName | None = None
    controller: AnyPID | None = None
    label: Annotated[str | None, Field(min_length=1, max_length=60)] = None

    @model_validator(mode="after")
    def _one(self) -> Entry:
        if (self.rule is None) == (self.controller is None):
            raise ValueError("give a rule or a controller")
        if (self.rule is None) != (self.type is None):
            raise ValueError("a rule comes with the type of controller, and a controller without")
        return self


class CompareRequest(RuleOptions):
    """A plant to tune on, controllers, and what they are to be judged on."""

    plant: Annotated[System, Field(description="What the rules are told.")]
    true_plant: Annotated[
        System | None, Field(description="What the loops are closed around; left out, the plant itself.")
    ] = None
    entries: Annotated[list[Entry], Field(min_length=1, max_length=MOST)]
    spread_pct: Annotated[
        float | None, Field(gt=0, le=90, description="Vary gain, time constants and dead time by so much [%].")
    ] = None
    horizon: Annotated[float | None, Field(gt=0, description="Length of the responses [time].")] = None
    points: Annotated[int, Field(ge=20, le=1000)] = 300
    arrays: Arrays = "list"

    @model_validator(mode="after")
    def _bounded(self) -> CompareRequest:
        if self.spread_pct is not None and len(self.entries) > MOST_WITH_SPREAD:
            raise ValueError(f"with a spread at most {MOST_WITH_SPREAD} entries: each is simulated on 9 plants")
        return self


@dataclass(frozen=True)
class _Row:
    """A controller with its label, or the reason why its rule gives none."""

    head: dict[str, Any]
    controller: PID | None
    reason: str | None = None


def _row(entry: Entry, index: int, known: KnownPlant, request: CompareRequest) -> _Row:
    head = {"label": entry.label, "rule": entry.rule, "type": entry.type}
    if entry.controller is not None:
        with located(f"entries[{index}].controller"):
            controller = entry.controller.to_engine()
        return _Row(head | {"label": entry.label or "your controller", "type": controller.type}, controller)
    assert entry.rule is not None
    assert entry.type is not None
    rule = RULES[entry.rule]
    head["label"] = entry.label or f"{rule.name}, {entry.type}"
    try:
        found = known.tune(rule, entry.type, request.options())
    except EngineError as error:
        return _Row(head, None, error.message)
    return _Row(head, PID(found.Kc, found.tau_I, found.tau_D, found.alpha))


def _case(case: Case | None) -> dict[str, Any] | None:
    if case is None:
        return None
    return {
        "K": case.K,
        "tau": case.tau,
        "theta": case.theta,
        "closed_loop_stable": case.loop.margins.closed_loop_stable,
        "Ms": case.loop.margins.Ms,
        "IAE": case.loop.setpoint.IAE,
        "load_IAE": case.loop.load.IAE,
    }


def _band(band: Band | None) -> dict[str, Any] | None:
    return None if band is None else {"low": band.low, "high": band.high}


def _spread(plant: TransferFunction, controller: PID, request: CompareRequest, horizon: float) -> dict[str, Any]:
    assert request.spread_pct is not None
    found = sensitivity(plant, controller, request.spread_pct, horizon, request.points)
    reason = None
    if found.unstable:
        reason = (
            f"the loop is not stable on {len(found.unstable)} of {len(found.cases)} plants; the bands leave them out"
        )
    return {
        "spread_pct": request.spread_pct,
        "t": found.t,
        "setpoint": _band(found.setpoint),
        "load": _band(found.load),
        "cases": len(found.cases),
        "unstable": [_case(c) for c in found.unstable],
        "worst_Ms": _case(found.worst_Ms),
        "worst_IAE": _case(found.worst_IAE),
        "reason": reason,
    }


def _simulated(true: TransferFunction, controller: PID, request: CompareRequest, horizon: float) -> dict[str, Any]:
    """A row's loop on the true plant; raises EngineError where the two make no loop that can be computed."""
    [loop] = compare(true, [controller], horizon, request.points)
    answer = judged_answer(loop) | {"controller": controller_answer(controller)}
    if request.spread_pct is not None:
        answer["sensitivity"] = _spread(true, controller, request, horizon)
    return answer


EXAMPLES = {
    "rules on their own model": {
        "value": {
            "plant": {"type": "fopdt", "K": 1, "tau": 5, "theta": 1},
            "entries": [
                {"rule": "ziegler_nichols", "type": "PI"},
                {"rule": "simc", "type": "PI"},
                {"label": "by hand", "controller": {"type": "pid", "Kc": 2, "tau_I": 3}},
            ],
            "points": 60,
        }
    },
    "a plant that is not the model": {
        "value": {
            "plant": {"type": "fopdt", "K": 1, "tau": 5, "theta": 1},
            "true_plant": {"type": "expr", "text": "1.2 exp(-s)/((4s+1)(s+1))"},
            "entries": [{"rule": "simc", "type": "PI"}, {"rule": "amigo", "type": "PID"}],
            "points": 60,
        }
    },
    "a spread": {
        "value": {
            "plant": {"type": "fopdt", "K": 1, "tau": 5, "theta": 1},
            "entries": [{"rule": "itae_load", "type": "PI"}],
            "spread_pct": 20,
            "points": 60,
        }
    },
}


@router.post("/compare", summary="Controllers side by side", responses={200: {"model": CompareAnswer}, **ERRORS})
def compare_controllers(request: Annotated[CompareRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Margins, metrics and responses of up to 12 controllers on one plant, mismatch and all.

    The rules tune on `plant`; the loops are closed around `true_plant`. With `spread_pct` each of up to 4 controllers
    meets 9 plants (the nominal one, and every corner of gain, time constants and dead time): the bands of y, the worst
    case, and the plants on which the loop is not stable.
    """
    with located("plant"):
        plant = request.plant.to_engine()
    known, true = KnownPlant.of(plant), plant
    if request.true_plant is not None:
        with located("true_plant"):
            true = request.true_plant.to_engine().require_proper()
    rows = [_row(entry, i, known, request) for i, entry in enumerate(request.entries)]
    horizon = request.horizon or plant_horizon(true)
    out = []
    for row in rows:
        answer: dict[str, Any] = {**row.head, "valid": row.controller is not None, "reason": row.reason}
        answer |= dict.fromkeys(("controller", "closed_loop_stable", "margins", "setpoint", "load", "responses"))
        answer["sensitivity"] = None
        if row.controller is not None:
            try:
                answer |= _simulated(true, row.controller, request, horizon)
            except EngineError as error:
                answer |= {"valid": False, "reason": error.message}
        out.append(answer)
    return json_response({"horizon": horizon, "rows": out}, request.arrays)
