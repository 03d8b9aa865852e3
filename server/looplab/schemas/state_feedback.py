"""A state feedback as JSON: the plant, how its gains are found, and what is measured and held."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from looplab.engine.design.state_feedback import ByPoles, ByWeights, Faster
from looplab.engine.systems.polynomial import FloatArray
from looplab.schemas.base import Model, Roots, to_complex
from looplab.schemas.models import NonlinearModel, Values
from looplab.schemas.state_space import Matrices, Matrix

SignalName = Annotated[str, Field(max_length=32)]
SignalNames = Annotated[list[SignalName], Field(max_length=10)]
Weights = Annotated[
    Annotated[list[float], Field(max_length=60)] | Matrix, Field(description="A diagonal, or a whole matrix.")
]


class LinearFeedbackPlant(Matrices):
    """x' = A x + B u, y = C x + D u; the states are x1, x2, ..., the inputs u1, ..., the outputs y1, ..."""

    type: Literal["ss"]


class _NonlinearPlant(Model):
    operating_point: Annotated[
        str | None, Field(max_length=64, description="Its inputs, parameters and states are the nominal ones.")
    ] = None
    inputs: Annotated[Values, Field(description="Left out: nominal.")] = Field(default={})
    parameters: Annotated[Values, Field(description="Left out: nominal.")] = Field(default={})
    near: Annotated[Values, Field(description="States near the steady state that is meant.")] = Field(default={})
    actuators: Annotated[SignalNames | None, Field(description="Inputs that the feedback moves; null: the first.")] = (
        None
    )


class LibraryFeedbackPlant(_NonlinearPlant):
    """A plant of the library, linearised at a steady state."""

    type: Literal["plant"]
    id: Annotated[str, Field(max_length=64, examples=["cart-pendulum"])]


class ModelFeedbackPlant(_NonlinearPlant):
    """A model in the request, linearised at a steady state."""

    type: Literal["model"]
    model: NonlinearModel


FeedbackPlant = Annotated[LinearFeedbackPlant | LibraryFeedbackPlant | ModelFeedbackPlant, Field(discriminator="type")]


class PolesGain(Model):
    """Poles, one for each state, those of integrators included."""

    method: Literal["poles"]
    poles: Roots

    def to_engine(self) -> ByPoles:
        """The poles for the engine."""
        return ByPoles(tuple(to_complex(pole) for pole in self.poles))


class LQRGain(Model):
    """The gain of least cost: the integral of x' Q x + u' R u, integrators last in x."""

    method: Literal["lqr"]
    Q: Weights
    R: Weights

    def to_engine(self) -> ByWeights:
        """The weights for the engine."""
        return ByWeights(_weights(self.Q), _weights(self.R))


class KalmanObserver(Model):
    """The Kalman-Bucy filter of white noises with intensities Q on the states and R on the measurements."""

    method: Literal["kalman"]
    Q: Weights
    R: Weights

    def to_engine(self) -> ByWeights:
        """The intensities for the engine."""
        return ByWeights(_weights(self.Q), _weights(self.R))


class FasterObserver(Model):
    """The poles of A - B K times ``speed``."""

    method: Literal["faster"]
    speed: Annotated[float, Field(gt=0, le=1000)] = 4.0

    def to_engine(self) -> Faster:
        """The choice for the engine."""
        return Faster(self.speed)


FeedbackGain = Annotated[PolesGain | LQRGain, Field(discriminator="method")]
ObserverGain = Annotated[PolesGain | KalmanObserver | FasterObserver, Field(discriminator="method")]


def _weights(value: list[float] | list[list[float]]) -> FloatArray:
    rows = [row if isinstance(row, list) else [row] for row in value]
    if all(not isinstance(row, list) for row in value):
        return np.diag([row[0] for row in rows]) if rows else np.zeros((0, 0))
    width = max(len(row) for row in rows)
    # A ragged matrix has no shape: the engine refuses what is not square.
    return np.array(rows, dtype=float) if all(len(row) == width for row in rows) else np.zeros((len(rows), 0))
