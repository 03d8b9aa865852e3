"""What the tuning routes are told of a plant, and how settings are written in their answers."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, field_validator, model_validator

from looplab.engine.errors import EngineError
from looplab.engine.loop import PID
from looplab.engine.low_order.models import real_lags
from looplab.engine.systems import FOPDT, SOPDT
from looplab.engine.tuning import (
    Gains,
    KnownPlant,
    Options,
    PlantData,
    Rule,
    UltimatePoint,
    ideal_to_parallel,
    ideal_to_series,
    relay_point,
)
from looplab.engine.tuning.settings import KINDS
from looplab.schemas import Model, System, located


class ModelParameters(Model):
    """A first-order model with dead time."""

    K: float
    tau: Annotated[float, Field(gt=0)]
    theta: Annotated[float, Field(ge=0)]


class UltimateParameters(Model):
    """Ultimate gain and period, as an experiment gives them."""

    Ku: float
    Pu: Annotated[float, Field(gt=0)]

    @field_validator("Ku")
    @classmethod
    def _not_zero(cls, Ku: float) -> float:
        if Ku == 0:
            raise ValueError("Ku must not be zero")
        return Ku


class RelayParameters(Model):
    """A relay experiment: u between -amplitude and amplitude makes y swing between -swing and swing."""

    amplitude: Annotated[float, Field(gt=0, description="d, half the height of the relay's square wave [input].")]
    swing: Annotated[float, Field(gt=0, description="a, half the height of y [output].")]
    Pu: Annotated[float, Field(gt=0, description="Period of the oscillation [time].")]
    hysteresis: Annotated[float, Field(ge=0, description="Half the width of the relay's dead band [output].")] = 0.0


class RuleOptions(Model):
    """What the user may choose in some rules."""

    tau_c: Annotated[
        float | None, Field(ge=0, description="Closed-loop time constant of IMC, lambda tuning and SIMC [time].")
    ] = None
    PM_deg: Annotated[
        float, Field(gt=0, lt=90, description="Phase margin of the Åström–Hägglund relay rule [deg].")
    ] = 45.0

    def options(self) -> Options:
        """The same for the engine."""
        return Options(self.tau_c, self.PM_deg)


class KnownPlantRequest(RuleOptions):
    """What is known of the plant: the plant itself, a first-order model, or its ultimate point from an experiment."""

    plant: System | None = None
    model: ModelParameters | None = None
    ultimate: UltimateParameters | None = None
    relay: RelayParameters | None = None

    @model_validator(mode="after")
    def _one_source(self) -> KnownPlantRequest:
        if self.plant is None and self.model is None and self.ultimate is None and self.relay is None:
            raise ValueError("give one of plant, model, ultimate or relay")
        if self.plant is not None and (self.model or self.ultimate or self.relay):
            raise ValueError("give the plant, or a model and/or ultimate values of it, not both")
        if self.ultimate is not None and self.relay is not None:
            raise ValueError("give ultimate values or a relay experiment, not both")
        return self

    def known(self) -> KnownPlant:
        """The same for the engine; raises EngineError naming the field."""
        if self.plant is not None:
            with located("plant"):
                plant = self.plant.to_engine()
            return KnownPlant.of(plant)
        model = point = None
        if self.model is not None:
            with located("model"):
                model = FOPDT(self.model.K, self.model.tau, self.model.theta)
        if self.ultimate is not None:
            with located("ultimate"):
                point = UltimatePoint.of(self.ultimate.Ku, self.ultimate.Pu)
        if self.relay is not None:
            with located("relay"):
                relay = self.relay
                point = relay_point(relay.amplitude, relay.swing, relay.Pu, relay.hysteresis)
        return KnownPlant(model=model, ultimate=point)


def gains_answer(gains: Gains) -> dict[str, float | None]:
    """Kc, tau_I and tau_D; null for an action that is off."""
    return {"Kc": gains.Kc, "tau_I": gains.tau_I, "tau_D": gains.tau_D or None}


def forms_answer(ideal: Gains, Tf: float = 0.0) -> dict[str, Any]:
    """Series and parallel form of an ideal controller; the series form is null with a reason where there is none."""
    parallel = ideal_to_parallel(ideal)
    try:
        series, reason = gains_answer(ideal_to_series(ideal, Tf)), None
    except EngineError as error:
        series, reason = None, error.message
    return {
        "series": series,
        "series_reason": reason,
        "parallel": {"Kp": parallel.Kp, "Ki": parallel.Ki, "Kd": parallel.Kd},
    }


def controller_answer(controller: PID) -> dict[str, Any]:
    """A controller as the requests take it."""
    return {
        "type": "pid",
        "form": controller.form,
        "Kc": controller.sign * controller.Kc,
        "tau_I": controller.tau_I,
        "tau_D": controller.tau_D,
        "alpha": controller.alpha,
    }


def basis_answer(data: PlantData, rule: Rule, known: KnownPlant) -> dict[str, Any]:
    """What a rule started from, and how that was come by."""
    values = {name: value for name, value in vars(data).items() if isinstance(value, float | int)}
    if isinstance(data, SOPDT):
        lags = real_lags(data)
        if lags is not None:
            values |= {"tau_1": lags[0], "tau_2": lags[1]}
    return {"kind": KINDS[data.__class__], "values": values, "how": known.describe(data, rule)}
