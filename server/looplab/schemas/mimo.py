"""Several loops on one process as JSON: a matrix of transfer functions, a pairing, and a controller for each output."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.engine.errors import InvalidInput
from looplab.engine.mimo import (
    Decoupler,
    MultiLoop,
    Prediction,
    ProcessMatrix,
    check_pairing,
    dynamic_decoupler,
    static_decoupler,
)
from looplab.plants import load_transfer_matrix, transfer_matrix_ids
from looplab.plants.transfer_matrix import Signal
from looplab.schemas.base import Model, located
from looplab.schemas.controllers import AnyPID
from looplab.schemas.systems import System

Number = Annotated[int, Field(ge=1, le=5)]
DecouplerKind = Literal["none", "static", "dynamic"]


class LibraryMatrix(Model):
    """A transfer matrix of the plant library."""

    type: Literal["plant"]
    id: Annotated[str, Field(max_length=64, examples=["wood-berry"])]

    def to_engine(self) -> ProcessMatrix:
        """The process for the engine; raises EngineError naming the field."""
        if self.id not in transfer_matrix_ids():
            raise InvalidInput(
                "the library has no transfer matrix of this id",
                field="id",
                hint=f"there are {', '.join(transfer_matrix_ids())}",
            )
        entries = load_transfer_matrix(self.id).entries
        return ProcessMatrix(tuple(tuple(entry.system() for entry in row) for row in entries))

    def units(self) -> tuple[str, list[Signal], list[Signal]]:
        """Time unit, inputs and outputs, once it has been found."""
        matrix = load_transfer_matrix(self.id)
        return matrix.time_unit, list(matrix.inputs), list(matrix.outputs)


class WrittenMatrix(Model):
    """A transfer matrix written out: rows are outputs, columns are inputs."""

    type: Literal["matrix"]
    entries: Annotated[
        list[Annotated[list[System], Field(min_length=1, max_length=5)]], Field(min_length=2, max_length=5)
    ]
    time_unit: Literal["s", "min", "h"] = "s"

    def to_engine(self) -> ProcessMatrix:
        """The process for the engine; raises EngineError naming the field."""
        rows = []
        for i, row in enumerate(self.entries):
            found = []
            for j, entry in enumerate(row):
                with located(f"entries[{i}][{j}]"):
                    found.append(entry.to_engine())
            rows.append(tuple(found))
        return ProcessMatrix(tuple(rows))

    def units(self) -> tuple[str, list[Signal], list[Signal]]:
        """Time unit, inputs and outputs, which have numbers for names."""
        n = len(self.entries)
        inputs = [Signal(f"u{j + 1}", "-", f"input {j + 1}", f"u_{j + 1}") for j in range(n)]
        outputs = [Signal(f"y{i + 1}", "-", f"output {i + 1}", f"y_{i + 1}") for i in range(n)]
        return self.time_unit, inputs, outputs


Process = Annotated[LibraryMatrix | WrittenMatrix, Field(discriminator="type")]


class PairedProcess(Model):
    """A process, and which input controls which output."""

    plant: Process
    pairing: Annotated[list[Number], Field(min_length=2, max_length=5)] | None = Field(
        default=None, description="Number of the input of each output in turn; left out: 1, 2, ..."
    )

    def process(self) -> ProcessMatrix:
        """The process for the engine; raises EngineError naming the field."""
        with located("plant"):
            try:
                return self.plant.to_engine()
            except InvalidInput as error:
                error.field = None if error.field == "plant" else error.field
                raise

    def order(self, process: ProcessMatrix) -> tuple[int, ...]:
        """The pairing, counted from zero."""
        given = self.pairing or list(range(1, process.size + 1))
        return check_pairing(tuple(j - 1 for j in given), process.size)


class LoopOfSeveral(Model):
    """The controller of one output, and whether it acts."""

    controller: AnyPID
    mode: Literal["auto", "manual"] = "auto"


class SeveralLoops(PairedProcess):
    """A process under several PID controllers."""

    loops: Annotated[list[LoopOfSeveral], Field(min_length=2, max_length=5, description="One for each output.")]
    decoupler: Annotated[
        DecouplerKind, Field(description="static: any number of loops, right at rest; dynamic: two loops.")
    ] = "none"
    prediction: Annotated[
        Prediction,
        Field(description="Where a dynamic decoupler would have to know the future: leave it out, or wait."),
    ] = "drop"

    def to_engine(self) -> MultiLoop:
        """The loops for the engine; raises EngineError naming the field."""
        process = self.process()
        order = self.order(process)
        if len(self.loops) != process.size:
            raise InvalidInput(
                f"{process.size} outputs need {process.size} loops, not {len(self.loops)}", field="loops"
            )
        controllers = []
        for i, loop in enumerate(self.loops):
            with located(f"loops[{i}].controller"):
                controllers.append(loop.controller.to_engine())
        found = decoupler_of(process.paired(order), self.decoupler, self.prediction)
        closed = tuple(loop.mode == "auto" for loop in self.loops)
        return MultiLoop(process, order, tuple(controllers), closed, None if found is None else found.matrix)


def decoupler_of(paired: ProcessMatrix, kind: DecouplerKind, prediction: Prediction) -> Decoupler | None:
    """The decoupler of a process with its loops on the diagonal; None for "none"."""
    if kind == "none":
        return None
    return static_decoupler(paired) if kind == "static" else dynamic_decoupler(paired, prediction)
