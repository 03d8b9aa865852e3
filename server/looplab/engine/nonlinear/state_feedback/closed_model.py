"""A model with its state feedback is a model again: observer and integrators are states, gains are parameters.

Compiled once for every gain; its Jacobian stays exact.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import count
from typing import Any

import numpy as np

from looplab.engine.design.state_feedback import StateFeedback
from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.language import BUILT_IN
from looplab.engine.nonlinear.model import CompiledModel, compile_model
from looplab.engine.nonlinear.steady_states import LinearModel
from looplab.engine.systems.polynomial import FloatArray

MAX_STATES = 12


@dataclass(frozen=True)
class Wiring:
    """What of a feedback makes a difference to the formulas; numbers do not.

    Attributes
    ----------
    inputs : tuple of int
        Inputs of the model that the feedback moves.
    measured, controlled : tuple of int
        Outputs of the model.
    observer, integral, limited : bool
    """

    inputs: tuple[int, ...]
    measured: tuple[int, ...]
    controlled: tuple[int, ...]
    observer: bool
    integral: bool
    limited: bool


@dataclass(frozen=True)
class ClosedModel:
    """The closed loop as a model, and the prefix of what was added to it.

    States: the model's own, then ``I0`` ... (integrals) and ``h0`` ... (estimates, as deviations). Inputs: those that
    the feedback leaves alone, ``r0`` ... (setpoints, as deviations) and ``d0`` ... (added to what the feedback does).
    Outputs: the model's own, then ``command0`` ... and ``applied0`` ..., before and after the limits, without d.
    """

    model: CompiledModel
    prefix: str


@lru_cache(maxsize=32)
def closed_model(plant: CompiledModel, wiring: Wiring) -> ClosedModel:
    """The plant under state feedback, compiled; parameters have the value 1 until they are set.

    Raises
    ------
    InvalidInput
        The model has more than 12 states.
    """
    document = plant.document
    n = len(document.states)
    if n > MAX_STATES:
        raise InvalidInput(
            f"the model has {n} states; the feedback of a nonlinear model takes up to {MAX_STATES}",
            field="plant",
            hint="send its linear model as matrices",
        )
    taken = [
        each.name
        for items in (document.parameters, document.inputs, document.variables, document.states, document.outputs)
        for each in items
    ]
    prefix = next(p for k in count() if not any(name.startswith(p := f"k{k}_") for name in taken))
    parts = _Parts(prefix)
    _write(parts, plant, wiring)
    moved = set(wiring.inputs)
    closed = compile_model(
        {
            "id": document.id,
            "title": document.title,
            "time_unit": document.time_unit,
            "parameters": [*map(asdict, document.parameters), *parts.parameters],
            "inputs": [*(asdict(i) for k, i in enumerate(document.inputs) if k not in moved), *parts.inputs],
            "variables": [*map(asdict, document.variables), *parts.variables],
            # A start as a formula may be of an input that the feedback moves: it is always set from outside.
            "states": [*({**asdict(s), "initial": 0.0} for s in document.states), *parts.states],
            "outputs": [*map(asdict, document.outputs), *parts.outputs],
            "events": [*map(asdict, document.events)],
        },
        BUILT_IN,
    )
    return ClosedModel(closed, prefix)


class _Parts:
    """What the feedback adds to the document."""

    def __init__(self, prefix: str) -> None:
        self.prefix = prefix
        self.parameters: list[dict[str, Any]] = []
        self.inputs: list[dict[str, Any]] = []
        self.variables: list[dict[str, Any]] = []
        self.states: list[dict[str, Any]] = []
        self.outputs: list[dict[str, Any]] = []

    def parameter(self, name: str) -> str:
        self.parameters.append({"name": self.prefix + name, "value": 1.0})
        return self.prefix + name

    def input(self, name: str) -> str:
        self.inputs.append({"name": self.prefix + name, "value": 0.0})
        return self.prefix + name

    def variable(self, name: str, expression: str) -> str:
        self.variables.append({"name": name, "expression": expression})
        return name

    def output(self, name: str, expression: str) -> None:
        self.outputs.append({"name": self.prefix + name, "expression": expression})

    def row(self, name: str, index: int, signals: list[str]) -> str:
        """The product of one row of a matrix with signals."""
        return " + ".join(
            f"{self.parameter(f'{name}{index}_{column}')}*{signal}" for column, signal in enumerate(signals)
        )


def _write(parts: _Parts, plant: CompiledModel, wiring: Wiring) -> None:
    document, own = plant.document, parts.prefix
    names, n = plant.state_names, len(plant.state_names)
    seen = {
        k: f"({document.outputs[k].expression} - {parts.parameter(f'y{k}')})"
        for k in sorted({*wiring.measured, *wiring.controlled})
    }
    deviations = [f"{own}h{i}" for i in range(n)]
    if not wiring.observer:
        deviations = [f"({name} - {parts.parameter(f'x{i}')})" for i, name in enumerate(names)]
    setpoints = [parts.input(f"r{k}") for k in range(len(wiring.controlled))]
    integrals = [f"{own}I{k}" for k in range(len(wiring.controlled))] if wiring.integral else []
    moves = []
    for j, index in enumerate(wiring.inputs):
        rows = [f"{parts.parameter(f'u{j}')} - ({parts.row('K', j, deviations)})"]
        rows += [parts.row("J", j, integrals)] if integrals else []
        rows += [parts.row("N", j, setpoints)] if setpoints else []
        command = parts.variable(f"{own}command{j}", " + ".join(rows))
        parts.output(f"command{j}", command)
        limits = f"{parts.parameter(f'low{j}')}, {parts.parameter(f'high{j}')}" if wiring.limited else ""
        applied = parts.variable(f"{own}applied{j}", f"clip({command}, {limits})" if limits else command)
        parts.output(f"applied{j}", applied)
        parts.variable(document.inputs[index].name, f"{applied} + {parts.input(f'd{j}')}")
        moves.append(f"({applied} - {own}u{j})")
    for integral, setpoint, k in zip(integrals, setpoints, wiring.controlled, strict=False):
        parts.states.append({"name": integral, "initial": 0.0, "equation": f"{setpoint} - {seen[k]}"})
    if wiring.observer:
        innovations = [
            parts.variable(
                f"{own}e{row}",
                f"{seen[k]} - ({parts.row('C', row, deviations)}) - ({parts.row('D', row, moves)})",
            )
            for row, k in enumerate(wiring.measured)
        ]
        for i, estimate in enumerate(deviations):
            rows = [parts.row("A", i, deviations), parts.row("B", i, moves), parts.row("L", i, innovations)]
            parts.states.append({"name": estimate, "initial": 0.0, "equation": " + ".join(rows)})


def parameter_values(
    closed: ClosedModel, point: LinearModel, wiring: Wiring, found: StateFeedback, limits: FloatArray | None
) -> dict[str, float]:
    """Values of the parameters that were added, by name; ``limits`` has shape (m, 2)."""
    model = found.model
    matrices: dict[str, FloatArray] = {"K": found.K}
    if wiring.integral:
        matrices["J"] = found.K_I
    if wiring.controlled:
        matrices["N"] = found.N
    if wiring.observer and found.L is not None:
        seen = list(wiring.measured)
        matrices |= {"A": model.A, "B": model.B, "C": model.C[seen], "D": model.D[seen], "L": found.L}
    out = {
        f"{name}{row}_{column}": float(value)
        for name, matrix in matrices.items()
        for (row, column), value in np.ndenumerate(matrix)
    }
    out |= {f"u{j}": point.u[index] for j, index in enumerate(wiring.inputs)}
    out |= {f"y{k}": point.y[k] for k in {*wiring.measured, *wiring.controlled}}
    out |= {} if wiring.observer else {f"x{i}": value for i, value in enumerate(point.x)}
    if limits is not None:
        out |= {f"{end}{j}": float(row[k]) for j, row in enumerate(limits) for k, end in enumerate(("low", "high"))}
    return {closed.prefix + name: value for name, value in out.items()}
