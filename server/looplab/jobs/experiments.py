"""What workers do with nonlinear plants in an experiment; the engine's parts are imported when one is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from looplab.plants import load_plant

if TYPE_CHECKING:
    from looplab.engine.experiments.nonlinear import NonlinearRinging, Point
    from looplab.engine.experiments.relay import Relay, RelayRun
    from looplab.engine.experiments.step_test import StepTest, StepTestResult
    from looplab.engine.nonlinear.control_loop import Instrument


@dataclass(frozen=True)
class PlantPoint:
    """Which plant, which of its signals, and where it starts."""

    id: str
    input: str
    output: str
    inputs: Mapping[str, float]
    parameters: Mapping[str, float]
    initial: Mapping[str, float]


def _point(at: PlantPoint) -> tuple[Point, str]:
    from looplab.engine.experiments.nonlinear import rest_point

    model = load_plant(at.id)
    point = rest_point(model, at.input, at.output, at.inputs, at.parameters, at.initial)
    return point, model.document.time_unit


def step_test(at: PlantPoint, test: StepTest) -> dict[str, Any]:
    """A step test on a plant, as the API answers it."""
    from looplab.engine.experiments.nonlinear import nonlinear_step_test

    point, time_unit = _point(at)
    return step_test_answer(nonlinear_step_test(point, test), point.u0, point.y0, time_unit)


def step_test_answer(found: StepTestResult, u0: float, y0: float, time_unit: str) -> dict[str, Any]:
    """A step test's record and where it began."""
    return {"time_unit": time_unit, "u0": u0, "y0": y0, **vars(found), "notes": list(found.notes)}


def ultimate_cycle(
    at: PlantPoint, Kc: float | None, start: float, bump: float | None, horizon: float, sensor: Instrument
) -> dict[str, Any]:
    """One run with a given gain, or the search, as the API answers it."""
    from looplab.engine.experiments.nonlinear import nonlinear_ring, nonlinear_ultimate_cycle

    point, time_unit = _point(at)
    size = bump or 1e-3 * max(abs(point.y0), 1.0)
    out: dict[str, Any] = {"Ku": None, "Pu": None, "omega_180": None, "trials": []}
    if Kc is None:
        found, ringing = nonlinear_ultimate_cycle(point, start, size, horizon, sensor)
        out |= {"Ku": found.Ku, "Pu": found.Pu, "omega_180": 2.0 * np.pi / found.Pu}
        out["trials"] = [asdict(trial) for trial in found.trials]
    else:
        ringing = nonlinear_ring(point, Kc, size, horizon, sensor=sensor)
    return {"time_unit": time_unit, **out, "notes": list(point.notes), "run": ringing_answer(ringing, horizon)}


def ringing_answer(run: NonlinearRinging, horizon: float) -> dict[str, Any]:
    """A ringing run and what its swings tell."""
    seen = run.oscillation
    return {
        **{name: getattr(run, name) for name in ("Kc", "t", "r", "u", "y", "truncated_at", "truncated_reason")},
        "horizon": horizon,
        "turning_points": {"t": seen.t, "y": seen.y},
        "decay_ratio": seen.decay_ratio,
        "Pu": seen.Pu,
        "reason": None if seen.growth is not None else "there are too few swings to tell their decay",
    }


def relay(at: PlantPoint, settings: Relay, horizon: float, half: float) -> dict[str, Any]:
    """A relay experiment on a plant, as the API answers it."""
    from looplab.engine.experiments.nonlinear import nonlinear_relay

    point, time_unit = _point(at)
    found = nonlinear_relay(point, settings, horizon, half)
    return {**relay_answer(found, settings, time_unit), "notes": list(point.notes), "u0": point.u0, "y0": point.y0}


def relay_answer(found: RelayRun, settings: Relay, time_unit: str) -> dict[str, Any]:
    """A relay run, its estimate, and the same as /tune takes it."""
    point = found.point
    every = max(1, -(-found.t.size // 5000))
    ready = None
    if point is not None:
        ready = {
            "amplitude": settings.amplitude,
            "swing": found.swing,
            "Pu": found.Pu,
            "hysteresis": settings.hysteresis,
        }
    return {
        "time_unit": time_unit,
        "t": found.t[::every],
        "u": found.u[::every],
        "y": found.y[::every],
        "switches": found.switches,
        "swing": found.swing,
        "Pu": found.Pu,
        "Ku": None if point is None else point.Ku,
        "relay": ready,
        "reason": found.reason,
    }
