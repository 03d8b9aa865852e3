"""What workers do with the linear model of a nonlinear one, and with its phase plane."""

from __future__ import annotations

from typing import Any

import numpy as np

from looplab.engine.errors import EngineError, InvalidInput, NonFinite
from looplab.engine.nonlinear.steady_states import (
    LinearModel,
    compare_step,
    linearize,
    phase_plane,
    steady_state_near,
    trajectories,
)
from looplab.engine.nonlinear.steady_states.equations import known_states, search_box
from looplab.engine.nonlinear.steady_states.verdict import kind_of
from looplab.jobs.points import ModelPoint, PointSettings, Values, bounds, column, index_of, pairs, per
from looplab.jobs.tasks import PLANT, ModelSource, located_in

# Horizons, where none is asked for, in slowest time constants.
STEP_HORIZON, PLANE_HORIZON = 5.0, 10.0
POINTS = 301


def linear_model(source: ModelSource, settings: PointSettings, options: dict[str, Any]) -> dict[str, Any]:
    """The linear model at a steady state or at a given point, and how far it holds."""
    point = ModelPoint.of(source, settings)
    model = point.model
    steady = options["at"] == "steady-state"
    with located_in(source, NonFinite):
        x = steady_state_near(model, point.u, point.p, point.near).x if steady else point.near
        linear = linearize(model, x, point.u, point.p)
    J = linear.jacobians
    document = model.document
    slowest = next(iter(linear.time_constants), 1.0)
    answer = {
        **point.head(),
        "x": point.names(linear.x),
        "equilibrium": linear.equilibrium,
        "f": point.names(linear.f),
        "remark": None
        if linear.equilibrium
        else "this point is not an equilibrium: the linear model carries the constant f(x, u) with it",
        "states": _signals(document.states, linear.x),
        "input_signals": _signals(document.inputs, linear.u),
        "output_signals": _signals(document.outputs, linear.y),
        **{name: getattr(J, name).tolist() for name in "ABCD"},
        "poles": pairs(linear.poles),
        "verdict": linear.verdict,
        "because": linear.because,
        "kind": kind_of(linear.poles),
        "time_constants": list(linear.time_constants),
        "channel": None,
        "channel_reason": None,
        "responses": [],
    }
    if not model.input_names:
        return {**answer, "channel_reason": "the model has no input"}
    output = index_of(options["output"], model.output_names, "output")
    input = index_of(options["input"], model.input_names, "input")
    try:
        answer["channel"] = _channel(source, settings, options, point, linear, output, input)
    except EngineError as error:
        answer["channel_reason"] = error.message
    times = np.linspace(0.0, options["horizon"] or STEP_HORIZON * slowest, POINTS)
    for index, size in enumerate(options["steps"]):
        try:
            found = compare_step(model, linear, output, input, size, times)
        except InvalidInput as error:
            if error.field and error.field.startswith("inputs."):
                error.field = f"steps[{index}]"
            raise
        answer["responses"].append({**found.__dict__})
    return answer


def _signals(items: Any, values: Values) -> list[dict[str, Any]]:
    return [
        {**{key: getattr(item, key) for key in ("name", "unit", "meaning", "latex")}, "value": value}
        for item, value in zip(items, values, strict=True)
    ]


def _channel(
    source: ModelSource,
    settings: PointSettings,
    options: dict[str, Any],
    point: ModelPoint,
    linear: LinearModel,
    output: int,
    input: int,
) -> dict[str, Any]:
    document = point.model.document
    names = document.inputs[input].name, document.outputs[output].name
    G = linear.transfer_function(output, input)
    matrices = linear.channel(output, input)
    gain = G.dc_gain
    reasons = {
        "integrating": "a pole at the origin: the output does not come to rest after a step of this input",
        "unstable": "G(0) of an unstable model: between steady states, not what a step leads to",
    }
    finite = bool(np.isfinite(gain))
    is_plant = source.kind == PLANT and options["at"] == "steady-state"
    return {
        "input": names[0],
        "output": names[1],
        "gain": float(gain) if finite else None,
        "gain_unit": per(document.outputs[output].unit, document.inputs[input].unit),
        "gain_reason": reasons["integrating"]
        if not finite
        else reasons["unstable"]
        if linear.verdict == "unstable"
        else None,
        "zeros": pairs(G.zeros),
        "poles": pairs(G.poles),
        "k": float(G.gain),
        "latex": G.to_latex(),
        "ss": {"type": "ss", **{name: getattr(matrices, name).tolist() for name in "ABCD"}},
        "zpk": {"type": "zpk", "zeros": pairs(G.zeros), "poles": pairs(G.poles), "k": float(G.gain)},
        "plant": {
            "type": "plant",
            "id": source.text,
            "params": dict(settings.parameters),
            "operating_point": None,
            "inputs": dict(settings.inputs),
            "near": point.names(linear.x),
            "input": names[0],
            "output": names[1],
        }
        if is_plant
        else None,
    }


def plane(source: ModelSource, settings: PointSettings, options: dict[str, Any]) -> dict[str, Any]:
    """The phase plane of two states."""
    point = ModelPoint.of(source, settings)
    model = point.model
    if len(model.state_names) < 2:
        raise InvalidInput("a phase plane needs two states; the model has one", field="horizontal")
    first = index_of(options["horizontal"], model.state_names, "horizontal")
    rest = [name for name in model.state_names if name != model.state_names[first]]
    second = model.state_names.index(rest[0])
    if options["vertical"] is not None:
        second = index_of(options["vertical"], model.state_names, "vertical")
    with located_in(source, NonFinite):
        x = model.states(options["held"], point.near_or_given(), "held")
        known = [point.near, *known_states(model, point.u, point.p)]
        window = search_box(model, known, bounds(options["ranges"]), "ranges")[[first, second]]
        found = phase_plane(model, x, point.u, point.p, (first, second), window, options["grid"])
        slowest = max(
            (
                1 / abs(pole.real)
                for state in found.steady_states
                for pole in state.eigenvalues
                if abs(pole.real) > 1e-9 * abs(pole)
            ),
            default=1.0,
        )
        times = np.linspace(0.0, options["horizon"] or PLANE_HORIZON * slowest, POINTS)
        paths = trajectories(model, x, point.u, point.p, (first, second), options["starts"], times)
    axes = [
        {"name": each.name, "unit": each.unit, "low": float(low), "high": float(high)}
        for each, (low, high) in zip((model.document.states[i] for i in (first, second)), window, strict=True)
    ]
    held = {name: value for name, value in point.names(x).items() if name not in (axes[0]["name"], axes[1]["name"])}
    return {
        **point.head(),
        "horizontal": axes[0],
        "vertical": axes[1],
        "held": held,
        "field": {
            "horizontal": found.horizontal.tolist(),
            "vertical": found.vertical.tolist(),
            "d_horizontal": [column(row) for row in found.d_horizontal],
            "d_vertical": [column(row) for row in found.d_vertical],
        },
        "nullclines": [
            {
                "state": axis["name"],
                "lines": [
                    {
                        "horizontal": line.horizontal.tolist(),
                        "vertical": line.vertical.tolist(),
                        "closed": line.closed,
                    }
                    for line in lines
                ],
            }
            for axis, lines in zip(axes, found.nullclines, strict=True)
        ],
        "trajectories": [
            {
                "t": path.t.tolist(),
                "horizontal": path.horizontal.tolist(),
                "vertical": path.vertical.tolist(),
                "truncated_at": path.truncated_at,
                "truncated_reason": path.truncated_reason,
            }
            for path in paths
        ],
        "steady_states": [point.steady_state(state) for state in found.steady_states],
        "remark": "arrows, nullclines and steady states are those of the two states with the others held; "
        "trajectories are those of the whole model, which moves the others too"
        if held
        else None,
    }
