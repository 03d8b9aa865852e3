"""Spectrum of a sampled signal: sines, samples, or a signal of a loop."""

from __future__ import annotations

from math import radians
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Body
from pydantic import Field, model_validator
from starlette.responses import Response

from looplab.api.answers.spectrum import SpectrumAnswer
from looplab.api.docs import ERRORS
from looplab.api.encode import Arrays, json_response
from looplab.api.strict import StrictRoute
from looplab.engine.frequency.sines import Sine, sum_of_sines
from looplab.engine.frequency.spectrum import MAX_SAMPLES, Window, alias, leakage_pct, noise_amplitude, spectrum
from looplab.engine.loop.sampled_signals import loop_signals
from looplab.engine.systems.polynomial import FloatArray
from looplab.schemas import Loop, Model, located

router = APIRouter(tags=["frequency"], route_class=StrictRoute)

# Between the samples the signal is drawn over so many of them.
SHOWN, FINE = 40, 1500

Size = Annotated[float, Field(ge=-1e9, le=1e9)]


class SineShape(Model):
    """amplitude sin(2 pi frequency t + phase)."""

    amplitude: Size = 1.0
    frequency: Annotated[float, Field(ge=0, le=1e9, description="[cycles/time]")]
    phase_deg: Annotated[float, Field(ge=-360, le=360)] = 0.0


class SinesSignal(Model):
    """A sum of sines, known between its samples too."""

    type: Literal["sines"]
    sines: Annotated[list[SineShape], Field(min_length=1, max_length=8)]
    offset: Size = 0.0


class SampledSignal(Model):
    """Samples as they were measured."""

    type: Literal["samples"]
    values: Annotated[list[Size], Field(min_length=2, max_length=MAX_SAMPLES)]


class LoopSignal(Model):
    """A signal of a stable loop after steps at t = 0, with noise of its sensor."""

    type: Literal["loop"]
    loop: Loop
    of: Literal["y", "u", "e"] = "y"
    setpoint: Size = 1.0
    load: Size = 0.0
    noise: Annotated[float, Field(ge=0, le=1e9, description="Standard deviation.")] = 0.0
    seed: Annotated[int, Field(ge=0, le=2**31)] = 0


class SpectrumRequest(Model):
    """A signal, how it is sampled, and the window over the samples."""

    signal: Annotated[SinesSignal | SampledSignal | LoopSignal, Field(discriminator="type")]
    rate: Annotated[float, Field(ge=1e-9, le=1e9, description="Samples per time.")]
    samples: Annotated[int | None, Field(ge=20, le=2048, description="N; left out where the samples are given.")] = None
    window: Window = "rectangular"
    remove_mean: bool = False
    arrays: Arrays = "list"

    @model_validator(mode="after")
    def _counted(self) -> SpectrumRequest:
        if (self.samples is None) != isinstance(self.signal, SampledSignal):
            raise ValueError("give samples, how many, for sines and loops, and for them only")
        return self


LOOP = {"plant": {"type": "fopdt", "K": 1, "tau": 5, "theta": 1}, "controller": {"type": "pid", "Kc": 2, "tau_I": 5}}
EXAMPLES: dict[str, Any] = {
    "a sine seen at the wrong frequency": {
        "value": {"signal": {"type": "sines", "sines": [{"frequency": 9}]}, "rate": 10, "samples": 40}
    },
    "leakage": {
        "value": {
            "signal": {"type": "sines", "sines": [{"frequency": 1.1}, {"frequency": 3, "amplitude": 0.1}]},
            "rate": 10,
            "samples": 64,
            "window": "hann",
        }
    },
    "noise in a loop": {
        "value": {
            "signal": {"type": "loop", "loop": LOOP, "of": "u", "noise": 0.1},
            "rate": 4,
            "samples": 256,
            "remove_mean": True,
        }
    },
    "samples": {"value": {"signal": {"type": "samples", "values": [0, 1, 0, -1, 0, 1, 0, -1]}, "rate": 4}},
}


def _of_sines(sines: list[Sine], offset: float, rate: float, samples: int) -> dict[str, Any]:
    """Where each sine is seen, and the signal between its samples beside the slowest one that shares them."""
    lines = []
    for sine in sines:
        seen_at, k = alias(sine.frequency, rate)
        aliased = {"seen_at": seen_at, "k": k, "aliased": k != 0}
        lines.append({"amplitude": sine.amplitude, "frequency": sine.frequency, **aliased})
    t = np.linspace(0.0, (min(samples, SHOWN) - 1) / rate, FINE)
    seen = sum_of_sines([sine.aliased(rate) for sine in sines], t, offset)
    return {
        "lines": lines,
        "curves": {"t": t, "signal": sum_of_sines(sines, t, offset), "seen": seen},
        "expected": None,
    }


def _sampled(request: SpectrumRequest) -> tuple[FloatArray, float, dict[str, Any]]:
    """The samples, their rate, and what is known of them beside."""
    signal, rate, unknown = request.signal, request.rate, {"lines": None, "curves": None, "expected": None}
    if isinstance(signal, SampledSignal):
        return np.array(signal.values), rate, unknown
    assert request.samples is not None
    if isinstance(signal, SinesSignal):
        sines = [Sine(s.amplitude, s.frequency, radians(s.phase_deg)) for s in signal.sines]
        t = np.arange(request.samples) / rate
        return sum_of_sines(sines, t, signal.offset), rate, _of_sines(sines, signal.offset, rate, request.samples)
    with located("signal"):
        with located("loop"):
            loop = signal.loop.to_engine()
        horizon = (request.samples - 1) / rate
        found = loop_signals(loop, horizon, request.samples, signal.setpoint, signal.load, signal.noise, signal.seed)
    pulse = found.pulse_u if signal.of == "u" else found.pulse_y
    expected = noise_amplitude(pulse, signal.noise, request.window)
    return getattr(found, signal.of), float(1.0 / found.t[1]), unknown | {"expected": expected}


@router.post("/spectrum", summary="Spectrum", responses={200: {"model": SpectrumAnswer}, **ERRORS})
def spectrum_of(request: Annotated[SpectrumRequest, Body(openapi_examples=EXAMPLES)]) -> Response:
    """Discrete Fourier transform of sines, of samples, or of y, u or e of a loop with noise.

    Amplitudes, and |U| with the factor 1/sqrt(N) under which Parseval's sums are equal. A sine above half the sampling
    rate is seen at |f - k rate|; one that does not fit into the record leaks into its neighbours, less under a window.
    """
    values, rate, beside = _sampled(request)
    used = values - values.mean() if request.remove_mean else values
    found = spectrum(used, rate, request.window)
    reasons: dict[str, str] = {}
    share = None
    if beside["expected"] is None:
        reasons["expected"] = "known for a signal of a loop"
    if beside["lines"] is None:
        reasons |= dict.fromkeys(("lines", "leakage_pct", "curves"), "known for a sum of sines")
    else:
        offset = [0.0] if isinstance(request.signal, SinesSignal) and request.signal.offset else []
        share = leakage_pct(found, [*offset, *(line["seen_at"] for line in beside["lines"])], request.window)
    answer = {
        "time_unit": "s",
        "rate": rate,
        "samples": values.size,
        "window": request.window,
        "t": np.arange(values.size) / rate,
        "values": used,
        "frequency": found.frequency,
        "omega": found.omega,
        "amplitude": found.amplitude,
        "magnitude": np.abs(found.U),
        "phase_deg": np.degrees(np.angle(found.U)),
        "resolution": found.resolution,
        "highest": found.highest,
        "parseval": {
            "energy": found.energy,
            "spectral_energy": found.spectral_energy,
            "residual": found.parseval_residual,
            "inverse_error": found.inverse_error,
        },
        **beside,
        "leakage_pct": share,
        "reasons": reasons,
    }
    return json_response(answer, request.arrays)
