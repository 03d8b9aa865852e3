"""The routes for several loops: what they say, and which field they refuse."""

from typing import Any

import numpy as np
import pytest

from looplab.api.answers.mimo import DecouplerAnswer, InteractionAnswer, RGAAnswer, SeveralResponses, SeveralSettings

COLUMN = {"type": "plant", "id": "ethanol-water"}
WOOD_BERRY = {"type": "plant", "id": "wood-berry"}
PI = [
    {"controller": {"type": "pid", "Kc": 0.375, "tau_I": 8.29}},
    {"controller": {"type": "pid", "Kc": -0.075, "tau_I": 23.6}},
]


def ask(post: Any, route: str, body: dict[str, Any], model: Any) -> Any:
    response = post(f"/mimo/{route}", body)
    assert response.status_code == 200, response.text
    return model.model_validate_json(response.content)


def test_relative_gains_of_the_column(post: Any) -> None:
    found = ask(post, "rga", {"plant": COLUMN, "points": 30}, RGAAnswer)
    assert found.rga[0] == pytest.approx([1.421, -0.421], abs=5e-4)
    assert found.pairing == [1, 2] and found.niederlinski == pytest.approx(1 / found.rga[0][0])
    assert found.pairings[1].faults and not found.pairings[1].acceptable
    assert found.inputs[0].meaning == "reflux" and found.time_unit == "min"
    curve = found.frequency.rga
    assert np.array(curve[0][0].re) + np.array(curve[0][1].re) == pytest.approx(np.ones(30), abs=1e-9)
    assert found.condition_number == pytest.approx(np.linalg.cond(found.gains))


def test_what_is_not_defined_has_its_reason(post: Any) -> None:
    integrating = {
        "type": "matrix",
        "entries": [[{"type": "expr", "text": text} for text in row] for row in (["1/s", "0.1"], ["1", "1/(s+1)"])],
    }
    found = ask(post, "rga", {"plant": integrating}, RGAAnswer)
    assert found.gains is None and "integrates" in found.reasons["gains"]
    assert found.rga == [pytest.approx([1, 0]), pytest.approx([0, 1])]
    assert found.niederlinski is None and "stable" in found.reasons["niederlinski"]
    singular = {"type": "matrix", "entries": [[{"type": "fopdt", "K": 2, "tau": 1}] * 2] * 2}
    found = ask(post, "rga", {"plant": singular}, RGAAnswer)
    assert found.rga is None and "singular" in found.reasons["rga"] and found.frequency.rga is None


def test_a_setpoint_step_of_both_loops(post: Any) -> None:
    body = {"plant": WOOD_BERRY, "loops": PI, "changes": [{"kind": "setpoint", "loop": 1}], "horizon": 400}
    found = ask(post, "simulate", body, SeveralResponses)
    assert found.verdict.verdict == "stable"
    assert [y[-1] for y in found.y] == pytest.approx([1, 0], abs=2e-3)
    brief = ask(post, "simulate", {**body, "verdict": False}, SeveralResponses)
    assert brief.y == found.y and brief.verdict is None and brief.reasons["verdict"] == "not asked for"
    crossed = {**body, "pairing": [2, 1]}
    found = ask(post, "simulate", crossed, SeveralResponses)
    assert found.verdict.verdict == "unstable"
    decoupled = {**body, "decoupler": "dynamic", "arrays": "f4"}
    assert ask(post, "simulate", decoupled, SeveralResponses).verdict.verdict == "stable"


def test_one_loop_with_the_other_open_and_closed(post: Any) -> None:
    found = ask(post, "interaction", {"plant": WOOD_BERRY, "loops": PI, "loop": 2}, InteractionAnswer)
    assert found.own_gain == pytest.approx(-19.4)
    assert found.effective_gain == pytest.approx(-19.4 / found.relative_gain)
    assert found.own_margins.closed_loop_stable and found.effective_margins.closed_loop_stable
    assert found.own_response.y[-1] != found.effective_response.y[-1]


def test_decoupler_and_settings(post: Any) -> None:
    found = ask(post, "decoupler", {"plant": COLUMN}, DecouplerAnswer)
    first = found.elements[0]
    assert first.theta == pytest.approx(-1.6) and "prediction" in first.problems[0] and "+1.6" in first.ideal.latex
    assert not found.exact and ask(post, "decoupler", {"plant": COLUMN, "prediction": "wait"}, DecouplerAnswer).exact
    tuned = ask(post, "tune", {"plant": WOOD_BERRY}, SeveralSettings)
    assert tuned.settings[0].controller.Kc == pytest.approx(0.375, abs=5e-4)
    crossed = ask(post, "tune", {"plant": WOOD_BERRY, "pairing": [2, 1]}, SeveralSettings)
    assert all(each.controller is None and "pairing" in each.reason for each in crossed.settings)
    each = ask(post, "tune", {"plant": WOOD_BERRY, "method": "simc"}, SeveralSettings)
    assert each.settings[1].controller.Kc < 0 and each.factor is None


@pytest.mark.parametrize(
    ("route", "change", "path"),
    [
        ("rga", {"plant": {"type": "plant", "id": "cstr"}}, "plant.id"),
        ("rga", {"plant": {"type": "matrix", "entries": [[{"type": "fopdt", "K": 1, "tau": 1}] * 2]}}, "plant.entries"),
        ("rga", {"plant": {"type": "matrix", "entries": [[{"type": "fopdt", "K": 1, "tau": 1}] * 2] * 3}}, None),
        (
            "rga",
            {"plant": {"type": "matrix", "entries": [[{"type": "expr", "text": "1/(s2+1)"}] * 2] * 2}},
            "plant.entries[0][0].text",
        ),
        ("rga", {"plant": {"type": "matrix", "entries": [[{"type": "expr", "text": "s"}] * 2] * 2}}, None),
        ("rga", {"omega": [10, 1]}, "omega"),
        ("simulate", {"pairing": [1, 1]}, "pairing"),
        ("simulate", {"loops": PI[:1]}, "loops"),
        ("simulate", {"loops": [*PI, PI[0]]}, "loops"),
        ("simulate", {"loops": [{**PI[0], "mode": "manual"}, PI[1]]}, "changes[0].kind"),
        ("simulate", {"changes": [{"kind": "setpoint", "loop": 3}]}, "changes[0]"),
        ("simulate", {"loops": [{"controller": {"type": "pid", "Kc": 1, "tau_I": 0}}, PI[1]]}, None),
        ("interaction", {"loop": 3}, "loop"),
        ("decoupler", {"plant": {"type": "plant", "id": "ogunnaike-ray"}}, "decoupler"),
        ("tune", {"method": "magic"}, "method"),
    ],
)
def test_a_refusal_names_its_field(post: Any, route: str, change: dict[str, Any], path: str | None) -> None:
    body: dict[str, Any] = {"plant": WOOD_BERRY}
    if route in ("simulate", "interaction"):
        body["loops"] = PI
    if route == "simulate":
        body["changes"] = [{"kind": "setpoint", "loop": 1}]
    response = post(f"/mimo/{route}", body | change)
    assert response.status_code == 422, response.text
    error = response.json()["error"]
    assert error["message"] and (path is None or error["path"] == path), error
