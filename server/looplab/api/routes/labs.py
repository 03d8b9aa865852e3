"""Labs: the list, one lab as its page shows it, answers checked, and a lab under way validated."""

from __future__ import annotations

from dataclasses import asdict
from functools import cache
from typing import Annotated, Any

from fastapi import APIRouter, Body, Path
from pydantic import Field
from starlette.responses import Response

from looplab.api.answers.labs import GradedAnswer, LabList, LabValidation, RenderedLab
from looplab.api.docs import ERRORS
from looplab.api.encode import json_response
from looplab.api.errors import ApiError
from looplab.api.strict import StrictRoute
from looplab.engine.errors import InvalidInput
from looplab.labs import Lab, LabError, Library, grade, list_entry, render_text, run_tests, validate_lab
from looplab.schemas import Model

router = APIRouter(tags=["labs"], route_class=StrictRoute)
library = cache(Library)
TEST_SECONDS = 5.0
"""For the tests of a lab that is only being validated."""

LabId = Annotated[str, Path(description="The lab's id, as the list has it.", examples=["ziegler-nichols-third-order"])]
NOT_FOUND: dict[int | str, dict[str, Any]] = {404: {**ERRORS[422], "description": "There is no lab of this id."}}
EXAMPLES = {
    "a number": {"value": {"exercise": "ultimate-gain", "answer": 8}},
    "several numbers": {"value": {"exercise": "zn-pi", "answer": {"Kc": "3.6", "tau_I": "3.02"}}},
    "a design": {"value": {"exercise": "specification", "answer": {"Kc": 4.8, "tau_I": 3, "tau_D": 0.8}}},
    "show the solution": {"value": {"exercise": "ultimate-gain", "reveal": True}},
}


class CheckRequest(Model):
    """An answer to one exercise, or the wish to see its solution."""

    exercise: Annotated[str, Field(max_length=64, description="The exercise's id.")]
    answer: Annotated[Any, Field(description="As the kind of exercise takes it; null is a blank.")] = None
    reveal: Annotated[bool, Field(description="Show the worked solution; the exercise then earns nothing.")] = False


@router.get("/labs", summary="The labs there are", responses={200: {"model": LabList}})
def list_labs() -> Response:
    """Title, level, section of the notes, time and number of exercises of every lab."""
    return json_response({"labs": [list_entry(lab) for lab in library().all()]})


@router.get(
    "/labs/{lab_id}",
    summary="One lab, ready to show",
    responses={200: {"model": RenderedLab}, 422: ERRORS[422], **NOT_FOUND},
)
def show_lab(lab_id: LabId) -> Response:
    """Texts as HTML, formulas as MathML, the bench, and the exercises without their answers."""
    _find(lab_id)
    return json_response(library().rendered(lab_id))


@router.post("/labs/validate", summary="Validate a lab", responses={200: {"model": LabValidation}, **ERRORS})
def validate(
    lab: Annotated[
        dict[str, Any],
        Body(openapi_examples={"not a lab yet": {"value": {"id": "my-lab", "title": "My lab"}}}),
    ],
) -> Response:
    """What has to be repaired in a lab, with its place in the JSON; if nothing, the lab's own tests are run."""
    try:
        tests = [asdict(outcome) for outcome in run_tests(validate_lab(lab), TEST_SECONDS)]
    except LabError as error:
        return json_response({"valid": False, "problems": [asdict(p) for p in error.problems], "tests": []})
    return json_response({"valid": all(test["passed"] for test in tests), "problems": [], "tests": tests})


@router.post(
    "/labs/{lab_id}/check", summary="Check an answer", responses={200: {"model": GradedAnswer}, **ERRORS, **NOT_FOUND}
)
def check(lab_id: LabId, request: Annotated[CheckRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """The verdict on one answer, by measuring and computing: `correct`, feedback, and each check with its value.

    An answer that a student can give by mistake is always graded; one that no page would send is a 422.
    """
    lab = _find(lab_id)
    exercise = lab.exercise(request.exercise)
    if exercise is None:
        raise InvalidInput(
            "this lab has no such exercise",
            field="exercise",
            hint=f"it has {', '.join(exercise.id for exercise in lab.exercises())}",
        )
    if request.reveal:
        verdict = {"correct": False, "status": "revealed", "score": 0.0, "feedback_html": "", "checks": []}
        return json_response({**verdict, "solution_html": render_text(exercise.solution)})
    result = grade(lab, exercise, request.answer)
    solution = render_text(exercise.solution) if result.correct else None
    return json_response({**result.as_dict(), "solution_html": solution})


def _find(lab_id: str) -> Lab:
    lab = library().get(lab_id)
    if lab is None:
        raise ApiError(404, "not_found", "there is no lab of this id", "lab_id", "GET /api/v1/labs lists them")
    return lab
