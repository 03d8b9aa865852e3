"""Controller settings by named rules."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Body
from pydantic import Field, field_validator, model_validator
from starlette.responses import Response

from looplab.api.answers.tune import TuneAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.strict import StrictRoute
from looplab.engine.errors import EngineError
from looplab.engine.identification import two_point
from looplab.engine.systems import FOPDT
from looplab.engine.tuning import RULES, UltimatePoint, ultimate_point
from looplab.labs.text import render_math
from looplab.schemas import Model, System, located

router = APIRouter(tags=["tuning"], route_class=StrictRoute)

RuleName = Literal["ziegler_nichols", "cohen_coon"]
TypeName = Literal["P", "PI", "PID"]
ALPHA = 0.1


class ModelParameters(Model):
    """A first-order model with dead time."""

    K: float
    tau: Annotated[float, Field(gt=0)]
    theta: Annotated[float, Field(ge=0)]


class UltimateParameters(Model):
    """Ultimate gain and period, as an experiment gives them."""

    Ku: float
    Pu: Annotated[float, Field(gt=0)]

    @field_validator("Ku")
    @classmethod
    def _not_zero(cls, Ku: float) -> float:
        if Ku == 0:
            raise ValueError("Ku must not be zero")
        return Ku


class TuneRequest(Model):
    """What is known of the plant: the plant itself, a first-order model, or its ultimate gain and period."""

    plant: System | None = None
    model: ModelParameters | None = None
    ultimate: UltimateParameters | None = None
    rules: Annotated[list[RuleName], Field(min_length=1, max_length=16)] | None = None
    types: Annotated[list[TypeName], Field(min_length=1, max_length=8)] = Field(default=["P", "PI", "PID"])

    @model_validator(mode="after")
    def _one_source(self) -> TuneRequest:
        if self.plant is None and self.model is None and self.ultimate is None:
            raise ValueError("give one of plant, model or ultimate")
        if self.plant is not None and (self.model is not None or self.ultimate is not None):
            raise ValueError("give the plant, or a model and/or ultimate values of it, not both")
        return self


class _PlantData:
    """The ultimate point and the model that rules start from; a refusal is kept to be told with each rule."""

    def __init__(self, request: TuneRequest) -> None:
        self.given: dict[str, Any] = {"ultimate": None, "model": None}
        self.refusals: dict[str, str] = {}
        self.how = "as given"
        if request.plant is not None:
            self._from_plant(request)
        if request.model is not None:
            with located("model"):
                model = FOPDT(request.model.K, request.model.tau, request.model.theta)
            self.given["model"] = model
            if request.ultimate is None:
                self._try("ultimate", lambda: ultimate_point(model.to_transfer_function()))
        if request.ultimate is not None:
            Ku, Pu = request.ultimate.Ku, request.ultimate.Pu
            self.given["ultimate"] = UltimatePoint(Ku, Pu, 6.283185307179586 / Pu)
            if request.model is None:
                self.refusals["model"] = "this rule needs a model or the plant, not Ku and Pu"

    def _from_plant(self, request: TuneRequest) -> None:
        assert request.plant is not None
        with located("plant"):
            plant = request.plant.to_engine().require_proper()
        self._try("ultimate", lambda: ultimate_point(plant))
        self._try("model", lambda: two_point(plant))
        exact = plant.order == 1 and not plant.zeros.size
        self.how = "the plant itself" if exact else "through 28.3 % and 63.2 % of the plant's exact step response"

    def _try(self, name: str, find: Any) -> None:
        try:
            self.given[name] = find()
        except EngineError as error:
            self.refusals[name] = error.message


def _settings(rule_id: str, type_: str, data: _PlantData) -> dict[str, Any]:
    rule = RULES[rule_id]
    latex = rule.formulas[type_]
    out: dict[str, Any] = {
        "rule": rule_id,
        "name": rule.name,
        "type": type_,
        "Kc": None,
        "tau_I": None,
        "tau_D": None,
        "alpha": ALPHA,
        "valid": False,
        "reason": data.refusals.get(rule.needs),
        "formula": {"latex": latex, "mathml": render_math(latex)},
        "source": rule.source,
    }
    source = data.given[rule.needs]
    if source is None:
        return out
    try:
        found = rule.apply(source, type_)
    except EngineError as error:
        return out | {"reason": error.message}
    return out | {"Kc": found.Kc, "tau_I": found.tau_I, "tau_D": found.tau_D, "alpha": found.alpha, "valid": True}


EXAMPLES = {
    "a plant": {"value": {"plant": {"type": "expr", "text": "1/(s+1)^3"}, "rules": ["ziegler_nichols"]}},
    "a model": {"value": {"model": {"K": 1, "tau": 0.5, "theta": 0.1}, "rules": ["cohen_coon"]}},
    "an experiment": {"value": {"ultimate": {"Ku": 8, "Pu": 3.6276}, "types": ["PID"], "rules": ["ziegler_nichols"]}},
}


@router.post("/tune", summary="Settings by tuning rules", responses={200: {"model": TuneAnswer}, **ERRORS})
def tune(request: Annotated[TuneRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Settings for the ideal form by each rule and controller type, with formula and source.

    A rule outside its range is in the list too, with `valid: false` and the reason.
    """
    data = _PlantData(request)
    rules = dict.fromkeys(request.rules or RULES)
    settings = [_settings(rule, type_, data) for rule in rules for type_ in dict.fromkeys(request.types)]
    point, model = data.given["ultimate"], data.given["model"]
    ultimate = None
    if point is not None:
        ultimate = {"Ku": point.Ku, "Pu": point.Pu, "omega_180": point.omega_180, "reason": None}
    elif "ultimate" in data.refusals:
        ultimate = {"Ku": None, "Pu": None, "omega_180": None, "reason": data.refusals["ultimate"]}
    found = None
    if model is not None:
        found = {"K": model.K, "tau": model.tau, "theta": model.theta, "how": data.how}
    elif request.ultimate is None:
        found = {"K": None, "tau": None, "theta": None, "how": data.refusals["model"]}
    return json_response({"settings": settings, "ultimate": ultimate, "model": found})
