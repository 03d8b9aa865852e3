"""A nonlinear model as JSON: the shape of its document, for requests, files and editors."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, JsonValue

from looplab.engine.nonlinear import BUILT_IN
from looplab.engine.nonlinear.document import MAX_EVENTS, MAX_OPERATING_POINTS
from looplab.schemas.base import Model

# Requests are held to less by the engine, which says so in words; plants written by code may be as large as this.
_LIMITS = BUILT_IN
NAME = r"^[A-Za-z][A-Za-z0-9_]*$"
ID = r"^[a-z0-9][a-z0-9-]*$"

Name = Annotated[
    str, Field(pattern=NAME, max_length=32, description="A letter, then letters, digits and _: as formulas use it.")
]
Id = Annotated[str, Field(pattern=ID, max_length=64)]
Formula = Annotated[
    str,
    Field(
        min_length=1,
        max_length=BUILT_IN.characters,
        description="+ - * / ^ ( ), exp log log10 sqrt sin cos tan asin acos atan sinh cosh tanh abs sign min max pow "
        "clip if(a < b, then, else), the names of the model, t and pi.",
    ),
]
Unit = Annotated[str, Field(max_length=40, description="Text only: nothing is converted.")]
Meaning = Annotated[str, Field(max_length=2_000, description="What it is, in a few words.")]
Latex = Annotated[str, Field(max_length=200, description="Symbol in formulas; left out: the name.")]
Values = Annotated[dict[str, float], Field(max_length=200)]


class ModelSetting(Model):
    """A parameter or an input: a number that can be set."""

    name: Name
    value: Annotated[float, Field(description="Nominal.")]
    unit: Unit = ""
    min: float | None = None
    max: float | None = None
    meaning: Meaning = ""
    latex: Latex = ""
    source: Annotated[str, Field(max_length=2_000, description="Where the number is from.")] = ""


class ModelQuantity(Model):
    """A variable or an output: a number that is computed."""

    name: Name
    expression: Formula
    unit: Unit = ""
    meaning: Meaning = ""
    latex: Latex = ""


class ModelState(Model):
    """A state and its differential equation."""

    name: Name
    initial: Annotated[float | Formula, Field(description="A number, or a formula of parameters and inputs.")]
    equation: Annotated[Formula, Field(description="The right-hand side of d(name)/dt.")]
    unit: Unit = ""
    min: Annotated[float | None, Field(description="A simulation ends where the state falls below.")] = None
    max: Annotated[float | None, Field(description="A simulation ends where the state rises above.")] = None
    meaning: Meaning = ""
    latex: Latex = ""


class ModelOperatingPoint(Model):
    """Inputs and parameters to start from, and roughly where the steady state lies."""

    name: Id
    title: Annotated[str, Field(max_length=200)] = ""
    inputs: Values = Field(default={})
    parameters: Values = Field(default={})
    near: Annotated[Values, Field(description="States near the steady state that is meant.")] = Field(default={})


class ModelEvent(Model):
    """What happens when a comparison becomes true."""

    name: Name
    when: Annotated[Formula, Field(description="A comparison, such as h <= 0.")]
    action: Annotated[
        Literal["stop", "report"], Field(description="stop ends the simulation; report goes on and tells.")
    ] = "report"
    message: Annotated[str, Field(max_length=200, description="What the student reads.")] = ""


class NonlinearModel(Model):
    """A model: dx/dt = f(t, x, u, p), y = g(t, x, u, p), written as formulas."""

    schema_: Annotated[str, Field(alias="$schema", max_length=200, description="For editors.")] = ""
    id: Annotated[Id, Field(description="The file's name without .json.")]
    title: Annotated[str, Field(max_length=200)]
    summary: Annotated[str, Field(max_length=2_000)] = ""
    notes: Annotated[str, Field(max_length=200, description="Sections of the lecture notes, such as 2.1.1, 3.1.")] = ""
    time_unit: Literal["s", "min", "h", "d"] = "s"
    parameters: Annotated[list[ModelSetting], Field(max_length=2 * _LIMITS.expressions)] = Field(default=[])
    inputs: Annotated[list[ModelSetting], Field(max_length=_LIMITS.states)] = Field(default=[])
    variables: Annotated[
        list[ModelQuantity], Field(max_length=_LIMITS.expressions, description="In any order; no circles.")
    ] = Field(default=[])
    states: Annotated[list[ModelState], Field(min_length=1, max_length=_LIMITS.states)]
    outputs: Annotated[
        list[ModelQuantity], Field(max_length=_LIMITS.expressions, description="Left out: the states.")
    ] = Field(default=[])
    operating_points: Annotated[list[ModelOperatingPoint], Field(max_length=MAX_OPERATING_POINTS)] = Field(default=[])
    events: Annotated[list[ModelEvent], Field(max_length=MAX_EVENTS)] = Field(default=[])
    schematic: Annotated[dict[str, JsonValue] | None, Field(description="A drawing; computing ignores it.")] = None

    def to_document(self) -> dict[str, Any]:
        """The document as the engine reads it."""
        return self.model_dump(exclude={"schema_", "schematic"}, exclude_unset=True)


def json_schema() -> dict[str, Any]:
    """What ``plants/model.schema.json`` holds."""
    schema = NonlinearModel.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
