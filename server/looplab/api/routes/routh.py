"""The Routh array of a polynomial or a loop, and the gains that stabilise the loop."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
import numpy.typing as npt
from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.responses import Response

from looplab.api.answers.stability import RouthAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.strict import StrictRoute
from looplab.engine.errors import InvalidInput
from looplab.engine.frequency import nyquist_count
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.stability import (
    GainRanges,
    RouthArray,
    characteristic_polynomial,
    closed_loop_verdict,
    gain_ranges,
    pi_region,
    routh_array,
)
from looplab.engine.stability.cancellation import hidden_modes
from looplab.engine.stability.routh import number_text, polynomial_text
from looplab.engine.systems.polynomial import ComplexArray
from looplab.schemas import Loop, Model, located
from looplab.schemas.base import Coefficients

router = APIRouter(tags=["stability"], route_class=StrictRoute)

DIGITS_LOST = "multiplied out, the polynomial loses the digits that decide; the factors keep them"
_COUNTS = ("sign_changes", "rhp_roots", "imaginary_axis_roots", "lhp_roots")


class RouthRequest(Model):
    """A polynomial, or a loop whose characteristic polynomial is meant."""

    polynomial: Annotated[Coefficients, Field(description="Highest power first.")] | None = None
    loop: Loop | None = None
    negative: Annotated[
        bool | None, Field(description="Look at negative gains too; null: only if the gain is negative now.")
    ] = None
    tau_I: (
        Annotated[
            list[Annotated[float, Field(gt=0)]],
            Field(min_length=1, max_length=60, description="Cuts of the stable region of a PI controller [time]."),
        ]
        | None
    ) = None

    @model_validator(mode="after")
    def _one(self) -> RouthRequest:
        if (self.polynomial is None) == (self.loop is None):
            raise ValueError("give a polynomial or a loop")
        if self.loop is None and self.tau_I is not None:
            raise ValueError("tau_I needs a loop with a PI controller")
        return self


def _array(found: RouthArray) -> dict[str, Any]:
    rows = [
        {
            "power": row.power,
            "label": row.label,
            "entries": [float(c) for c in row.entries],
            "texts": [number_text(c) for c in row.entries],
            "kind": row.kind,
            "computed": None if row.computed is None else [float(c) for c in row.computed],
            "note": row.note,
        }
        for row in found.rows
    ]
    auxiliary = [
        {"degree": degree, "coefficients": [float(c) for c in p], "text": polynomial_text(p)}
        for degree, p in found.auxiliary_polynomials
    ]
    return {
        "polynomial": [float(c) for c in found.coefficients],
        "polynomial_text": polynomial_text(found.coefficients),
        "exact": found.exact,
        "tolerance": found.tolerance,
        "array": rows,
        "auxiliary_polynomials": auxiliary,
        **{name: getattr(found, name) for name in _COUNTS},
        "stable": found.stable,
        "because": found.because,
    }


def _exactness(found: RouthArray) -> dict[str, str]:
    return {"tolerance": "computed with fractions: nothing is rounded"} if found.exact else {}


def _on_axis(poles: ComplexArray) -> npt.NDArray[np.bool_]:
    return np.asarray(np.abs(poles.real) <= 1e-9 * np.abs(poles))


def _without_array(loop: FeedbackLoop, why: str) -> tuple[dict[str, Any], dict[str, str]]:
    verdict, count = closed_loop_verdict(loop), nyquist_count(loop.open_loop)
    # Nyquist's count on the factors is the surer one where many poles lie close together.
    stable = 1.0 in gain_ranges(loop.open_loop) and not count.through_minus_one
    right = verdict.rhp_poles if count.Z is None else count.Z
    because = verdict.because
    if stable != verdict.closed_loop_stable:
        because = f"closed-loop poles in the right half-plane by Nyquist's count, Z = N + P: {right}"
    empty: dict[str, Any] = dict.fromkeys(
        ("polynomial", "polynomial_text", "exact", "array", "auxiliary_polynomials", *_COUNTS, "tolerance")
    )
    known = {"rhp_roots": right}
    L = loop.open_loop
    if right is not None and not count.through_minus_one and not (loop.theta and L.gain):
        # So many roots there are in all, and only what is hidden can stand on the axis.
        hidden = hidden_modes(L.zeros, L.poles) if L.gain else L.poles
        axis = int(np.count_nonzero(_on_axis(hidden)))
        known |= {"imaginary_axis_roots": axis, "lhp_roots": L.order - right - axis}
    reasons = {name: why for name in empty if known.get(name) is None}
    return empty | known | {"stable": stable, "because": because}, reasons


def _loop_array(loop: FeedbackLoop) -> tuple[dict[str, Any], dict[str, str]]:
    if loop.theta and loop.open_loop.gain:
        return _without_array(loop, "with dead time the characteristic equation is no polynomial; Nyquist counts")
    try:
        found = routh_array(characteristic_polynomial(loop).tolist())
    except InvalidInput as error:
        return _without_array(loop, error.message)
    L = loop.open_loop
    hidden = hidden_modes(L.zeros, L.poles)
    if L.gain and not np.any(_on_axis(hidden)):
        Z = nyquist_count(L).Z
        if Z is not None and (found.rhp_roots, found.imaginary_axis_roots) != (Z, 0):
            return _without_array(loop, DIGITS_LOST)
    return _array(found), _exactness(found)


def _ranges(found: GainRanges) -> list[dict[str, Any]]:
    return [
        {
            "low": r.low.K,
            "high": r.high.K,
            "low_omega": list(r.low.omega),
            "high_omega": list(r.high.omega),
            "low_reason": r.low.reason,
            "high_reason": r.high.reason,
        }
        for r in found.ranges
    ]


def _region(loop: FeedbackLoop, tau_I: list[float], negative: bool) -> dict[str, Any]:
    controller = loop.controller
    if not isinstance(controller, PID) or controller.tau_I is None or controller.tau_D:
        raise InvalidInput(
            "the region in Kc and tau_I is that of a PI controller",
            field="loop.controller",
            hint='{"type": "pid", "Kc": 1, "tau_I": 1}',
        )
    with located("loop"):
        region = pi_region(loop.path, tau_I, negative)
    curve = region.boundary
    there = np.isfinite(curve.tau_I) & (negative | (curve.Kc > 0))
    return {
        "boundary": {"omega": curve.omega[there], "Kc": curve.Kc[there], "tau_I": curve.tau_I[there]},
        "cuts": [
            {"tau_I": t, "gain_ranges": _ranges(found), "reason": found.reason}
            for t, found in zip(region.tau_I, region.ranges, strict=True)
        ],
    }


EXAMPLES = {
    "a polynomial": {"value": {"polynomial": [1, 2, 24, 48, -25, -50]}},
    "a loop": {
        "value": {"loop": {"plant": {"type": "expr", "text": "1/(s+1)^3"}, "controller": {"type": "pid", "Kc": 4}}}
    },
    "a PI controller": {
        "value": {
            "loop": {
                "plant": {"type": "expr", "text": "1/(s^2+2s+2)"},
                "controller": {"type": "pid", "Kc": 1, "tau_I": 0.25},
            },
            "tau_I": [0.1, 0.25, 0.5],
        }
    },
}


@router.post("/routh", summary="Routh array and stable gains", responses={200: {"model": RouthAnswer}, **ERRORS})
def routh(request: Annotated[RouthRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """The Routh array, roots on either side of the imaginary axis, and every stable range of the loop's gain.

    Numbers of up to 12 digits are taken as decimals and the array is exact. A first entry that is zero is treated by
    a positive multiplier (the note of the row says which), a row of zeros by its auxiliary polynomial. With dead time
    there is no array, but the gain ranges are exact.
    """
    if request.polynomial is not None:
        why = "a polynomial alone has no gain: send a loop"
        array = routh_array(request.polynomial)
        nothing = ("gain", "gain_ranges", "pi_region")
        reasons = _exactness(array) | dict.fromkeys(nothing, why)
        return json_response(_array(array) | dict.fromkeys(nothing) | {"reasons": reasons})
    assert request.loop is not None
    with located("loop"):
        loop = request.loop.to_engine()
    answer, reasons = _loop_array(loop)
    negative = loop.gain < 0 if request.negative is None else request.negative
    found = gain_ranges(loop.locus_system, negative)
    if found.reason:
        reasons["gain_ranges"] = found.reason
    region = None
    if request.tau_I is not None:
        region = _region(loop, request.tau_I, negative)
    else:
        reasons["pi_region"] = "not asked for: give tau_I"
    name = "Kc" if isinstance(loop.controller, PID) else "k"
    # The ranges are open, and 0 is the end of one of them: there the loop itself tells.
    inside = loop.gain in found or (loop.gain == 0.0 and answer["stable"])
    gain = {"name": name, "value": loop.gain, "in_range": inside}
    return json_response(
        answer | {"gain": gain, "gain_ranges": _ranges(found), "pi_region": region, "reasons": reasons}
    )
