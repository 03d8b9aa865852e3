"""Several loops on one process: relative gains and pairing, decouplers, settings for all loops."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.mimo import DecouplerAnswer, RGAAnswer, SeveralSettings
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.strict import StrictRoute
from looplab.api.tuning_request import RuleOptions
from looplab.engine.errors import EngineError, InvalidInput, RuleNotApplicable
from looplab.engine.loop import PID
from looplab.engine.mimo import (
    NI_ASSUMES,
    Element,
    Pairing,
    Prediction,
    ProcessMatrix,
    blt,
    rga_number,
    rga_response,
    singular_values,
    study_pairings,
    tune_alone,
)
from looplab.engine.systems import TransferFunction
from looplab.engine.tuning import RULES, RuleName, TypeName
from looplab.labs.text import render_math
from looplab.schemas.mimo import PairedProcess, decoupler_of

router = APIRouter(tags=["mimo"], route_class=StrictRoute)

BLT_SOURCE = "W. L. Luyben, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 654-660"
Frequencies = Annotated[list[Annotated[float, Field(gt=0)]], Field(min_length=2, max_length=2)]
WOOD_BERRY: dict[str, Any] = {"type": "plant", "id": "wood-berry"}
BLENDING: dict[str, Any] = {
    "type": "matrix",
    "time_unit": "min",
    "entries": [
        [{"type": "fopdt", "K": 1, "tau": 0.5, "theta": 0.1}, {"type": "fopdt", "K": 1, "tau": 0.5, "theta": 0.1}],
        [{"type": "fopdt", "K": 0.3, "tau": 2, "theta": 0.5}, {"type": "expr", "text": "-0.2 exp(-0.5s)/(2s + 1)"}],
    ],
}


def frequencies(process: ProcessMatrix, ends: list[float] | None, points: int) -> np.ndarray:
    """The frequencies asked for, or those at which something happens [rad/time]."""
    low, high = ends or process.frequency_range()
    if not low < high:
        raise InvalidInput("omega is [low, high], the lower first", field="omega")
    return np.geomspace(low, high, points)


class RGARequest(PairedProcess):
    """A process, and where its frequency response is wanted; the pairing is that of the RGA number."""

    omega: Frequencies | None = Field(default=None, description="[low, high]; left out, chosen [rad/time].")
    points: Annotated[int, Field(ge=2, le=2000)] = 200
    arrays: Literal["list", "f4"] = "list"


def _pairing(found: Pairing) -> dict[str, Any]:
    return {
        "pairing": [j + 1 for j in found.inputs],
        "relative_gains": list(found.relative_gains),
        "niederlinski": found.niederlinski,
        "niederlinski_reason": found.niederlinski_reason,
        "rga_number": found.rga_number,
        "acceptable": found.acceptable,
        "faults": list(found.faults),
    }


def _frequency(
    process: ProcessMatrix, omega: np.ndarray, order: tuple[int, ...], reasons: dict[str, str]
) -> dict[str, Any]:
    G = process.response(omega)
    sizes = singular_values(G)
    n = process.size
    answer: dict[str, Any] = {
        "omega": omega,
        "rga": None,
        "rga_number": None,
        "singular_values": [sizes.values[:, i].copy() for i in range(n)],
        "condition_number": sizes.condition_number if np.isfinite(sizes.condition_number).all() else None,
        "minimized_condition_number": sizes.minimized,
    }
    if answer["condition_number"] is None:
        reasons["frequency.condition_number"] = "infinite: the matrix is singular at one of the frequencies"
    if sizes.minimized is None:
        reasons["frequency.minimized_condition_number"] = "it has a closed form for two loops only"
    elif not np.isfinite(sizes.minimized).all():
        answer["minimized_condition_number"] = None
        reasons["frequency.minimized_condition_number"] = "infinite: the matrix is singular at one of the frequencies"
    try:
        rga = rga_response(process, omega)
    except InvalidInput as error:
        reasons["frequency.rga"] = reasons["frequency.rga_number"] = error.message
        return answer
    answer["rga"] = [
        [{"re": rga[:, i, j].real.copy(), "im": rga[:, i, j].imag.copy()} for j in range(n)] for i in range(n)
    ]
    answer["rga_number"] = rga_number(rga, order)
    return answer


RGA_EXAMPLES = {
    "Wood and Berry's column": {"value": {"plant": WOOD_BERRY, "points": 50}},
    "a matrix of one's own": {"value": {"plant": BLENDING, "points": 50}},
}


@router.post("/mimo/rga", summary="Relative gains and pairing", responses={200: {"model": RGAAnswer}, **ERRORS})
def rga(request: Annotated[RGARequest, Body(openapi_examples=RGA_EXAMPLES)]) -> Response:
    """Relative gain array, Niederlinski index and condition number, every pairing judged, and all over frequency.

    Gains of integrating entries are infinite: their relative gains are limits, and the index, a theorem on stable
    entries, is null.
    """
    process = request.process()
    order = request.order(process)
    time_unit, inputs, outputs = request.plant.units()
    reasons: dict[str, str] = {}
    answer: dict[str, Any] = {
        "time_unit": time_unit,
        "inputs": [{"name": each.name, "unit": each.unit, "meaning": each.meaning} for each in inputs],
        "outputs": [{"name": each.name, "unit": each.unit, "meaning": each.meaning} for each in outputs],
        "gains": None,
        "rga": None,
        "pairing": None,
        "niederlinski": None,
        "because": "",
        "assumptions": NI_ASSUMES,
        "pairings": [],
        "condition_number": None,
        "horizon": process.horizon(),
    }
    if process.integrates:
        reasons["gains"] = reasons["condition_number"] = "an entry integrates: it has no gain at rest"
    else:
        answer["gains"] = process.gains().tolist()
        number = float(singular_values(process.gains()[None]).condition_number[0])
        answer["condition_number"] = number if np.isfinite(number) else None
        if not np.isfinite(number):
            reasons["condition_number"] = "infinite: the gains are singular"
    try:
        study = study_pairings(process)
    except InvalidInput as error:
        reasons["rga"] = reasons["pairing"] = reasons["niederlinski"] = answer["because"] = error.message
    else:
        answer |= {"rga": study.rga.tolist(), "because": study.because}
        answer["pairings"] = [_pairing(each) for each in study.pairings]
        if study.recommended is None:
            reasons["pairing"] = reasons["niederlinski"] = study.because
        else:
            answer["pairing"] = [j + 1 for j in study.recommended.inputs]
            answer["niederlinski"] = study.recommended.niederlinski
            if study.recommended.niederlinski_reason:
                reasons["niederlinski"] = study.recommended.niederlinski_reason
            if request.pairing is None:
                order = study.recommended.inputs
    omega = frequencies(process, request.omega, request.points)
    answer["frequency"] = _frequency(process, omega, order, reasons)
    return json_response(answer | {"reasons": reasons}, request.arrays)


class DecouplerRequest(PairedProcess):
    """A process with its pairing, and the decoupler wanted."""

    kind: Literal["static", "dynamic"] = "dynamic"
    prediction: Prediction = "drop"


def _formula(system: TransferFunction) -> dict[str, str]:
    latex = system.to_latex()
    return {"text": system.to_text(), "latex": latex, "mathml": render_math(latex)}


def _element(element: Element) -> dict[str, Any]:
    ideal = _formula(TransferFunction(element.zeros, element.poles, element.gain, max(element.theta, 0.0)))
    if element.theta < 0:
        latex = f"{ideal['latex']}\\,e^{{+{-element.theta:.4g} s}}"
        text = f"{ideal['text']} exp(+{-element.theta:.6g} s)"
        ideal = {"text": text, "latex": latex, "mathml": render_math(latex)}
    return {
        "name": element.name,
        "ideal": ideal,
        "theta": element.theta,
        "problems": list(element.problems),
        "realised": _formula(element.realised),
    }


DECOUPLER_EXAMPLES = {
    "one that must predict": {"value": {"plant": {"type": "plant", "id": "ethanol-water"}}},
    "gains only": {"value": {"plant": {"type": "plant", "id": "ogunnaike-ray"}, "kind": "static"}},
}


@router.post("/mimo/decoupler", summary="A decoupler", responses={200: {"model": DecouplerAnswer}, **ERRORS})
def decoupler(request: Annotated[DecouplerRequest, Body(openapi_examples=DECOUPLER_EXAMPLES)]) -> Response:
    """What each controller must add to the other inputs so that its loop leaves the other outputs alone.

    An element that would have to know the future, differentiate, or be unstable is named with its reason and replaced
    by one that can be built.
    """
    process = request.process()
    order = request.order(process)
    found = decoupler_of(process.paired(order), request.kind, request.prediction)
    assert found is not None
    return json_response(
        {
            "kind": request.kind,
            "pairing": [j + 1 for j in order],
            "matrix": [[_formula(entry) for entry in row] for row in found.matrix],
            "exact": found.exact,
            "elements": [_element(element) for element in found.elements],
        }
    )


class TuneSeveralRequest(PairedProcess, RuleOptions):
    """A process with its pairing, and how its loops are to be tuned."""

    method: Annotated[
        RuleName | Literal["blt"],
        Field(description="blt: all loops together, detuned Ziegler-Nichols; else each by a rule for its own entry."),
    ] = "blt"
    type: Annotated[TypeName, Field(description="Of a rule; BLT gives PI.")] = "PI"


def _pid(controller: PID) -> dict[str, Any]:
    return {
        "type": "pid",
        "form": controller.form,
        **{name: getattr(controller, name) for name in ("Kc", "tau_I", "tau_D", "alpha")},
    }


TUNE_EXAMPLES = {
    "all loops together": {"value": {"plant": WOOD_BERRY, "method": "blt"}},
    "each loop by itself": {"value": {"plant": WOOD_BERRY, "method": "simc", "tau_c": 4}},
}


@router.post("/mimo/tune", summary="Settings for several loops", responses={200: {"model": SeveralSettings}, **ERRORS})
def tune(request: Annotated[TuneSeveralRequest, Body(openapi_examples=TUNE_EXAMPLES)]) -> Response:
    """Settings of all loops by the biggest log modulus, or of each by a rule as if the others were in manual."""
    process = request.process()
    paired = process.paired(request.order(process))
    answer: dict[str, Any] = {"method": request.method, "factor": None, "log_modulus_dB": None, "omega": None}
    if request.method == "blt":
        try:
            found = blt(paired)
        except RuleNotApplicable as error:
            refused = [{"controller": None, "reason": error.message}] * paired.size
            return json_response(answer | {"settings": refused, "source": BLT_SOURCE})
        settings: list[dict[str, Any]] = [{"controller": _pid(each), "reason": None} for each in found.controllers]
        answer |= {name: getattr(found, name) for name in ("factor", "log_modulus_dB", "omega")}
        return json_response(answer | {"settings": settings, "source": BLT_SOURCE})
    try:
        alone = tune_alone(paired, request.method, request.type, request.options())
    except EngineError as error:
        error.field = "method"
        raise
    settings = [
        {"controller": None if each.controller is None else _pid(each.controller), "reason": each.reason}
        for each in alone
    ]
    return json_response(answer | {"settings": settings, "source": RULES[request.method].source})
