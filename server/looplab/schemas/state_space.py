"""A state-space model as JSON."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.engine.state_space import StateSpaceModel, to_transfer_function
from looplab.engine.systems import TransferFunction
from looplab.engine.systems.notation import latex_number
from looplab.engine.systems.polynomial import FloatArray
from looplab.schemas.base import DeadTime, Model

Row = Annotated[list[float], Field(max_length=50)]
Matrix = Annotated[list[Row], Field(max_length=50, description="Rows of equal length.")]

# Wider matrices are named by their size in a formula.
WIDEST = 6


def _matrix_latex(matrix: FloatArray, name: str) -> str:
    if max(matrix.shape, default=0) > WIDEST:
        return name
    rows = r" \\ ".join(" & ".join(latex_number(float(v), 4) for v in row) for row in matrix)
    return rf"\begin{{bmatrix}} {rows} \end{{bmatrix}}"


def state_space_latex(model: StateSpaceModel, theta: float = 0.0) -> str:
    """x' = A x + B u, y = C x + D u with its numbers; large matrices by name and size."""
    u = "u(t)" if not theta else rf"u(t - {latex_number(theta, 4)})"
    A, B, C, D = (_matrix_latex(getattr(model, name), name) for name in "ABCD")
    if not model.states:
        return rf"y = {D}\, {u}"
    text = rf"\dot{{x}} = {A}\, x + {B}\, {u}, \quad y = {C}\, x"
    if model.D.any():
        text += rf" + {D}\, {u}"
    if A == "A":
        text += rf", \quad x \in \mathbb{{R}}^{{{model.states}}}"
    return text


class Matrices(Model):
    """x' = A x + B u, y = C x + D u, with any number of inputs and outputs."""

    A: Matrix = Field(description="n x n; [] for a static gain.")
    B: Matrix = Field(description="n x m, one column for each input.")
    C: Matrix = Field(description="p x n, one row for each output.")
    D: Matrix | None = Field(default=None, description="p x m; left out, nothing passes directly.")

    def to_model(self) -> StateSpaceModel:
        """The model for the engine; raises EngineError naming the matrix."""
        if self.D and not (self.A or self.B or any(self.C)):
            return StateSpaceModel.static(self.D)
        return StateSpaceModel(self.A, self.B, self.C, self.D)


class StateSpaceSystem(Matrices):
    """x' = A x + B u(t - theta), y = C x + D u(t - theta), one input and one output."""

    type: Literal["ss"]
    theta: DeadTime = 0.0

    def to_engine(self) -> TransferFunction:
        """The system for the engine with every mode kept, hidden ones too; raises EngineError naming the field."""
        model = self.to_model()
        model.require_single()
        return to_transfer_function(model, theta=self.theta)

    def to_latex(self) -> str:
        """The equations with their numbers."""
        return state_space_latex(self.to_model(), self.theta)
