"""Pole placement by the Diophantine equation."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.responses import Response

from looplab.api.answers.design import PolePlacementAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import complex_pairs, json_response
from looplab.api.strict import StrictRoute
from looplab.api.tuning_request import controller_answer
from looplab.engine.design import PolePlacement, pole_placement, required_degree
from looplab.engine.design.pole_placement import Structure, completed_poles
from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.systems import TransferFunction, parse_transfer_function
from looplab.engine.systems.polynomial import ComplexArray
from looplab.labs.text import render_math
from looplab.schemas import Model, System, located
from looplab.schemas.base import Coefficients, Roots, to_complex
from looplab.schemas.systems import PolynomialSystem

router = APIRouter(tags=["design"], route_class=StrictRoute)


class PolePlacementRequest(Model):
    """A plant, the poles wanted, and what the controller shall have."""

    plant: System
    poles: Roots | None = Field(default=None, description="Wanted closed-loop poles, conjugates included.")
    D: Coefficients | None = Field(default=None, description="The same as a polynomial, highest power first.")
    D_text: Annotated[str, Field(max_length=500, examples=["(s^2+5s+16)(s+40)"])] | None = None
    complete: Annotated[
        bool, Field(description="Add fast poles where fewer are given than are needed, instead of an error.")
    ] = False
    integrator: Annotated[bool, Field(description="The controller shall integrate: no offset.")] = False
    L_factor: Coefficients | None = Field(
        default=None, description="A polynomial that L shall contain, highest power first: [1, 0, 4] against sin 2t."
    )
    structure: Annotated[Structure, Field(description="strictly_proper passes less noise and needs one pole more.")] = (
        "biproper"
    )
    pade_order: Annotated[int, Field(ge=1, le=8)] | None = Field(
        default=None, description="Design for this Padé approximation of the dead time; left out, none is made."
    )

    @model_validator(mode="after")
    def _one(self) -> PolePlacementRequest:
        given = sum(value is not None for value in (self.poles, self.D, self.D_text))
        if given > 1 or (not given and not self.complete):
            raise ValueError("give one of poles, D or D_text, or complete: true to have them chosen")
        return self

    @property
    def field(self) -> str:
        """How the request spells the wanted poles."""
        return next((name for name in ("D", "D_text") if getattr(self, name) is not None), "poles")

    def wanted(self) -> ComplexArray:
        """Roots of D; raises EngineError naming the field."""
        if self.D is not None:
            with located("D"):
                return TransferFunction.from_polynomials(self.D, [1.0]).zeros
        if self.D_text is not None:
            with located("D_text"):
                found = parse_transfer_function(self.D_text)
            if found.order or found.theta:
                raise InvalidInput("D is a polynomial: it has no denominator and no dead time", field="D_text")
            return found.zeros
        with located("poles"):
            return TransferFunction(zeros=[to_complex(p) for p in self.poles or []]).zeros

    def factor(self) -> TransferFunction:
        """What L shall contain."""
        with located("L_factor"):
            given = TransferFunction.from_polynomials(self.L_factor or [1.0], [1.0])
            if not given.gain:
                raise InvalidInput("the factor is zero", field=None, hint="[1, 0] is s")
        return TransferFunction(zeros=[*given.zeros, *([0.0] if self.integrator else [])])


EXAMPLES: dict[str, Any] = {
    "the notes' example": {
        "value": {"plant": {"type": "expr", "text": "2/((s+1)(s+2))"}, "D_text": "(s^2+5s+16)(s+40)"}
    },
    "with an integrator": {
        "value": {
            "plant": {"type": "expr", "text": "2/((s+1)(s+2))"},
            "poles": [[-2.5, 3.1225], [-2.5, -3.1225], -40],
            "integrator": True,
            "complete": True,
        }
    },
    "a dead time, approximated": {
        "value": {"plant": {"type": "fopdt", "K": 1, "tau": 2, "theta": 0.5}, "complete": True, "pade_order": 2}
    },
}


def _controller(found: PolePlacement, reasons: dict[str, str]) -> dict[str, Any]:
    C, lead = found.C, found.L[0]
    num, den = (found.P / lead).tolist(), (found.L / lead).tolist()
    latex = PolynomialSystem(type="tf", num=num, den=den).to_latex()
    if found.pid.reason is not None:
        reasons["C.pid"] = found.pid.reason
    return {
        "text": C.to_text(),
        "latex": latex,
        "mathml": render_math(latex),
        "num": num,
        "den": den,
        "zeros": complex_pairs(C.zeros),
        "poles": complex_pairs(C.poles),
        "relative_degree": C.relative_degree,
        "stable": found.controller_verdict.closed_loop_stable,
        "because": found.controller_verdict.because,
        "integrators": int(np.count_nonzero(C.poles == 0)),
        "pid": controller_answer(found.pid.controller) if found.pid.controller else None,
    }


@router.post("/pole-placement", summary="Place poles", responses={200: {"model": PolePlacementAnswer}, **ERRORS})
def place(request: Annotated[PolePlacementRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """The controller C = P/L of least order that gives the loop the wanted poles: A L + B P = D.

    The equation is solved through Sylvester's matrix and refined with exact residuals. Numerator and denominator of the
    plant must not share a root; a shared one is named. A dead time is refused unless `pade_order` is given: the poles
    are then those of the approximation, and the verdict that of the loop with the dead time itself.
    """
    with located("plant"):
        plant = request.plant.to_engine().require_proper()
    factor, wanted = request.factor(), request.wanted()
    padded = (request.pade_order or 0) if plant.theta else 0
    required = required_degree(plant, factor, request.structure) + 2 * padded
    added = completed_poles(plant, wanted, required) if request.complete else wanted[:0]
    try:
        found = pole_placement(plant, np.concatenate([wanted, added]), factor, request.structure, request.pade_order)
    except EngineError as error:
        if error.field == "D":
            error.field = request.field
        raise
    reasons = dict(found.reasons)
    static = found.static_gain
    if static is None:
        reasons["offset_pct"] = reasons["static_gain"]
    return json_response(
        {
            "time_unit": "s",
            "C": _controller(found, reasons),
            "equation": {
                "A": found.design_plant.den.tolist(),
                "B": found.design_plant.num.tolist(),
                "L": (found.L / found.L[0]).tolist(),
                "P": (found.P / found.L[0]).tolist(),
                "D": (found.D / found.L[0]).tolist(),
            },
            "plant_poles": complex_pairs(found.design_plant.poles),
            "plant_zeros": complex_pairs(found.design_plant.zeros),
            "wanted": complex_pairs(np.concatenate([wanted, added])),
            "added": complex_pairs(added),
            "required": required,
            "residual": found.residual,
            "condition": found.condition,
            "scale": found.scale,
            "closed_loop_poles": complex_pairs(found.closed_loop_poles),
            "pole_error": found.pole_error,
            "verdict": found.verdict.verdict,
            "because": found.verdict.because,
            "static_gain": static,
            "offset_pct": None if static is None else 100.0 * (1.0 - static),
            "reference_gain": found.reference_gain,
            "approximation": {"theta": plant.theta, "order": padded} if padded else None,
            "reasons": reasons,
        }
    )
