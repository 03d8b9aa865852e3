"""The answers of the routes for several loops; inputs and outputs are counted from one."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.api.answers.base import Answer, Numbers, Reasons
from looplab.api.answers.connect import SystemVerdict
from looplab.api.answers.loop import MarginsAnswer
from looplab.api.answers.tune import PIDSettings

Matrix = list[list[float]]


class MatrixSignal(Answer):
    """An input or an output of the process."""

    name: str
    unit: str
    meaning: str


class PairingAnswer(Answer):
    """One way to pair: the input of each output in turn, and what speaks against it."""

    pairing: list[int]
    relative_gains: list[float]
    niederlinski: float | None
    niederlinski_reason: str | None
    rga_number: Annotated[float, Field(description="Sum of |lambda - 1| on the pairs and |lambda| beside them.")]
    acceptable: bool
    faults: list[str]


class ComplexCurve(Answer):
    """A complex number over frequency."""

    re: Numbers
    im: Numbers


class MatrixFrequency(Answer):
    """What depends on frequency; null with a reason where it is not defined at one of them."""

    omega: Numbers
    rga: Annotated[list[list[ComplexCurve]] | None, Field(description="Of each output (row) and input (column).")]
    rga_number: Annotated[Numbers | None, Field(description="Of the pairing that was asked for or is recommended.")]
    singular_values: Annotated[list[Numbers], Field(description="Largest first, in the units of the process.")]
    condition_number: Numbers | None
    minimized_condition_number: Annotated[
        Numbers | None, Field(description="The least over all units of inputs and outputs; of two loops.")
    ]


class RGAAnswer(Answer):
    """Relative gains of a process, and what follows from them for the pairing."""

    time_unit: str
    inputs: list[MatrixSignal]
    outputs: list[MatrixSignal]
    gains: Annotated[Matrix | None, Field(description="At rest; null where an entry integrates.")]
    rga: Annotated[Matrix | None, Field(description="At rest; of integrating entries the limit.")]
    pairing: Annotated[list[int] | None, Field(description="Recommended; null where something speaks against each.")]
    niederlinski: Annotated[float | None, Field(description="Of the recommended pairing.")]
    because: str
    assumptions: Annotated[str, Field(description="Of the Niederlinski index.")]
    pairings: Annotated[list[PairingAnswer], Field(description="The best first.")]
    condition_number: Annotated[float | None, Field(description="At rest, in the units of the process.")]
    horizon: Annotated[float, Field(description="A time in which the process settles [time].")]
    frequency: MatrixFrequency
    reasons: Reasons


class SeveralResponses(Answer):
    """Outputs and inputs of all loops over time, one array each, shorter than asked for where they were cut."""

    time_unit: str
    horizon: float
    t: Numbers
    y: list[Numbers]
    u: Annotated[list[Numbers], Field(description="By inputs of the process, before the loads.")]
    verdict: SystemVerdict | None
    truncated_at: float | None
    truncated_reason: str | None
    reasons: Reasons


class BodeCurve(Answer):
    """A frequency response [dB, deg]."""

    mag_dB: Numbers
    phase_deg: Numbers


class LoopResponse(Answer):
    """One loop's output and controller output after a unit step of its setpoint."""

    t: Numbers
    y: Numbers
    u: Numbers
    truncated_at: float | None
    truncated_reason: str | None


class InteractionAnswer(Answer):
    """One loop with all others in manual (own), and with all of them in automatic (effective)."""

    time_unit: str
    omega: Numbers
    own: BodeCurve
    effective: BodeCurve
    own_gain: float | None
    effective_gain: float | None
    relative_gain: float | None
    own_margins: MarginsAnswer | None
    effective_margins: MarginsAnswer | None
    others: Annotated[SystemVerdict | None, Field(description="The other loops alone, this one in manual.")]
    horizon: float
    own_response: LoopResponse | None
    effective_response: LoopResponse | None
    reasons: Reasons


class Formula(Answer):
    """A transfer function as text, LaTeX and MathML."""

    text: str
    latex: str
    mathml: str


class ElementAnswer(Answer):
    """A crossing path of a dynamic decoupler: as it should be, why that cannot be built, and what is built."""

    name: Annotated[str, Field(description="d12: from controller 2 to the input of loop 1.")]
    ideal: Formula
    theta: Annotated[float, Field(description="Negative where it would have to know the future [time].")]
    problems: list[str]
    realised: Formula


class DecouplerAnswer(Answer):
    """From controllers (columns) to the inputs of the loops (rows), in the order of the outputs."""

    kind: Literal["static", "dynamic"]
    pairing: list[int]
    matrix: list[list[Formula]]
    exact: Annotated[bool, Field(description="Whether no crossing effect is left at any frequency.")]
    elements: list[ElementAnswer]


class SettingsOfSeveral(Answer):
    """The controller of one output; null with the reason where the rule does not apply."""

    controller: PIDSettings | None
    reason: str | None


class SeveralSettings(Answer):
    """A controller for each output; factor, peak and frequency are those of BLT."""

    method: str
    settings: list[SettingsOfSeveral]
    factor: float | None
    log_modulus_dB: float | None
    omega: float | None
    source: str
