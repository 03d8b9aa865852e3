"""Linear plants written as models, and setpoints, for tests of control loops."""

from typing import Any

from looplab.engine.nonlinear import CompiledModel, compile_model
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.response import step
from models import model, parameters

# 1/(s + 1)^3 from u to y, with a load d at its input.
THIRD_ORDER: dict[str, Any] = model(
    ["-x1 + u + d", "x1 - x2", "x2 - x3"],
    [0.0, 0.0, 0.0],
    inputs=parameters(u=0.0, d=0.0),
    outputs=[{"name": "y", "expression": "x3"}],
)
# 1/(s + 1)
FIRST_ORDER: dict[str, Any] = model("-x + u", 0.0, inputs=parameters(u=0.0), outputs=[{"name": "y", "expression": "x"}])


def compiled(document: dict[str, Any]) -> CompiledModel:
    return compile_model(document)


def unit_step(start: float = 0.0) -> InputCourse:
    return InputCourse(0.0).plus(step(1.0, start))
