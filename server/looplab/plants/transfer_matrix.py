"""Plants known by what each input does to each output: matrices of transfer functions with dead times."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.response import simulate, step
from looplab.engine.systems import TransferFunction
from looplab.engine.systems.polynomial import FloatArray

KIND = "transfer-matrix"


@dataclass(frozen=True)
class Signal:
    """An input or an output, a deviation from where the plant ran: ``value`` is the nominal one."""

    name: str
    unit: str
    meaning: str
    latex: str
    value: float = 0.0


@dataclass(frozen=True)
class Entry:
    r"""K (\lambda s + 1).../((\tau s + 1)...) e^{-\theta s}.

    Attributes
    ----------
    K : float
        Gain [output/input].
    leads, lags : tuple of float
        Time constants of numerator and denominator [time].
    theta : float
        Dead time [time].
    """

    K: float
    leads: tuple[float, ...]
    lags: tuple[float, ...]
    theta: float

    def system(self) -> TransferFunction:
        """The same by zeros, poles and their gain."""
        gain = self.K * float(np.prod(self.leads)) / float(np.prod(self.lags))
        return TransferFunction(
            [-1.0 / each for each in self.leads], [-1.0 / each for each in self.lags], gain, self.theta
        )

    def to_latex(self) -> str:
        """The entry by its time constants, as it is printed in books."""
        factors = ["".join(rf"({each:g} s + 1)" for each in some) for some in (self.leads, self.lags)]
        if len(self.lags) == 1:
            factors[1] = factors[1].strip("()")
        rate = "" if self.theta == 1 else f"{self.theta:g} "
        delay = f" e^{{-{rate}s}}" if self.theta else ""
        return rf"\frac{{{self.K:g}{factors[0]}{delay}}}{{{factors[1]}}}"


@dataclass(frozen=True)
class TransferMatrix:
    """A plant of kind "transfer-matrix"; ``entries[i][j]`` is what input j does to output i."""

    id: str
    title: str
    summary: str
    notes: str
    time_unit: str
    source: str
    inputs: tuple[Signal, ...]
    outputs: tuple[Signal, ...]
    entries: tuple[tuple[Entry, ...], ...]

    @property
    def operating_points(self) -> tuple[()]:
        """None: it is one already."""
        return ()

    def gains(self) -> FloatArray:
        """The outputs at rest for a unit of each input, shape (outputs, inputs)."""
        return np.array([[entry.K for entry in row] for row in self.entries])


@dataclass(frozen=True)
class MatrixResponse:
    """Inputs u, shape (count, inputs), and outputs y, shape (count, outputs), at the times t; cut where y runs away."""

    t: FloatArray
    u: FloatArray
    y: FloatArray
    truncated_at: float | None
    truncated_reason: str | None


@cache
def _documents() -> dict[str, str]:
    folder = files(__package__).joinpath("transfer_matrices")
    return {entry.name.removesuffix(".json"): entry.read_text(encoding="utf-8") for entry in folder.iterdir()}


def transfer_matrix_ids() -> list[str]:
    """The ids of all transfer matrices, sorted."""
    return sorted(_documents())


def transfer_matrix_document(plant_id: str) -> dict[str, Any]:
    """The document of one of them, a copy of the caller's own; a KeyError for any other id."""
    document: dict[str, Any] = json.loads(_documents()[plant_id])
    return document


@cache
def load_transfer_matrix(plant_id: str) -> TransferMatrix:
    """One of them, ready to compute; a KeyError for any other id."""
    document = transfer_matrix_document(plant_id)
    inputs, outputs = (tuple(Signal(**each) for each in document[kind]) for kind in ("inputs", "outputs"))
    entries = tuple(
        tuple(Entry(each["K"], tuple(each["leads"]), tuple(each["lags"]), each["theta"]) for each in row)
        for row in document["entries"]
    )
    text = {name: document[name] for name in ("id", "title", "summary", "notes", "time_unit", "source")}
    return TransferMatrix(**text, inputs=inputs, outputs=outputs, entries=entries)


def matrix_response(
    matrix: TransferMatrix, inputs: Mapping[str, float | InputCourse], horizon: float, points: int
) -> MatrixResponse:
    r"""The outputs from rest, exact with dead times: every entry answers every part of its input, and all is added.

    .. math:: y_i(s) = \sum_j G_{ij}(s)\, u_j(s)

    Parameters
    ----------
    matrix : TransferMatrix
    inputs : mapping
        Deviations by name, from t = 0 on: a number or a course. Left out: 0.
    horizon : float
        [time]
    points : int
        Samples, evenly from 0 to the horizon.

    Returns
    -------
    MatrixResponse

    Raises
    ------
    InvalidInput
        There is no such input, or horizon or points are out of range.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley, 2005, section 3.1.
    """
    names = [each.name for each in matrix.inputs]
    for name in inputs:
        if name not in names:
            raise InvalidInput(
                "the plant has no input of this name", field=f"inputs.{name[:40]}", hint=f"it has {', '.join(names)}"
            )
    t = np.linspace(0.0, horizon, points)
    u, y = np.zeros((points, len(names))), np.zeros((points, len(matrix.outputs)))
    count, reason = points, None
    for j, name in enumerate(names):
        given = inputs.get(name, 0.0)
        course = given if isinstance(given, InputCourse) else InputCourse(float(given))
        u[:, j] = course.values(t)
        parts = (*course.parts, step(course.level)) if course.level else course.parts
        for i, row in enumerate(matrix.entries):
            for part in parts:
                found = simulate(row[j].system(), part, horizon, points)
                y[: found.y.size, i] += found.y
                if found.y.size < count:
                    count, reason = found.y.size, found.truncated_reason
    return MatrixResponse(t[:count], u[:count], y[:count], float(t[count]) if count < points else None, reason)
