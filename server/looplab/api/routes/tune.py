"""Controller settings by named rules, and the rules themselves."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.tune import RuleList, TuneAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.strict import StrictRoute
from looplab.api.tuning_request import KnownPlantRequest, basis_answer, forms_answer, gains_answer
from looplab.engine.errors import EngineError
from looplab.engine.tuning import RULES, Gains, KnownPlant, Options, Rule, RuleName, TypeName
from looplab.labs.text import render_math

router = APIRouter(tags=["tuning"], route_class=StrictRoute)

ALPHA = 0.1


class TuneRequest(KnownPlantRequest):
    """What is known of the plant, and the rules and types of controller wanted."""

    rules: Annotated[list[RuleName], Field(min_length=1, max_length=32)] | None = Field(
        default=None, description="Left out, every rule."
    )
    types: Annotated[list[TypeName], Field(min_length=1, max_length=8)] | None = Field(
        default=None, description="Left out, each rule's own types."
    )


def _formula(latex: str | None) -> dict[str, str] | None:
    return None if latex is None else {"latex": latex, "mathml": render_math(latex)}


def _settings(rule: Rule, type_: str, known: KnownPlant, options: Options) -> dict[str, Any]:
    out: dict[str, Any] = {
        "rule": rule.id,
        "name": rule.name,
        "family": rule.family,
        "type": type_,
        "Kc": None,
        "tau_I": None,
        "tau_D": None,
        "alpha": ALPHA,
        "valid": False,
        "reason": None,
        "formula": _formula(rule.formula(type_)),
        "source": rule.source,
        "validity": rule.validity,
        "published": None,
        "note": None,
        "basis": None,
        "series": None,
        "series_reason": None,
        "parallel": None,
    }
    try:
        found = known.tune(rule, type_, options)
    except EngineError as error:
        return out | {"reason": error.message, "series_reason": "the rule does not apply"}
    out |= {name: getattr(found, name) for name in ("Kc", "tau_I", "tau_D", "alpha", "note")}
    if found.published is not None:
        out["published"] = {"form": rule.form, **gains_answer(found.published)}
    ideal = Gains(found.Kc, found.tau_I, found.tau_D or 0.0)
    return (
        out
        | forms_answer(ideal)
        | {
            "valid": True,
            "formula": _formula(found.formula),
            "basis": basis_answer(known.for_rule(rule, type_), rule, known),
        }
    )


def _ultimate(known: KnownPlant) -> dict[str, Any]:
    try:
        point = known.ultimate()
    except EngineError as error:
        return {"Ku": None, "Pu": None, "omega_180": None, "reason": error.message}
    return {"Ku": point.Ku, "Pu": point.Pu, "omega_180": point.omega_180, "reason": None}


def _model(known: KnownPlant) -> dict[str, Any] | None:
    if known.plant is None:
        return None
    try:
        model = known.reaction_curve()
    except EngineError as error:
        return {"K": None, "tau": None, "theta": None, "how": error.message}
    how = known.describe(model, RULES["cohen_coon"])
    return {"K": model.K, "tau": model.tau, "theta": model.theta, "how": how}


EXAMPLES = {
    "a plant": {"value": {"plant": {"type": "expr", "text": "1/(s+1)^3"}, "rules": ["ziegler_nichols"]}},
    "a model": {"value": {"model": {"K": 1, "tau": 0.5, "theta": 0.1}, "rules": ["cohen_coon"]}},
    "an experiment": {"value": {"ultimate": {"Ku": 8, "Pu": 3.6276}, "types": ["PID"], "rules": ["ziegler_nichols"]}},
    "a relay": {"value": {"relay": {"amplitude": 1, "swing": 0.16, "Pu": 3.6}, "rules": ["astrom_hagglund_relay"]}},
    "an integrating plant": {
        "value": {"plant": {"type": "expr", "text": "1/(s (s+1)^2)"}, "rules": ["simc"], "tau_c": 2}
    },
}


@router.post("/tune", summary="Settings by tuning rules", responses={200: {"model": TuneAnswer}, **ERRORS})
def tune(request: Annotated[TuneRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Settings for the ideal form by each rule and controller type, with formula, source and the data used.

    A rule outside its range is in the list too, with `valid: false` and the reason. Each rule reduces the plant to the
    model it was made for: half rule for SIMC, reaction curve for the others; an integrating plant to an integrator.
    """
    known, options = request.known(), request.options()
    settings = [
        _settings(RULES[name], type_, known, options)
        for name in dict.fromkeys(request.rules or RULES)
        for type_ in dict.fromkeys(request.types or RULES[name].types)
    ]
    return json_response({"settings": settings, "ultimate": _ultimate(known), "model": _model(known)})


@router.get("/tune/rules", summary="The tuning rules", responses={200: {"model": RuleList}})
def rules() -> Response:
    """Every rule with its formulas and source, what it needs to know of the plant, and the range it refuses outside."""
    return json_response(
        {
            "rules": [
                {
                    "id": rule.id,
                    "name": rule.name,
                    "family": rule.family,
                    "source": rule.source,
                    "validity": rule.validity,
                    "needs": rule.needs,
                    "form": rule.form,
                    "types": list(rule.types),
                    "formulas": [
                        {"kind": kind, "type": type_, **(_formula(latex) or {})}
                        for kind, by_type in rule.formulas.items()
                        for type_, latex in by_type.items()
                    ],
                }
                for rule in RULES.values()
            ]
        }
    )
