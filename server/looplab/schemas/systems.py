"""A linear system as JSON: six ways to write it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from looplab.engine.systems import FOPDT, SOPDT, TransferFunction, expression_latex, parse_transfer_function
from looplab.engine.systems.notation import latex_number
from looplab.schemas.base import Coefficients, DeadTime, Model, Roots, located, to_complex
from looplab.schemas.state_space import StateSpaceSystem


def _dead_time_latex(theta: float) -> str:
    if not theta:
        return ""
    return r"\,e^{-s}" if theta == 1 else rf"\,e^{{-{latex_number(theta, 4)} s}}"


def _polynomial_latex(coefficients: list[float]) -> str:
    terms = []
    degree = len(coefficients) - 1
    for i, c in enumerate(coefficients):
        if c == 0 and degree:
            continue
        power = degree - i
        s = "" if power == 0 else "s" if power == 1 else f"s^{{{power}}}"
        size = latex_number(abs(c), 4)
        body = s if s and size == "1" else rf"{size}\,{s}" if s else size
        terms.append((" - " if c < 0 else " + ") + body)
    text = "".join(terms) or " + 0"
    return text[3:] if text.startswith(" + ") else "-" + text[3:]


class PolynomialSystem(Model):
    """num(s)/den(s) exp(-theta s), coefficients from the highest power down."""

    type: Literal["tf"]
    num: Coefficients
    den: Coefficients
    theta: DeadTime = 0.0

    def to_engine(self) -> TransferFunction:
        """The system for the engine; raises EngineError naming the field."""
        return TransferFunction.from_polynomials(self.num, self.den, self.theta)

    def to_latex(self) -> str:
        """The system as it was written."""
        fraction = rf"\frac{{{_polynomial_latex(self.num)}}}{{{_polynomial_latex(self.den)}}}"
        return fraction + _dead_time_latex(self.theta)


class ZPKSystem(Model):
    """k prod(s - zeros)/prod(s - poles) exp(-theta s); a complex root is [re, im] and comes with its conjugate."""

    type: Literal["zpk"]
    zeros: Roots = Field(default=[])
    poles: Roots = Field(default=[])
    k: float = 1.0
    theta: DeadTime = 0.0

    def to_engine(self) -> TransferFunction:
        """The system for the engine; raises EngineError naming the field."""
        zeros, poles = ([to_complex(v) for v in roots] for roots in (self.zeros, self.poles))
        return TransferFunction(zeros, poles, self.k, self.theta)

    def to_latex(self) -> str:
        """The system in factors."""
        return self.to_engine().to_latex()


class FOPDTSystem(Model):
    """First order plus dead time, K exp(-theta s)/(tau s + 1)."""

    type: Literal["fopdt"]
    K: float
    tau: Annotated[float, Field(gt=0)]
    theta: DeadTime = 0.0

    def to_model(self) -> FOPDT:
        """The model with its parameters."""
        return FOPDT(self.K, self.tau, self.theta)

    def to_engine(self) -> TransferFunction:
        """The system for the engine; raises EngineError naming the field."""
        return self.to_model().to_transfer_function()

    def to_latex(self) -> str:
        """The model with its numbers."""
        fraction = rf"\frac{{{latex_number(self.K, 4)}}}{{{_polynomial_latex([self.tau, 1.0])}}}"
        return fraction + _dead_time_latex(self.theta)


class SOPDTSystem(Model):
    """Second order plus dead time, K exp(-theta s)/(tau^2 s^2 + 2 zeta tau s + 1)."""

    type: Literal["sopdt"]
    K: float
    tau: Annotated[float, Field(gt=0)]
    zeta: float
    theta: DeadTime = 0.0

    def to_engine(self) -> TransferFunction:
        """The system for the engine; raises EngineError naming the field."""
        return SOPDT(self.K, self.tau, self.zeta, self.theta).to_transfer_function()

    def to_latex(self) -> str:
        """The model with its numbers."""
        bottom = _polynomial_latex([self.tau**2, 2 * self.zeta * self.tau, 1.0])
        return rf"\frac{{{latex_number(self.K, 4)}}}{{{bottom}}}" + _dead_time_latex(self.theta)


class ExpressionSystem(Model):
    """Text such as ``(s+3)/(s^2 (s+2)) exp(-0.1 s)``."""

    type: Literal["expr"]
    text: Annotated[str, Field(max_length=500, examples=["1/(s+1)^3", "(s+3)/(s^2*(s+2)) exp(-0.1 s)"])]

    def to_engine(self) -> TransferFunction:
        """The system for the engine; raises ParseError with the column."""
        with located("text"):
            return parse_transfer_function(self.text)

    def to_latex(self) -> str:
        """The text as its author wrote it."""
        with located("text"):
            return expression_latex(self.text)


System = Annotated[
    PolynomialSystem | ZPKSystem | FOPDTSystem | SOPDTSystem | ExpressionSystem | StateSpaceSystem,
    Field(discriminator="type"),
]
