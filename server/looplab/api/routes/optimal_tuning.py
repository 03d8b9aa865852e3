"""The best settings under a limit of robustness, the price of that limit, and the forms of a controller."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.tune import FormsAnswer, OptimalAnswer, TradeOffAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.strict import StrictRoute
from looplab.api.tuning_request import controller_answer, forms_answer, gains_answer
from looplab.engine.systems import TransferFunction
from looplab.engine.tuning import (
    Aim,
    Criterion,
    Gains,
    OptimalTuning,
    ParallelGains,
    optimal_tuning,
    parallel_to_ideal,
    proportional_band,
    series_to_ideal,
    trade_off,
)
from looplab.schemas import AnyPID, Model, ParallelPID, System, located

router = APIRouter(tags=["tuning"], route_class=StrictRoute)

MsLimit = Annotated[float, Field(ge=1.05, le=4.0)]


class SearchRequest(Model):
    """A plant, and what is to be smallest."""

    plant: System
    type: Literal["P", "PI", "PID"] = "PI"
    criterion: Criterion = "IAE"
    aim: Annotated[Aim, Field(description="After a unit step of the load or of the setpoint.")] = "load"

    def transfer_function(self) -> TransferFunction:
        """The plant for the engine; raises EngineError naming the field."""
        with located("plant"):
            return self.plant.to_engine().require_proper()


class OptimalRequest(SearchRequest):
    """One search."""

    Ms_limit: Annotated[MsLimit, Field(description="Largest sensitivity allowed: 1.4 is robust, 2 is fast.")] = 1.6
    Mt_limit: MsLimit | None = None


class TradeOffRequest(SearchRequest):
    """A search for each of some limits."""

    Ms_limits: Annotated[list[MsLimit], Field(min_length=1, max_length=8)] = Field(
        default=[1.2, 1.4, 1.6, 1.8, 2.0, 2.2], description="Limits of Ms; every one is a search of its own."
    )


class FormsRequest(Model):
    """A controller, and whether its derivative filter counts in the conversion."""

    controller: AnyPID
    filtered: Annotated[
        bool, Field(description="Convert the filtered controller exactly; false for the textbook's unfiltered one.")
    ] = False


def _optimum(found: OptimalTuning) -> dict[str, Any]:
    return asdict(found) | {"controller": controller_answer(found.controller)}


PLANT = {"type": "fopdt", "K": 1, "tau": 5, "theta": 1}
OPTIMAL_EXAMPLES = {
    "PI for a load": {"value": {"plant": PLANT, "type": "PI", "Ms_limit": 1.6}},
    "PID for a setpoint": {
        "value": {
            "plant": {"type": "expr", "text": "1/(s+1)^4"},
            "type": "PID",
            "aim": "setpoint",
            "criterion": "ITAE",
            "Ms_limit": 1.7,
            "Mt_limit": 1.3,
        }
    },
}


@router.post("/tune/optimal", summary="The best settings", responses={200: {"model": OptimalAnswer}, **ERRORS})
def optimal(request: Annotated[OptimalRequest, Body(openapi_examples=OPTIMAL_EXAMPLES)]) -> Response:
    """Smallest IAE, ISE or ITAE with Ms (and Mt) within a limit, dead time exact; P, PI or PID.

    The work is bounded: one map of 572 settings at the most, then 13 rounds of 75 around the best, and the exact loop
    at the end. Where the search ends on the edge of its box, or a limit is what holds, the answer says so.
    """
    found = optimal_tuning(
        request.transfer_function(), request.type, request.criterion, request.aim, request.Ms_limit, request.Mt_limit
    )
    C = found.controller
    return json_response(_optimum(found) | forms_answer(Gains(C.Kc, C.tau_I, C.tau_D or 0.0)))


TRADE_OFF_EXAMPLES = {"PI for a load": {"value": {"plant": PLANT, "Ms_limits": [1.3, 1.6, 2.0]}}}


@router.post("/tune/trade-off", summary="The price of robustness", responses={200: {"model": TradeOffAnswer}, **ERRORS})
def price_of_robustness(request: Annotated[TradeOffRequest, Body(openapi_examples=TRADE_OFF_EXAMPLES)]) -> Response:
    """The best value of the criterion, and the settings that reach it, for each of up to 8 limits of Ms.

    Each search starts where the one before it ended, with 8 rounds of at most 75 settings.
    """
    found = trade_off(request.transfer_function(), request.type, request.criterion, request.aim, request.Ms_limits)
    points = [
        {"Ms_limit": limit, "optimum": _optimum(result) if result else None, "reason": found.reasons.get(f"{limit:g}")}
        for limit, result in zip(found.limits, found.results, strict=True)
    ]
    return json_response({"points": points})


FORMS_EXAMPLES = {
    "a series controller": {
        "value": {"controller": {"type": "pid", "form": "series", "Kc": 2, "tau_I": 4, "tau_D": 1}, "filtered": True}
    },
    "a parallel controller": {
        "value": {"controller": {"type": "pid", "form": "parallel", "Kp": 2, "Ki": 0.5, "Kd": 1}}
    },
}


@router.post("/controller-forms", summary="Forms of a controller", responses={200: {"model": FormsAnswer}, **ERRORS})
def controller_forms(request: Annotated[FormsRequest, Body(openapi_examples=FORMS_EXAMPLES)]) -> Response:
    """Ideal, series and parallel form of one controller, exactly, and its proportional band.

    There is no series form where the zeros are complex: for an unfiltered controller where tau_I < 4 tau_D.
    """
    C = request.controller
    with located("controller"):
        if isinstance(C, ParallelPID):
            ideal = parallel_to_ideal(ParallelGains(C.Kp, C.Ki, C.Kd))
            Tf = C.alpha * ideal.tau_D if request.filtered else 0.0
        else:
            given = Gains(C.Kc, C.tau_I, C.tau_D or 0.0)
            Tf = C.alpha * given.tau_D if request.filtered else 0.0
            ideal = series_to_ideal(given, Tf) if C.form == "series" else given
    reasons = {} if ideal.Kc else {"proportional_band_pct": "a gain of zero has no proportional band"}
    return json_response(
        {
            "ideal": gains_answer(ideal),
            **forms_answer(ideal, Tf),
            "Tf": Tf,
            "proportional_band_pct": proportional_band(ideal.Kc) if ideal.Kc else None,
            "reasons": reasons,
        }
    )
