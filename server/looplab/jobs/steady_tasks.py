"""What workers do with the steady states of nonlinear models. Answers are as the API gives them."""

from __future__ import annotations

from typing import Any

import numpy as np

from looplab.engine.errors import NonFinite
from looplab.engine.nonlinear.steady_states import balance_curve, continue_steady_states, find_steady_states
from looplab.engine.nonlinear.steady_states.continuation import find_setting
from looplab.engine.nonlinear.steady_states.curve import Curve
from looplab.jobs.points import ModelPoint, PointSettings, bounds, column, per
from looplab.jobs.tasks import ModelSource, located_in

# Names of variables that a balance shows where a model has them.
HEATS = ("heat_generated", "heat_removed")


def steady_states(source: ModelSource, settings: PointSettings, options: dict[str, Any]) -> dict[str, Any]:
    """Every steady state that many starts lead to."""
    point = ModelPoint.of(source, settings)
    with located_in(source, NonFinite):
        found = find_steady_states(point.model, point.u, point.p, bounds(options["box"]), options["starts"], point.near)
    return {
        **point.head(),
        "box": dict(zip(point.model.state_names, found.box.tolist(), strict=True)),
        "steady_states": [point.steady_state(state) for state in found.steady_states],
        "starts": found.starts,
        "converged": found.converged,
        "remark": found.remark,
    }


def continuation(source: ModelSource, settings: PointSettings, options: dict[str, Any]) -> dict[str, Any]:
    """Steady states over one input or parameter."""
    point = ModelPoint.of(source, settings)
    model, name, box = point.model, options["over"], bounds(options["box"])
    setting = find_setting(model, name)
    with located_in(source, NonFinite):
        found = continue_steady_states(
            model, point.u, point.p, name, options["low"], options["high"], box, options["starts"], point.near
        )
        at_own = find_steady_states(model, point.u, point.p, box, options["starts"], point.near)
    value = (point.head()["inputs"] | point.head()["parameters"])[name]
    branches = [_branch(point, name, curve) for curve in found.curves]
    special: dict[str, list[dict[str, Any]]] = {"turning": [], "hopf": [], "branch": []}
    for each in found.special:
        shown: dict[str, Any] = {
            "branch": each.branch,
            "index": each.index,
            "value": each.value,
            "states": point.names(each.x),
            "outputs": {key: values[each.index] for key, values in branches[each.branch]["outputs"].items()},
            "determinant": each.determinant,
        }
        if each.kind == "hopf" and each.omega is not None:
            shown |= {"omega": each.omega, "period": 2 * np.pi / each.omega}
        special[each.kind].append(shown)
    return {
        "time_unit": model.document.time_unit,
        "over": {
            "name": name,
            "unit": setting.unit,
            "meaning": setting.meaning,
            "low": found.low,
            "high": found.high,
            "value": value,
        },
        "branches": branches,
        "turning_points": special["turning"],
        "hopf_points": special["hopf"],
        "branch_points": special["branch"],
        "steady_states": [point.steady_state(state) for state in at_own.steady_states],
        "remark": "branches are followed from what a search finds at a few values of the quantity: one that none of "
        "them meets is missed"
        if branches
        else "no steady state was found over this range",
    }


def _branch(point: ModelPoint, over: str, curve: Curve) -> dict[str, Any]:
    model = point.model
    y = np.array([each.y for each in curve.points])
    outputs = np.full((len(y), len(model.output_names)), np.nan)
    u, p = list(point.u), list(point.p)
    names, target = (model.input_names, u) if over in model.input_names else (model.parameter_names, p)
    for row, values in zip(outputs, y.tolist(), strict=True):
        target[names.index(over)] = values[-1]
        try:
            row[:] = model.outputs(0.0, values[:-1], u, p)
        except NonFinite:
            continue
    stable = [count == 0 for count in curve.unstable]
    starts = [0, *(i for i in range(1, len(stable)) if stable[i] != stable[i - 1])]
    pieces = [
        {"first": first, "last": last, "stable": stable[first]}
        for first, last in zip(starts, [*starts[1:], len(stable)], strict=True)
    ]
    return {
        "values": column(y[:, -1]),
        "states": {name: column(y[:, i]) for i, name in enumerate(model.state_names)},
        "outputs": {name: column(outputs[:, i]) for i, name in enumerate(model.output_names)},
        "stable": [*stable, stable[-1]],
        "pieces": pieces,
        "closed": curve.closed,
        "ends": list(curve.ends),
    }


def balance(source: ModelSource, settings: PointSettings, options: dict[str, Any]) -> dict[str, Any]:
    """The balance over one state."""
    point = ModelPoint.of(source, settings)
    model, box = point.model, bounds(options["box"])
    curves = options["curves"]
    if curves is None:
        curves = [name for name in HEATS if name in model.variable_names]
    with located_in(source, NonFinite):
        found = balance_curve(
            model, point.u, point.p, options["state"], options["low"], options["high"], curves, box, point.near
        )
        at_rest = find_steady_states(model, point.u, point.p, box, options["starts"], point.near)
    index = model.state_names.index(found.state)
    state = model.document.states[index]
    quantities = {each.name: each for each in model.document.variables}
    return {
        **point.head(),
        "state": {
            "name": state.name,
            "unit": state.unit,
            "meaning": state.meaning,
            "low": found.low,
            "high": found.high,
        },
        "rate_unit": per(state.unit, model.document.time_unit),
        "branches": [
            {
                "values": column(branch.states[:, index]),
                "states": {name: column(branch.states[:, i]) for i, name in enumerate(model.state_names) if i != index},
                "rate": column(branch.rate),
                "curves": {name: column(values) for name, values in branch.curves.items()},
            }
            for branch in found.branches
        ],
        "curves": [
            {"name": name, "unit": quantities[name].unit, "meaning": quantities[name].meaning} for name in curves
        ],
        "steady_states": [point.steady_state(each) for each in at_rest.steady_states],
        "remark": "the other states are taken to be at rest for each value of this one; where its rate is zero is a "
        "steady state, unstable where the rate rises through zero"
        if found.branches
        else "the other states come to rest nowhere over this range",
    }
